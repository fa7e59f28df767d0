/* SPDX-License-Identifier: MIT */
/* What the domains of descriptors and of pairs have in common: how vectors, places and patterns
 * stand in records. A pattern is what a feature looks for: a vector or a pair of vectors. */
#ifndef RLVC_DOMAINS_VECTORS_H
#define RLVC_DOMAINS_VECTORS_H

#include "rlvc/descriptors.h"

#include <stddef.h>
#include <stdint.h>

/* What records look like. */
typedef struct rlvc_layout {
    const rlvc_descriptors *d;
    uint32_t feature_bytes;
    uint32_t feature_words; /* numbers of 4 bytes that a feature begins with */
    uint32_t pairs;   /* how many candidates are pairs, behind d->candidates vectors; 0: percepts
                         have no places and features no room for a second vector */
    uint8_t directed; /* has each place a direction? */
} rlvc_layout;

/* A pattern: vector [0], or if `scale` is not 0 also vector [1] of another point, displaced from
 * the first. Its vectors lie in a percept or in a feature. */
typedef struct rlvc_pattern {
    const void *vector[2];
    float scale; /* what a squared pixel of displacement counts beside a squared distance */
    float displacement[2];
} rlvc_pattern;

/* Numbers of 4 bytes of a vector. */
uint32_t rlvc_vectors_words(const rlvc_descriptors *d);
uint32_t rlvc_vectors_count(const void *percept);
/* Vector i of a percept. */
const void *rlvc_vectors_at(const rlvc_descriptors *d, const void *record, uint32_t i);
/* From a percept's point i to its point j, in pixels; if points have directions, turned by that of
 * point i. */
void rlvc_vectors_displacement(const rlvc_layout *layout, const void *percept, uint32_t i,
                               uint32_t j, float displacement[2]);
/* The pattern of a feature, and back: writes a whole record. */
void rlvc_vectors_read(const rlvc_layout *layout, const void *feature, rlvc_pattern *pattern);
void rlvc_vectors_write(const rlvc_layout *layout, const rlvc_pattern *pattern, float radius,
                        void *feature);
/* Are both patterns the same? */
int rlvc_vectors_equal(const rlvc_layout *layout, const rlvc_pattern *a, const rlvc_pattern *b);

/* What check_percept and check_feature have in common: 0 if sound. */
int rlvc_vectors_check_percept(const rlvc_descriptors *d, const void *percept);
int rlvc_vectors_check_feature(const rlvc_layout *layout, const void *feature);
/* Are the first numbers at a place finite and of absolute value at most 1e15? */
int rlvc_vectors_sound(const float *number, uint32_t count);
/* The text of name(): a word, a space and eight hexadecimal digits, a hash of the record. */
void rlvc_vectors_name(const rlvc_layout *layout, const char *word, const void *feature, char *text,
                       uint32_t room);

#endif
