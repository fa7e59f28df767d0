/* SPDX-License-Identifier: MIT */
/* The domain of local descriptors (sections 3 and 6.2): patterns of one vector. */
#include "rlvc/float_rules.h"

#include "rlvc/descriptors.h"

#include "draws.h"
#include "nearest.h"
#include "vectors.h"

#include <string.h>

#define NUMBER_MAX 1e15f
#define MARGIN_MAX 16.0f

static rlvc_layout layout_of(const rlvc_descriptors *d) {
    const rlvc_layout layout = {
        .d = d,
        .feature_bytes = RLVC_DESCRIPTORS_FEATURE_BYTES(d->dimensions, d->form),
        .feature_words = 1u + rlvc_vectors_words(d),
    };
    return layout;
}

float rlvc_descriptors_radius(const void *feature) {
    float radius = -1.0f;
    if (feature != NULL)
        memcpy(&radius, feature, sizeof radius);
    return radius;
}

static int exhibits(void *ctx, const void *percept, const void *feature, uint8_t *present) {
    const rlvc_layout layout = layout_of((const rlvc_descriptors *)ctx);
    return rlvc_vectors_exhibits(&layout, percept, feature, present);
}

static int detect(void *ctx, const rlvc_samples *samples, uint32_t first, uint32_t n,
                  const void *features, uint32_t m, uint64_t *columns) {
    const rlvc_layout layout = layout_of((const rlvc_descriptors *)ctx);
    return rlvc_vectors_detect(&layout, samples, first, n, features, m, columns);
}

static int candidates(void *ctx, const rlvc_samples *samples, uint32_t first, uint32_t room,
                      void *features, uint32_t *written) {
    const rlvc_layout layout = layout_of((const rlvc_descriptors *)ctx);
    return rlvc_draw_candidates(&layout, samples, first, room, features, written);
}

static int name(void *ctx, const void *feature, char *text, uint32_t room) {
    const rlvc_layout layout = layout_of((const rlvc_descriptors *)ctx);
    rlvc_vectors_name(&layout, "vector ", feature, text, room);
    return 0;
}

static int check_percept(void *ctx, const void *percept) {
    return rlvc_vectors_check_percept((const rlvc_descriptors *)ctx, percept);
}

static int check_feature(void *ctx, const void *feature) {
    const rlvc_layout layout = layout_of((const rlvc_descriptors *)ctx);
    return rlvc_vectors_check_feature(&layout, feature);
}

/* ------------------------------------------------------------------ the interface */

rlvc_status rlvc_descriptors_default(rlvc_descriptors *descriptors, uint32_t points,
                                     uint32_t dimensions, uint32_t form, float radius) {
    if (descriptors == NULL)
        return RLVC_E_NULL;
    const rlvc_descriptors made = {
        .points = points,
        .dimensions = dimensions,
        .candidates = 64u,
        .draws = 8u,
        .radius = radius,
        .margin = 1.8f,
        .form = (uint8_t)form,
    };
    *descriptors = made;
    return RLVC_OK;
}

static int in(uint32_t value, uint32_t low, uint32_t high) {
    return value >= low && value <= high;
}

/* A percept of the most points and dimensions is below the 2^20 bytes that a domain may have. */
static int is_valid(const rlvc_descriptors *d) {
    return in(d->points, 1, RLVC_DESCRIPTORS_POINTS_MAX) &&
           in(d->dimensions, 1, RLVC_DESCRIPTORS_DIMENSIONS_MAX) &&
           in(d->candidates, 1, RLVC_DESCRIPTORS_CANDIDATES_MAX) &&
           in(d->draws, 1, RLVC_DESCRIPTORS_DRAWS_MAX) && d->form <= RLVC_DESCRIPTORS_INT8 &&
           d->radius > 0.0f && d->radius <= NUMBER_MAX && d->margin >= 1.0f &&
           d->margin <= MARGIN_MAX;
}

rlvc_status rlvc_descriptors_domain(rlvc_descriptors *descriptors, rlvc_domain *domain) {
    if (descriptors == NULL || domain == NULL)
        return RLVC_E_NULL;
    if (!is_valid(descriptors))
        return RLVC_E_RANGE;
    const rlvc_domain made = {
        .ctx = descriptors,
        .percept_bytes = RLVC_DESCRIPTORS_PERCEPT_BYTES(descriptors->points,
                                                        descriptors->dimensions, descriptors->form),
        .feature_bytes = RLVC_DESCRIPTORS_FEATURE_BYTES(descriptors->dimensions, descriptors->form),
        .features_max = descriptors->candidates,
        .kind = RLVC_DOMAIN_DESCRIPTORS,
        .exhibits = exhibits,
        .candidates = candidates,
        .detect = detect,
        .name = name,
        .check_percept = check_percept,
        .check_feature = check_feature,
        .method = &rlvc_method_classes,
        .percept_words = 1u + rlvc_vectors_words(descriptors) * descriptors->points,
        .feature_words = 1u + rlvc_vectors_words(descriptors),
    };
    *domain = made;
    return RLVC_OK;
}

rlvc_status rlvc_descriptors_nearest(const rlvc_descriptors *descriptors, const void *percept,
                                     const void *feature, uint32_t *point, float *squared) {
    const float unlimited = 3e38f;
    if (descriptors == NULL || percept == NULL || feature == NULL)
        return RLVC_E_NULL;
    const uint32_t count = rlvc_vectors_count(percept);
    if (count == 0 || count > descriptors->points)
        return RLVC_E_RANGE;
    const rlvc_layout layout = layout_of(descriptors);
    uint32_t at[2] = {0, 0};
    rlvc_pattern pattern;
    rlvc_probe wanted;
    rlvc_vectors_read(&layout, feature, &pattern);
    rlvc_probe_open(&layout, &pattern, &wanted);
    const float least = rlvc_probe_nearest(&wanted, percept, 0.0f, unlimited, at);
    if (point != NULL)
        *point = at[0];
    if (squared != NULL)
        *squared = least;
    return RLVC_OK;
}
