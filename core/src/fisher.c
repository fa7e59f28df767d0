/* SPDX-License-Identifier: MIT */
/* Fisher's exact test of a 2 x 2 table.
 *
 * Given the sums of rows and columns, one cell says all. Let x be the one whose row r and column c are the
 * smaller ones; of N samples. Were rows and columns independent, x would be hypergeometric,
 *
 *     P(x) = r! (N - r)! c! (N - c)! / (N! x! (r - x)! (c - x)! (N - r - c + x)!),
 *
 * with a mean of E = r c / N. The p-value is the sum of P(y) over all y that are no more probable than x.
 *
 * The factorials nearly cancel. With n! = n^n e^-n H(n), where H(n) is near sqrt(2 pi n), the powers leave
 * the information gain, which score.c computes without cancelling (g bits a sample):
 *
 *     ln P = ln H of the four sums - ln H(N) - ln H of the four cells - N g ln 2.
 *
 * The other y follow from x by ratios of neighbours, and what is far from the mean adds nothing. As E is
 * bounded, so is the work: at most some 250 ratios, some 40 for E < 5. */
#include "fisher.h"

#include "real.h"
#include "rlvc/agent.h"
#include "rlvc/chi2.h"
#include "score.h"
#include <stddef.h>

#define LN_2 0.693147181f
#define HALF_LN_2_PI 0.918938533f
#define E_1 2.71828183f

/* Below this expected count a table alone is tested exactly; in a sum, below that (Cochran 1954). */
#define EXPECTED_ALONE 5u
#define EXPECTED_IN_SUM 1u

/* How much the tables that are just as probable as the observed one count: in a p-value, in a mid-p-value. */
#define WHOLE 1.0f
#define HALF 0.5f

/* What is no more probable than x, when roundings are allowed for. */
#define AS_RARE 1.0001f

/* Terms below it, of sums above 1, are not seen. */
#define NEGLIGIBLE 1e-8f

/* x of the table, its row, column and the total. */
typedef struct cell {
    int64_t x, r, c, n;
} cell;

static int64_t product_of_sums(const rlvc_table *t, int64_t *n) {
    int64_t r1 = (int64_t)t->a + t->b, r2 = (int64_t)t->c + t->d;
    int64_t c1 = (int64_t)t->a + t->c, c2 = (int64_t)t->b + t->d;
    *n = r1 + r2;
    return (r1 < r2 ? r1 : r2) * (c1 < c2 ? c1 : c2);
}

/* Turns the table so that x is its first cell. */
static cell turned(const rlvc_table *t) {
    int64_t a = t->a, b = t->b, c = t->c, d = t->d;
    int upper = a + b <= c + d;
    int left = a + c <= b + d;
    cell made;
    made.n = a + b + c + d;
    made.r = upper ? a + b : c + d;
    made.c = left ? a + c : b + d;
    made.x = upper ? (left ? a : b) : (left ? c : d);
    return made;
}

/* ln H(n) = ln n! - n ln n + n: by its product below 4, from there on by Stirling's series. */
static float ln_h(int64_t n) {
    float m = (float)n;
    if (n < 4) {
        float product = 1.0f;
        for (int64_t i = 1; i <= n; i++)
            product *= E_1 * ((float)i / m);
        return rlvc_ln(product);
    }
    float inverse = 1.0f / m;
    float square = inverse * inverse;
    float series = inverse * (1.0f / 12.0f - square * (1.0f / 360.0f - square * (1.0f / 1260.0f)));
    return HALF_LN_2_PI + 0.5f * rlvc_ln(m) + series;
}

/* ln P(x). */
static float ln_probability(const cell *at) {
    int64_t b = at->r - at->x, c = at->c - at->x, d = at->n - at->r - c;
    float gain =
        rlvc_score(RLVC_SCORE_GAIN, (uint32_t)at->x, (uint32_t)b, (uint32_t)c, (uint32_t)d);
    float sums = ln_h(at->r) + ln_h(at->n - at->r) + ln_h(at->c) + ln_h(at->n - at->c);
    float cells = ln_h(at->x) + ln_h(b) + ln_h(c) + ln_h(d);
    return (sums - cells - ln_h(at->n)) - (float)at->n * LN_2 * gain;
}

