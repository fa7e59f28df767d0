/* SPDX-License-Identifier: MIT */
/* The config: its defaults, and for each field the ends of its range and what lies beyond. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "rlvc/agent.h"
#include "rlvc/bits.h"
#include "rlvc/planner.h"
#include "rlvc/thresholds.h"

static rlvc_config config;
static rlvc_domain domain;

static void make(void) {
    assert_int_equal(rlvc_bits_domain(18, &domain), RLVC_OK);
    assert_int_equal(rlvc_config_default(&config, &domain, 4), RLVC_OK);
    config.successors = 0; /* which asks something of other fields: see test_successors */
}

static rlvc_status check(const char **why) {
    *why = NULL;
    return rlvc_config_check(&config, &domain, why);
}

/* Fails unless the check finds the field at fault, or with `field` null, none. */
static void expect(const char *field, const char *what) {
    const char *why;
    rlvc_status status = check(&why);
    assert_non_null(why);
    if (status != (field ? RLVC_E_CONFIG : RLVC_OK) || strstr(why, field ? field : "ok") == NULL)
        fail_msg("%s: %d, %s", what, status, why);
    assert_int_equal(rlvc_config_check(&config, &domain, NULL), status);
}

static void test_defaults(void **state) {
    (void)state;
    const uint32_t features[] = {0, 1, 18, 63, 64, 65, UINT32_MAX};
    const uint32_t at_once[] = {64, 1, 18, 63, 64, 64, 64};
    make();
    for (size_t i = 0; i < sizeof features / sizeof features[0]; i++) {
        domain.features_max = features[i];
        domain.kind = i % 2 ? RLVC_DOMAIN_BITS : RLVC_DOMAIN_OWN;
        memset(&config, 0xa5, sizeof config);
        assert_int_equal(rlvc_config_default(&config, &domain, 9), RLVC_OK);
        assert_int_equal(config.features_at_once, at_once[i]);
        assert_int_equal(config.actions, 9);
        assert_int_equal(config.successors, i % 2);
        assert_int_equal(config.dependence, i % 2);
        assert_true(config.alpha_known == (i % 2 ? 0.1f : 1.0f));
        expect(NULL, "defaults");
    }
    /* As the header states them. */
    assert_int_equal(config.capacity, 2000);
    assert_int_equal(config.classes, 64);
    assert_int_equal(config.min_samples, 8);
    assert_int_equal(config.max_sweeps, 10000);
    assert_int_equal(config.seed, 1);
    assert_int_equal(config.criterion, RLVC_CRITERION_RESIDUAL);
    assert_int_equal(config.score, RLVC_SCORE_GAIN);
    assert_int_equal(config.solver, RLVC_SOLVER_VALUE_ITERATION);
    assert_int_equal(config.continuing, 0);
    const float numbers[] = {config.discount,       config.epsilon,   config.alpha,
                             config.alpha_known,    config.tolerance, config.learning_rate,
                             config.smallest_effect};
    const float expected[] = {0.9f, 0.9f, 0.01f, 1.0f, 0.01f, 0.1f, 0.0f};
    assert_memory_equal(numbers, expected, sizeof expected);
}

static void test_null(void **state) {
    (void)state;
    const char *why = NULL;
    make();
    assert_int_equal(rlvc_config_default(NULL, &domain, 4), RLVC_E_NULL);
    assert_int_equal(rlvc_config_default(&config, NULL, 4), RLVC_E_NULL);
    assert_int_equal(rlvc_config_check(NULL, &domain, &why), RLVC_E_NULL);
    assert_int_equal(rlvc_config_check(&config, NULL, &why), RLVC_E_NULL);
    assert_null(why);
}

typedef struct range {
    const char *field;
    uint32_t *place;
    uint32_t low, high;
} range;

static void test_counts(void **state) {
    (void)state;
    const range ranges[] = {
        {"actions", &config.actions, 1, 255},
        {"capacity", &config.capacity, 1, INT32_MAX},
        {"classes", &config.classes, 1, 65535},
        {"features_at_once", &config.features_at_once, 1, 64},
        {"min_samples", &config.min_samples, 2, INT32_MAX},
        {"max_sweeps", &config.max_sweeps, 1, INT32_MAX},
        {"seed", &config.seed, 0, UINT32_MAX},
        {"percept_bytes", &domain.percept_bytes, 1, 1u << 20},
        {"feature_bytes", &domain.feature_bytes, 1, 1u << 16},
        {"features_max", &domain.features_max, 0, UINT32_MAX},
    };
    for (size_t i = 0; i < sizeof ranges / sizeof ranges[0]; i++) {
        const range *r = &ranges[i];
        const uint32_t values[] = {r->low, r->high, r->low - 1u, r->high + 1u, UINT32_MAX, 0};
        for (size_t j = 0; j < sizeof values / sizeof values[0]; j++) {
            make();
            *r->place = values[j];
            expect(values[j] >= r->low && values[j] <= r->high ? NULL : r->field, r->field);
        }
    }
}

