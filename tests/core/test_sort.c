/* SPDX-License-Identifier: MIT */
/* Sorting: every shape of keys and every slicing. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "rlvc/agent.h"
#include "base/rng.h"
#include "samples/sort.h"

#define COUNT_MAX 70000u

static rlvc_sample input[COUNT_MAX], whole[COUNT_MAX], sliced[COUNT_MAX];
static uint8_t seen[COUNT_MAX];
static uint32_t scratch[RLVC_SORT_SCRATCH_BYTES / 4u];

enum { RANDOM, SMALL, RISING, FALLING, EQUAL, ONE_BIT, FEW_BITS, SKEWED, FLOATS, SHAPES };
static const char *const shape_names[SHAPES] = {"random", "small", "rising", "falling", "equal",
                                                "1 bit",  "few",   "skewed", "floats"};

static uint32_t key_of(int shape, uint32_t i, uint32_t count, rlvc_rng *rng) {
    uint32_t word = rlvc_rng_next(rng);
    switch (shape) {
    case RANDOM:
        return word;
    case SMALL:
        return word % 256u + 77u;
    case RISING:
        return i * 3u;
    case FALLING:
        return (count - i) * 60013u;
    case EQUAL:
        return 0xdeadbeefu;
    case ONE_BIT:
        return 1u << word % 32u;
    case FEW_BITS:
        return word & 0x80010001u;
    case SKEWED:
        return word & rlvc_rng_next(rng) & rlvc_rng_next(rng) & rlvc_rng_next(rng);
    default:
        return 0x3f800000u + (word >> 12) + (word >> 22);
    }
}

static void make_input(int shape, uint32_t count, uint32_t seed) {
    rlvc_rng rng;
    rlvc_rng_seed(&rng, seed);
    for (uint32_t i = 0; i < count; i++) {
        input[i].key = key_of(shape, i, count, &rng);
        input[i].slot = i;
    }
}

/* Sorts with budgets of `budget`, or random ones if that is 0. Returns the units used. */
static uint64_t sort(rlvc_sample *sample, uint32_t count, uint32_t budget, rlvc_rng *rng) {
    rlvc_sort_cursor state;
    uint64_t work = 0;
    memcpy(sample, input, count * sizeof *sample);
    rlvc_sort_begin(&state, sample, count, scratch);
    while (!state.done) {
        uint32_t room = budget > 0 ? budget : RLVC_BUDGET_MIN + rlvc_rng_below(rng, 300u);
        uint32_t used = rlvc_sort_step(&state, room);
        assert_in_range(used, 1u, room);
        work += used;
    }
    return work;
}

static void check(int shape, uint32_t count, uint32_t seed) {
    rlvc_rng rng;
    rlvc_rng_seed(&rng, seed);
    make_input(shape, count, seed);
    uint64_t bound = 70u * (uint64_t)count + 700u * (count / 32u);
    assert_true(sort(whole, count, RLVC_BUDGET_UNBOUNDED, &rng) <= bound);
    memset(seen, 0, count);
    for (uint32_t i = 0; i < count; i++) {
        uint32_t slot = whole[i].slot;
        if (slot >= count || seen[slot] || whole[i].key != input[slot].key ||
            (i > 0 && whole[i - 1u].key > whole[i].key))
            fail_msg("%s, count %u, seed %u: wrong at %u", shape_names[shape], count, seed, i);
        seen[slot] = 1;
    }
    for (int random = 0; random < 2; random++) {
        assert_true(sort(sliced, count, random ? 0 : RLVC_BUDGET_MIN, &rng) <= bound);
        if (memcmp(sliced, whole, count * sizeof *whole) != 0)
            fail_msg("%s, count %u, seed %u: depends on the slicing", shape_names[shape], count,
                     seed);
    }
}

static void test_shapes(void **state) {
    (void)state;
    const uint32_t counts[] = {33, 100, 257, 1000, 4096, COUNT_MAX};
    for (int shape = 0; shape < SHAPES; shape++)
        for (size_t i = 0; i < sizeof counts / sizeof counts[0]; i++)
            check(shape, counts[i], 5u + (uint32_t)i);
}

static void test_short(void **state) {
    (void)state;
    for (int shape = 0; shape < SHAPES; shape++)
        for (uint32_t count = 0; count < 70u; count++)
            check(shape, count, count);
}

/* All keys of 3 values at every place: 3^9 inputs. */
static void test_every_small_input(void **state) {
    (void)state;
    enum { COUNT = 9, INPUTS = 19683 };
    for (uint32_t number = 0; number < INPUTS; number++) {
        uint32_t rest = number;
        for (uint32_t i = 0; i < COUNT; i++, rest /= 3u) {
            input[i].key = rest % 3u << 20;
            input[i].slot = i;
        }
        sort(whole, COUNT, RLVC_BUDGET_MIN, NULL);
        for (uint32_t i = 1; i < COUNT; i++)
            assert_true(whole[i - 1u].key <= whole[i].key);
    }
}

static void test_small_state(void **state) {
    (void)state;
    assert_true(sizeof(rlvc_sort_cursor) <= 96u);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_shapes),
        cmocka_unit_test(test_short),
        cmocka_unit_test(test_every_small_input),
        cmocka_unit_test(test_small_state),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
