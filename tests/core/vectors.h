/* SPDX-License-Identifier: MIT */
/* Percepts of vectors of small whole numbers, whose distances are exact in both forms: what the
 * tests of the two domains of vectors begin with. Include after cmocka.h, with POINTS_MAX,
 * DIMENSIONS_MAX and FEATURES_MAX defined. */
#ifndef RLVC_TESTS_VECTORS_H
#define RLVC_TESTS_VECTORS_H

#include "base/rng.h"
#include "rlvc/spatial.h"

#include <string.h>

#define PERCEPTS 80u

typedef struct fixture {
    rlvc_spatial s; /* of it the domain of descriptors has s.vectors alone */
    rlvc_domain domain;
    rlvc_samples samples;
    rlvc_sample sample[PERCEPTS];
    float percepts[PERCEPTS * (1u + POINTS_MAX * (DIMENSIONS_MAX + 2u))];
    float features[FEATURES_MAX * (4u + 2u * DIMENSIONS_MAX)];
    rlvc_rng rng;
} fixture;

static fixture f;

static inline unsigned char *percept(uint32_t i) {
    return (unsigned char *)f.percepts + (size_t)i * f.domain.percept_bytes;
}

static inline unsigned char *feature(uint32_t j) {
    return (unsigned char *)f.features + (size_t)j * f.domain.feature_bytes;
}

static inline uint32_t vector_bytes(void) {
    return RLVC_DESCRIPTORS_VECTOR_BYTES(f.s.vectors.dimensions, f.s.vectors.form);
}

static inline void set_count(uint32_t i, uint32_t count) {
    memcpy(percept(i), &count, sizeof count);
}

static inline uint32_t count_of(const unsigned char *p) {
    uint32_t count;
    memcpy(&count, p, sizeof count);
    return count;
}

/* The vectors of a percept or a feature follow its count or radius. */
static inline unsigned char *vectors_of(unsigned char *record) {
    return record + 4u;
}

static inline void set_number(unsigned char *vectors, uint32_t i, int value) {
    const float number = (float)value;
    const int8_t byte = (int8_t)value;
    if (f.s.vectors.form == RLVC_DESCRIPTORS_INT8)
        memcpy(vectors + i, &byte, 1);
    else
        memcpy(vectors + 4u * i, &number, sizeof number);
}

static inline double get_number(const unsigned char *vectors, uint32_t i) {
    float number;
    if (f.s.vectors.form == RLVC_DESCRIPTORS_INT8)
        return (double)(int8_t)vectors[i];
    memcpy(&number, vectors + 4u * i, sizeof number);
    return (double)number;
}

/* A vector's squared distance from a percept's vector number `point`. */
static inline double squared_of(const unsigned char *p, uint32_t point,
                                const unsigned char *vector) {
    const uint32_t n = f.s.vectors.dimensions;
    double sum = 0.0;
    for (uint32_t k = 0; k < n; k++) {
        const double difference = get_number(p + 4u, point * n + k) - get_number(vector, k);
        sum += difference * difference;
    }
    return sum;
}

/* Draws 0 to P vectors for each percept, when the domain has been made, and groups the samples. */
static inline void draw_percepts(void) {
    const rlvc_descriptors *of = &f.s.vectors;
    rlvc_rng_seed(&f.rng, of->points + of->dimensions);
    assert_true(f.domain.percept_bytes * PERCEPTS <= sizeof f.percepts);
    for (uint32_t i = 0; i < PERCEPTS; i++) {
        set_count(i, rlvc_rng_below(&f.rng, of->points + 1u));
        for (uint32_t k = 0; k < of->points * of->dimensions; k++)
            set_number(vectors_of(percept(i)), k, (int)rlvc_rng_below(&f.rng, 5) - 2);
        f.sample[i] = (rlvc_sample){i / 7u, (i * 31u) % PERCEPTS};
    }
    f.samples =
        (rlvc_samples){(unsigned char *)f.percepts, f.sample, f.domain.percept_bytes, PERCEPTS};
}

#endif
