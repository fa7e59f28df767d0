/* SPDX-License-Identifier: MIT */
/* The rank-sum statistic against its formula in double, from the samples' mid-ranks. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "split/cutpoint.h"
#include "rlvc/agent.h"
#include "base/rng.h"

#define COUNT_MAX RLVC_RANK_SUM_MAX
#define WORDS_MAX (COUNT_MAX / 64u)
#define ALLOWED 4e-6

static uint64_t column[WORDS_MAX], cuts[WORDS_MAX];
static rlvc_rng rng;

static uint32_t bit_at(const uint64_t *words, uint32_t i) {
    return (uint32_t)(words[i / 64u] >> i % 64u & 1u);
}

static void set_bit(uint64_t *words, uint32_t i, uint32_t bit) {
    words[i / 64u] = (words[i / 64u] & ~((uint64_t)1 << i % 64u)) | (uint64_t)bit << i % 64u;
}

/* h(u). */
static double excess(double u) {
    if (u < 1e-3)
        return u * u * (0.5 - u * (1.0 / 6.0 - u / 12.0));
    return (1.0 + u) * log1p(u) - u;
}

/* T, or z^2 if `plain`, by the definition: each sample has the mean rank of its cluster. */
static double reference(uint32_t count, int plain) {
    double n = count, present = 0.0, sum = 0.0, squares = 0.0, cubes = 0.0;
    for (uint32_t s = 0, e; s < count; s = e) {
        e = s + 1u;
        while (e < count && !bit_at(cuts, e))
            e++;
        double t = e - s, rank = ((double)s + 1.0 + (double)e) / 2.0 - (n + 1.0) / 2.0;
        for (uint32_t i = s; i < e; i++) {
            present += bit_at(column, i);
            sum += bit_at(column, i) ? rank : 0.0;
        }
        squares += t * rank * rank;
        cubes += t * t * t;
    }
    double absent = n - present;
    double variance = present * absent / (n * (n - 1.0)) * squares;
    if (plain)
        return sum * sum / variance;
    double jump = 0.5 * sqrt(((present - absent) * (present - absent) + 1.0) * cubes / (n * n * n));
    return 2.0 * variance / (jump * jump) * excess(jump * fabs(sum) / variance);
}

/* Budgets of `budget`, or random ones if that is 0. */
static rlvc_cutpoint scan(uint32_t count, uint32_t budget, uint64_t *work) {
    rlvc_cutpoint_cursor state;
    *work = 0;
    rlvc_cutpoint_begin(&state, column, cuts, count, 1, 1e30f);
    while (!state.done) {
        uint32_t room = budget > 0 ? budget : RLVC_BUDGET_MIN + rlvc_rng_below(&rng, 300u);
        uint32_t used = rlvc_cutpoint_step(&state, room);
        assert_in_range(used, 1u, room);
        *work += used;
    }
    return state.best;
}

static float statistic(uint32_t count) {
    uint64_t work;
    return scan(count, RLVC_BUDGET_UNBOUNDED, &work).score;
}

static void check(uint32_t count, const char *what) {
    const uint32_t budgets[] = {RLVC_BUDGET_UNBOUNDED, RLVC_BUDGET_MIN, 0};
    uint64_t first = 0, work;
    uint32_t present = 0;
    for (uint32_t i = 0; i < count; i++)
        present += bit_at(column, i);
    double expected = present == 0 || present == count ? -1.0 : reference(count, 0);
    for (int i = 0; i < 3; i++) {
        rlvc_cutpoint got = scan(count, budgets[i], &work);
        if (!(fabs((double)got.score - expected) <= ALLOWED * (1.0 + expected)))
            fail_msg("%s, %u of %u samples, budget %u: %.9g, not %.9g", what, present, count,
                     budgets[i], (double)got.score, expected);
        assert_int_equal(got.present, present);
        first = i == 0 ? work : first;
        assert_true(work == first);
        assert_true(work <=
                    (count + 63u) / 64u * (RLVC_CUTPOINT_WORD_UNITS + RLVC_CUTPOINT_SCORE_UNITS));
    }
}

/* All columns and clusters of up to 8 samples. */
static void test_every_small_column(void **state) {
    (void)state;
    enum { SAMPLES = 8 };
    for (uint32_t count = 2; count <= SAMPLES; count++)
        for (uint64_t bits = 0; bits < 1u << count; bits++)
            for (uint64_t cut = 2; cut < 1u << count; cut += 2u) {
                column[0] = bits;
                cuts[0] = cut;
                check(count, "small");
            }
}

/* A share of the samples exhibits the feature, more and more of them to the right; a cluster begins
 * at one of `every`, but not in the greatest part if `tied`. */
