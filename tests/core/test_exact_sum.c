/* SPDX-License-Identifier: MIT */
/* Exact sums: the same in any order, as often, and in parts; rounded once. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "base/exact_sum.h"
#include "base/float_math.h"
#include "base/rng.h"
#include "rlvc/agent.h"

static float any_reward(rlvc_rng *rng) {
    float x;
    do {
        x = rlvc_float_of(rlvc_rng_next(rng));
    } while (!(fabsf(x) <= RLVC_REWARD_MAX));
    return x;
}

static void test_any_order(void **state) {
    (void)state;
    static float x[1000];
    for (uint32_t seed = 1; seed <= 50u; seed++) {
        rlvc_rng rng;
        rlvc_exact_sum up = {{0}}, down = {{0}}, halves[2] = {{{0}}, {{0}}};
        rlvc_rng_seed(&rng, seed);
        for (uint32_t i = 0; i < 1000u; i++)
            x[i] = any_reward(&rng);
        for (uint32_t i = 0; i < 1000u; i++) {
            rlvc_exact_sum_add(&up, x[i], 3);
            for (uint32_t k = 0; k < 3u; k++)
                rlvc_exact_sum_add(&down, x[999u - i], 1);
            rlvc_exact_sum_add(&halves[i % 2u], x[i], 3);
        }
        rlvc_exact_sum_join(&halves[0], &halves[1]);
        assert_memory_equal(&up, &down, sizeof up);
        assert_memory_equal(&up, &halves[0], sizeof up);
        for (uint32_t i = 0; i < 1000u; i++) /* what is taken back leaves nothing */
            rlvc_exact_sum_add(&up, -x[i], 3);
        assert_true(rlvc_exact_sum_float(&up) == 0.0f);
    }
}

/* One number comes back, with any count whose product a float holds. */
static void test_one_number(void **state) {
    (void)state;
    rlvc_rng rng;
    rlvc_rng_seed(&rng, 9);
    for (uint32_t i = 0; i < 100000u; i++) {
        float x = any_reward(&rng);
        uint32_t shift = rlvc_rng_below(&rng, 48);
        rlvc_exact_sum sum = {{0}};
        rlvc_exact_sum_add(&sum, x, UINT64_C(1) << shift);
        assert_true(rlvc_exact_sum_float(&sum) == x * (float)(UINT64_C(1) << shift));
    }
}

/* As doubles have it, where these are exact: sums of multiples of 2^-10. */
static void test_rounded_once(void **state) {
    (void)state;
    rlvc_rng rng;
    rlvc_rng_seed(&rng, 10);
    for (uint32_t i = 0; i < 20000u; i++) {
        rlvc_exact_sum sum = {{0}};
        double exact = 0.0;
        for (uint32_t k = 0; k < 4u; k++) {
            float x = ((float)rlvc_rng_below(&rng, 1u << 24) - 8388608.0f) / 1024.0f;
            uint32_t count = rlvc_rng_below(&rng, 1u << 24);
            rlvc_exact_sum_add(&sum, x, count);
            exact += (double)x * count;
        }
        assert_true(rlvc_exact_sum_float(&sum) == (float)exact);
    }
}

/* Far below the last digit one unit still breaks a tie. */
static void test_ties(void **state) {
    (void)state;
    const float tie = 16777216.0f * 4096.0f;
    rlvc_exact_sum sum = {{0}};
    rlvc_exact_sum_add(&sum, tie, 1);
    rlvc_exact_sum_add(&sum, 4096.0f, 1);
    assert_true(rlvc_exact_sum_float(&sum) == tie);
    rlvc_exact_sum_add(&sum, 1e-45f, 1);
    assert_true(rlvc_exact_sum_float(&sum) == tie + 8192.0f);
    rlvc_exact_sum_add(&sum, -1e-45f, 2);
    assert_true(rlvc_exact_sum_float(&sum) == tie);
}

static void test_null(void **state) {
    (void)state;
    rlvc_exact_sum sum = {{0}};
    rlvc_exact_sum_add(&sum, 1.5f, 2);
    rlvc_exact_sum_add(NULL, 1.0f, 1);
    rlvc_exact_sum_join(NULL, &sum);
    rlvc_exact_sum_join(&sum, NULL);
    assert_true(rlvc_exact_sum_float(&sum) == 3.0f);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_any_order),    cmocka_unit_test(test_one_number),
        cmocka_unit_test(test_rounded_once), cmocka_unit_test(test_ties),
        cmocka_unit_test(test_null),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
