/* SPDX-License-Identifier: MIT */
/* Scores of 2 x 2 tables against the same formula in double. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "base/rng.h"
#include "stats/score.h"

#define ALLOWED ((double)RLVC_SCORE_ERROR / 4.0) /* the rest is a reserve */

/* O ln(O / E) - (O - E) over E, where u = (O - E) / E. */
static double excess(double u) {
    if (fabs(u) < 1e-2) {
        double sum = 0.0;
        double power = u * u;
        for (int k = 2; k < 12; k++, power *= -u)
            sum += power / (k * (k - 1));
        return sum;
    }
    return u <= -1.0 ? 1.0 : (1.0 + u) * log1p(u) - u;
}

static double reference(const uint32_t t[4]) {
    double rows[2] = {(double)t[0] + t[1], (double)t[2] + t[3]};
    double columns[2] = {(double)t[0] + t[2], (double)t[1] + t[3]};
    double total = rows[0] + rows[1];
    int64_t n = (int64_t)t[0] * t[3] - (int64_t)t[1] * t[2];
    double sum = 0.0;
    if (rows[0] * rows[1] * columns[0] * columns[1] <= 0.0)
        return 0.0;
    for (int i = 0; i < 4; i++) {
        double expected = rows[i / 2] * columns[i % 2] / total;
        double u = (i == 0 || i == 3 ? 1.0 : -1.0) * (double)n / total / expected;
        sum += expected * excess(u);
    }
    return sum / (total * log(2.0));
}

static float score(const uint32_t t[4]) {
    return rlvc_score(t[0], t[1], t[2], t[3]);
}

static void check(const uint32_t t[4]) {
    double expected = reference(t);
    double got = (double)score(t);
    if (!(fabs(got - expected) <= ALLOWED * expected) || got < 0.0)
        fail_msg("%u %u / %u %u: %.9g, not %.9g", t[0], t[1], t[2], t[3], got, expected);
    const uint32_t rows[4] = {t[2], t[3], t[0], t[1]};
    const uint32_t columns[4] = {t[1], t[0], t[3], t[2]};
    const uint32_t both[4] = {t[3], t[2], t[1], t[0]};
    const uint32_t transposed[4] = {t[0], t[2], t[1], t[3]};
    assert_memory_equal(&(float){score(rows)}, &(float){score(t)}, sizeof(float));
    assert_memory_equal(&(float){score(columns)}, &(float){score(t)}, sizeof(float));
    assert_memory_equal(&(float){score(both)}, &(float){score(t)}, sizeof(float));
    assert_memory_equal(&(float){score(transposed)}, &(float){score(t)}, sizeof(float));
}

static void test_every_small_table(void **state) {
    (void)state;
    enum { SUM = 20 };
    for (uint32_t a = 0; a <= SUM; a++)
        for (uint32_t b = 0; a + b <= SUM; b++)
            for (uint32_t c = 0; a + b + c <= SUM; c++)
                for (uint32_t d = 0; a + b + c + d <= SUM; d++)
                    check((const uint32_t[4]){a, b, c, d});
}

/* Tables of any size and shape; half of them within a few counts of independence, where a plain sum
 * of logarithms would have no right digit. */
static void test_large_tables(void **state) {
    (void)state;
    rlvc_rng rng;
    rlvc_rng_seed(&rng, 11u);
    for (int i = 0; i < 200000; i++) {
        uint32_t total = (uint32_t)INT32_MAX >> rlvc_rng_below(&rng, 30u);
        uint32_t row = rlvc_rng_below(&rng, total + 1u) >> rlvc_rng_below(&rng, 20u);
        uint32_t column = rlvc_rng_below(&rng, total + 1u) >> rlvc_rng_below(&rng, 20u);
        uint32_t least = row + column > total ? row + column - total : 0u;
        uint32_t most = row < column ? row : column;
        uint32_t a = least + rlvc_rng_below(&rng, most - least + 1u);
        if (i % 2 == 0) {
            a = (uint32_t)((uint64_t)row * column / total) + rlvc_rng_below(&rng, 5u);
            a = a < most ? a : most;
        }
        check((const uint32_t[4]){a, row - a, column - a, total - row - column + a});
    }
}

static void test_known_values(void **state) {
    (void)state;
    const uint32_t perfect[4] = {8, 0, 0, 8};
    const uint32_t none[4] = {4, 8, 2, 4};
    const uint32_t largest[4] = {1u << 30, 0, 0, (1u << 30) - 1u};
    assert_float_equal(score(perfect), 1.0f, 1e-6f);
    assert_float_equal(score(none), 0.0f, 0.0f);
    check(largest);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_every_small_table),
        cmocka_unit_test(test_large_tables),
        cmocka_unit_test(test_known_values),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
