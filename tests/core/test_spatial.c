/* SPDX-License-Identifier: MIT */
/* The domain of features of several points: detect() agrees with exhibits() and with the
 * definition, by whole numbers; what candidates are; what is refused; and an arrangement that no
 * single vector tells is learnt. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "rlvc/agent.h"

#include <math.h>

#define POINTS_MAX 6u
#define DIMENSIONS_MAX 33u
#define FEATURES_MAX 130u
#include "vectors.h"

/* A feature's scale and displacement; its vectors. */
static unsigned char *place_of(uint32_t j) {
    return feature(j) + 4u;
}

static unsigned char *first_of(uint32_t j) {
    return feature(j) + 16u;
}

static unsigned char *second_of(uint32_t j) {
    return first_of(j) + vector_bytes();
}

static unsigned char *places_of(unsigned char *p) {
    return p + RLVC_DESCRIPTORS_PERCEPT_BYTES(f.s.vectors.points, f.s.vectors.dimensions,
                                              f.s.vectors.form);
}

static void set_place(unsigned char *p, uint32_t point, int x, int y, int turn) {
    static const int8_t directions[4][2] = {{127, 0}, {0, 127}, {-127, 0}, {0, -127}};
    const uint32_t place[2] = {(uint32_t)x, (uint32_t)y};
    for (uint32_t k = 0; k < 4u; k++)
        places_of(p)[4u * point + k] = (unsigned char)(place[k / 2u] >> 8u * (k % 2u));
    if (f.s.directed)
        memcpy(places_of(p) + 4u * f.s.vectors.points + 2u * point, directions[turn], 2);
}

/* The points lie on a grid of 10 pixels. */
static void open_fixture(uint32_t points, uint32_t dimensions, uint32_t form, uint32_t directed,
                         float margin) {
    memset(&f, 0, sizeof f);
    assert_int_equal(rlvc_spatial_default(&f.s, points, dimensions, form, directed, 4.0f), RLVC_OK);
    f.s.vectors.margin = margin;
    assert_int_equal(rlvc_spatial_domain(&f.s, &f.domain), RLVC_OK);
    draw_percepts();
    for (uint32_t i = 0; i < PERCEPTS; i++)
        for (uint32_t k = 0; k < points; k++)
            set_place(percept(i), k, 10 * (int)rlvc_rng_below(&f.rng, 4) - 20,
                      10 * (int)rlvc_rng_below(&f.rng, 4), (int)rlvc_rng_below(&f.rng, 4));
}

static void set_feature(uint32_t j, float radius, float scale, float x, float y) {
    const float second[3] = {scale, x, y};
    memcpy(feature(j), &radius, sizeof radius);
    memcpy(place_of(j), second, sizeof second);
}

static void make_features(uint32_t m) {
    for (uint32_t j = 0; j < m; j++) {
        memset(feature(j), 0, f.domain.feature_bytes);
        for (uint32_t k = 0; k < f.s.vectors.dimensions; k++) {
            set_number(first_of(j), k, (int)rlvc_rng_below(&f.rng, 5) - 2);
            set_number(second_of(j), k, (int)rlvc_rng_below(&f.rng, 5) - 2);
        }
        if (j % 3u == 0 && count_of(percept(j)) > 1u) { /* two of some percept */
            memcpy(first_of(j), percept(j) + 4u, vector_bytes());
            memcpy(second_of(j), percept(j) + 4u + vector_bytes(), vector_bytes());
        }
        set_feature(j, j % 8u == 7u ? -1.0f : (float)rlvc_rng_below(&f.rng, 12),
                    j % 4u == 2u ? 0.0f : 0.25f, 10.0f * (float)rlvc_rng_below(&f.rng, 3),
                    10.0f * (float)rlvc_rng_below(&f.rng, 3) - 10.0f);
    }
}

static double misplaced(unsigned char *p, uint32_t i, uint32_t j, const float place[3]) {
    int at[2][2];
    for (uint32_t k = 0; k < 4u; k++) {
        const unsigned char *low = places_of(p) + 4u * (k < 2u ? i : j) + 2u * (k % 2u);
        at[k / 2u][k % 2u] = (int)low[0] | (int)(int8_t)low[1] * 256;
    }
    double x = at[1][0] - at[0][0], y = at[1][1] - at[0][1];
    if (f.s.directed) {
        const int8_t *direction = (const int8_t *)places_of(p) + 4u * f.s.vectors.points + 2u * i;
        const double along = direction[0] / 127, across = direction[1] / 127;
        const double turned = x * along + y * across;
        y = y * along - x * across;
        x = turned;
    }
    x -= (double)place[1];
    y -= (double)place[2];
    return (x * x + y * y) * (double)place[0];
}

