/* SPDX-License-Identifier: MIT */
/* What a table adds to a sum of very many is the least of two statistics, to the last bit, also
 * where it is known without the logarithms of one of them. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "base/rng.h"
#include "rlvc/chi2.h"
#include "stats/score.h"
#include "stats/table_test.h"

#define LN_2 0.693147181f

/* Which was the least. */
static uint32_t pearsons, ratios;

static void check(uint32_t a, uint32_t b, uint32_t c, uint32_t d) {
    const rlvc_table table = {a, b, c, d};
    const float n = (float)((uint64_t)a + b + c + d);
    float pearson;
    if (a + b == 0 || c + d == 0 || a + c == 0 || b + d == 0)
        return;
    assert_int_equal(rlvc_chi2_table(a, b, c, d, &pearson), RLVC_OK);
    pearson *= (n - 1.0f) / n;
    const float ratio = 2.0f * (n * (LN_2 * rlvc_score(a, b, c, d)));
    const float expected = pearson < ratio ? pearson : ratio, got = rlvc_table_least(&table);
    if (memcmp(&expected, &got, sizeof got) != 0)
        fail_msg("%u %u %u %u: %.9g, not %.9g", a, b, c, d, (double)got, (double)expected);
    pearsons += pearson < ratio;
    ratios += ratio < pearson;
}

static void test_every_small_table(void **state) {
    (void)state;
    enum { SUM = 34 };
    for (uint32_t a = 0; a <= SUM; a++)
        for (uint32_t b = 0; a + b <= SUM; b++)
            for (uint32_t c = 0; a + b + c <= SUM; c++)
                for (uint32_t d = 0; a + b + c + d <= SUM; d++)
                    check(a, b, c, d);
    assert_true(pearsons > 1000u && ratios > 1000u);
}

/* Most are near independence, as tables of noise are, where the two hardly differ. */
static void test_large_tables(void **state) {
    (void)state;
    rlvc_rng rng;
    rlvc_rng_seed(&rng, 3);
    for (uint32_t i = 0; i < 300000u; i++) {
        const uint32_t total = i % 3u == 0 ? 4096u - rlvc_rng_below(&rng, 8u)
                                           : (uint32_t)INT32_MAX >> rlvc_rng_below(&rng, 28u);
        const uint32_t row = rlvc_rng_below(&rng, total + 1u);
        const uint32_t column = rlvc_rng_below(&rng, total + 1u) >> rlvc_rng_below(&rng, 6u);
        const uint32_t least = row + column > total ? row + column - total : 0u;
        const uint32_t most = row < column ? row : column;
        const uint64_t mean = (uint64_t)row * column / total;
        const uint32_t spread = 1u + (uint32_t)mean / 16u;
        uint32_t a = i % 4u == 0 ? least + rlvc_rng_below(&rng, most - least + 1u)
                                 : (uint32_t)mean + rlvc_rng_below(&rng, 2u * spread) - spread;
        a = a > most || a > INT32_MAX ? most : a < least ? least : a;
        check(a, row - a, column - a, total - row - column + a);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_every_small_table),
        cmocka_unit_test(test_large_tables),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
