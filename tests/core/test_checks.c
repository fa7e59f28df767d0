/* SPDX-License-Identifier: MIT */
/* Domains vouch for their records: what comes in, what is loaded, and what lies in memory. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "agent/state.h"
#include "base/rng.h"
#include "block.h"
#include "rlvc/bits.h"
#include "rlvc/descriptors.h"
#include "rlvc/thresholds.h"
#include "store.h"

#include <math.h>
#include <string.h>

#define POINTS 2u
#define DIMENSIONS 3u
#define INTERACTIONS 60u

static uint64_t block[8192], saved[8192];
static medium m;
static rlvc_thresholds thresholds, oblique;
static rlvc_descriptors floats, bytes;

typedef struct picture {
    uint32_t count;
    float number[POINTS * DIMENSIONS];
} picture;

typedef struct seen { /* a feature of descriptors */
    float radius;
    float number[DIMENSIONS];
} seen;

static rlvc_domain bits_domain(uint32_t bits) {
    rlvc_domain domain;
    assert_int_equal(rlvc_bits_domain(bits, &domain), RLVC_OK);
    return domain;
}

static rlvc_domain thresholds_domain(rlvc_thresholds *t, uint8_t is_oblique) {
    rlvc_domain domain;
    assert_int_equal(rlvc_thresholds_default(t, 2), RLVC_OK);
    t->oblique = is_oblique;
    assert_int_equal(rlvc_thresholds_domain(t, &domain), RLVC_OK);
    return domain;
}

static rlvc_domain descriptors_domain(rlvc_descriptors *d, uint8_t form) {
    rlvc_domain domain;
    assert_int_equal(rlvc_descriptors_default(d, POINTS, DIMENSIONS, form, 1.0f), RLVC_OK);
    assert_int_equal(rlvc_descriptors_domain(d, &domain), RLVC_OK);
    return domain;
}

static rlvc_agent *agent_of(const rlvc_domain *domain, rlvc_config *config) {
    rlvc_agent *agent;
    assert_int_equal(rlvc_config_default(config, domain, 2), RLVC_OK);
    config->method = &rlvc_method_classes;
    config->capacity = INTERACTIONS;
    config->classes = 8;
    config->explore = RLVC_EXPLORE_UNIFORM;
    block_fill(block, 0xa5, sizeof block);
    assert_int_equal(rlvc_agent_init(config, domain, block, sizeof block, &agent), RLVC_OK);
    return agent;
}

/* A sound percept, the i-th. */
static const void *percept_of(const rlvc_domain *domain, uint32_t i) {
    static union {
        unsigned char byte[8];
        float number[2];
        picture picture;
    } made;
    memset(&made, 0, sizeof made);
    if (domain->kind == RLVC_DOMAIN_BITS) {
        made.byte[0] = (unsigned char)(i * 37u);
    } else if (domain->kind == RLVC_DOMAIN_THRESHOLDS) {
        made.number[0] = (float)(i * 7u % 10u);
        made.number[1] = (float)(i * 3u % 5u);
    } else {
        made.picture.count = 1u + i % POINTS;
        for (uint32_t k = 0; k < POINTS * DIMENSIONS; k++)
            made.picture.number[k] = (float)((i + k) % 4u) * 5.0f;
    }
    return &made;
}

/* Interactions whose rewards depend on the percept, and a learning step. */
static void live(rlvc_agent *agent, const rlvc_domain *domain) {
    rlvc_progress progress;
    assert_int_equal(rlvc_begin(agent, percept_of(domain, 0)), RLVC_OK);
    for (uint32_t i = 1; i <= INTERACTIONS; i++) {
        const rlvc_choice choice = {(uint8_t)(i / 2u % 2u), 0};
        uint32_t before = i - 1u;
        float reward = domain->kind == RLVC_DOMAIN_BITS         ? (float)(before * 37u % 2u)
                       : domain->kind == RLVC_DOMAIN_THRESHOLDS ? (float)(before * 7u % 10u > 4u)
                                                                : (float)(before % 4u == 1u);
        assert_int_equal(rlvc_observe(agent, choice, reward * 10.0f, percept_of(domain, i), 0),
                         RLVC_OK);
    }
    assert_int_equal(rlvc_learn(agent, RLVC_BUDGET_UNBOUNDED, &progress), RLVC_OK);
    assert_int_equal(rlvc_agent_check(agent), RLVC_OK);
}

