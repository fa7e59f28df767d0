/* SPDX-License-Identifier: MIT */
/* Means over millions of samples against the same mean in double. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "golden.h"
#include "base/mean.h"
#include "base/rng.h"

static float constant(rlvc_rng *rng) {
    (void)rng;
    return 0.1f;
}

static float uniform(rlvc_rng *rng) {
    return rlvc_rng_uniform(rng) * 100.0f;
}

/* What a maze pays: -1 mostly, 100 now and then. */
static float maze(rlvc_rng *rng) {
    return rlvc_rng_below(rng, 50u) == 0u ? 100.0f : -1.0f;
}

/* Huge rewards that all but cancel what is small. */
static float swinging(rlvc_rng *rng) {
    float small = rlvc_rng_uniform(rng);
    return rlvc_rng_below(rng, 2u) == 0u ? small : 1e12f * (rlvc_rng_uniform(rng) - 0.5f);
}

static const struct {
    const char *name;
    float (*draw)(rlvc_rng *rng);
    uint32_t terms;
    uint32_t weight_below; /* weights are drawn in [0, weight_below); 0: all are 1 */
} cases[] = {
    {"constant", constant, 4000000u, 0u},
    {"uniform", uniform, 4000000u, 0u},
    {"maze", maze, 1000000u, 0u},
    {"swinging", swinging, 1000000u, 0u},
    {"weighted", uniform, 1000000u, 4000u},
    {"one term", uniform, 1u, 0u},
    {"huge weight", uniform, 1u, UINT32_MAX},
};

static void test_near_double(void **state) {
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        rlvc_rng rng;
        rlvc_sum total;
        double sum = 0.0, size = 0.0, weights = 0.0;
        rlvc_rng_seed(&rng, (uint32_t)i);
        rlvc_sum_clear(&total);
        for (uint32_t n = 0; n < cases[i].terms; n++) {
            float x = cases[i].draw(&rng);
            uint32_t weight =
                cases[i].weight_below == 0u ? 1u : rlvc_rng_below(&rng, cases[i].weight_below);
            double product = (double)x * (double)weight;
            rlvc_sum_add(&total, x, weight);
            sum += product;
            size += product < 0.0 ? -product : product;
            weights += (double)weight;
        }
        double error = (double)rlvc_sum_mean(&total) * weights - sum;
        if (!(error <= 2.5e-7 * size && error >= -2.5e-7 * size))
            fail_msg("%s: the mean is off by %g of the terms' mean size", cases[i].name,
                     error / size);
    }
}

static void test_relative_to_a_plain_mean(void **state) {
    (void)state;
    /* 4,000,000 times the same: a naive float sum stands still long before the end. */
    rlvc_sum total;
    rlvc_sum_clear(&total);
    for (int i = 0; i < 4000000; i++)
        rlvc_sum_add(&total, 7.3f, 1u);
    float mean = rlvc_sum_mean(&total);
    assert_true(mean > 7.3f * (1.0f - 2e-7f) && mean < 7.3f * (1.0f + 2e-7f));
}

static void test_nothing_and_exact_sums(void **state) {
    (void)state;
    rlvc_sum total;
    rlvc_sum_clear(&total);
    assert_true(rlvc_sum_mean(&total) == 0.0f);
    rlvc_sum_add(&total, 5.0f, 0u);
    assert_true(rlvc_sum_mean(&total) == 0.0f);
    rlvc_sum_add(&total, 1e9f, 1u); /* what the great term swallows comes back when it leaves */
    rlvc_sum_add(&total, 3.0f, 1u);
    rlvc_sum_add(&total, -1e9f, 1u);
    assert_true(rlvc_sum_mean(&total) == 1.0f);
}

static void test_same_bits_everywhere(void **state) {
    (void)state;
    uint32_t all = DIGEST_START;
    rlvc_rng rng;
    rlvc_sum total;
    rlvc_rng_seed(&rng, 99u);
    rlvc_sum_clear(&total);
    for (int i = 0; i < 20000; i++) {
        float x = uniform(&rng);
        rlvc_sum_add(&total, x, rlvc_rng_below(&rng, 5u));
        all = digest(digest(all, rlvc_sum_mean(&total)), total.rest);
    }
    const uint32_t pinned = 0x4589a211u;
    if (all != pinned)
        fail_msg("the digest is 0x%08xu, not 0x%08xu", (unsigned)all, (unsigned)pinned);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_near_double),
        cmocka_unit_test(test_relative_to_a_plain_mean),
        cmocka_unit_test(test_nothing_and_exact_sums),
        cmocka_unit_test(test_same_bits_everywhere),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
