/* SPDX-License-Identifier: MIT */
/* The chi-square distribution against numbers of 60 digits (tests/golden/make_chi2.py). */
#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "golden.h"
#include "rlvc/chi2.h"

/* The header promises 1e-5; the tests hold it to what was measured. */
#define SURVIVAL_RELATIVE 3e-6
#define ONE_DEGREE_RELATIVE 6e-7
#define CRITICAL_RELATIVE 3e-6
#define TABLE_RELATIVE 4e-7
#define FISHER_ERROR 4e-6 /* of ln p, in units of 1 - ln p */

static void test_survival(void **state) {
    (void)state;
    golden table = golden_open("chi2.csv", 4);
    while (golden_next(&table)) {
        uint32_t degrees = (uint32_t)table.row[0];
        double relative = degrees == 1u ? ONE_DEGREE_RELATIVE : SURVIVAL_RELATIVE;
        float p = -1.0f;
        float log_p = 1.0f;
        assert_int_equal(rlvc_chi2_survival((float)table.row[1], degrees, &p, &log_p), RLVC_OK);
        if (table.row[2] >= 1e-30)
            golden_close(&table, "p", p, table.row[2], relative);
        else if (!(p >= 0.0f && p <= 1.01e-30f))
            fail_msg("%s:%d: p is %g", table.name, table.line, (double)p);
        if (table.row[3] < 0.0)
            golden_close(&table, "log_p", log_p, table.row[3], relative);
        else if (!(log_p <= 0.0f && log_p >= -1.2e-38f))
            fail_msg("%s:%d: log_p is %g", table.name, table.line, (double)log_p);
    }
}

static void test_survival_at_the_ends(void **state) {
    (void)state;
    static const uint32_t degrees[] = {1u, 2u, 3u, 4u, 254u, 255u};
    for (size_t i = 0; i < sizeof degrees / sizeof degrees[0]; i++) {
        float p = -1.0f;
        float log_p = 1.0f;
        assert_int_equal(rlvc_chi2_survival(0.0f, degrees[i], &p, &log_p), RLVC_OK);
        assert_true(p == 1.0f && log_p == 0.0f);
        assert_int_equal(rlvc_chi2_survival(FLT_MIN / 8.0f, degrees[i], &p, &log_p), RLVC_OK);
        assert_true(p == 1.0f && log_p == 0.0f);
        assert_int_equal(rlvc_chi2_survival(1.1e-37f, degrees[i], &p, &log_p), RLVC_OK);
        assert_true(p == 1.0f && log_p <= 0.0f && log_p > -1e-18f);
        assert_int_equal(rlvc_chi2_survival(FLT_MAX, degrees[i], &p, &log_p), RLVC_OK);
        assert_true(p == 0.0f && log_p == -0.5f * FLT_MAX);
    }
}

static void test_survival_falls(void **state) {
    (void)state;
    for (uint32_t degrees = 1; degrees <= RLVC_CHI2_DEGREES_MAX; degrees++) {
        float before = 0.0f;
        for (float x = 0.01f; x < 1e5f; x *= 1.02f) {
            float log_p;
            assert_int_equal(rlvc_chi2_survival(x, degrees, NULL, &log_p), RLVC_OK);
            if (!(log_p < before || (log_p <= 0.0f && log_p > -1e-36f)))
                fail_msg("%u degrees: log_p is %g at %g", (unsigned)degrees, (double)log_p,
                         (double)x);
            before = log_p;
        }
    }
}

static void test_survival_arguments(void **state) {
    (void)state;
    static const struct {
        float statistic;
        uint32_t degrees;
    } refused[] = {{-1e-30f, 1u}, {NAN, 1u}, {INFINITY, 1u}, {1.0f, 0u}, {1.0f, 256u}};
    for (size_t i = 0; i < sizeof refused / sizeof refused[0]; i++) {
        float p = 7.0f;
        float log_p = 7.0f;
        assert_int_equal(rlvc_chi2_survival(refused[i].statistic, refused[i].degrees, &p, &log_p),
                         RLVC_E_RANGE);
        assert_true(p == 7.0f && log_p == 7.0f);
    }
    float p;
    float log_p;
    float alone;
    assert_int_equal(rlvc_chi2_survival(3.0f, 1u, NULL, NULL), RLVC_OK);
    assert_int_equal(rlvc_chi2_survival(3.0f, 1u, &p, &log_p), RLVC_OK);
    assert_int_equal(rlvc_chi2_survival(3.0f, 1u, &alone, NULL), RLVC_OK);
    assert_true(alone == p);
    assert_int_equal(rlvc_chi2_survival(3.0f, 1u, NULL, &alone), RLVC_OK);
    assert_true(alone == log_p);
}

static void test_critical(void **state) {
    (void)state;
    golden table = golden_open("chi2_critical.csv", 3);
    while (golden_next(&table)) {
        float x = -1.0f;
        assert_int_equal(rlvc_chi2_critical((float)table.row[1], (uint32_t)table.row[0], &x),
                         RLVC_OK);
        golden_close(&table, "the critical value", x, table.row[2], CRITICAL_RELATIVE);
    }
}

