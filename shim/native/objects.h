/* SPDX-License-Identifier: MIT */
/* The objects of the Tiled Gridworld (examples/gridworld/objects) for the Python package. A
 * separate library, because it needs OpenCV. shim/rlvc/objects.py uses it. */
#ifndef RLVC_SHIM_OBJECTS_H
#define RLVC_SHIM_OBJECTS_H

#include "rlvc/status.h" /* RLVC_API */

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct rlvc_shim_objects rlvc_shim_objects;

/* Reads the objects of a folder that have a picture from each of `count` angles, or renders
 * `wanted` objects.
 * @param folder  UTF-8; empty: render
 * @param wanted  the minimum number of objects
 * @param side    pictures are scaled to side x side; 0: left as they are
 * @param scale_depth  1: 16 bits a channel are scaled to 8; 0: refused
 * @param text    receives the error message, cut to `room` bytes
 * @return 0, and *objects is new; -1, and *objects is unchanged */
RLVC_API int rlvc_shim_objects_find(const char *folder, const int32_t *angles, uint32_t count,
                                    uint32_t wanted, uint32_t side, uint32_t scale_depth,
                                    rlvc_shim_objects **objects, char *text, size_t room);

/* Reads one picture, as the only object, seen from angle 0.
 * @param path    UTF-8
 * @param side, scale_depth, objects, text, room, and what is returned: as above */
RLVC_API int rlvc_shim_objects_read(const char *path, uint32_t side, uint32_t scale_depth,
                                    rlvc_shim_objects **objects, char *text, size_t room);

/* The number of objects, and the height and width of a picture. */
RLVC_API void rlvc_shim_objects_size(const rlvc_shim_objects *objects, uint32_t *count,
                                     uint32_t *height, uint32_t *width);

/* The name of an object in UTF-8, valid as long as the objects. */
RLVC_API const char *rlvc_shim_objects_name(const rlvc_shim_objects *objects, uint32_t index);

/* Copies a picture, red first; grey pictures become R = G = B.
 * @param pixels [height][width][3] */
RLVC_API void rlvc_shim_objects_copy(const rlvc_shim_objects *objects, uint32_t index,
                                     int32_t angle, uint8_t *pixels);

/* Frees the objects; null is allowed. */
RLVC_API void rlvc_shim_objects_free(rlvc_shim_objects *objects);

#ifdef __cplusplus
}
#endif

#endif