/* Of the planner, which looks at no other field: the highest of `sample` and of `random` are those
 * of the default capacity. */
static void test_planner(void **state) {
    (void)state;
    rlvc_thresholds thresholds;
    const range ranges[] = {
        {"actions", &config.actions, 2, RLVC_PLANNER_ACTIONS_MAX},
        {"capacity", &config.capacity, 2000, RLVC_PLANNER_CAPACITY_MAX},
        {"sample", &config.sample, 32, 2000},
        {"model_leaves", &config.model_leaves, 1, RLVC_PLANNER_MODEL_LEAVES_MAX},
        {"leaves", &config.leaves, 2, RLVC_PLANNER_LEAVES_MAX},
        {"horizon", &config.horizon, 1, RLVC_PLANNER_CAPACITY_MAX},
        {"random", &config.random, 32, 1000},
        {"candidates", &config.candidates, 1, RLVC_PLANNER_CANDIDATES_MAX},
        {"patience", &config.patience, 1, RLVC_PLANNER_CANDIDATES_MAX},
        {"seed", &config.seed, 0, UINT32_MAX},
        {"classes", &config.classes, 0, UINT32_MAX},
    };
    assert_int_equal(rlvc_thresholds_default(&thresholds, 3), RLVC_OK);
    for (size_t i = 0; i < sizeof ranges / sizeof ranges[0]; i++) {
        const range *r = &ranges[i];
        const uint32_t values[] = {r->low, r->high, r->low - 1u, r->high + 1u};
        for (size_t j = 0; j < sizeof values / sizeof values[0]; j++) {
            const int fine = values[j] >= r->low && values[j] <= r->high;
            assert_int_equal(rlvc_thresholds_domain(&thresholds, &domain), RLVC_OK);
            assert_int_equal(rlvc_config_default(&config, &domain, 4), RLVC_OK);
            assert_ptr_equal(config.method, &rlvc_method_planner);
            *r->place = values[j];
            /* fewer percepts than a sample has interactions are said of the sample */
            expect(fine                                     ? NULL
                   : r->place == &config.capacity && j == 2 ? "sample"
                                                            : r->field,
                   r->field);
        }
    }
    assert_int_equal(rlvc_config_default(&config, &domain, 4), RLVC_OK);
    domain.percept_bytes = 4u * (RLVC_PLANNER_COMPONENTS_MAX + 1u);
    expect("components", "too many components");
    domain.percept_bytes = 3;
    expect("components", "no component");
    domain.kind = RLVC_DOMAIN_OWN;
    expect("thresholds", "of another domain");
    assert_int_equal(rlvc_thresholds_policy_domain(&thresholds, &domain), RLVC_OK);
    assert_int_equal(rlvc_config_default(&config, &domain, 4), RLVC_OK);
    expect("method", "without a method");
    config.method = &rlvc_method_classes;
    expect(NULL, "by classes");
}

static void test_choices(void **state) {
    (void)state;
    const struct {
        const char *field;
        uint8_t *place;
        uint8_t high;
    } choices[] = {
        {"criterion", &config.criterion, RLVC_CRITERION_RESIDUAL},
        {"solver", &config.solver, RLVC_SOLVER_SARSA},
        {"continuing", &config.continuing, 1},
        {"successors", &config.successors, 1},
        {"explore", &config.explore, 1},
        {"dependence", &config.dependence, 1},
        {"reserved", &config.reserved, 0},
    };
    for (size_t i = 0; i < sizeof choices / sizeof choices[0]; i++)
        for (uint32_t value = 0; value <= UINT8_MAX; value++) {
            make();
            *choices[i].place = (uint8_t)value;
            expect(value <= choices[i].high ? NULL : choices[i].field, choices[i].field);
        }
    for (uint32_t value = 0; value <= UINT8_MAX; value++) {
        make();
        config.score = (uint8_t)value;
        expect(value == RLVC_SCORE_GAIN || value == RLVC_SCORE_RANKS ? NULL : "score", "score");
    }
}

