/* SPDX-License-Identifier: MIT */
/* Vectors, places and patterns in records. */
#include "rlvc/float_rules.h"

#include "vectors.h"

#include <string.h>

#define NUMBER_MAX 1e15f
#define RADIUS_MAX 16e15f /* the largest tau with the largest margin */
#define REFUSED (-1.0f)
#define UNIT 127.0f /* the length of a direction */

static uint32_t vector_bytes(const rlvc_descriptors *d) {
    return RLVC_DESCRIPTORS_VECTOR_BYTES(d->dimensions, d->form);
}

uint32_t rlvc_vectors_words(const rlvc_descriptors *d) {
    return d->form == RLVC_DESCRIPTORS_FLOAT ? d->dimensions : 0;
}

uint32_t rlvc_vectors_count(const void *percept) {
    uint32_t count;
    memcpy(&count, percept, sizeof count);
    return count;
}

const void *rlvc_vectors_at(const rlvc_descriptors *d, const void *record, uint32_t i) {
    return (const unsigned char *)record + 4u + (size_t)i * vector_bytes(d);
}

/* Coordinate i of the places behind a percept's vectors. */
static int32_t coordinate(const unsigned char *places, size_t i) {
    const uint32_t bits = (uint32_t)places[2u * i] | (uint32_t)places[2u * i + 1u] << 8;
    return (int32_t)(bits ^ 0x8000u) - 0x8000;
}

void rlvc_vectors_displacement(const rlvc_layout *layout, const void *percept, uint32_t i,
                               uint32_t j, float displacement[2]) {
    const rlvc_descriptors *d = layout->d;
    const unsigned char *places = (const unsigned char *)percept +
                                  RLVC_DESCRIPTORS_PERCEPT_BYTES(d->points, d->dimensions, d->form);
    const size_t from = 2u * (size_t)i, to = 2u * (size_t)j;
    const float x = (float)(coordinate(places, to) - coordinate(places, from));
    const float y = (float)(coordinate(places, to + 1u) - coordinate(places, from + 1u));
    displacement[0] = x;
    displacement[1] = y;
    if (layout->directed) {
        const int8_t *direction = (const int8_t *)places + 4u * (size_t)d->points + from;
        const float along = (float)direction[0] / UNIT, across = (float)direction[1] / UNIT;
        displacement[0] = x * along + y * across;
        displacement[1] = y * along - x * across;
    }
}

void rlvc_vectors_read(const rlvc_layout *layout, const void *feature, rlvc_pattern *pattern) {
    const unsigned char *in = (const unsigned char *)feature + 4u;
    pattern->scale = 0.0f;
    if (layout->pairs > 0) {
        memcpy(&pattern->scale, in, 4u);
        memcpy(pattern->displacement, in + 4u, 8u);
        in += 12u;
    }
    pattern->vector[0] = in;
    pattern->vector[1] = layout->pairs > 0 ? in + vector_bytes(layout->d) : NULL;
}

void rlvc_vectors_write(const rlvc_layout *layout, const rlvc_pattern *pattern, float radius,
                        void *feature) {
    const uint32_t bytes = vector_bytes(layout->d);
    unsigned char *out = (unsigned char *)feature;
    memset(out, 0, layout->feature_bytes);
    memcpy(out, &radius, sizeof radius);
    out += 4u;
    if (layout->pairs > 0)
        out += 12u;
    memcpy(out, pattern->vector[0], bytes);
    if (pattern->scale > 0.0f) {
        memcpy(out - 12u, &pattern->scale, 4u);
        memcpy(out - 8u, pattern->displacement, 8u);
        memcpy(out + bytes, pattern->vector[1], bytes);
    }
}

int rlvc_vectors_equal(const rlvc_layout *layout, const rlvc_pattern *a, const rlvc_pattern *b) {
    const uint32_t bytes = vector_bytes(layout->d);
    if (memcmp(a->vector[0], b->vector[0], bytes) != 0 ||
        memcmp(&a->scale, &b->scale, sizeof a->scale) != 0)
        return 0;
    return !(a->scale > 0.0f) ||
           (memcmp(a->displacement, b->displacement, sizeof a->displacement) == 0 &&
            memcmp(a->vector[1], b->vector[1], bytes) == 0);
}

int rlvc_vectors_sound(const float *number, uint32_t count) {
    uint32_t i = 0;
    while (i < count && number[i] >= -NUMBER_MAX && number[i] <= NUMBER_MAX)
        i++;
    return i == count;
}

int rlvc_vectors_check_percept(const rlvc_descriptors *d, const void *percept) {
    const uint32_t count = rlvc_vectors_count(percept);
    if (count > d->points)
        return 1;
    return d->form == RLVC_DESCRIPTORS_FLOAT &&
           !rlvc_vectors_sound((const float *)rlvc_vectors_at(d, percept, 0),
                               count * d->dimensions);
}

int rlvc_vectors_check_feature(const rlvc_layout *layout, const void *feature) {
    const rlvc_descriptors *d = layout->d;
    const float radius = rlvc_descriptors_radius(feature);
    rlvc_pattern pattern;
    rlvc_vectors_read(layout, feature, &pattern);
    if (!(radius >= REFUSED && radius <= RADIUS_MAX))
        return 1;
    return d->form == RLVC_DESCRIPTORS_FLOAT &&
           !rlvc_vectors_sound((const float *)pattern.vector[0],
                               layout->pairs > 0 ? 2u * d->dimensions : d->dimensions);
}

/* Byte i of a feature's record as it is stored: of numbers the lowest first. */
static uint32_t stored_byte(const rlvc_layout *layout, const void *feature, uint32_t i) {
    const unsigned char *byte = (const unsigned char *)feature;
    uint32_t number;
    if (i / 4u >= layout->feature_words)
        return byte[i];
    memcpy(&number, byte + i / 4u * 4u, sizeof number);
    return number >> 8u * (i % 4u) & 255u;
}

/* The hash is FNV-1a. */
void rlvc_vectors_name(const rlvc_layout *layout, const char *word, const void *feature, char *text,
                       uint32_t room) {
    uint32_t sum = 2166136261u, n = 0;
    for (uint32_t i = 0; i < layout->feature_bytes; i++)
        sum = (sum ^ stored_byte(layout, feature, i)) * 16777619u;
    for (; *word != '\0' && n + 1u < room; n++)
        text[n] = *word++;
    for (uint32_t digit = 0; digit < 8u && n + 1u < room; digit++, n++)
        text[n] = "0123456789abcdef"[sum >> (28u - 4u * digit) & 15u];
    text[n] = '\0';
}
