/* SPDX-License-Identifier: MIT */
/* How far a percept is from a pattern, and whether it exhibits a feature. */
#ifndef RLVC_DOMAINS_NEAREST_H
#define RLVC_DOMAINS_NEAREST_H

#include "vectors.h"

/* A pattern in the form that distances are taken in. */
typedef struct rlvc_probe {
    const rlvc_layout *layout;
    rlvc_pattern pattern;
    int16_t wide[2][RLVC_DESCRIPTORS_DIMENSIONS_MAX]; /* int8 vectors: distances take less work */
} rlvc_probe;

void rlvc_probe_open(const rlvc_layout *layout, const rlvc_pattern *pattern, rlvc_probe *made);

/* How far a percept is from a pattern, squared, if that is below the limit, else the limit. Of a
 * pair it is the largest of the three: of the distances of both vectors, and of the error of the
 * displacement by the pattern's scale. The first below `enough` will do.
 * @param point [2]: which of the percept's points; set if any is below the limit. Of a single
 *              vector only the first. */
float rlvc_probe_nearest(const rlvc_probe *wanted, const void *percept, float enough, float limit,
                         uint32_t point[2]);

/* From the pattern's vector `which` to another, squared; if that is not below the limit, any number
 * that is not. */
float rlvc_probe_between(const rlvc_probe *wanted, uint32_t which, const void *vector, float limit);

/* The domains' callbacks, given a layout. */
int rlvc_vectors_exhibits(const rlvc_layout *layout, const void *percept, const void *feature,
                          uint8_t *present);
int rlvc_vectors_detect(const rlvc_layout *layout, const rlvc_samples *samples, uint32_t first,
                        uint32_t n, const void *features, uint32_t m, uint64_t *columns);

#endif
