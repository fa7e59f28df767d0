/* SPDX-License-Identifier: MIT */
/* Fisher's exact test of a 2 x 2 table.
 *
 * Were rows and columns independent, then, given the sums of rows and columns, N in all, a table
 * with the cells a, b, c, d would have the probability (it is hypergeometric)
 *
 *     P = (a + b)! (c + d)! (a + c)! (b + d)! / (N! a! b! c! d!).
 *
 * The factorials nearly cancel. With n! = n^n e^-n sqrt(2 pi n) e^c(n), the powers leave the
 * information gain, which score.c computes without cancelling (g bits a sample), and the roots one
 * logarithm:
 *
 *     ln P = 1/2 ln(product of the four sums / (2 pi N product of the four cells))
 *            + c of the four sums - c(N) - c of the four cells - N g ln 2.
 *
 * 0! = 1 comes out with 1 in place of n under the root.
 *
 * The tables on the same side are farther and farther from independence; where a d >= b c, the next
 * has a + 1, b - 1, c - 1, d + 1, and is b c / ((a + 1)(d + 1)) times as probable. The p-value is
 * twice their sum. As the least expected count is bounded, so is the work: a sum of some dozens of
 * terms. */
#include "rlvc/float_rules.h"

#include "table_test.h"

#include "../base/float_math.h"
#include "../base/solver_select.h"
#include "rlvc/chi2.h"
#include "score.h"
#include <stddef.h>

#define LN_2 0.693147181f
#define HALF_LN_2_PI 0.918938533f

/* Below this expected count a table alone is tested exactly; in a sum, below that (Cochran
 * 1954). */
#define EXPECTED_ALONE 5u
#define EXPECTED_IN_SUM 1u

/* Terms below it, of sums above 1, are not seen. */
#define NEGLIGIBLE 1e-6f

/* c(n): from 4 on by Stirling's series. */
static float correction(rlvc_count n) {
    static const float small[4] = {-0.918938533f, 0.081061467f, 0.041340696f, 0.027677926f};
    if (n < 4)
        return small[n];
    float inverse = 1.0f / (float)n;
    float square = inverse * inverse;
    return inverse * (1.0f / 12.0f - square * (1.0f / 360.0f - square * (1.0f / 1260.0f)));
}

/* x / y, each 1 if it is 0. */
static float ratio(rlvc_count x, rlvc_count y) {
    return (float)(x > 0 ? x : 1u) / (float)(y > 0 ? y : 1u);
}

/* N g ln 2. */
static float likelihood(const rlvc_table *t) {
    float gain = rlvc_score(t->a, t->b, t->c, t->d);
    return (float)(t->a + t->b + t->c + t->d) * (LN_2 * gain);
}

/* ln P. */
static float ln_probability(const rlvc_table *t) {
    const rlvc_count sums[4] = {t->a + t->b, t->c + t->d, t->a + t->c, t->b + t->d};
    const rlvc_count cells[4] = {t->a, t->d, t->c, t->b};
    rlvc_count n = sums[0] + sums[1];
    float quotient = ratio(1, n), corrections = -correction(n);
    for (int i = 0; i < 4; i++) {
        quotient *= ratio(sums[i], cells[i]);
        corrections += correction(sums[i]) - correction(cells[i]);
    }
    return (0.5f * rlvc_ln(quotient) - HALF_LN_2_PI) + corrections - likelihood(t);
}

/* The probability of all tables as far from independence on this side, as a multiple of P. */
static float tail(const rlvc_table *t) {
    float a = (float)t->a, b = (float)t->b, c = (float)t->c, d = (float)t->d;
    if (a * d < b * c) {
        float swapped = a;
        a = b;
        b = swapped;
        swapped = c;
        c = d;
        d = swapped;
    }
    float w = 1.0f, sum = 1.0f;
    while (w > NEGLIGIBLE) {
        a += 1.0f;
        d += 1.0f;
        w *= b * c / (a * d); /* 0 once b or c is */
        b -= 1.0f;
        c -= 1.0f;
        sum += w;
    }
    return sum;
}

static float ln_exact(const rlvc_table *table) {
    float ln_p = ln_probability(table) + rlvc_ln(2.0f * tail(table));
    return ln_p < 0.0f ? ln_p : 0.0f;
}

static rlvc_count smaller(rlvc_count x, rlvc_count y) {
    return x < y ? x : y;
}