/* ------------------------------------------------------------------ percepts */

static void expect_refused(const rlvc_domain *domain, const void *percept) {
    rlvc_config config;
    rlvc_agent *agent = agent_of(domain, &config);
    const rlvc_choice choice = {0, 0};
    assert_int_not_equal(domain->check_percept(domain->ctx, percept), 0);
    for (uint32_t i = 0; i < 2; i++) {
        block_copy(saved, block, sizeof block);
        assert_int_equal(rlvc_begin(agent, percept), RLVC_E_PERCEPT);
        if (i == 1) {
            assert_int_equal(rlvc_observe(agent, choice, 0.0f, percept, RLVC_GOES_ON),
                             RLVC_E_PERCEPT);
            assert_int_equal(rlvc_observe(agent, choice, 0.0f, percept, RLVC_TRUNCATED),
                             RLVC_E_PERCEPT);
        }
        assert_true(block_equal(saved, block, sizeof block));
        assert_int_equal(rlvc_begin(agent, percept_of(domain, i)), RLVC_OK);
    }
    /* Of a terminated interaction s' is not looked at. */
    assert_int_equal(rlvc_observe(agent, choice, 0.0f, percept, RLVC_TERMINATED), RLVC_OK);
    assert_int_equal(rlvc_agent_check(agent), RLVC_OK);
    /* A percept that changed in memory is found. */
    memcpy(agent->replay.percept, percept, domain->percept_bytes);
    assert_int_equal(rlvc_agent_check(agent), RLVC_E_MEMORY);
}

static void test_percepts(void **state) {
    const rlvc_domain real = thresholds_domain(&thresholds, 0);
    const rlvc_domain pictures = descriptors_domain(&floats, RLVC_DESCRIPTORS_FLOAT);
    const rlvc_domain small = descriptors_domain(&bytes, RLVC_DESCRIPTORS_INT8);
    const float wrong[] = {NAN, INFINITY, -INFINITY, 1.1e15f, -1.1e15f};
    (void)state;
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        for (uint32_t k = 0; k < 2; k++) {
            float x[2] = {1.0f, -1e15f};
            x[k] = wrong[i];
            expect_refused(&real, x);
        }
        for (uint32_t k = 0; k < POINTS * DIMENSIONS; k++) {
            picture shown = {POINTS, {1.0f, 2.0f, 1e15f, -1e15f, 0.0f, 3.0f}};
            shown.number[k] = wrong[i];
            expect_refused(&pictures, &shown);
            shown.count = k / DIMENSIONS; /* now it is not looked at */
            assert_int_equal(pictures.check_percept(pictures.ctx, &shown), 0);
        }
    }
    for (uint32_t count = POINTS + 1u; count != 0; count *= 2u) {
        picture shown = {count, {0.0f}};
        expect_refused(&pictures, &shown);
        assert_int_not_equal(small.check_percept(small.ctx, &shown), 0);
    }
    assert_int_equal(small.check_percept(small.ctx, &(picture){POINTS, {NAN}}), 0);
    assert_null(bits_domain(3).check_percept);
}

/* ------------------------------------------------------------------ features */

static int refuses(const rlvc_domain *domain, const void *feature) {
    return domain->check_feature(domain->ctx, feature) != 0;
}

