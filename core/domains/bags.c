/* SPDX-License-Identifier: MIT */
/* The domain of bags of vectors: patterns of which a part is enough. */
#include "rlvc/float_rules.h"

#include "rlvc/bags.h"

#include "bag.h"
#include "gather.h"
#include "nearest.h"

#include <string.h>

#define REFUSED (-1.0f)
#define NEEDED_MAX 32e30f /* the largest tau, squared, by the most vectors */

static uint8_t has_enough(const rlvc_layout *layout, const void *percept, const void *feature) {
    const float needed = rlvc_bags_needed(feature);
    rlvc_bag bag;
    if (needed < 0.0f)
        return 0;
    rlvc_bag_read(layout, feature, &bag);
    return rlvc_bag_score(layout, &bag, percept, needed) >= needed;
}

static int exhibits(void *ctx, const void *percept, const void *feature, uint8_t *present) {
    const rlvc_layout layout = rlvc_bag_layout((const rlvc_bags *)ctx);
    if (rlvc_vectors_count(percept) > layout.d->points)
        return -1;
    *present = has_enough(&layout, percept, feature);
    return 0;
}

/* A percept at a time, while it is in the cache, against the whole block of features. */
static int detect(void *ctx, const rlvc_samples *samples, uint32_t first, uint32_t n,
                  const void *features, uint32_t m, uint64_t *columns) {
    const rlvc_layout layout = rlvc_bag_layout((const rlvc_bags *)ctx);
    memset(columns, 0, m * sizeof *columns);
    for (uint32_t i = 0; i < n; i++) {
        const void *percept = rlvc_samples_percept(samples, first + i);
        const unsigned char *feature = (const unsigned char *)features;
        if (rlvc_vectors_count(percept) > layout.d->points)
            return -1;
        for (uint32_t j = 0; j < m; j++, feature += layout.feature_bytes)
            columns[j] |= (uint64_t)has_enough(&layout, percept, feature) << i;
    }
    return 0;
}

static int candidates(void *ctx, const rlvc_samples *samples, uint32_t first, uint32_t room,
                      void *features, uint32_t *written) {
    const rlvc_bags *bags = (const rlvc_bags *)ctx;
    const rlvc_layout layout = rlvc_bag_layout(bags);
    return rlvc_gather_candidates(&layout, bags->size, samples, first, room, features, written);
}

static int name(void *ctx, const void *feature, char *text, uint32_t room) {
    const rlvc_layout layout = rlvc_bag_layout((const rlvc_bags *)ctx);
    rlvc_vectors_name(&layout, "bag ", feature, text, room);
    return 0;
}

static int check_percept(void *ctx, const void *percept) {
    return rlvc_vectors_check_percept(&((const rlvc_bags *)ctx)->vectors, percept);
}

static int check_feature(void *ctx, const void *feature) {
    const rlvc_bags *bags = (const rlvc_bags *)ctx;
    const rlvc_descriptors *d = &bags->vectors;
    const float needed = rlvc_bags_needed(feature);
    if (!(needed >= REFUSED && needed <= NEEDED_MAX) || rlvc_bags_count(feature) > bags->size)
        return 1;
    return d->form == RLVC_DESCRIPTORS_FLOAT &&
           !rlvc_vectors_sound(
               (const float *)rlvc_vectors_at(d, (const unsigned char *)feature + 4u, 0),
               bags->size * d->dimensions);
}

/* ------------------------------------------------------------------ the interface */

rlvc_status rlvc_bags_default(rlvc_bags *bags, uint32_t points, uint32_t dimensions, uint32_t form,
                              float radius) {
    if (bags == NULL)
        return RLVC_E_NULL;
    bags->size = 32u;
    const rlvc_status status =
        rlvc_descriptors_default(&bags->vectors, points, dimensions, form, radius);
    bags->vectors.candidates = 16u;
    return status;
}

rlvc_status rlvc_bags_domain(rlvc_bags *bags, rlvc_domain *domain) {
    rlvc_domain made;
    if (bags == NULL || domain == NULL)
        return RLVC_E_NULL;
    if (rlvc_descriptors_domain(&bags->vectors, &made) != RLVC_OK || bags->size == 0 ||
        bags->size > RLVC_BAGS_SIZE_MAX)
        return RLVC_E_RANGE;
    const rlvc_layout layout = rlvc_bag_layout(bags);
    made.ctx = bags;
    made.feature_bytes = layout.feature_bytes;
    made.feature_words = layout.feature_words;
    made.kind = RLVC_DOMAIN_BAGS;
    made.exhibits = exhibits;
    made.candidates = candidates;
    made.detect = detect;
    made.name = name;
    made.check_percept = check_percept;
    made.check_feature = check_feature;
    *domain = made;
    return RLVC_OK;
}

rlvc_status rlvc_bags_nearest(const rlvc_bags *bags, const void *percept, const void *feature,
                              uint32_t which, uint32_t *point, float *squared) {
    if (bags == NULL || percept == NULL || feature == NULL)
        return RLVC_E_NULL;
    const float unlimited = 3e38f;
    const uint32_t count = rlvc_vectors_count(percept);
    if (count == 0 || count > bags->vectors.points || which >= rlvc_bags_count(feature))
        return RLVC_E_RANGE;
    const rlvc_layout layout = rlvc_bag_layout(bags);
    const void *vectors = (const unsigned char *)feature + 4u;
    const rlvc_pattern pattern = {
        {rlvc_vectors_at(layout.d, vectors, which), NULL}, 0.0f, {0.0f, 0.0f}};
    uint32_t at[2] = {0, 0};
    rlvc_probe wanted;
    rlvc_probe_open(&layout, &pattern, &wanted);
    const float nearest = rlvc_probe_nearest(&wanted, percept, 0.0f, unlimited, at);
    if (point != NULL)
        *point = at[0];
    if (squared != NULL)
        *squared = nearest;
    return RLVC_OK;
}
