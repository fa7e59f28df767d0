/* SPDX-License-Identifier: MIT */
/* How far percepts are from patterns.
 *
 * Distances stay squared. That of two float vectors is summed in eight lanes, number i in lane i
 * mod 8, which compilers make vector code of without leave to reorder; lane by lane it only grows,
 * and so does the rounded sum of the lanes. Hence a sum that is above the limit after a part of the
 * numbers is above it after all of them, and to stop there changes no answer. Int8 vectors have
 * distances of at most 256 * 255^2 < 2^24, which a float holds exactly.
 *
 * A pair is looked for without memory: for each point near the first vector, those in place, of
 * which there are few, have their distance to the second taken. */
#include "rlvc/float_rules.h"

#include "nearest.h"

#include <string.h>

#define LANES 8u
#define CHUNK 32u /* numbers between two looks at the limit */
#define INT8_FARTHEST 16777216.0f

static inline float sum_of(const float lane[LANES]) {
    return ((lane[0] + lane[4]) + (lane[2] + lane[6])) +
           ((lane[1] + lane[5]) + (lane[3] + lane[7]));
}

/* The squared distance; if it is above the limit, any number above the limit. */
static float between_floats(const float *a, const float *b, uint32_t n, float limit) {
    float lane[LANES] = {0.0f};
    uint32_t i = 0;
    for (; n - i >= CHUNK; i += CHUNK) {
        for (uint32_t k = 0; k < CHUNK; k++) {
            const float difference = a[i + k] - b[i + k];
            lane[k % LANES] += difference * difference;
        }
        if (sum_of(lane) > limit)
            return sum_of(lane);
    }
    for (; n - i >= LANES; i += LANES)
        for (uint32_t k = 0; k < LANES; k++) {
            const float difference = a[i + k] - b[i + k];
            lane[k] += difference * difference;
        }
    for (uint32_t k = 0; k < n - i; k++) {
        const float difference = a[i + k] - b[i + k];
        lane[k] += difference * difference;
    }
    return sum_of(lane);
}

/* Likewise. Chunks are of a length that is not known beforehand, but is a multiple of 16: of that
 * compilers make vector code, while a loop of 16 would be unrolled. */
static inline int32_t between_bytes(const int8_t *a, const int16_t *b, uint32_t n, int32_t limit) {
    const uint32_t even = n & ~15u;
    int32_t sum = 0;
    uint32_t i = 0;
    while (i < even && sum <= limit) {
        const uint32_t to = even - i < CHUNK ? even : i + CHUNK;
        for (; i < to; i++) {
            const int16_t difference = (int16_t)(a[i] - b[i]);
            sum += (int32_t)difference * difference;
        }
    }
    for (; i < n; i++) {
        const int16_t difference = (int16_t)(a[i] - b[i]);
        sum += (int32_t)difference * difference;
    }
    return sum;
}

static void widen(const rlvc_descriptors *d, const void *vector, int16_t *wide) {
    for (uint32_t k = 0; k < d->dimensions; k++)
        wide[k] = ((const int8_t *)vector)[k];
}

void rlvc_probe_open(const rlvc_layout *layout, const rlvc_pattern *pattern, rlvc_probe *made) {
    made->layout = layout;
    made->pattern = *pattern;
    if (layout->d->form == RLVC_DESCRIPTORS_INT8) {
        widen(layout->d, pattern->vector[0], made->wide[0]);
        if (pattern->scale > 0.0f)
            widen(layout->d, pattern->vector[1], made->wide[1]);
    }
}

/* The number that follows a finite one that is not negative. */
static float after(float number) {
    uint32_t bits;
    memcpy(&bits, &number, sizeof bits);
    bits++;
    memcpy(&number, &bits, sizeof number);
    return number;
}

/* The least whole number that is not below a squared distance; none of int8 vectors reaches the
 * highest. */
static int32_t whole_of(float squared) {
    if (!(squared < INT8_FARTHEST))
        return (int32_t)INT8_FARTHEST;
    const int32_t below = (int32_t)squared;
    return below + ((float)below < squared);
}

/* The least squared distance that is below the limit, else the limit. */
static int32_t nearest_bytes(const int8_t *vector, uint32_t count, uint32_t n,
                             const int16_t *wanted, int32_t enough, int32_t limit,
                             uint32_t *point) {
    int32_t least = limit;
    for (uint32_t i = 0; i < count && least >= enough; i++, vector += n) {
        const int32_t squared = between_bytes(vector, wanted, n, least);
        if (squared < least) {
            least = squared;
            *point = i;
        }
    }
    return least;
}

static float nearest_floats(const float *vector, uint32_t count, uint32_t n, const float *wanted,
                            float enough, float limit, uint32_t *point) {
    float least = limit;
    for (uint32_t i = 0; i < count && least >= enough; i++, vector += n) {
        const float squared = between_floats(vector, wanted, n, least);
        if (squared < least) {
            least = squared;
            *point = i;
        }
    }
    return least;
}

