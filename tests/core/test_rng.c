/* SPDX-License-Identifier: MIT */
/* The pseudo-random numbers against a second implementation, whose output is in tests/golden. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "golden.h"
#include "base/rng.h"

static void test_golden(void **state) {
    (void)state;
    rlvc_rng rng = {0};
    double seed = -1.0;
    golden table = golden_open("rng.csv", 5);
    while (golden_next(&table)) {
        if (table.row[0] < seed || table.row[0] > seed) {
            seed = table.row[0];
            rlvc_rng_seed(&rng, (uint32_t)seed);
        }
        rlvc_rng twin = rng;
        rlvc_rng third = rng;
        golden_close(&table, "uniform", rlvc_rng_uniform(&twin), table.row[2] / 16777216.0, 0.0);
        uint32_t below = rlvc_rng_below(&third, (uint32_t)table.row[3]);
        uint32_t next = rlvc_rng_next(&rng);
        if (next != (uint32_t)table.row[1] || below != (uint32_t)table.row[4])
            fail_msg("%s:%d: next %u, below %u", table.name, table.line, (unsigned)next,
                     (unsigned)below);
        assert_true(twin.state == rng.state && third.state == rng.state); /* one draw each */
    }
}

static void test_evenly_spread(void **state) {
    (void)state;
    enum { DRAWS = 120000, SIDES = 6 };
    uint32_t seen[SIDES] = {0};
    double sum = 0.0;
    rlvc_rng rng;
    rlvc_rng_seed(&rng, 7u);
    for (int i = 0; i < DRAWS; i++) {
        seen[rlvc_rng_below(&rng, SIDES)]++;
        float u = rlvc_rng_uniform(&rng);
        assert_true(u >= 0.0f && u < 1.0f);
        sum += (double)u;
    }
    for (int side = 0; side < SIDES; side++) /* within four standard deviations, 129 each */
        assert_in_range(seen[side], DRAWS / SIDES - 516, DRAWS / SIDES + 516);
    assert_true(sum / DRAWS > 0.4966 && sum / DRAWS < 0.5034);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_golden),
        cmocka_unit_test(test_evenly_spread),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