/* The least distance of a percept from a feature's pattern, squared; or infinite. */
static double distance_by_definition(uint32_t at, uint32_t j) {
    unsigned char *p = percept(at);
    double least = HUGE_VAL;
    float place[3];
    memcpy(place, place_of(j), sizeof place);
    for (uint32_t a = 0; a < count_of(percept(at)); a++) {
        const double first = squared_of(p, a, first_of(j));
        for (uint32_t b = 0; place[0] > 0.0f && b < count_of(percept(at)); b++)
            if (a != b)
                least = fmin(least, fmax(fmax(first, squared_of(p, b, second_of(j))),
                                         misplaced(p, a, b, place)));
        if (!(place[0] > 0.0f))
            least = fmin(least, first);
    }
    return least;
}

static void check_detect(uint32_t first, uint32_t n, uint32_t m) {
    uint64_t columns[65];
    columns[m] = 0x123456789abcdefu;
    assert_int_equal(f.domain.detect(&f.s, &f.samples, first, n, f.features, m, columns), 0);
    for (uint32_t j = 0; j < m; j++) {
        const double radius = (double)rlvc_descriptors_radius(feature(j));
        for (uint32_t i = 0; i < n; i++) {
            const uint32_t slot = f.sample[first + i].slot;
            uint8_t present = 2;
            assert_int_equal(f.domain.exhibits(&f.s, percept(slot), feature(j), &present), 0);
            assert_int_equal(present,
                             radius >= 0.0 && distance_by_definition(slot, j) <= radius * radius);
            if ((columns[j] >> i & 1u) != present)
                fail_msg("P %u D %u form %u directed %u, feature %u, sample %u", f.s.vectors.points,
                         f.s.vectors.dimensions, f.s.vectors.form, f.s.directed, j, first + i);
        }
        assert_int_equal(n < 64u ? columns[j] >> n : 0, 0);
    }
    assert_true(columns[m] == 0x123456789abcdefu);
}

static void test_detect(void **state) {
    (void)state;
    const uint32_t dimensions[] = {1, 3, 8, 33};
    for (uint32_t form = 0; form <= RLVC_DESCRIPTORS_INT8; form++)
        for (uint32_t directed = 0; directed < 2u; directed++)
            for (size_t i = 0; i < sizeof dimensions / sizeof dimensions[0]; i++)
                for (uint32_t points = 1; points <= POINTS_MAX; points++) {
                    open_fixture(points, dimensions[i], form, directed, 1.0f);
                    make_features(64);
                    check_detect(0, 64, 64);
                    check_detect(PERCEPTS - 3u, 3, 5);
                }
}

/* Two vectors of a percept that lie more than 6 pixels apart, with the displacement and the scale
 * that the header says. */
static int comes_from_a_percept(uint32_t j) {
    float place[3];
    memcpy(place, place_of(j), sizeof place);
    const float squared = place[1] * place[1] + place[2] * place[2];
    const float error = fmaxf(16.0f, 0.35f * 0.35f * squared);
    for (uint32_t i = 0; i < PERCEPTS; i++)
        for (uint32_t a = 0; a < count_of(percept(i)); a++)
            for (uint32_t b = 0; b < count_of(percept(i)); b++)
                if (a != b && squared > 36.0f &&
                    memcmp(first_of(j), percept(i) + 4u + a * vector_bytes(), vector_bytes()) ==
                        0 &&
                    memcmp(second_of(j), percept(i) + 4u + b * vector_bytes(), vector_bytes()) ==
                        0 &&
                    misplaced(percept(i), a, b, place) < 1e-6 &&
                    fabsf(place[0] * error - 16.0f) < 1e-3f)
                    return 1;
    return 0;
}

