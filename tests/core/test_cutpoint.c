/* SPDX-License-Identifier: MIT */
/* The search for the best cutpoint against a plain sweep over all of them: the same, to the bit. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "split/cutpoint.h"
#include "base/popcount.h"
#include "rlvc/agent.h"
#include "base/rng.h"
#include "stats/score.h"

#define COUNT_MAX (1u << 21)
#define WORDS_MAX (COUNT_MAX / 64u)

static uint64_t column[WORDS_MAX], cuts[WORDS_MAX];
static rlvc_rng rng;

static uint32_t bit_at(const uint64_t *words, uint32_t i) {
    return (uint32_t)(words[i / 64u] >> i % 64u & 1u);
}

static rlvc_cutpoint sweep(uint32_t count, float beat) {
    rlvc_cutpoint best = {-1.0f, 0, 0, 0};
    float bar = beat > 0.0f ? beat : 0.0f;
    uint32_t x = 0;
    for (uint32_t i = 0; i < count; i++)
        best.present += bit_at(column, i);
    for (uint32_t i = 0; i < count; i++) {
        if (bit_at(cuts, i)) {
            uint32_t above = best.present - x;
            float score = rlvc_score(x, i - x, above, count - i - above);
            if (score > bar) {
                bar = score;
                best = (rlvc_cutpoint){score, i, x, best.present};
            }
        }
        x += bit_at(column, i);
    }
    return best;
}

/* Budgets of `budget`, or random ones if that is 0. */
static rlvc_cutpoint scan(uint32_t count, float beat, uint32_t budget, uint64_t *work) {
    rlvc_cutpoint_cursor state;
    *work = 0;
    rlvc_cutpoint_begin(&state, column, cuts, count, 0, beat);
    while (!state.done) {
        uint32_t room = budget > 0 ? budget : RLVC_BUDGET_MIN + rlvc_rng_below(&rng, 300u);
        uint32_t used = rlvc_cutpoint_step(&state, room);
        assert_in_range(used, 1u, room);
        *work += used;
    }
    return state.best;
}

static int same(rlvc_cutpoint a, rlvc_cutpoint b) {
    return memcmp(&a, &b, sizeof a) == 0;
}

static void check_scan(uint32_t count, float beat, const char *what) {
    rlvc_cutpoint expected = sweep(count, beat);
    const uint32_t budgets[] = {RLVC_BUDGET_UNBOUNDED, RLVC_BUDGET_MIN, 0};
    uint64_t first = 0;
    for (int i = 0; i < 3; i++) {
        uint64_t work;
        rlvc_cutpoint got = scan(count, beat, budgets[i], &work);
        if (!same(got, expected))
            fail_msg("%s, count %u, beat %.9g, budget %u: %.9g at %u (%u of %u), not "
                     "%.9g at %u (%u of %u)",
                     what, count, (double)beat, budgets[i], (double)got.score, got.below,
                     got.present_below, got.present, (double)expected.score, expected.below,
                     expected.present_below, expected.present);
        first = i == 0 ? work : first;
        assert_true(work == first);
        assert_true(work <= (uint64_t)(count + 63u) / 64u * (64u * 25u + 120u) + 16u * 40u);
    }
}

/* With nothing to beat; with the best score itself, which must not win again; and with one a hair
 * below it. */
static void check(uint32_t count, const char *what) {
    float best = sweep(count, -1.0f).score;
    check_scan(count, -1.0f, what);
    check_scan(count, best, what);
    check_scan(count, best * 0.9999999f, what);
}

/* Every column and every set of cutpoints of up to 8 samples. */
static void test_every_small_column(void **state) {
    (void)state;
    enum { SAMPLES = 7 };
    for (uint32_t count = 1; count <= SAMPLES; count++)
        for (uint64_t bits = 0; bits < 1u << count; bits++)
            for (uint64_t cut = 0; cut < 1u << count; cut += 2u) {
                column[0] = bits;
                cuts[0] = cut;
                check(count, "small");
            }
}

enum { NOISE, RARE, STEP, SLOPE, BLOCKS, ALTERNATING, SORTED, HALVES, SHAPES };
static const char *const shape_names[SHAPES] = {"noise",  "rare",        "step",   "slope",
                                                "blocks", "alternating", "sorted", "halves"};

static uint32_t draw(int shape, uint32_t i, uint32_t count) {
    float t = (float)i / (float)count;
    float u = rlvc_rng_uniform(&rng);
    switch (shape) {
    case NOISE:
        return u < 0.5f;
    case RARE:
        return u < 0.01f;
    case STEP:
        return u < (t < 0.62f ? 0.4f : 0.55f);
    case SLOPE:
        return u < 0.2f + 0.5f * t;
    case BLOCKS:
        return i / 100u % 2u;
    case ALTERNATING:
        return i % 2u;
    case SORTED:
        return i >= count / 3u;
    default: /* twice the same score, at a quarter and at three quarters */
        return i >= count / 4u && i < count / 4u * 3u;
    }
}

/* About one cutpoint in `every` samples. */
static void make(int shape, uint32_t count, uint32_t every) {
    memset(column, 0, (count + 63u) / 64u * 8u);
    memset(cuts, 0, (count + 63u) / 64u * 8u);
    for (uint32_t i = 0; i < count; i++) {
        column[i / 64u] |= (uint64_t)draw(shape, i, count) << i % 64u;
        if (i > 0 && rlvc_rng_below(&rng, every) == 0)
            cuts[i / 64u] |= (uint64_t)1 << i % 64u;
    }
}