static void test_numbers(void **state) {
    (void)state;
    const float zero = 0.0f, least = 1e-45f, nan = zero / zero, infinity = 1.0f / zero;
    const float one = 1.0f, beyond_one = 1.0000001f, most = RLVC_REWARD_MAX, beyond = 1.0000001e12f;
    const struct {
        const char *field;
        float *place;
        float good[4], bad[4];
    } numbers[] = {
        {"discount",
         &config.discount,
         {zero, -zero, least, one},
         {-least, beyond_one, nan, infinity}},
        {"epsilon",
         &config.epsilon,
         {zero, -zero, least, one},
         {-least, beyond_one, nan, infinity}},
        {"alpha", &config.alpha, {least, 0.5f, 0.05f, one}, {zero, beyond_one, nan, -one}},
        {"alpha_known",
         &config.alpha_known,
         {least, 0.5f, 0.05f, one},
         {zero, beyond_one, nan, -one}},
        {"tolerance", &config.tolerance, {least, one, 10.0f, most}, {zero, beyond, nan, -one}},
        {"learning_rate",
         &config.learning_rate,
         {least, 0.5f, 0.1f, one},
         {zero, beyond_one, nan, -one}},
        {"smallest_effect",
         &config.smallest_effect,
         {zero, least, 10.0f, most},
         {-least, beyond, nan, -one}},
    };
    for (size_t i = 0; i < sizeof numbers / sizeof numbers[0]; i++)
        for (int j = 0; j < 4; j++) {
            make();
            *numbers[i].place = numbers[i].good[j];
            expect(NULL, numbers[i].field);
            *numbers[i].place = numbers[i].bad[j];
            expect(numbers[i].field, numbers[i].field);
        }
}

static int oracle(void *ctx, const rlvc_samples *samples, uint32_t below, void *feature,
                  uint32_t *considered) {
    (void)ctx;
    (void)samples;
    (void)below;
    (void)feature;
    *considered = 0;
    return 0;
}

static void test_callbacks(void **state) {
    (void)state;
    make();
    domain.exhibits = NULL;
    expect("exhibits", "without exhibits");
    for (uint32_t i = 0; i < 4u; i++) {
        static const uint32_t unknown[] = {RLVC_DOMAIN_BAGS + 1u, 8u + RLVC_DOMAIN_BITS,
                                           32u + RLVC_DOMAIN_BITS, UINT32_MAX};
        make();
        domain.kind = unknown[i];
        expect("exhibits", "of a kind that there is none of");
    }
    make();
    domain.name = NULL;
    expect("name", "without name");
    make();
    domain.detect = NULL;
    expect(NULL, "without detect");
    domain.candidates = NULL;
    expect("candidates", "without candidates");
    domain.oracle = oracle;
    expect(NULL, "with an oracle instead of candidates");
    make();
    domain.oracle = oracle;
    expect(NULL, "with both");
}

/* Looking for what follows needs candidates, and how many there are. */
static void test_successors(void **state) {
    (void)state;
    static const struct {
        uint32_t features_max, features_at_once;
        uint8_t own_oracle, possible;
    } cases[] = {{18, 18, 0, 1}, {18, 64, 0, 1}, {1, 1, 0, 1},  {19, 18, 0, 1},
                 {0, 64, 0, 0},  {65, 64, 0, 1}, {18, 18, 1, 0}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        make();
        domain.features_max = cases[i].features_max;
        domain.oracle = cases[i].own_oracle ? oracle : NULL;
        config.features_at_once = cases[i].features_at_once;
        config.successors = 1;
        expect(cases[i].possible ? NULL : "successors", "successors");
        config.successors = 0;
        expect(NULL, "no successors");
    }
}

/* An oracle is asked about cutpoints, and ranks have none; and a count cubed must fit into 64
 * bits. */
static void test_ranks(void **state) {
    (void)state;
    make();
    config.successors = 0;
    config.score = RLVC_SCORE_RANKS;
    config.capacity = (1u << 21) - 1u;
    expect(NULL, "ranks");
    config.capacity++;
    expect("ranks", "ranks of too many");
    config.score = RLVC_SCORE_GAIN;
    expect(NULL, "gain of many");
    domain.oracle = oracle;
    expect(NULL, "gain with an oracle");
    config.capacity = 1000;
    config.score = RLVC_SCORE_RANKS;
    expect("ranks", "ranks with an oracle");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_defaults),  cmocka_unit_test(test_null),
        cmocka_unit_test(test_counts),    cmocka_unit_test(test_planner),
        cmocka_unit_test(test_choices),   cmocka_unit_test(test_numbers),
        cmocka_unit_test(test_callbacks), cmocka_unit_test(test_successors),
        cmocka_unit_test(test_ranks),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
