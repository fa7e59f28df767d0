/* SPDX-License-Identifier: MIT */
/* Bags: see bag.h. */
#include "rlvc/float_rules.h"

#include "bag.h"

#include "nearest.h"

#include <string.h>

rlvc_layout rlvc_bag_layout(const rlvc_bags *bags) {
    const rlvc_descriptors *d = &bags->vectors;
    const rlvc_layout layout = {
        .d = d,
        .feature_bytes = RLVC_BAGS_FEATURE_BYTES(bags->size, d->dimensions, d->form),
        .feature_words = 2u + bags->size * rlvc_vectors_words(d),
    };
    return layout;
}

float rlvc_bags_needed(const void *feature) {
    float needed = -1.0f;
    if (feature != NULL)
        memcpy(&needed, feature, sizeof needed);
    return needed;
}

uint32_t rlvc_bags_count(const void *feature) {
    return feature != NULL ? rlvc_vectors_count((const unsigned char *)feature + 4u) : 0;
}

/* The vectors of a feature lie behind its count as those of a percept do. */
void rlvc_bag_read(const rlvc_layout *layout, const void *feature, rlvc_bag *bag) {
    bag->count = rlvc_bags_count(feature);
    for (uint32_t i = 0; i < bag->count; i++)
        bag->vector[i] = rlvc_vectors_at(layout->d, (const unsigned char *)feature + 4u, i);
}

float rlvc_bag_likeness(const rlvc_layout *layout, const void *vector, const void *percept) {
    const float limit = layout->d->radius * layout->d->radius;
    const rlvc_pattern pattern = {{vector, NULL}, 0.0f, {0.0f, 0.0f}};
    uint32_t point[2];
    rlvc_probe wanted;
    rlvc_probe_open(layout, &pattern, &wanted);
    return limit - rlvc_probe_nearest(&wanted, percept, 0.0f, limit, point);
}

float rlvc_bag_score(const rlvc_layout *layout, const rlvc_bag *bag, const void *percept,
                     float enough) {
    float sum = 0.0f;
    for (uint32_t i = 0; i < bag->count && sum < enough; i++)
        sum += rlvc_bag_likeness(layout, bag->vector[i], percept);
    return sum;
}