static void test_candidates(void **state) {
    (void)state;
    for (uint32_t form = 0; form <= RLVC_DESCRIPTORS_INT8; form++)
        for (uint32_t directed = 0; directed < 2u; directed++) {
            uint32_t written = 0, pairs = 0;
            open_fixture(5, 9, form, directed, directed ? 1.0f : 1.8f);
            f.s.vectors.candidates = 20;
            f.s.pairs = 30;
            assert_int_equal(f.domain.candidates(&f.s, &f.samples, 0, 64, f.features, &written), 0);
            assert_int_equal(written, 50);
            for (uint32_t j = 0; j < written; j++) {
                const int refused = rlvc_descriptors_radius(feature(j)) < 0.0f;
                const int is_pair = rlvc_spatial_is_pair(&f.s, feature(j));
                assert_true(refused || is_pair == (j >= 20u));
                assert_true(!is_pair || comes_from_a_percept(j));
                pairs += (uint32_t)is_pair;
                for (uint32_t i = 0; i < j && !refused; i++)
                    assert_memory_not_equal(feature(i) + 4u, feature(j) + 4u,
                                            f.domain.feature_bytes - 4u);
            }
            assert_true(pairs > 5u);
            /* The last ones, asked for alone, are pairs again. */
            assert_int_equal(f.domain.candidates(&f.s, &f.samples, 45, 64, f.features, &written),
                             0);
            assert_int_equal(written, 5);
        }
}

/* Points that lie together make no pair, nor does one point alone. */
static void test_no_pairs(void **state) {
    (void)state;
    for (uint32_t count = 1; count <= 3u; count += 2u) {
        uint32_t written;
        open_fixture(3, 2, RLVC_DESCRIPTORS_FLOAT, 0, 1.0f);
        for (uint32_t i = 0; i < PERCEPTS; i++) {
            set_count(i, count);
            for (uint32_t k = 0; k < 3u; k++)
                set_place(percept(i), k, 3 * (int)k, 0, 0);
        }
        f.s.vectors.candidates = 1;
        assert_int_equal(f.domain.candidates(&f.s, &f.samples, 1, 64, f.features, &written), 0);
        assert_int_equal(written, 64);
        for (uint32_t j = 0; j < written; j++)
            assert_true(rlvc_descriptors_radius(feature(j)) < 0.0f);
    }
}

/* The same first vector makes another pair with another second vector or displacement, and only
 * then. */
static void test_pairs_that_share_a_point(void **state) {
    (void)state;
    uint32_t written, pairs = 0;
    open_fixture(2, 1, RLVC_DESCRIPTORS_FLOAT, 0, 1.0f);
    for (uint32_t i = 0; i < PERCEPTS; i++) {
        set_count(i, 2);
        for (uint32_t k = 0; k < 2u; k++) {
            set_number(percept(i) + 4u, k, k ? (int)(i % 2u) : 9);
            set_place(percept(i), k, (i % 4u < 2u ? 20 : -20) * (int)k, 0, 0);
        }
    }
    f.s.vectors.candidates = 1;
    assert_int_equal(f.domain.candidates(&f.s, &f.samples, 1, 64, f.features, &written), 0);
    for (uint32_t j = 0; j < written; j++)
        pairs += rlvc_descriptors_radius(feature(j)) > 0.0f;
    assert_int_equal(pairs, 8); /* 9 and 0, 9 and 1, to either side, and the other way round */
}

static void test_damaged_percepts(void **state) {
    (void)state;
    uint8_t present = 2;
    uint64_t column = 7;
    uint32_t written = 7, point[2] = {8, 9};
    open_fixture(2, 3, RLVC_DESCRIPTORS_FLOAT, 0, 1.0f);
    make_features(1);
    for (uint32_t i = 0; i < PERCEPTS; i++)
        set_count(i, 3);
    assert_int_not_equal(f.domain.exhibits(&f.s, percept(0), feature(0), &present), 0);
    assert_int_not_equal(f.domain.detect(&f.s, &f.samples, 0, 1, f.features, 1, &column), 0);
    assert_int_not_equal(f.domain.candidates(&f.s, &f.samples, 0, 1, f.features, &written), 0);
    assert_int_equal(rlvc_spatial_nearest(&f.s, percept(0), feature(0), point, NULL), RLVC_E_RANGE);
    assert_int_equal(present, 2);
    assert_int_equal(column, 7);
    assert_int_equal(written, 7);
    assert_int_equal(point[0], 8);
}

