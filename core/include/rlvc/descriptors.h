/* SPDX-License-Identifier: MIT */
/* The ready-made domain of local descriptors (sections 3 and 6.2): a percept is the vectors found
 * at a picture's interest points, a feature is one vector with a radius, and a percept exhibits the
 * feature if the nearest of its vectors is at most the radius away (Euclid's distance). */
#ifndef RLVC_DESCRIPTORS_H
#define RLVC_DESCRIPTORS_H

#include "rlvc/domain.h"
#include "rlvc/status.h"

#ifdef __cplusplus
extern "C" {
#endif

/* form: the type of the numbers of a vector. Values never change. */
#define RLVC_DESCRIPTORS_FLOAT 0u /* binary32, finite, of absolute value at most 1e15 */
#define RLVC_DESCRIPTORS_INT8 1u  /* int8_t: distances are exact */

#define RLVC_DESCRIPTORS_POINTS_MAX 1000u
#define RLVC_DESCRIPTORS_DIMENSIONS_MAX 256u
#define RLVC_DESCRIPTORS_CANDIDATES_MAX 65535u
#define RLVC_DESCRIPTORS_DRAWS_MAX 64u

/* Percepts, features and candidates. It belongs to the caller, who keeps it in place and unchanged
 * while an agent uses the domain. */
typedef struct rlvc_descriptors {
    uint32_t points;     /* P: the most vectors of a percept, [1, RLVC_DESCRIPTORS_POINTS_MAX] */
    uint32_t dimensions; /* D: numbers of a vector, [1, RLVC_DESCRIPTORS_DIMENSIONS_MAX] */
    uint32_t candidates; /* the most features looked at for one class,
                            [1, RLVC_DESCRIPTORS_CANDIDATES_MAX]. Default 64 */
    uint32_t draws;      /* a candidate is the one that the margin rule likes best of so many
                            vectors drawn from the class's percepts, [1,
                            RLVC_DESCRIPTORS_DRAWS_MAX]. Of no meaning without that rule. Default
                            8 */
    float radius;        /* tau, in units of the percept's numbers, (0, 1e15] */
    float margin;        /* m, [1, 16]. 1: every feature has the radius tau. Else the margin
                            rule: each has a radius of its own in [tau / m, m tau], in the widest
                            gap that the class's percepts leave there, and is refused if that is
                            less than a ninth of the interval. Default 1.8 */
    uint8_t form;        /* RLVC_DESCRIPTORS_* */
    uint8_t reserved[3]; /* 0 */
} rlvc_descriptors;

/* Bytes of a vector in a record. */
#define RLVC_DESCRIPTORS_VECTOR_BYTES(dimensions, form)                                            \
    ((form) == RLVC_DESCRIPTORS_INT8 ? (uint32_t)(dimensions) : 4u * (uint32_t)(dimensions))

/* Bytes of a percept: uint32_t count, in [0, P]; P vectors, of which the first `count` mean
 * something; then up to a multiple of 4. */
#define RLVC_DESCRIPTORS_PERCEPT_BYTES(points, dimensions, form)                                   \
    (4u + (RLVC_DESCRIPTORS_VECTOR_BYTES(dimensions, form) * (uint32_t)(points) + 3u) / 4u * 4u)

/* Bytes of a feature: float radius, the vector, then zeros up to a multiple of 4. A negative radius
 * is that of a candidate that was refused: no percept exhibits it. */
#define RLVC_DESCRIPTORS_FEATURE_BYTES(dimensions, form)                                           \
    (4u + (RLVC_DESCRIPTORS_VECTOR_BYTES(dimensions, form) + 3u) / 4u * 4u)

/* Fills *descriptors with the defaults for such percepts. Nothing is checked. O(1).
 * @return RLVC_OK; RLVC_E_NULL. */
RLVC_API rlvc_status rlvc_descriptors_default(rlvc_descriptors *descriptors, uint32_t points,
                                              uint32_t dimensions, uint32_t form, float radius);

/* Makes *domain the domain of such percepts, with *descriptors as its ctx. rlvc_begin and
 * rlvc_observe refuse a percept whose count is above P, or that holds a number which is not finite
 * or is beyond 1e15 (RLVC_E_PERCEPT). The other callbacks fail for a count above P, and for nothing
 * else.
 *
 * Detecting costs O(P D) for each percept and feature, at most. The vectors that candidates come
 * from are drawn from all targets alike, so that a rare one is not missed; without repetition among
 * those of a call. Under the margin rule candidates() measures each vector drawn against up to 512
 * of the class's percepts, evenly chosen: at most O(512 P D) for each of room * draws vectors, in
 * one call.
 *
 * @return RLVC_OK; RLVC_E_NULL; RLVC_E_RANGE (a field), *domain unchanged. O(1). */
RLVC_API rlvc_status rlvc_descriptors_domain(rlvc_descriptors *descriptors, rlvc_domain *domain);

/* The radius of a feature; of a null pointer -1, as of one that no percept exhibits. O(1). */
RLVC_API float rlvc_descriptors_radius(const void *feature);

/* Which vector of a percept is the nearest to that of a feature (of equals the first), and how far
 * it is, squared. To show where a feature was found; acting and learning do not need it. O(P D).
 * @param point, squared each optional
 * @return RLVC_OK; RLVC_E_NULL; RLVC_E_RANGE: the percept has no vector, or a count above P. */
RLVC_API rlvc_status rlvc_descriptors_nearest(const rlvc_descriptors *descriptors,
                                              const void *percept, const void *feature,
                                              uint32_t *point, float *squared);

#ifdef __cplusplus
}
#endif

#endif
