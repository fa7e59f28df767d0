/* SPDX-License-Identifier: MIT */
/* The score of a 2 x 2 table. score.h has the formula; here is how it is kept from cancelling.
 *
 * With P = N O and Q = r c (so that E = Q / N), both exact integers, a cell adds
 *
 *      P ln(P / Q) - (P - Q)  =  N (O ln(O / E) - (O - E))  >=  0
 *
 * to N^2 ln 2 times the gain. Near independence the two terms nearly agree. There, with
 * s = (P - Q) / (P + Q), so that ln(P / Q) = 2 (s + s^3 / 3 + ...) and 2 P = (P + Q)(1 + s):
 *
 *      P ln(P / Q) - (P - Q)  =  (P - Q) s + 2 P (s^3 / 3 + s^5 / 5 + ...)
 *
 * whose second term is at most |s| / 3 of the first. The cells are added as (a + d) + (b + c): an
 * exchange of rows or columns only exchanges operands of a sum, which changes no bit. */
#include "rlvc/float_rules.h"

#include "score.h"

#include "../base/assert.h"
#include "../base/float_math.h"

#define LN_2 0.693147181f

/* Beyond it the series would want more terms, and the plain form loses no more than 3 bits. */
#define SERIES_MAX 0.25f

float rlvc_excess(float p, float q, float difference, float sum) {
    float s = difference / sum;
    if (s > -SERIES_MAX && s < SERIES_MAX) {
        float z = s * s;
        float odd =
            1.0f / 3.0f +
            z * (1.0f / 5.0f +
                 z * (1.0f / 7.0f + z * (1.0f / 9.0f + z * (1.0f / 11.0f + z * (1.0f / 13.0f)))));
        return difference * s + 2.0f * p * (s * z * odd);
    }
    if (!(p > 0.0f))
        return q;
    return p * rlvc_ln(p / q) - difference;
}

/* The same for integers below 2^62. */
static float cell_gain(int64_t p, int64_t q) {
    return rlvc_excess((float)p, (float)q, (float)(p - q),
                       (float)(int64_t)((uint64_t)p + (uint64_t)q));
}

#if RLVC_COUNT_BITS == 64
/* The same for integers below 2^96. */
static float wide_cell_gain(rlvc_product p, rlvc_product q) {
    return rlvc_excess(rlvc_product_float(p), rlvc_product_float(q), rlvc_product_difference(p, q),
                       rlvc_product_float(rlvc_product_sum(p, q)));
}

/* The score where products do not fit into 63 bits. */
static float wide_score(rlvc_count a, rlvc_count b, rlvc_count c, rlvc_count d) {
    rlvc_count r1 = a + b, r2 = c + d, c1 = a + c, c2 = b + d, total = r1 + r2;
    float diagonal = wide_cell_gain(rlvc_product_of(total, a), rlvc_product_of(r1, c1)) +
                     wide_cell_gain(rlvc_product_of(total, d), rlvc_product_of(r2, c2));
    float other = wide_cell_gain(rlvc_product_of(total, b), rlvc_product_of(r1, c2)) +
                  wide_cell_gain(rlvc_product_of(total, c), rlvc_product_of(r2, c1));
    return (diagonal + other) / (rlvc_product_float(rlvc_product_of(total, total)) * LN_2);
}
#endif

float rlvc_score(rlvc_count present_below, rlvc_count absent_below, rlvc_count present_above,
                 rlvc_count absent_above) {
    int64_t a = (int64_t)present_below;
    int64_t b = (int64_t)absent_below;
    int64_t c = (int64_t)present_above;
    int64_t d = (int64_t)absent_above;
    int64_t r1 = a + b;
    int64_t r2 = c + d;
    int64_t c1 = a + c;
    int64_t c2 = b + d;
    int64_t total = r1 + r2;
    RLVC_ASSERT(total <= (int64_t)RLVC_COUNT_MAX);
    if (r1 == 0 || r2 == 0 || c1 == 0 || c2 == 0)
        return 0.0f;
#if RLVC_COUNT_BITS == 64
    if (total > INT32_MAX)
        return wide_score(present_below, absent_below, present_above, absent_above);
#endif
    float diagonal = cell_gain(total * a, r1 * c1) + cell_gain(total * d, r2 * c2);
    float other = cell_gain(total * b, r1 * c2) + cell_gain(total * c, r2 * c1);
    return (diagonal + other) / ((float)(total * total) * LN_2);
}