/* P(x + 1) / P(x). */
static float ratio_up(const cell *at, int64_t x) {
    float ways = (float)((at->r - x) * (at->c - x));
    return ways / (float)((x + 1) * (at->n - at->r - at->c + x + 1));
}

/* What w = P(y) / P(x) adds to the p-value; what is as rare as x itself counts `same`. */
static float counted(float w, float same) {
    if (w > AS_RARE)
        return 0.0f;
    return w * AS_RARE < 1.0f ? w : same * w;
}

/* The sum of it over the y > x. */
static float above(const cell *at, float same) {
    int64_t last = at->r < at->c ? at->r : at->c;
    float w = 1.0f, sum = 0.0f;
    for (int64_t y = at->x; y < last; y++) {
        float ratio = ratio_up(at, y);
        w *= ratio;
        if (w < NEGLIGIBLE)
            break;
        sum += counted(w, same);
    }
    return sum;
}

/* The same for y < x. There are none if 0 is more probable than x, as it surely is if x is far above the
 * mean; so no w leaves the range of a float. */
static float below(const cell *at, float ln_p, float same) {
    cell none = *at;
    float w = 1.0f, sum = 0.0f;
    none.x = 0;
    if (at->x == 0 || ln_probability(&none) > ln_p + 0.01f)
        return 0.0f;
    for (int64_t y = at->x - 1; y >= 0; y--) {
        w /= ratio_up(at, y);
        sum += counted(w, same);
    }
    return sum;
}

/* ln of the p-value. */
static float ln_exact(const rlvc_table *table, float same) {
    cell at = turned(table);
    float ln_p = ln_probability(&at);
    ln_p += rlvc_ln(same + above(&at, same) + below(&at, ln_p, same));
    return ln_p < 0.0f ? ln_p : 0.0f;
}

static int expects_below(const rlvc_table *table, uint32_t count) {
    int64_t n;
    int64_t product = product_of_sums(table, &n);
    return product < (int64_t)count * n;
}

int rlvc_table_small(const rlvc_table *table) {
    return expects_below(table, EXPECTED_IN_SUM);
}

static float pearson(const rlvc_table *table) {
    float statistic = 0.0f;
    (void)rlvc_chi2_table(table->a, table->b, table->c, table->d, &statistic);
    return statistic;
}

float rlvc_table_log_p(const rlvc_table *table) {
    float log_p = 0.0f;
    if (expects_below(table, EXPECTED_ALONE))
        return ln_exact(table, WHOLE);
    (void)rlvc_chi2_survival(pearson(table), 1, NULL, &log_p);
    return log_p;
}

/* The statistic of one degree of freedom whose p-value is given: the square of a normal quantile, which is
 * within 4.5e-4 by Abramowitz and Stegun's 26.2.23, with t^2 = -2 ln(p / 2). */
static float statistic_of(float log_p) {
    float t = rlvc_sqrt(2.0f * (LN_2 - log_p));
    float above = 2.515517f + t * (0.802853f + t * 0.010328f);
    float under = 1.0f + t * (1.432788f + t * (0.189269f + t * 0.001308f));
    float z = t - above / under;
    return z * z;
}

float rlvc_table_statistic(const rlvc_table *table) {
    return rlvc_table_small(table) ? statistic_of(ln_exact(table, HALF)) : pearson(table);
}

rlvc_status rlvc_fisher_table(uint32_t a, uint32_t b, uint32_t c, uint32_t d, float *p,
                              float *log_p) {
    const rlvc_table table = {a, b, c, d};
    int64_t n;
    if ((uint64_t)a + b + c + d > INT32_MAX)
        return RLVC_E_RANGE;
    int64_t product = product_of_sums(&table, &n);
    if (product > (int64_t)RLVC_FISHER_EXPECTED_MAX * n)
        return RLVC_E_RANGE;
    float ln_p = product > 0 ? ln_exact(&table, WHOLE) : 0.0f;
    if (p)
        *p = rlvc_exp(ln_p);
    if (log_p)
        *log_p = ln_p;
    return RLVC_OK;
}