static int expects_below(const rlvc_table *t, uint32_t count) {
    rlvc_count row = smaller(t->a + t->b, t->c + t->d), column = smaller(t->a + t->c, t->b + t->d);
    return rlvc_product_below(rlvc_product_of(row, column),
                              rlvc_product_of(t->a + t->b + t->c + t->d, count));
}

#if RLVC_COUNT_BITS == 64
/* The statistic where products do not fit into 63 bits: as chi2.c works it out. */
static float wide_pearson(const rlvc_table *t) {
    rlvc_product rows = rlvc_product_of(t->a + t->b, t->c + t->d);
    rlvc_product columns = rlvc_product_of(t->a + t->c, t->b + t->d);
    float determinant =
        rlvc_product_difference(rlvc_product_of(t->a, t->d), rlvc_product_of(t->b, t->c));
    float u = determinant / rlvc_product_float(rows);
    float v = determinant / rlvc_product_float(columns);
    return (float)(t->a + t->b + t->c + t->d) * (u * v);
}
#endif

static float pearson(const rlvc_table *table) {
    float statistic = 0.0f;
#if RLVC_COUNT_BITS == 64
    if (table->a + table->b + table->c + table->d > INT32_MAX)
        return wide_pearson(table);
#endif
    (void)rlvc_chi2_table((uint32_t)table->a, (uint32_t)table->b, (uint32_t)table->c,
                          (uint32_t)table->d, &statistic);
    return statistic;
}

float rlvc_table_log_p(const rlvc_table *table) {
    float log_p = 0.0f;
    if (expects_below(table, EXPECTED_ALONE))
        return ln_exact(table);
    (void)rlvc_chi2_survival(pearson(table), 1, NULL, &log_p);
    return log_p;
}

float rlvc_table_statistic(const rlvc_table *table) {
    return expects_below(table, EXPECTED_IN_SUM) ? 2.0f * likelihood(table) : pearson(table);
}

/* Up to so many samples a lead of 1 / (8 N) is beyond all roundings (RLVC_SCORE_ERROR), and
 * products of five sums fit into 63 bits. */
#define SURE_MAX 4096u

/* Whether G^2 is surely no less than Pearson's x times (N - 1) / N, without a logarithm.
 *
 * With u = (O - E) / E a cell adds E u^2 to x, and E u^2 f(u) to G^2, where
 * f(u) = 2 ((1 + u) ln (1 + u) - u) / u^2 is convex (it is 2 times the integral of (1 - t) / (1 + u
 * t) over t from 0 to 1) with the tangent 1 - u / 3 at 0. Hence G^2 >= x (1 - m / 3), m being the
 * mean of u by these weights. As |O - E| is the same in all cells, it is m = (a d - b c) (r2 - r1)
 * (c2 - c1) / (r1 r2 c1 c2). */
static int is_pearson_least(const rlvc_table *t) {
    const rlvc_count r1 = t->a + t->b, r2 = t->c + t->d, c1 = t->a + t->c, c2 = t->b + t->d;
    if (r1 + r2 > SURE_MAX)
        return 0;
    const int64_t n = (int64_t)(r1 + r2),
                  determinant = (int64_t)(t->a * t->d) - (int64_t)(t->b * t->c);
    const int64_t skew = ((int64_t)r2 - (int64_t)r1) * ((int64_t)c2 - (int64_t)c1);
    return 8 * n * determinant * skew <= 21 * (int64_t)(r1 * r2) * (int64_t)(c1 * c2);
}

float rlvc_table_least(const rlvc_table *table) {
    const float n = (float)(table->a + table->b + table->c + table->d);
    const float x = pearson(table) * ((n - 1.0f) / n);
    if (RLVC_AT_ONCE && is_pearson_least(table))
        return x;
    const float g = 2.0f * likelihood(table);
    return x < g ? x : g;
}

rlvc_status rlvc_fisher_table(uint32_t a, uint32_t b, uint32_t c, uint32_t d, float *p,
                              float *log_p) {
    const rlvc_table table = {a, b, c, d};
    if ((uint64_t)a + b + c + d > INT32_MAX)
        return RLVC_E_RANGE;
    if (a + b + c + d > 0 && !expects_below(&table, RLVC_FISHER_EXPECTED_MAX + 1u))
        return RLVC_E_RANGE;
    float ln_p = ln_exact(&table);
    if (p)
        *p = rlvc_exp(ln_p);
    if (log_p)
        *log_p = ln_p;
    return RLVC_OK;
}
