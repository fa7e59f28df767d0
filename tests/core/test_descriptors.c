/* SPDX-License-Identifier: MIT */
/* The domain of local descriptors: detect() agrees with exhibits() bit for bit, and both with the
 * definition; candidates, the margin rule, and what is refused. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "rlvc/agent.h"
#include "rlvc/descriptors.h"

#define POINTS_MAX 5u
#define DIMENSIONS_MAX 256u
#define FEATURES_MAX 64u
#include "vectors.h"

static void open_fixture(uint32_t points, uint32_t dimensions, uint32_t form, float margin) {
    rlvc_descriptors *d = &f.s.vectors;
    memset(&f, 0, sizeof f);
    assert_int_equal(rlvc_descriptors_default(d, points, dimensions, form, 4.0f), RLVC_OK);
    d->margin = margin;
    assert_int_equal(rlvc_descriptors_domain(d, &f.domain), RLVC_OK);
    draw_percepts();
}

static int exhibits_by_definition(const unsigned char *p, const unsigned char *v) {
    const double radius = (double)rlvc_descriptors_radius(v);
    for (uint32_t i = 0; i < count_of(p); i++)
        if (radius >= 0.0 && squared_of(p, i, v + 4u) <= radius * radius)
            return 1;
    return 0;
}

static void make_features(uint32_t m) {
    for (uint32_t j = 0; j < m; j++) {
        const float radius =
            j % 8u == 7u ? -1.0f : (float)rlvc_rng_below(&f.rng, 3u * f.s.vectors.dimensions);
        memcpy(feature(j), &radius, sizeof radius);
        for (uint32_t k = 0; k < f.s.vectors.dimensions; k++)
            set_number(vectors_of(feature(j)), k, (int)rlvc_rng_below(&f.rng, 5) - 2);
        if (j % 3u == 0) /* one that some percept has; its radius reaches just so far */
            memcpy(feature(j) + 4u, percept(j) + 4u,
                   RLVC_DESCRIPTORS_VECTOR_BYTES(f.s.vectors.dimensions, f.s.vectors.form));
    }
}

static void check_detect(uint32_t first, uint32_t n, uint32_t m) {
    uint64_t columns[65];
    columns[m] = 0x123456789abcdefu;
    assert_int_equal(f.domain.detect(&f.s.vectors, &f.samples, first, n, f.features, m, columns),
                     0);
    for (uint32_t j = 0; j < m; j++) {
        uint64_t expected = 0;
        for (uint32_t i = 0; i < n; i++) {
            const unsigned char *p = rlvc_samples_percept(&f.samples, first + i);
            uint8_t present = 2;
            assert_int_equal(f.domain.exhibits(&f.s.vectors, p, feature(j), &present), 0);
            assert_int_equal(present, exhibits_by_definition(p, feature(j)));
            expected |= (uint64_t)present << i;
        }
        if (columns[j] != expected)
            fail_msg("P %u D %u form %u, feature %u, samples %u + %u", f.s.vectors.points,
                     f.s.vectors.dimensions, f.s.vectors.form, j, first, n);
    }
    assert_true(columns[m] == 0x123456789abcdefu);
}

static void test_detect(void **state) {
    (void)state;
    const uint32_t dimensions[] = {1, 7, 8, 9, 31, 32, 33, 41, 128, 255, 256};
    for (uint32_t form = 0; form <= RLVC_DESCRIPTORS_INT8; form++)
        for (size_t i = 0; i < sizeof dimensions / sizeof dimensions[0]; i++)
            for (uint32_t points = 1; points <= POINTS_MAX; points += 2) {
                open_fixture(points, dimensions[i], form, 1.0f);
                make_features(64);
                check_detect(0, 64, 64);
                check_detect(PERCEPTS - 3u, 3, 5);
                check_detect(11, 1, 1);
            }
}

/* At the radius itself a feature is there; a hair beyond it is not. */
static void test_edge_of_radius(void **state) {
    (void)state;
    for (uint32_t form = 0; form <= RLVC_DESCRIPTORS_INT8; form++) {
        uint8_t present = 2;
        float radius = 5.0f;
        open_fixture(1, 2, form, 1.0f);
        set_count(0, 1);
        set_number(vectors_of(percept(0)), 0, 3);
        set_number(vectors_of(percept(0)), 1, -4);
        memcpy(feature(0), &radius, sizeof radius);
        assert_int_equal(f.domain.exhibits(&f.s.vectors, percept(0), feature(0), &present), 0);
        assert_int_equal(present, 1);
        radius = 4.999999f;
        memcpy(feature(0), &radius, sizeof radius);
        assert_int_equal(f.domain.exhibits(&f.s.vectors, percept(0), feature(0), &present), 0);
        assert_int_equal(present, 0);
        set_count(0, 0);
        radius = 1e15f;
        memcpy(feature(0), &radius, sizeof radius);
        assert_int_equal(f.domain.exhibits(&f.s.vectors, percept(0), feature(0), &present), 0);
        assert_int_equal(present, 0); /* no point, no feature */
    }
}

