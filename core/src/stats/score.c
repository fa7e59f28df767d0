/* SPDX-License-Identifier: MIT */
/* The score of a 2 x 2 table. score.h has the formula; here is how it is kept from cancelling.
 *
 * With P = N O and Q = r c (so that E = Q / N), both exact in 64 bits, a cell adds
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
    return rlvc_excess((float)p, (float)q, (float)(p - q), (float)(p + q));
}

float rlvc_score(uint32_t present_below, uint32_t absent_below, uint32_t present_above,
                 uint32_t absent_above) {
    int64_t a = present_below;
    int64_t b = absent_below;
    int64_t c = present_above;
    int64_t d = absent_above;
    int64_t r1 = a + b;
    int64_t r2 = c + d;
    int64_t c1 = a + c;
    int64_t c2 = b + d;
    int64_t total = r1 + r2;
    RLVC_ASSERT(total <= INT32_MAX);
    if (r1 == 0 || r2 == 0 || c1 == 0 || c2 == 0)
        return 0.0f;
    float diagonal = cell_gain(total * a, r1 * c1) + cell_gain(total * d, r2 * c2);
    float other = cell_gain(total * b, r1 * c2) + cell_gain(total * c, r2 * c1);
    return (diagonal + other) / ((float)(total * total) * LN_2);
}