static void test_critical_arguments(void **state) {
    (void)state;
    static const struct {
        float p;
        uint32_t degrees;
    } refused[] = {{0.0f, 1u}, {9.9e-31f, 1u},  {1.0f, 1u},  {2.0f, 1u},
                   {NAN, 1u},  {-INFINITY, 1u}, {0.05f, 0u}, {0.05f, 256u}};
    for (size_t i = 0; i < sizeof refused / sizeof refused[0]; i++) {
        float x = 7.0f;
        assert_int_equal(rlvc_chi2_critical(refused[i].p, refused[i].degrees, &x), RLVC_E_RANGE);
        assert_true(x == 7.0f);
    }
    assert_int_equal(rlvc_chi2_critical(0.05f, 1u, NULL), RLVC_E_NULL);
    float x;
    assert_int_equal(rlvc_chi2_critical(1e-30f, 255u, &x), RLVC_OK);
}

static void test_table(void **state) {
    (void)state;
    golden table = golden_open("chi2_table.csv", 5);
    while (golden_next(&table)) {
        float x = -1.0f;
        assert_int_equal(rlvc_chi2_table((uint32_t)table.row[0], (uint32_t)table.row[1],
                                         (uint32_t)table.row[2], (uint32_t)table.row[3], &x),
                         RLVC_OK);
        golden_close(&table, "the statistic", x, table.row[4], TABLE_RELATIVE);
    }
}

static void test_table_arguments(void **state) {
    (void)state;
    const uint32_t most = INT32_MAX;
    float x = 7.0f;
    assert_int_equal(rlvc_chi2_table(1u, 2u, 3u, 4u, NULL), RLVC_E_NULL);
    assert_int_equal(rlvc_chi2_table(most, 1u, 0u, 0u, &x), RLVC_E_RANGE);
    assert_int_equal(rlvc_chi2_table(UINT32_MAX, 1u, 0u, 0u, &x), RLVC_E_RANGE);
    assert_int_equal(rlvc_chi2_table(UINT32_MAX, UINT32_MAX, UINT32_MAX, UINT32_MAX, &x),
                     RLVC_E_RANGE);
    assert_true(x == 7.0f);
    assert_int_equal(rlvc_chi2_table(most, 0u, 0u, 0u, &x), RLVC_OK);
    assert_true(x == 0.0f);
}

static void test_fisher(void **state) {
    (void)state;
    golden table = golden_open("fisher_table.csv", 6);
    while (golden_next(&table)) {
        float p = -1.0f;
        float log_p = 1.0f;
        assert_int_equal(rlvc_fisher_table((uint32_t)table.row[0], (uint32_t)table.row[1],
                                           (uint32_t)table.row[2], (uint32_t)table.row[3], &p,
                                           &log_p),
                         RLVC_OK);
        const double bound = FISHER_ERROR * (1.0 - table.row[5]);
        if (!(fabs((double)log_p - table.row[5]) <= bound && log_p <= 0.0f))
            fail_msg("%s:%d: log_p is %g", table.name, table.line, (double)log_p);
        if (table.row[4] >= 1e-30)
            golden_close(&table, "p", p, table.row[4], 2.0 * bound);
    }
}

static void test_fisher_arguments(void **state) {
    (void)state;
    const uint32_t most = INT32_MAX;
    float p = 7.0f;
    float log_p = 7.0f;
    assert_int_equal(rlvc_fisher_table(most, 1u, 0u, 0u, &p, &log_p), RLVC_E_RANGE);
    assert_int_equal(rlvc_fisher_table(UINT32_MAX, 1u, UINT32_MAX, 1u, &p, NULL), RLVC_E_RANGE);
    assert_int_equal(rlvc_fisher_table(26u, 26u, 26u, 26u, &p, &log_p), RLVC_E_RANGE);
    assert_true(p == 7.0f && log_p == 7.0f);
    assert_int_equal(rlvc_fisher_table(25u, 25u, 25u, 25u, NULL, NULL), RLVC_OK);
    assert_int_equal(rlvc_fisher_table(0u, 0u, 0u, 0u, NULL, NULL), RLVC_OK);
    assert_int_equal(rlvc_fisher_table(0u, 0u, most, 0u, &p, &log_p), RLVC_OK);
    assert_true(p == 1.0f && log_p == 0.0f);
}

static void test_same_bits_everywhere(void **state) {
    (void)state;
    uint32_t all = DIGEST_START;
    for (uint32_t degrees = 1; degrees <= RLVC_CHI2_DEGREES_MAX; degrees++) {
        for (float x = 1e-6f; x < 1e8f; x *= 1.37f) {
            float p;
            float log_p;
            assert_int_equal(rlvc_chi2_survival(x, degrees, &p, &log_p), RLVC_OK);
            all = digest(digest(all, p), log_p);
        }
        float x;
        assert_int_equal(rlvc_chi2_critical(1.0f / (float)(degrees + 1u), degrees, &x), RLVC_OK);
        all = digest(all, x);
        assert_int_equal(rlvc_chi2_table(degrees, 1000u, 77u * degrees, 5u, &x), RLVC_OK);
        all = digest(all, x);
        assert_int_equal(rlvc_fisher_table(degrees % 9u, 8u, degrees, 99u, NULL, &x), RLVC_OK);
        all = digest(all, x);
    }
    const uint32_t pinned = 0xc0800874u;
    if (all != pinned)
        fail_msg("the digest is 0x%08xu, not 0x%08xu", (unsigned)all, (unsigned)pinned);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_survival),
        cmocka_unit_test(test_survival_at_the_ends),
        cmocka_unit_test(test_survival_falls),
        cmocka_unit_test(test_survival_arguments),
        cmocka_unit_test(test_critical),
        cmocka_unit_test(test_critical_arguments),
        cmocka_unit_test(test_table),
        cmocka_unit_test(test_table_arguments),
        cmocka_unit_test(test_fisher),
        cmocka_unit_test(test_fisher_arguments),
        cmocka_unit_test(test_same_bits_everywhere),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