static float nearest_vector(const rlvc_probe *wanted, const void *percept, float enough,
                            float limit, uint32_t *point) {
    const rlvc_descriptors *d = wanted->layout->d;
    const void *vectors = rlvc_vectors_at(d, percept, 0);
    const uint32_t count = rlvc_vectors_count(percept);
    if (d->form != RLVC_DESCRIPTORS_INT8)
        return nearest_floats((const float *)vectors, count, d->dimensions,
                              (const float *)wanted->pattern.vector[0], enough, limit, point);
    const int32_t beyond = whole_of(limit);
    const int32_t least = nearest_bytes((const int8_t *)vectors, count, d->dimensions,
                                        wanted->wide[0], whole_of(enough), beyond, point);
    return least < beyond ? (float)least : limit;
}

float rlvc_probe_between(const rlvc_probe *wanted, uint32_t which, const void *vector,
                         float limit) {
    const rlvc_descriptors *d = wanted->layout->d;
    if (d->form != RLVC_DESCRIPTORS_INT8)
        return between_floats((const float *)vector, (const float *)wanted->pattern.vector[which],
                              d->dimensions, limit);
    return (float)between_bytes((const int8_t *)vector, wanted->wide[which], d->dimensions,
                                whole_of(limit));
}

/* How far point j is from where the pattern has it beside point i, squared and scaled. */
static float misplacement(const rlvc_probe *wanted, const void *percept, uint32_t i, uint32_t j) {
    float there[2];
    rlvc_vectors_displacement(wanted->layout, percept, i, j, there);
    const float x = there[0] - wanted->pattern.displacement[0];
    const float y = there[1] - wanted->pattern.displacement[1];
    return (x * x + y * y) * wanted->pattern.scale;
}

/* Likewise for a second point to point i, which is `first` away: the largest of the three
 * distances. */
static float nearest_second(const rlvc_probe *wanted, const void *percept, uint32_t i, float first,
                            float limit, uint32_t *second) {
    const uint32_t count = rlvc_vectors_count(percept);
    float least = limit;
    for (uint32_t j = 0; j < count; j++) {
        const float off = j == i ? least : misplacement(wanted, percept, i, j);
        if (!(off < least))
            continue;
        float worst =
            rlvc_probe_between(wanted, 1, rlvc_vectors_at(wanted->layout->d, percept, j), least);
        worst = worst < first ? first : worst;
        worst = worst < off ? off : worst;
        if (worst < least) {
            least = worst;
            *second = j;
        }
    }
    return least;
}

static float nearest_pair(const rlvc_probe *wanted, const void *percept, float enough, float limit,
                          uint32_t point[2]) {
    const uint32_t count = rlvc_vectors_count(percept);
    float least = limit;
    for (uint32_t i = 0; i < count && least >= enough; i++) {
        const float first =
            rlvc_probe_between(wanted, 0, rlvc_vectors_at(wanted->layout->d, percept, i), least);
        if (!(first < least))
            continue;
        const float worst = nearest_second(wanted, percept, i, first, least, &point[1]);
        if (worst < least) {
            least = worst;
            point[0] = i;
        }
    }
    return least;
}

float rlvc_probe_nearest(const rlvc_probe *wanted, const void *percept, float enough, float limit,
                         uint32_t point[2]) {
    if (wanted->pattern.scale > 0.0f)
        return nearest_pair(wanted, percept, enough, limit, point);
    return nearest_vector(wanted, percept, enough, limit, point);
}

/* ------------------------------------------------------------------ detecting */

static uint8_t within(const rlvc_layout *layout, const void *percept, const void *feature) {
    const float radius = rlvc_descriptors_radius(feature);
    if (radius < 0.0f)
        return 0;
    const float beyond = after(radius * radius);
    uint32_t point[2];
    rlvc_pattern pattern;
    rlvc_probe wanted;
    rlvc_vectors_read(layout, feature, &pattern);
    rlvc_probe_open(layout, &pattern, &wanted);
    return rlvc_probe_nearest(&wanted, percept, beyond, beyond, point) < beyond;
}

int rlvc_vectors_exhibits(const rlvc_layout *layout, const void *percept, const void *feature,
                          uint8_t *present) {
    if (rlvc_vectors_count(percept) > layout->d->points)
        return -1;
    *present = within(layout, percept, feature);
    return 0;
}

/* A percept at a time, while it is in the cache, against the whole block of features. */
int rlvc_vectors_detect(const rlvc_layout *layout, const rlvc_samples *samples, uint32_t first,
                        uint32_t n, const void *features, uint32_t m, uint64_t *columns) {
    uint64_t column[RLVC_DETECT_FEATURES] = {0};
    for (uint32_t i = 0; i < n; i++) {
        const void *percept = rlvc_samples_percept(samples, first + i);
        const unsigned char *feature = (const unsigned char *)features;
        if (rlvc_vectors_count(percept) > layout->d->points)
            return -1;
        for (uint32_t j = 0; j < m; j++, feature += layout->feature_bytes)
            column[j] |= (uint64_t)within(layout, percept, feature) << i;
    }
    memcpy(columns, column, m * sizeof *columns);
    return 0;
}