static void test_features(void **state) {
    const rlvc_domain bits = bits_domain(300), real = thresholds_domain(&thresholds, 0);
    const rlvc_domain slanted = thresholds_domain(&oblique, 1);
    const rlvc_domain pictures = descriptors_domain(&floats, RLVC_DESCRIPTORS_FLOAT);
    const rlvc_domain small = descriptors_domain(&bytes, RLVC_DESCRIPTORS_INT8);
    const struct {
        rlvc_threshold feature;
        int refused, refused_slanted;
    } tests[] = {
        {{0.5f, 0.0f, 1, 0}, 0, 0},     {{RLVC_THRESHOLDS_NONE, 0.0f, 0, 0}, 0, 0},
        {{0.5f, 0.0f, 2, 0}, 1, 1},     {{0.5f, 0.0f, 60000, 0}, 1, 1},
        {{0.5f, 0.0f, 1, 1}, 1, 1},     {{NAN, 0.0f, 1, 0}, 1, 1},
        {{INFINITY, 0.0f, 1, 0}, 1, 1}, {{0.5f, 2.0f, 0, 1}, 1, 0},
        {{0.5f, -2.0f, 0, 2}, 1, 1},    {{0.5f, NAN, 0, 1}, 1, 1},
        {{0.5f, INFINITY, 0, 1}, 1, 1},
    };
    (void)state;
    for (uint32_t bit = 0; bit < 65536u; bit++) {
        const unsigned char feature[2] = {(unsigned char)bit, (unsigned char)(bit >> 8)};
        assert_int_equal(refuses(&bits, feature), bit >= 300u);
    }
    for (size_t i = 0; i < sizeof tests / sizeof tests[0]; i++) {
        assert_int_equal(refuses(&real, &tests[i].feature), tests[i].refused);
        assert_int_equal(refuses(&slanted, &tests[i].feature), tests[i].refused_slanted);
    }
    const float radii[] = {1.0f, 0.0f, 1.6e16f, -1.0f, NAN, INFINITY, 1.7e16f, -1.1f};
    for (size_t i = 0; i < sizeof radii / sizeof radii[0]; i++) {
        seen feature = {radii[i], {1.0f, 2.0f, -3.0f}};
        assert_int_equal(refuses(&pictures, &feature), i >= 4);
        assert_int_equal(refuses(&small, &feature), i >= 4);
        feature.number[i % DIMENSIONS] = 2e15f;
        assert_true(refuses(&pictures, &feature));
        assert_int_equal(refuses(&small, &feature), i >= 4);
    }
}

/* A snapshot whose CRC is right, but whose tree or ring holds what the domain knows nothing of. */
static void expect_forgery_refused(const rlvc_domain *domain, const void *feature,
                                   const void *percept) {
    rlvc_config config;
    rlvc_agent *agent = agent_of(domain, &config);
    live(agent, domain);
    assert_true(agent->tree.classes > 1u);
    for (uint32_t i = 0; i < 3; i++) {
        unsigned char *forged = rlvc_tree_feature(&agent->tree, agent->tree.classes - 2u), kept[64];
        uint32_t size = domain->feature_bytes;
        if (i == 1) {
            forged = agent->replay.percept;
            size = domain->percept_bytes;
        }
        if (i < 2 && !(i == 0 ? feature : percept))
            continue;
        memset(&m, 0, sizeof m);
        m.power = UINT64_MAX;
        const rlvc_store store = medium_store(&m, &config, domain, 0);
        memcpy(kept, forged, size);
        if (i < 2) {
            memcpy(forged, i == 0 ? feature : percept, size);
            assert_int_equal(rlvc_agent_check(agent), RLVC_E_MEMORY);
        }
        assert_int_equal(rlvc_save(agent, &store), RLVC_OK);
        memcpy(forged, kept, size);
        assert_int_equal(rlvc_agent_check(agent), RLVC_OK);
        rlvc_agent *loaded;
        RLVC_UNPOISON(saved, sizeof saved);
        assert_int_equal(rlvc_load(&config, domain, saved, sizeof saved, &store, &loaded),
                         i < 2 ? RLVC_E_DAMAGED : RLVC_OK);
        assert_int_equal(loaded != NULL, i == 2);
    }
}