/* A candidate is a vector of a percept, or refused; none is there twice; asking in blocks of
 * another size changes nothing but what is seen as twice. */
static void check_candidates(uint32_t m) {
    for (uint32_t j = 0; j < m; j++) {
        int found = 0;
        if (rlvc_descriptors_radius(feature(j)) < 0.0f)
            continue;
        for (uint32_t i = 0; i < PERCEPTS; i++) {
            for (uint32_t k = 0; k < count_of(percept(i)); k++)
                found |= memcmp(feature(j) + 4u, percept(i) + 4u + (size_t)k * vector_bytes(),
                                vector_bytes()) == 0;
        }
        assert_true(found);
        for (uint32_t i = 0; i < j; i++)
            assert_true(rlvc_descriptors_radius(feature(i)) < 0.0f ||
                        memcmp(feature(i) + 4u, feature(j) + 4u, vector_bytes()) != 0);
    }
}

static void test_candidates(void **state) {
    (void)state;
    for (uint32_t form = 0; form <= RLVC_DESCRIPTORS_INT8; form++) {
        for (uint32_t limit = 1; limit <= 100u; limit += 33u) {
            uint32_t written = 99, all = 0;
            open_fixture(4, 9, form, limit % 2u ? 1.0f : 1.8f);
            f.s.vectors.candidates = limit;
            do {
                assert_int_equal(
                    f.domain.candidates(&f.s.vectors, &f.samples, all, 64, f.features, &written),
                    0);
                check_candidates(written);
                all += written;
            } while (written == 64u);
            assert_int_equal(all, limit);
        }
    }
}

static void test_candidates_repeat(void **state) {
    (void)state;
    uint32_t written;
    open_fixture(1, 3, RLVC_DESCRIPTORS_FLOAT, 1.0f);
    for (uint32_t i = 0; i < PERCEPTS; i++) {
        memcpy(percept(i), percept(0), f.domain.percept_bytes);
        set_count(i, 1);
    }
    assert_int_equal(f.domain.candidates(&f.s.vectors, &f.samples, 0, 64, f.features, &written), 0);
    assert_int_equal(written, 64);
    assert_true(rlvc_descriptors_radius(feature(0)) == 4.0f);
    for (uint32_t j = 1; j < written; j++)
        assert_true(rlvc_descriptors_radius(feature(j)) < 0.0f);
    for (uint32_t i = 0; i < PERCEPTS; i++)
        set_count(i, 0);
    assert_int_equal(f.domain.candidates(&f.s.vectors, &f.samples, 0, 64, f.features, &written), 0);
    for (uint32_t j = 0; j < written; j++)
        assert_true(rlvc_descriptors_radius(feature(j)) < 0.0f);
}

/* One number a percept, half of them `near` and half of them `far` from any. */
static void make_clusters(int near, int far, uint32_t count) {
    open_fixture(1, 1, RLVC_DESCRIPTORS_FLOAT, 2.0f);
    f.samples.count = count;
    for (uint32_t i = 0; i < PERCEPTS; i++) {
        set_count(i, 1);
        set_number(vectors_of(percept(i)), 0, i % 2u ? near : far);
    }
}

