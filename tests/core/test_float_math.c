/* SPDX-License-Identifier: MIT */
/* The elementary functions: near the true values, and the same bits everywhere. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "golden.h"
#include "base/float_math.h"

/* In the order of the golden file's first column. */
static const struct {
    const char *name;
    float (*function)(float x);
    double relative; /* error allowed */
    float sign;      /* of the arguments */
    float below;     /* their size */
} functions[] = {
    {"ln", rlvc_ln, 1.9e-7, 1.0f, INFINITY},
    {"sqrt", rlvc_sqrt, 1.2e-7, 1.0f, INFINITY},
    {"exp", rlvc_exp, 1.2e-7, -1.0f, INFINITY},
    {"ln_1_minus", rlvc_ln_1_minus, 2.6e-7, 1.0f, 1.0f},
};

static void test_golden(void **state) {
    (void)state;
    const double least_normal = 1.17549435e-38;
    const double half_of_least = 0.76e-45; /* and a little for what is rounded before */
    golden table = golden_open("real.csv", 3);
    while (golden_next(&table)) {
        size_t i = (size_t)table.row[0];
        float y = functions[i].function((float)table.row[1]);
        double wanted = table.row[2];
        double size = wanted < 0.0 ? -wanted : wanted;
        if (size >= least_normal || size == 0.0)
            golden_close(&table, functions[i].name, y, wanted, functions[i].relative);
        else
            golden_close(&table, functions[i].name, y, wanted, 1e-6 + 1.5 * half_of_least / size);
    }
}

static void test_exact_values(void **state) {
    (void)state;
    assert_true(rlvc_ln(1.0f) == 0.0f);
    assert_true(rlvc_exp(0.0f) == 1.0f);
    assert_true(rlvc_exp(-104.5f) == 0.0f);
    assert_true(rlvc_exp(-1e30f) == 0.0f);
    assert_true(rlvc_ln_1_minus(0.0f) == 0.0f);
}

static void test_scale(void **state) {
    (void)state;
    static const struct {
        float x;
        int32_t e;
        uint32_t bits;
    } cases[] = {
        {1.5f, 0, 0x3fc00000u},    {1.5f, 120, 0x7bc00000u},  {1.5f, -100, 0x0dc00000u},
        {1.5f, -101, 0x0d400000u}, {1.5f, -126, 0x00c00000u}, {1.5f, -149, 0x00000002u},
        {1.25f, -149, 1u},         {64.0f, -155, 1u},         {1.0f, -200, 0u},
        {64.0f, -201, 0u},         {1.0f, -2000000000, 0u},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        uint32_t bits = rlvc_bits_of(rlvc_scale(cases[i].x, cases[i].e));
        if (bits != cases[i].bits)
            fail_msg("case %d: 0x%08x, not 0x%08x", (int)i, (unsigned)bits,
                     (unsigned)cases[i].bits);
    }
}

static void test_exp_apart(void **state) {
    (void)state;
    /* exp(-1000) = 2^-1443 * 1.23538..., far out of a float's range */
    int32_t e;
    float m = rlvc_exp_apart(-1000.0f, &e);
    assert_int_equal(e, -1443);
    assert_true(m > 1.235383f && m < 1.235384f);
    m = rlvc_exp_apart(-1400.0f, &e);
    assert_true(m >= 0.7f && m <= 1.42f);
}

static void test_same_bits_everywhere(void **state) {
    (void)state;
    static const uint32_t pinned[] = {0x1cf07d1bu, 0xf98e38fdu, 0x14b45eeeu, 0xc4179da0u};
    for (size_t i = 0; i < sizeof functions / sizeof functions[0]; i++) {
        uint32_t all = DIGEST_START;
        for (uint32_t bits = 0x00800000u; bits < rlvc_bits_of(functions[i].below); bits += 20011u)
            all = digest(all, functions[i].function(functions[i].sign * rlvc_float_of(bits)));
        if (all != pinned[i])
            fail_msg("%s: the digest is 0x%08xu, not 0x%08xu", functions[i].name, (unsigned)all,
                     (unsigned)pinned[i]);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_golden),
        cmocka_unit_test(test_exact_values),
        cmocka_unit_test(test_scale),
        cmocka_unit_test(test_exp_apart),
        cmocka_unit_test(test_same_bits_everywhere),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