static void test_nearest(void **state) {
    (void)state;
    uint32_t point[2];
    float squared = 9.0f;
    open_fixture(5, 8, RLVC_DESCRIPTORS_FLOAT, 1, 1.0f);
    make_features(8);
    for (uint32_t j = 0; j < 8u; j++)
        for (uint32_t i = 0; i < PERCEPTS; i++) {
            const int is_pair = rlvc_spatial_is_pair(&f.s, feature(j));
            const rlvc_status status =
                rlvc_spatial_nearest(&f.s, percept(i), feature(j), point, &squared);
            if (count_of(percept(i)) < (is_pair ? 2u : 1u)) {
                assert_int_equal(status, RLVC_E_RANGE);
                continue;
            }
            float place[3];
            memcpy(place, place_of(j), sizeof place);
            assert_int_equal(status, RLVC_OK);
            assert_true(fabs((double)squared - distance_by_definition(i, j)) < 1e-3);
            assert_int_equal(point[0] != point[1], is_pair);
            const double first = squared_of(percept(i), point[0], first_of(j));
            const double other = is_pair ? fmax(squared_of(percept(i), point[1], second_of(j)),
                                                misplaced(percept(i), point[0], point[1], place))
                                         : 0.0;
            assert_true(fabs((double)squared - fmax(first, other)) < 1e-3);
        }
    set_count(0, 2);
    assert_int_equal(rlvc_spatial_nearest(&f.s, percept(0), feature(0), point, NULL), RLVC_OK);
    assert_int_equal(rlvc_spatial_is_pair(NULL, feature(0)), 0);
    assert_int_equal(rlvc_spatial_is_pair(&f.s, NULL), 0);
    assert_int_equal(rlvc_spatial_nearest(NULL, percept(0), feature(0), point, NULL), RLVC_E_NULL);
    assert_int_equal(rlvc_spatial_nearest(&f.s, NULL, feature(0), point, NULL), RLVC_E_NULL);
    assert_int_equal(rlvc_spatial_nearest(&f.s, percept(0), NULL, point, NULL), RLVC_E_NULL);
    assert_int_equal(rlvc_spatial_nearest(&f.s, percept(0), feature(0), NULL, NULL), RLVC_E_NULL);
}

static void test_name(void **state) {
    (void)state;
    char text[RLVC_NAME_BYTES];
    open_fixture(1, 3, RLVC_DESCRIPTORS_INT8, 0, 1.0f);
    assert_int_equal(f.domain.name(&f.s, feature(0), text, sizeof text), 0);
    assert_memory_equal(text, "vector ", 7);
    assert_int_equal(strlen(text), 15);
    set_feature(0, 1.0f, 0.5f, 9.0f, 9.0f);
    assert_int_equal(f.domain.name(&f.s, feature(0), text, sizeof text), 0);
    assert_memory_equal(text, "pair ", 5);
    assert_int_equal(strlen(text), 13);
}

static void test_checks(void **state) {
    (void)state;
    const float wrong[] = {NAN, INFINITY, -1.0f, 1.1e30f};
    for (uint32_t form = 0; form <= RLVC_DESCRIPTORS_INT8; form++) {
        open_fixture(2, 3, form, 1, 1.0f);
        assert_int_equal(f.domain.check_percept(&f.s, percept(0)), 0);
        set_count(0, 3);
        assert_int_not_equal(f.domain.check_percept(&f.s, percept(0)), 0);
        set_feature(0, 1.0f, 1e30f, 1e15f, -1e15f);
        assert_int_equal(f.domain.check_feature(&f.s, feature(0)), 0);
        for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
            set_feature(0, 1.0f, wrong[i], 0.0f, 0.0f);
            assert_int_not_equal(f.domain.check_feature(&f.s, feature(0)), 0);
        }
        set_feature(0, 1.0f, 1.0f, NAN, 0.0f);
        assert_int_not_equal(f.domain.check_feature(&f.s, feature(0)), 0);
        set_feature(0, -2.0f, 1.0f, 0.0f, 0.0f);
        assert_int_not_equal(f.domain.check_feature(&f.s, feature(0)), 0);
        set_feature(0, 1.0f, 1.0f, 0.0f, 0.0f);
        memset(second_of(0), 0xff, vector_bytes()); /* NaN, or -1 */
        assert_int_equal(f.domain.check_feature(&f.s, feature(0)) == 0,
                         form == RLVC_DESCRIPTORS_INT8);
    }
}

static void refuse(void) {
    rlvc_domain domain;
    memset(&domain, 0x5a, sizeof domain);
    const rlvc_domain before = domain;
    assert_int_equal(rlvc_spatial_domain(&f.s, &domain), RLVC_E_RANGE);
    assert_memory_equal(&domain, &before, sizeof domain);
}