static void test_margin(void **state) {
    (void)state;
    uint32_t written;
    /* tau 4, m 2: from 2 to 8 nothing lies, so the radius is a fifth of that below 8. */
    make_clusters(0, 100, PERCEPTS);
    assert_int_equal(f.domain.candidates(&f.s.vectors, &f.samples, 0, 1, f.features, &written), 0);
    assert_true(rlvc_descriptors_radius(feature(0)) > 6.79f);
    assert_true(rlvc_descriptors_radius(feature(0)) < 6.81f);
    /* ... those at 5 are in the way: from 2 to 5. */
    make_clusters(0, 5, PERCEPTS);
    assert_int_equal(f.domain.candidates(&f.s.vectors, &f.samples, 0, 1, f.features, &written), 0);
    assert_true(rlvc_descriptors_radius(feature(0)) > 4.3f);
    assert_true(rlvc_descriptors_radius(feature(0)) < 4.5f);
    /* All within, or none beyond: nothing to tell apart. */
    make_clusters(0, 1, PERCEPTS);
    assert_int_equal(f.domain.candidates(&f.s.vectors, &f.samples, 0, 1, f.features, &written), 0);
    assert_true(rlvc_descriptors_radius(feature(0)) < 0.0f);
    /* A crowd from 2 to 8 leaves no gap. */
    make_clusters(0, 0, PERCEPTS);
    for (uint32_t i = 0; i < PERCEPTS; i++) {
        const float number = 0.1f * (float)i;
        memcpy(percept(i) + 4u, &number, sizeof number);
    }
    f.sample[0].key = f.sample[1].key = 0;
    assert_int_equal(f.domain.candidates(&f.s.vectors, &f.samples, 0, 64, f.features, &written), 0);
    for (uint32_t j = 0; j < written; j++)
        assert_true(rlvc_descriptors_radius(feature(j)) < 0.0f);
}

/* Above 512 percepts only some are measured. */
static void test_margin_of_many(void **state) {
    (void)state;
    static rlvc_sample many[2000];
    uint32_t written;
    make_clusters(0, 100, PERCEPTS);
    for (uint32_t i = 0; i < 2000u; i++)
        many[i] = (rlvc_sample){i / 1000u, i % 3u ? 1u : 2u};
    f.samples.sample = many;
    f.samples.count = 2000;
    assert_int_equal(f.domain.candidates(&f.s.vectors, &f.samples, 0, 2, f.features, &written), 0);
    assert_int_equal(written, 2);
    assert_true(rlvc_descriptors_radius(feature(0)) > 6.79f);
    assert_true(rlvc_descriptors_radius(feature(0)) < 6.81f);
}

/* More targets than candidates: they come from all of them evenly. */
static void test_targets_evenly(void **state) {
    (void)state;
    uint32_t written;
    open_fixture(1, 1, RLVC_DESCRIPTORS_FLOAT, 1.0f);
    f.s.vectors.candidates = 10;
    for (uint32_t i = 0; i < PERCEPTS; i++) {
        set_count(i, 1);
        set_number(vectors_of(percept(i)), 0, (int)i);
        f.sample[i] = (rlvc_sample){i, i};
    }
    assert_int_equal(f.domain.candidates(&f.s.vectors, &f.samples, 0, 64, f.features, &written), 0);
    assert_int_equal(written, 10);
    for (uint32_t j = 0; j < 10u; j++)
        assert_true(get_number(vectors_of(feature(j)), 0) == (double)(8u * j));
}

static void test_damaged_percepts(void **state) {
    (void)state;
    uint8_t present = 2;
    uint64_t column = 7;
    uint32_t written = 7;
    open_fixture(2, 3, RLVC_DESCRIPTORS_FLOAT, 1.0f);
    make_features(1);
    for (uint32_t i = 0; i < PERCEPTS; i++)
        set_count(i, 3);
    assert_int_not_equal(f.domain.exhibits(&f.s.vectors, percept(0), feature(0), &present), 0);
    assert_int_not_equal(f.domain.detect(&f.s.vectors, &f.samples, 0, 1, f.features, 1, &column),
                         0);
    assert_int_not_equal(f.domain.candidates(&f.s.vectors, &f.samples, 0, 1, f.features, &written),
                         0);
    assert_int_equal(rlvc_descriptors_nearest(&f.s.vectors, percept(0), feature(0), NULL, NULL),
                     RLVC_E_RANGE);
    /* The one that is drawn is sound, one that is measured is not. */
    make_clusters(0, 100, PERCEPTS);
    set_count(f.sample[PERCEPTS - 1u].slot, 2);
    f.sample[PERCEPTS - 1u].key = 1000u;
    assert_int_not_equal(f.domain.candidates(&f.s.vectors, &f.samples, 0, 1, f.features, &written),
                         0);
    assert_int_equal(present, 2);
    assert_int_equal(column, 7);
    assert_int_equal(written, 7);
}

