/* SPDX-License-Identifier: MIT */
/* The ready-made domain of features of several points (section 7: "semi-local constraints"): a
 * percept is the vectors found at a picture's interest points with the points' places, a feature is
 * one vector, as in rlvc/descriptors.h, or a pair of vectors with a displacement. A percept
 * exhibits a pair if two of its points are like the two vectors and lie to each other as the
 * displacement says. */
#ifndef RLVC_SPATIAL_H
#define RLVC_SPATIAL_H

#include "rlvc/descriptors.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Percepts, features and candidates. It belongs to the caller, who keeps it in place and unchanged
 * while an agent uses the domain. */
typedef struct rlvc_spatial {
    rlvc_descriptors vectors; /* its candidates are those of one vector; draws, radius and margin
                                 hold for pairs, too */
    uint32_t pairs;           /* the most pairs looked at for one class, after the single vectors,
                                 [1, RLVC_DESCRIPTORS_CANDIDATES_MAX]. Default 64 */
    uint8_t directed;         /* 1: points have directions, and a displacement is turned with the
                                 direction of its first point, so that a turn of the picture leaves
                                 it alone; 0: they have none. Default: what was asked for */
    uint8_t reserved[3];      /* 0 */
} rlvc_spatial;

/* Bytes of a percept: the record of rlvc/descriptors.h; for each of the P points int16_t x, y in
 * pixels, low byte first; if directed, for each int8_t c, s, the direction as 127 cos and 127 sin;
 * then zeros up to a multiple of 4. Of the points the first `count` mean something. */
#define RLVC_SPATIAL_PERCEPT_BYTES(points, dimensions, form, directed)                             \
    (RLVC_DESCRIPTORS_PERCEPT_BYTES(points, dimensions, form) +                                    \
     ((directed) ? ((uint32_t)(points)*6u + 3u) / 4u * 4u : (uint32_t)(points)*4u))

/* Bytes of a feature: float radius, float scale, float displacement[2] in pixels, the first vector
 * and the second, then zeros up to a multiple of 4. Scale, displacement and second vector are 0 for
 * a feature of a single vector. A negative radius is that of a candidate that was refused.
 *
 * A pair (a, b) is there if for two distinct points i, j of the percept all of |v_i - a|,
 * |v_j - b| and sqrt(scale) |p_j - p_i - displacement| are at most the radius. scale is tau^2 /
 * rho^2 with rho = max(4 pixels, 0.35 |displacement|): at the radius tau, a displacement may err by
 * rho. */
#define RLVC_SPATIAL_FEATURE_BYTES(dimensions, form)                                               \
    (16u + (2u * RLVC_DESCRIPTORS_VECTOR_BYTES(dimensions, form) + 3u) / 4u * 4u)

/* Fills *spatial with the defaults for such percepts. Nothing is checked. O(1).
 * @return RLVC_OK; RLVC_E_NULL. */
RLVC_API rlvc_status rlvc_spatial_default(rlvc_spatial *spatial, uint32_t points,
                                          uint32_t dimensions, uint32_t form, uint32_t directed,
                                          float radius);

/* Makes *domain the domain of such percepts, with *spatial as its ctx. Percepts are refused as by
 * rlvc_descriptors_domain; any places will do.
 *
 * Detecting a pair costs O(P D + N P + M D) for each percept, where N points are like the first
 * vector and M have another in place: in the worst case O(P^2 D). The two points of a candidate are
 * of one percept and more than 6 pixels apart. The margin rule takes a pair's distance, the largest
 * of the three, for a vector's.
 *
 * @return RLVC_OK; RLVC_E_NULL; RLVC_E_RANGE (a field), *domain unchanged. O(1). */
RLVC_API rlvc_status rlvc_spatial_domain(rlvc_spatial *spatial, rlvc_domain *domain);

/* Is a feature a pair? O(1).
 * @return 1 or 0; 0 for a null pointer. */
RLVC_API int rlvc_spatial_is_pair(const rlvc_spatial *spatial, const void *feature);

/* Which points of a percept are nearest to a feature (of equals the first), and how far they are,
 * squared. To show where a feature was found; acting and learning do not need it.
 * @param point   [2], of a single vector twice the same
 * @param squared optional
 * @return RLVC_OK; RLVC_E_NULL; RLVC_E_RANGE: the percept has fewer points than the feature, or a
 *         count above P. */
RLVC_API rlvc_status rlvc_spatial_nearest(const rlvc_spatial *spatial, const void *percept,
                                          const void *feature, uint32_t point[2], float *squared);

#ifdef __cplusplus
}
#endif

#endif