static void check_shapes(uint32_t count, uint32_t every) {
    for (int shape = 0; shape < SHAPES; shape++) {
        rlvc_rng_seed(&rng, count + every);
        make(shape, count, every);
        check(count, shape_names[shape]);
    }
}

static void test_all_distinct(void **state) {
    (void)state;
    const uint32_t counts[] = {1,    2,    63,   64,   65,   127,   128,   129,  1000,
                               1023, 1024, 1025, 4000, 9999, 16384, 16385, 60000};
    for (size_t i = 0; i < sizeof counts / sizeof counts[0]; i++)
        check_shapes(counts[i], 1u);
}

static void test_few_cutpoints(void **state) {
    (void)state;
    const uint32_t counts[] = {65, 1000, 5000, 40000};
    const uint32_t every[] = {2, 7, 300, 6000};
    for (size_t i = 0; i < sizeof counts / sizeof counts[0]; i++)
        for (size_t j = 0; j < sizeof every / sizeof every[0]; j++)
            check_shapes(counts[i], every[j]);
}

static void test_many_samples(void **state) {
    (void)state;
    const int shapes[] = {NOISE, STEP, SLOPE};
    for (size_t i = 0; i < sizeof shapes / sizeof shapes[0]; i++) {
        rlvc_rng_seed(&rng, 3u);
        make(shapes[i], COUNT_MAX - 1u, 1u);
        check_scan(COUNT_MAX - 1u, 0.0f, shape_names[shapes[i]]);
    }
}

/* What this is for: most words are never looked at bit by bit. */
static void test_passes_over(void **state) {
    (void)state;
    const uint32_t words = WORDS_MAX / 2u;
    uint64_t work;
    rlvc_rng_seed(&rng, 4u);
    make(NOISE, words * 64u, 1u);
    scan(words * 64u, 1.5e-5f, RLVC_BUDGET_UNBOUNDED, &work);
    assert_true(work < 4u * (uint64_t)words);
    make(STEP, words * 64u, 1u);
    scan(words * 64u, 0.1f, RLVC_BUDGET_UNBOUNDED, &work);
    assert_true(work < words + 16u * 70u);
}

/* A column is counted by sixteenths of whole blocks of 16 words; the last ones may be shorter, or
 * have nothing. */
static void test_sixteenths(void **state) {
    (void)state;
    const uint32_t counted[] = {255, 256, 257, 511, 512, 4096};
    for (size_t i = 0; i < sizeof counted / sizeof counted[0]; i++) {
        const uint32_t words = counted[i];
        rlvc_cutpoint_cursor cursor;
        rlvc_rng_seed(&rng, words);
        make(NOISE, words * 64u, 1u);
        rlvc_cutpoint_begin(&cursor, column, cuts, words * 64u, 0, -1.0f);
        while (!cursor.done)
            (void)rlvc_cutpoint_step(&cursor, RLVC_BUDGET_UNBOUNDED);
        uint32_t length = 0; /* the least that sixteen of them hold all */
        while (RLVC_CUTPOINT_CHUNKS * length < words)
            length += 16u;
        for (uint32_t k = 0; k < RLVC_CUTPOINT_CHUNKS; k++) {
            uint32_t ones = 0;
            for (uint32_t at = k * length * 64u; at < (k + 1u) * length * 64u; at++)
                ones += at < words * 64u && bit_at(column, at);
            assert_int_equal(cursor.chunk_present[k], ones);
        }
    }
}

static void test_constant_column(void **state) {
    (void)state;
    for (int present = 0; present < 2; present++)
        for (uint32_t count = 64; count <= 6400u; count *= 10u) {
            memset(column, present ? 0xff : 0, count / 8u);
            memset(cuts, 0xff, count / 8u);
            cuts[0] -= 1u;
            check(count, "constant");
        }
}

static void test_ones(void **state) {
    (void)state;
    uint8_t each[RLVC_POPCOUNT_WORDS];
    rlvc_rng_seed(&rng, 9u);
    for (uint32_t words = 0; words <= RLVC_POPCOUNT_WORDS; words++) {
        make(NOISE, RLVC_POPCOUNT_WORDS * 64u, 1u);
        uint32_t expected = 0;
        for (uint32_t i = 0; i < words * 64u; i++)
            expected += bit_at(column, i);
        assert_int_equal(rlvc_popcount(column, words), expected);
        rlvc_popcount_each(column, words, each);
        for (uint32_t i = 0; i < words * 64u; i++)
            each[i / 64u] -= (uint8_t)bit_at(column, i);
        for (uint32_t i = 0; i < words; i++)
            assert_int_equal(each[i], 0);
        memset(column, 0xff, sizeof column[0] * RLVC_POPCOUNT_WORDS);
        assert_int_equal(rlvc_popcount(column, words), words * 64u);
        rlvc_popcount_each(column, words, each);
        for (uint32_t i = 0; i < words; i++)
            assert_int_equal(each[i], 64);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_every_small_column), cmocka_unit_test(test_all_distinct),
        cmocka_unit_test(test_few_cutpoints),      cmocka_unit_test(test_many_samples),
        cmocka_unit_test(test_passes_over),        cmocka_unit_test(test_sixteenths),
        cmocka_unit_test(test_constant_column),    cmocka_unit_test(test_ones),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