static void test_nearest(void **state) {
    (void)state;
    uint32_t point = 9;
    float squared = 9.0f;
    for (uint32_t form = 0; form <= RLVC_DESCRIPTORS_INT8; form++) {
        open_fixture(5, 33, form, 1.0f);
        make_features(8);
        for (uint32_t i = 0; i < PERCEPTS; i++) {
            uint32_t count, best = 0;
            memcpy(&count, percept(i), sizeof count);
            if (count == 0)
                continue;
            for (uint32_t k = 1; k < count; k++)
                if (squared_of(percept(i), k, vectors_of(feature(1))) <
                    squared_of(percept(i), best, vectors_of(feature(1))))
                    best = k;
            assert_int_equal(
                rlvc_descriptors_nearest(&f.s.vectors, percept(i), feature(1), &point, &squared),
                RLVC_OK);
            assert_int_equal(point, best);
            assert_true((double)squared == squared_of(percept(i), best, vectors_of(feature(1))));
        }
    }
    set_count(0, 0);
    assert_int_equal(rlvc_descriptors_nearest(&f.s.vectors, percept(0), feature(0), &point, NULL),
                     RLVC_E_RANGE);
    set_count(0, 1);
    assert_int_equal(rlvc_descriptors_nearest(&f.s.vectors, percept(0), feature(0), NULL, NULL),
                     RLVC_OK);
    assert_int_equal(rlvc_descriptors_nearest(NULL, percept(0), feature(0), NULL, NULL),
                     RLVC_E_NULL);
    assert_int_equal(rlvc_descriptors_nearest(&f.s.vectors, NULL, feature(0), NULL, NULL),
                     RLVC_E_NULL);
    assert_int_equal(rlvc_descriptors_nearest(&f.s.vectors, percept(0), NULL, NULL, NULL),
                     RLVC_E_NULL);
    assert_true(rlvc_descriptors_radius(NULL) < 0.0f);
}

static void test_name(void **state) {
    (void)state;
    char text[RLVC_NAME_BYTES], other[RLVC_NAME_BYTES];
    open_fixture(1, 3, RLVC_DESCRIPTORS_INT8, 1.0f);
    assert_int_equal(f.domain.name(&f.s.vectors, feature(0), text, sizeof text), 0);
    assert_string_equal(text, "vector 9be17165");
    set_number(vectors_of(feature(1)), 2, 1);
    assert_int_equal(f.domain.name(&f.s.vectors, feature(1), other, sizeof other), 0);
    assert_string_not_equal(text, other);
    assert_int_equal(f.domain.name(&f.s.vectors, feature(0), text, 10), 0);
    assert_string_equal(text, "vector 9b");
    assert_int_equal(f.domain.name(&f.s.vectors, feature(0), text, 4), 0);
    assert_string_equal(text, "vec");
}

static void refuse(void) {
    rlvc_domain domain;
    memset(&domain, 0x5a, sizeof domain);
    const rlvc_domain before = domain;
    assert_int_equal(rlvc_descriptors_domain(&f.s.vectors, &domain), RLVC_E_RANGE);
    assert_memory_equal(&domain, &before, sizeof domain);
}

static void test_ranges(void **state) {
    (void)state;
    rlvc_domain domain;
    const uint32_t counts[][2] = {{1, RLVC_DESCRIPTORS_POINTS_MAX},
                                  {1, RLVC_DESCRIPTORS_DIMENSIONS_MAX},
                                  {1, RLVC_DESCRIPTORS_CANDIDATES_MAX},
                                  {1, RLVC_DESCRIPTORS_DRAWS_MAX}};
    const float radii[] = {0.0f, -1.0f, 2e15f};
    const float margins[] = {0.99f, 16.1f};
    rlvc_descriptors good;
    assert_int_equal(rlvc_descriptors_default(&good, 2, 3, RLVC_DESCRIPTORS_FLOAT, 1.0f), RLVC_OK);
    for (uint32_t field = 0; field < 4u; field++)
        for (uint32_t end = 0; end < 2u; end++) {
            f.s.vectors = good;
            uint32_t *value = field == 0   ? &f.s.vectors.points
                              : field == 1 ? &f.s.vectors.dimensions
                              : field == 2 ? &f.s.vectors.candidates
                                           : &f.s.vectors.draws;
            *value = counts[field][end];
            assert_int_equal(rlvc_descriptors_domain(&f.s.vectors, &domain), RLVC_OK);
            *value = end ? *value + 1u : *value - 1u;
            refuse();
        }
    for (size_t i = 0; i < 3u; i++) {
        f.s.vectors = good;
        f.s.vectors.radius = radii[i];
        refuse();
    }
    for (size_t i = 0; i < 2u; i++) {
        f.s.vectors = good;
        f.s.vectors.margin = margins[i];
        refuse();
    }
    f.s.vectors = good;
    f.s.vectors.form = 2;
    refuse();
    assert_int_equal(rlvc_descriptors_default(&f.s.vectors, 1000, 256, RLVC_DESCRIPTORS_INT8, 1.0f),
                     RLVC_OK);
    assert_int_equal(rlvc_descriptors_domain(&f.s.vectors, &domain), RLVC_OK);
    assert_int_equal(domain.percept_bytes, 256004);
    f.s.vectors.points = 1000;
    f.s.vectors.dimensions = 256;
    f.s.vectors.form = RLVC_DESCRIPTORS_FLOAT;
    assert_int_equal(rlvc_descriptors_domain(&f.s.vectors, &domain), RLVC_OK);
    assert_int_equal(rlvc_descriptors_domain(NULL, &domain), RLVC_E_NULL);
    assert_int_equal(rlvc_descriptors_domain(&f.s.vectors, NULL), RLVC_E_NULL);
    assert_int_equal(rlvc_descriptors_default(NULL, 1, 1, 0, 1.0f), RLVC_E_NULL);
}

