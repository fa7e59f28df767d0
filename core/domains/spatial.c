/* SPDX-License-Identifier: MIT */
/* The domain of features of several points (section 7): patterns of one vector or two. */
#include "rlvc/float_rules.h"

#include "rlvc/spatial.h"

#include "draws.h"
#include "nearest.h"
#include "vectors.h"

#include <string.h>

#define SCALE_MAX 1e30f /* the largest tau, squared */

static rlvc_layout layout_of(const rlvc_spatial *spatial) {
    const rlvc_descriptors *d = &spatial->vectors;
    const rlvc_layout layout = {
        .d = d,
        .feature_bytes = RLVC_SPATIAL_FEATURE_BYTES(d->dimensions, d->form),
        .feature_words = 4u + 2u * rlvc_vectors_words(d),
        .pairs = spatial->pairs,
        .directed = spatial->directed,
    };
    return layout;
}

static int exhibits(void *ctx, const void *percept, const void *feature, uint8_t *present) {
    const rlvc_layout layout = layout_of((const rlvc_spatial *)ctx);
    return rlvc_vectors_exhibits(&layout, percept, feature, present);
}

static int detect(void *ctx, const rlvc_samples *samples, uint32_t first, uint32_t n,
                  const void *features, uint32_t m, uint64_t *columns) {
    const rlvc_layout layout = layout_of((const rlvc_spatial *)ctx);
    return rlvc_vectors_detect(&layout, samples, first, n, features, m, columns);
}

static int candidates(void *ctx, const rlvc_samples *samples, uint32_t first, uint32_t room,
                      void *features, uint32_t *written) {
    const rlvc_layout layout = layout_of((const rlvc_spatial *)ctx);
    return rlvc_draw_candidates(&layout, samples, first, room, features, written);
}

static int name(void *ctx, const void *feature, char *text, uint32_t room) {
    const rlvc_spatial *spatial = (const rlvc_spatial *)ctx;
    const rlvc_layout layout = layout_of(spatial);
    rlvc_vectors_name(&layout, rlvc_spatial_is_pair(spatial, feature) ? "pair " : "vector ",
                      feature, text, room);
    return 0;
}

static int check_percept(void *ctx, const void *percept) {
    return rlvc_vectors_check_percept(&((const rlvc_spatial *)ctx)->vectors, percept);
}

static int check_feature(void *ctx, const void *feature) {
    const rlvc_layout layout = layout_of((const rlvc_spatial *)ctx);
    rlvc_pattern pattern;
    rlvc_vectors_read(&layout, feature, &pattern);
    if (!(pattern.scale >= 0.0f && pattern.scale <= SCALE_MAX))
        return 1;
    return !rlvc_vectors_sound(pattern.displacement, 2) ||
           rlvc_vectors_check_feature(&layout, feature);
}

/* ------------------------------------------------------------------ the interface */

rlvc_status rlvc_spatial_default(rlvc_spatial *spatial, uint32_t points, uint32_t dimensions,
                                 uint32_t form, uint32_t directed, float radius) {
    if (spatial == NULL)
        return RLVC_E_NULL;
    memset(spatial, 0, sizeof *spatial);
    spatial->pairs = 64u;
    spatial->directed = (uint8_t)directed;
    return rlvc_descriptors_default(&spatial->vectors, points, dimensions, form, radius);
}

/* A percept of the most points and dimensions is below the 2^20 bytes that a domain may have. */
rlvc_status rlvc_spatial_domain(rlvc_spatial *spatial, rlvc_domain *domain) {
    rlvc_domain made;
    if (spatial == NULL || domain == NULL)
        return RLVC_E_NULL;
    if (rlvc_descriptors_domain(&spatial->vectors, &made) != RLVC_OK || spatial->pairs == 0 ||
        spatial->pairs > RLVC_DESCRIPTORS_CANDIDATES_MAX || spatial->directed > 1u)
        return RLVC_E_RANGE;
    const rlvc_descriptors *d = &spatial->vectors;
    made.ctx = spatial;
    made.percept_bytes =
        RLVC_SPATIAL_PERCEPT_BYTES(d->points, d->dimensions, d->form, spatial->directed);
    made.feature_bytes = RLVC_SPATIAL_FEATURE_BYTES(d->dimensions, d->form);
    made.features_max += spatial->pairs;
    made.kind = RLVC_DOMAIN_SPATIAL;
    made.exhibits = exhibits;
    made.candidates = candidates;
    made.detect = detect;
    made.name = name;
    made.check_percept = check_percept;
    made.check_feature = check_feature;
    made.feature_words = 4u + 2u * rlvc_vectors_words(d);
    *domain = made;
    return RLVC_OK;
}

int rlvc_spatial_is_pair(const rlvc_spatial *spatial, const void *feature) {
    if (spatial == NULL || feature == NULL)
        return 0;
    const rlvc_layout layout = layout_of(spatial);
    rlvc_pattern pattern;
    rlvc_vectors_read(&layout, feature, &pattern);
    return pattern.scale > 0.0f;
}

rlvc_status rlvc_spatial_nearest(const rlvc_spatial *spatial, const void *percept,
                                 const void *feature, uint32_t point[2], float *squared) {
    const float unlimited = 3e38f;
    if (spatial == NULL || percept == NULL || feature == NULL || point == NULL)
        return RLVC_E_NULL;
    const uint32_t count = rlvc_vectors_count(percept);
    const uint32_t needed = rlvc_spatial_is_pair(spatial, feature) ? 2u : 1u;
    if (count < needed || count > spatial->vectors.points)
        return RLVC_E_RANGE;
    const rlvc_layout layout = layout_of(spatial);
    uint32_t at[2] = {0, needed - 1u};
    rlvc_pattern pattern;
    rlvc_probe wanted;
    rlvc_vectors_read(&layout, feature, &pattern);
    rlvc_probe_open(&layout, &pattern, &wanted);
    const float least = rlvc_probe_nearest(&wanted, percept, 0.0f, unlimited, at);
    point[0] = at[0];
    point[1] = needed == 2u ? at[1] : at[0];
    if (squared != NULL)
        *squared = least;
    return RLVC_OK;
}
