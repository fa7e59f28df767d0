/* SPDX-License-Identifier: MIT */
/* Gram matrices against plain sums in double, ridge regression against Gauss-Jordan elimination. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "base/rng.h"
#include "dynamics/gram.h"
#include <math.h>
#include <string.h>

#define ORDER 7u
#define TERMS (ORDER - 1u)
#define ROWS 300u

static float rows[ROWS][ORDER];

static void draw_rows(uint32_t seed) {
    rlvc_rng rng;
    rlvc_rng_seed(&rng, seed);
    for (uint32_t r = 0; r < ROWS; r++) {
        float y = 0.3f * rlvc_rng_uniform(&rng);
        rows[r][0] = 1.0f;
        for (uint32_t i = 1; i < TERMS; i++)
            rows[r][i] = 2.0f * rlvc_rng_uniform(&rng) - 1.0f;
        for (uint32_t i = 0; i < TERMS; i++)
            y += (float)(i + 1u) * rows[r][i];
        rows[r][TERMS] = y;
    }
}

static void add_rows(float *gram, uint32_t from, uint32_t to) {
    for (uint32_t r = from; r < to; r++)
        rlvc_gram_add(gram, rows[r], ORDER);
}

static double product(uint32_t i, uint32_t j, uint32_t from, uint32_t to) {
    double sum = 0.0;
    for (uint32_t r = from; r < to; r++)
        sum += (double)rows[r][i] * (double)rows[r][j];
    return sum;
}

static void compare(const float *gram, uint32_t from, uint32_t to) {
    for (uint32_t i = 0; i < ORDER; i++)
        for (uint32_t j = 0; j <= i; j++)
            assert_true(fabs((double)gram[RLVC_GRAM_FLOATS(i) + j] - product(i, j, from, to)) <
                        0.02);
    assert_true(gram[0] == (float)(to - from));
}

static void test_sums(void **state) {
    (void)state;
    float all[RLVC_GRAM_FLOATS(ORDER)], part[RLVC_GRAM_FLOATS(ORDER)],
        rest[RLVC_GRAM_FLOATS(ORDER)];
    draw_rows(1);
    rlvc_gram_clear(all, ORDER);
    rlvc_gram_clear(part, ORDER);
    add_rows(all, 0, ROWS);
    add_rows(part, 0, 100);
    compare(all, 0, ROWS);
    compare(part, 0, 100);
    rlvc_gram_difference(rest, all, part, ORDER);
    compare(rest, 100, ROWS);
    rlvc_gram_sum(rest, part, ORDER);
    compare(rest, 0, ROWS);
}

/* The normal equations with a ridge, in double. */
static void eliminate(double ridge, double *b) {
    double a[TERMS][TERMS + 1u];
    for (uint32_t i = 0; i < TERMS; i++)
        for (uint32_t j = 0; j <= TERMS; j++)
            a[i][j] = product(i, j, 0, ROWS) + (i == j ? ridge : 0.0);
    for (uint32_t k = 0; k < TERMS; k++)
        for (uint32_t i = 0; i < TERMS; i++) {
            double share = a[i][k] / a[k][k];
            for (uint32_t j = 0; j <= TERMS && i != k; j++)
                a[i][j] -= share * a[k][j];
        }
    for (uint32_t i = 0; i < TERMS; i++)
        b[i] = a[i][TERMS] / a[i][i];
}

static void test_ridge_regression(void **state) {
    (void)state;
    const float ridges[] = {0.001f, 1.0f, 30.0f};
    for (uint32_t k = 0; k < 3; k++) {
        float gram[RLVC_GRAM_FLOATS(ORDER)], work[TERMS], b[TERMS];
        double expected[TERMS], least = 0.0;
        draw_rows(2 + k);
        rlvc_gram_clear(gram, ORDER);
        add_rows(gram, 0, ROWS);
        float left = rlvc_gram_factor(gram, ORDER, ridges[k]);
        for (uint32_t i = 0; i < TERMS; i++)
            b[i] = 1.0f; /* the regression is added */
        rlvc_gram_solve(gram, ORDER, work, b);
        eliminate((double)ridges[k], expected);
        for (uint32_t i = 0; i < TERMS; i++) {
            assert_true(fabs((double)b[i] - 1.0 - expected[i]) < 1e-3);
            least += (double)ridges[k] * expected[i] * expected[i];
        }
        for (uint32_t r = 0; r < ROWS; r++) {
            double e = (double)rows[r][TERMS];
            for (uint32_t i = 0; i < TERMS; i++)
                e -= expected[i] * (double)rows[r][i];
            least += e * e;
        }
        assert_true(fabs((double)left - least) < 0.01 + 1e-3 * least);
    }
}

/* Columns that are alike, a target that is explained, and no rows at all: all stays finite. */
static void test_singular(void **state) {
    (void)state;
    float gram[RLVC_GRAM_FLOATS(ORDER)], work[TERMS], b[TERMS] = {0};
    draw_rows(5);
    for (uint32_t r = 0; r < ROWS; r++) {
        rows[r][2] = rows[r][1];
        rows[r][TERMS] = rows[r][1];
    }
    rlvc_gram_clear(gram, ORDER);
    add_rows(gram, 0, ROWS);
    assert_true(rlvc_gram_factor(gram, ORDER, 0.0f) < 0.01f);
    rlvc_gram_solve(gram, ORDER, work, b);
    for (uint32_t i = 0; i < TERMS; i++)
        assert_true(fabsf(b[i]) < 10.0f);
    rlvc_gram_clear(gram, ORDER);
    assert_true(rlvc_gram_factor(gram, ORDER, 0.0f) < 1e-20f);
}

/* A Gram matrix may be a difference of two sums: where the target is explained, rounding may leave
 * less than nothing of its diagonal, or of a column's. */
static void test_less_than_nothing(void **state) {
    (void)state;
    float gram[RLVC_GRAM_FLOATS(ORDER)], work[TERMS], b[TERMS] = {0};
    draw_rows(6);
    for (uint32_t r = 0; r < ROWS; r++)
        rows[r][3] = rows[r][TERMS] = 0.0f;
    rlvc_gram_clear(gram, ORDER);
    add_rows(gram, 0, ROWS);
    gram[RLVC_GRAM_FLOATS(4u) - 1u] = -1e-3f;
    gram[RLVC_GRAM_FLOATS(ORDER) - 1u] = -1.5e-14f;
    float left = rlvc_gram_factor(gram, ORDER, 2e-4f);
    assert_true(left > 0.0f && left < 1e-20f);
    rlvc_gram_solve(gram, ORDER, work, b);
    for (uint32_t i = 0; i < TERMS; i++)
        assert_true(fabsf(b[i]) < 1e-6f);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_sums),
        cmocka_unit_test(test_ridge_regression),
        cmocka_unit_test(test_singular),
        cmocka_unit_test(test_less_than_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
