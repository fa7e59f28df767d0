/* SPDX-License-Identifier: MIT */
/* The objects of the Tiled Gridworld (examples/gridworld/objects) for the Python package: pictures
 * in, pixels out. A library of its own, since it reads files by OpenCV; shim/rlvc/objects.py
 * declares it. */
#ifndef RLVC_SHIM_OBJECTS_H
#define RLVC_SHIM_OBJECTS_H

#include "rlvc/status.h" /* RLVC_API */

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct rlvc_shim_objects rlvc_shim_objects;

/* Finds objects that are there from each of `count` angles: those of a folder, or `wanted` rendered
 * ones.
 * @param folder  UTF-8; empty: rendered
 * @param wanted  at least so many
 * @param text    gets what was wrong, in `room` bytes; longer text is cut
 * @return 0, and *objects is new; -1, and *objects is unchanged */
RLVC_API int rlvc_shim_objects_find(const char *folder, const int32_t *angles, uint32_t count,
                                    uint32_t wanted, rlvc_shim_objects **objects, char *text,
                                    size_t room);

/* How many there are, and the height and width of a picture. */
RLVC_API void rlvc_shim_objects_size(const rlvc_shim_objects *objects, uint32_t *count,
                                     uint32_t *height, uint32_t *width);

/* The name of an object; UTF-8, as long as the objects live. */
RLVC_API const char *rlvc_shim_objects_name(const rlvc_shim_objects *objects, uint32_t index);

/* Copies a picture: red first, also of grey ones.
 * @param pixels [height][width][3] */
RLVC_API void rlvc_shim_objects_copy(const rlvc_shim_objects *objects, uint32_t index,
                                     int32_t angle, uint8_t *pixels);

/* Frees the objects; null is allowed. */
RLVC_API void rlvc_shim_objects_free(rlvc_shim_objects *objects);

#ifdef __cplusplus
}
#endif

#endif