static void make(uint32_t count, float share, float slope, uint32_t every, int tied) {
    memset(column, 0, sizeof column);
    memset(cuts, 0, sizeof cuts);
    for (uint32_t i = 0; i < count; i++) {
        float place = (float)i / (float)count - 0.5f;
        set_bit(column, i, rlvc_rng_uniform(&rng) < share * (1.0f + slope * place));
        if (i > 0 && !(tied && i < count - count / 20u) && rlvc_rng_below(&rng, every) == 0)
            set_bit(cuts, i, 1);
    }
    set_bit(cuts, count - 1u, 1);
}

static void test_random_columns(void **state) {
    (void)state;
    const uint32_t counts[] = {2, 3, 63, 64, 65, 127, 128, 129, 1000, 4096, 50000};
    const uint32_t every[] = {1, 2, 40, 1000};
    const float shares[] = {0.5f, 0.1f, 0.02f, 0.97f};
    rlvc_rng_seed(&rng, 1u);
    for (size_t i = 0; i < sizeof counts / sizeof counts[0]; i++)
        for (uint32_t j = 0; j < 4u * 4u * 2u * 2u; j++) {
            make(counts[i], shares[j % 4u], j / 4u % 2u ? 1.0f : 0.0f, every[j / 8u % 4u],
                 j >= 32u);
            check(counts[i], j >= 32u ? "tied" : "random");
        }
}

/* The sums of as many samples as there may be. */
static void test_many_samples(void **state) {
    (void)state;
    rlvc_rng_seed(&rng, 2u);
    for (uint32_t j = 0; j < 3u; j++) {
        make(COUNT_MAX, j == 0 ? 0.5f : 0.001f, 0.01f, j == 1u ? COUNT_MAX : 1u, j == 2u);
        check(COUNT_MAX, "many");
    }
    for (uint32_t i = 0; i < COUNT_MAX; i++)
        set_bit(column, i, i >= COUNT_MAX / 2u);
    check(COUNT_MAX, "parted");
}

/* What rank_sum.h tells of it: at most z^2, and that itself without ties, or where A is B. */
static void test_between_normal_and_poisson(void **state) {
    (void)state;
    rlvc_rng_seed(&rng, 3u);
    for (uint32_t i = 0; i < 200u; i++) {
        make(500, i % 2u ? 0.2f : 0.05f, 1.0f, 1u + i % 50u, (int)(i % 3u));
        double normal = reference(500, 1);
        float got = statistic(500);
        assert_true((double)got <= normal * 1.000001);
        if (i % 50u == 0 && i % 3u == 0)
            assert_true((double)got >= normal * 0.99);
    }
    /* Half of 400 samples, and 30 of 40 in the upper one of two clusters. */
    memset(column, 0, sizeof column);
    memset(cuts, 0, sizeof cuts);
    set_bit(cuts, 360, 1);
    for (uint32_t i = 0; i < 200u; i++)
        set_bit(column, i < 170u ? i : 190u + i, 1);
    double z = 10.0 / sqrt(200.0 * 200.0 / 400.0 / 399.0 * 40.0 * 360.0 / 400.0);
    assert_true(fabs((double)statistic(400) - z * z) < 0.01);
    /* 10 of 1,000 and 3 of 10: were the count Poisson's of mean 0.1, 2 (3 ln 30 - 2.9) = 14.6. */
    memset(column, 0, sizeof column);
    memset(cuts, 0, sizeof cuts);
    set_bit(cuts, 990, 1);
    for (uint32_t i = 0; i < 7u; i++)
        set_bit(column, i, 1);
    for (uint32_t i = 990; i < 993u; i++)
        set_bit(column, i, 1);
    assert_true(fabs((double)statistic(1000) - 14.6) < 0.5);
    assert_true(reference(1000, 1) > 80.0);
}

/* Of features that say the same the first must win: the same bits for the complement, and for
 * samples of a cluster exchanged. */
static void test_same_bits(void **state) {
    (void)state;
    rlvc_rng_seed(&rng, 4u);
    for (uint32_t i = 0; i < 100u; i++) {
        uint32_t count = 70u + i * 5u;
        make(count, 0.3f, 1.0f, 3u, 0);
        float first = statistic(count);
        for (uint32_t s = 0; s + 1u < count; s++) {
            if (!bit_at(cuts, s + 1u)) {
                uint32_t bit = bit_at(column, s);
                set_bit(column, s, bit_at(column, s + 1u));
                set_bit(column, s + 1u, bit);
            }
        }
        assert_float_equal(statistic(count), first, 0.0f);
        for (uint32_t s = 0; s < count; s++)
            set_bit(column, s, !bit_at(column, s));
        assert_float_equal(statistic(count), first, 0.0f);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_every_small_column),
        cmocka_unit_test(test_random_columns),
        cmocka_unit_test(test_many_samples),
        cmocka_unit_test(test_between_normal_and_poisson),
        cmocka_unit_test(test_same_bits),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