/* Two things that call for two actions, each seen with some noise: one split tells them apart. */
static void test_learning(void **state) {
    (void)state;
    static uint64_t memory[20000];
    rlvc_config config;
    rlvc_agent *agent;
    rlvc_progress progress;
    rlvc_statistics statistics;
    open_fixture(2, 8, RLVC_DESCRIPTORS_INT8, 1.8f);
    assert_int_equal(rlvc_config_default(&config, &f.domain, 2), RLVC_OK);
    config.capacity = 200;
    assert_int_equal(rlvc_agent_init(&config, &f.domain, memory, sizeof memory, &agent), RLVC_OK);
    for (uint32_t t = 0; t < 200u; t++) {
        const uint8_t thing = (uint8_t)rlvc_rng_below(&f.rng, 2);
        const rlvc_choice choice = {(uint8_t)rlvc_rng_below(&f.rng, 2), 0};
        set_count(0, 2);
        for (uint32_t k = 0; k < 16u; k++)
            set_number(vectors_of(percept(0)), k,
                       (k % 8u == thing ? 40 : 0) + (int)rlvc_rng_below(&f.rng, 2));
        assert_int_equal(rlvc_begin(agent, percept(0)), RLVC_OK);
        assert_int_equal(rlvc_observe(agent, choice, choice.action == thing ? 1.0f : 0.0f, NULL,
                                      RLVC_TERMINATED),
                         RLVC_OK);
    }
    assert_int_equal(rlvc_learn(agent, RLVC_BUDGET_UNBOUNDED, &progress), RLVC_OK);
    assert_int_equal(rlvc_stats(agent, &statistics), RLVC_OK);
    assert_int_equal(statistics.classes, 2);
    uint32_t action = 9;
    for (uint32_t thing = 0; thing < 2u; thing++) {
        for (uint32_t k = 0; k < 16u; k++)
            set_number(vectors_of(percept(0)), k, k % 8u == thing ? 40 : 0);
        assert_int_equal(rlvc_predict(agent, percept(0), NULL, &action), RLVC_OK);
        assert_int_equal(action, thing);
    }
}

/* Of 1024 samples every other one is measured: none of those is near what only the others have,
 * so that a radius for it has nothing on this side, nor is there anything beyond what they all
 * have. */
static void test_gap_without_a_near_side(void **unused) {
    (void)unused;
    static rlvc_sample sample[1024];
    uint32_t written = 0;
    open_fixture(1, 1, RLVC_DESCRIPTORS_FLOAT, 1.8f);
    for (uint32_t i = 0; i < 2; i++) {
        set_count(i, 1);
        set_number(vectors_of(percept(i)), 0, 4 * (int)i);
    }
    for (uint32_t i = 0; i < 1024; i++)
        sample[i] = (rlvc_sample){0, i % 2u};
    f.samples.sample = sample;
    f.samples.count = 1024;
    assert_int_equal(f.domain.candidates(f.domain.ctx, &f.samples, 0, 8, f.features, &written), 0);
    assert_int_equal(written, 8);
    for (uint32_t j = 0; j < written; j++)
        assert_true(rlvc_descriptors_radius(feature(j)) < 0.0f);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_detect),
        cmocka_unit_test(test_edge_of_radius),
        cmocka_unit_test(test_candidates),
        cmocka_unit_test(test_candidates_repeat),
        cmocka_unit_test(test_margin),
        cmocka_unit_test(test_margin_of_many),
        cmocka_unit_test(test_targets_evenly),
        cmocka_unit_test(test_damaged_percepts),
        cmocka_unit_test(test_nearest),
        cmocka_unit_test(test_name),
        cmocka_unit_test(test_ranges),
        cmocka_unit_test(test_learning),
        cmocka_unit_test(test_gap_without_a_near_side),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