static void test_ranges(void **state) {
    (void)state;
    rlvc_domain domain;
    rlvc_spatial good;
    assert_int_equal(rlvc_spatial_default(&good, 2, 3, RLVC_DESCRIPTORS_FLOAT, 1, 1.0f), RLVC_OK);
    f.s = good;
    assert_int_equal(rlvc_spatial_domain(&f.s, &domain), RLVC_OK);
    assert_int_equal(domain.percept_bytes, 4 + 2 * 12 + 2 * 4 + 4);
    assert_int_equal(domain.feature_bytes, 4 + 12 + 12 + 12);
    assert_int_equal(domain.features_max, 128);
    f.s.pairs = RLVC_DESCRIPTORS_CANDIDATES_MAX;
    assert_int_equal(rlvc_spatial_domain(&f.s, &domain), RLVC_OK);
    f.s.pairs++;
    refuse();
    f.s.pairs = 0;
    refuse();
    f.s = good;
    f.s.directed = 2;
    refuse();
    f.s = good;
    f.s.vectors.points = 0;
    refuse();
    f.s = good;
    f.s.vectors.points = 1000;
    f.s.vectors.dimensions = 256;
    f.s.directed = 0;
    assert_int_equal(rlvc_spatial_domain(&f.s, &domain), RLVC_OK);
    assert_int_equal(domain.percept_bytes, 1028004);
    f.s.directed = 1;
    assert_int_equal(rlvc_spatial_domain(&f.s, &domain), RLVC_OK);
    assert_int_equal(domain.percept_bytes, 1030004);
    assert_int_equal(rlvc_spatial_domain(NULL, &domain), RLVC_E_NULL);
    assert_int_equal(rlvc_spatial_domain(&f.s, NULL), RLVC_E_NULL);
    assert_int_equal(rlvc_spatial_default(NULL, 1, 1, 0, 0, 1.0f), RLVC_E_NULL);
}

/* Two things beside each other, which of them is left being what counts: both are always there, so
 * that only a pair tells. Without directions pictures are upright; with them, turned. */
static void learn_which_is_left(uint32_t directed) {
    static uint64_t memory[30000];
    rlvc_config config;
    rlvc_agent *agent;
    rlvc_progress progress;
    rlvc_statistics statistics;
    unsigned char feature[200];
    rlvc_split split;
    open_fixture(2, 8, RLVC_DESCRIPTORS_INT8, directed, 1.8f);
    assert_int_equal(rlvc_config_default(&config, &f.domain, 2), RLVC_OK);
    config.capacity = 300;
    assert_int_equal(rlvc_agent_init(&config, &f.domain, memory, sizeof memory, &agent), RLVC_OK);
    for (uint32_t t = 0; t < 300u; t++) {
        static const int step[4][2] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
        const uint32_t left = rlvc_rng_below(&f.rng, 2), first = rlvc_rng_below(&f.rng, 2);
        const int turn = directed ? (int)rlvc_rng_below(&f.rng, 4) : 0;
        const rlvc_choice choice = {(uint8_t)rlvc_rng_below(&f.rng, 2), 0};
        set_count(0, 2);
        for (uint32_t k = 0; k < 16u; k++) {
            const uint32_t thing = k / 8u == first ? left : 1u - left;
            set_number(percept(0) + 4u, k,
                       (k % 8u == thing ? 40 : 0) + (int)rlvc_rng_below(&f.rng, 2));
        }
        for (uint32_t k = 0; k < 2u; k++) { /* the left one, then the right one, 40 pixels on */
            const int away = k == first ? 0 : 40 + (int)rlvc_rng_below(&f.rng, 7);
            set_place(percept(0), k, 100 + away * step[turn][0], 100 + away * step[turn][1], turn);
        }
        assert_int_equal(rlvc_begin(agent, percept(0)), RLVC_OK);
        assert_int_equal(
            rlvc_observe(agent, choice, choice.action == left ? 1.0f : 0.0f, NULL, RLVC_TERMINATED),
            RLVC_OK);
    }
    assert_int_equal(rlvc_learn(agent, RLVC_BUDGET_UNBOUNDED, &progress), RLVC_OK);
    assert_int_equal(rlvc_stats(agent, &statistics), RLVC_OK);
    assert_int_equal(statistics.classes, 2);
    assert_int_equal(rlvc_split_at(agent, 0, &split, feature), RLVC_OK);
    assert_true(rlvc_spatial_is_pair(&f.s, feature));
    assert_int_equal(rlvc_agent_check(agent), RLVC_OK);
}

static void test_learning(void **state) {
    (void)state;
    learn_which_is_left(0);
    learn_which_is_left(1);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_detect),   cmocka_unit_test(test_candidates),
        cmocka_unit_test(test_no_pairs), cmocka_unit_test(test_damaged_percepts),
        cmocka_unit_test(test_nearest),  cmocka_unit_test(test_name),
        cmocka_unit_test(test_checks),   cmocka_unit_test(test_ranges),
        cmocka_unit_test(test_learning), cmocka_unit_test(test_pairs_that_share_a_point),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