static void test_forged_snapshots(void **state) {
    const unsigned char bit[2] = {0xff, 0xff};
    const rlvc_threshold component = {0.0f, 0.0f, 60000, 0};
    const float nan[2] = {0.0f, NAN};
    const seen radius = {NAN, {0.0f, 0.0f, 0.0f}};
    const picture many = {1000000u, {0.0f}};
    rlvc_domain domain = bits_domain(3);
    (void)state;
    expect_forgery_refused(&domain, bit, NULL);
    domain = thresholds_domain(&thresholds, 0);
    expect_forgery_refused(&domain, &component, nan);
    domain = descriptors_domain(&floats, RLVC_DESCRIPTORS_FLOAT);
    floats.margin = 1.0f;
    expect_forgery_refused(&domain, &radius, &many);
}

/* Who does not check is not asked. */
static void test_no_checks(void **state) {
    rlvc_config config;
    rlvc_domain domain = thresholds_domain(&thresholds, 0);
    const float nan[2] = {0.0f, NAN};
    (void)state;
    domain.check_percept = NULL;
    domain.check_feature = NULL;
    rlvc_agent *agent = agent_of(&domain, &config);
    assert_int_equal(rlvc_begin(agent, nan), RLVC_OK);
    assert_int_equal(rlvc_agent_check(agent), RLVC_OK);
}

/* ------------------------------------------------------------------ callers and callbacks that are
 * careless */

static int (*bits_detect)(void *, const rlvc_samples *, uint32_t, uint32_t, const void *, uint32_t,
                          uint64_t *);

/* Sets every bit beyond the samples. */
static int stray_detect(void *ctx, const rlvc_samples *samples, uint32_t first, uint32_t n,
                        const void *features, uint32_t count, uint64_t *columns) {
    int failed = bits_detect(ctx, samples, first, n, features, count, columns);
    for (uint32_t j = 0; j < count && n < 64u; j++)
        columns[j] |= UINT64_MAX << n;
    return failed;
}

static void test_stray_bits(void **state) {
    rlvc_config config;
    rlvc_domain domain = bits_domain(3);
    rlvc_tree_split split[2];
    (void)state;
    bits_detect = domain.detect;
    for (uint32_t i = 0; i < 2; i++) {
        rlvc_agent *agent = agent_of(&domain, &config);
        live(agent, &domain);
        assert_true(agent->tree.classes > 1u);
        split[i] = agent->tree.split[0];
        domain.detect = stray_detect;
    }
    assert_memory_equal(&split[0], &split[1], sizeof split[0]);
}

/* The config and the domain may lie where the agent is to be. */
static void test_config_in_the_block(void **state) {
    rlvc_config config;
    const rlvc_domain domain = bits_domain(3);
    rlvc_agent *agent = agent_of(&domain, &config);
    (void)state;
    for (uint32_t offset = 0; offset < 512u; offset += 64u) {
        rlvc_config *inside = (rlvc_config *)(block + offset / 8u);
        rlvc_domain *beside = (rlvc_domain *)(block + offset / 8u + 32u);
        block_fill(block, 0xa5, sizeof block);
        *inside = config;
        *beside = domain;
        assert_int_equal(rlvc_agent_init(inside, beside, block, sizeof block, &agent), RLVC_OK);
        assert_int_equal(rlvc_agent_check(agent), RLVC_OK);
        assert_int_equal(agent->config.capacity, config.capacity);
        live(agent, &domain);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_percepts),         cmocka_unit_test(test_features),
        cmocka_unit_test(test_forged_snapshots), cmocka_unit_test(test_no_checks),
        cmocka_unit_test(test_stray_bits),       cmocka_unit_test(test_config_in_the_block),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
