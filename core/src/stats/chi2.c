/* SPDX-License-Identifier: MIT */
/* The chi-square distribution (section 4.2.4).
 *
 * With x the statistic and k the degrees of freedom, write
 *
 *     t(k) = (x/2)^(k/2) / Gamma(k/2 + 1),    t(0) = 1,  t(1) = sqrt(2x/pi),  t(k) = t(k-2) x/k.
 *
 * Below the mean, x < k, the distribution function q = 1 - p comes from the power series
 *
 *     q = exp(-x/2) t(k) (1 + x/(k+2) + x^2/((k+2)(k+4)) + ...),
 *
 * and so neither p nor ln p = ln(1 - q) suffers when q is small. From the mean on, p is a finite
 * sum,
 *
 *     p = exp(-x/2) (base + t(k-2) + t(k-4) + ... + t(1 or 2)),
 *     base = 1 for even k (it is t(0)),
 *     base = sqrt(2/pi) / (w + 1/(w + 2/(w + 3/(w + ...)))),  w = sqrt(x),  for odd k,
 *
 * that is added from its largest term, t(k-2) (1 + (k-2)/x (1 + (k-4)/x (...))). All terms of both
 * are positive: nothing cancels. exp(-x/2) and t(k) leave the range of a float long before their
 * product does, so each is kept as m * 2^e; and ln p is put together from their logarithms where p
 * is too small. The work is bounded by the degrees of freedom alone. */
#include "rlvc/float_rules.h"

#include "rlvc/chi2.h"

#include <float.h>
#include <stddef.h>

#include "../base/assert.h"
#include "../base/float_math.h"

#define ONE_BITS 0x3f800000u
#define ROOT_2_OVER_PI 0.797884561f

#define STATISTIC_MIN 1e-37f /* less counts as 0: x/2 would be no normal float */
#define P_MIN 1e-30f         /* less is not told apart by its logarithm's rounding */
#define DAMPED_MAX 1400.0f   /* from there on p is below the least float, for all degrees */

/* m * 2^e, m in [1, 2) or (a sum) in [1/64, 64]. */
typedef struct scaled {
    float m;
    int32_t e;
} scaled;

/* t(k). */
static scaled term(float x, uint32_t k) {
    RLVC_ASSERT(x >= STATISTIC_MIN);
    uint32_t odd = k & 1u;
    float first = odd != 0u ? ROOT_2_OVER_PI * rlvc_sqrt(x) : 1.0f;
    int32_t x_e;
    float x_m = rlvc_take_apart(x, ONE_BITS, &x_e);
    scaled t;
    t.m = rlvc_take_apart(first, ONE_BITS, &t.e);
    //@ loop unroll 128;
    for (uint32_t d = 2u + odd; d <= k; d += 2u) {
        int32_t e;
        t.m = rlvc_take_apart(t.m * (x_m / (float)d), ONE_BITS, &e);
        t.e += x_e + e;
    }
    return t;
}

/* The power series 1 + x/(k+2) + ..., x < k. What is cut off is below 1e-8 of it: the terms fall
 * off like exp(-n^2 / k), and at once for small k. */
static float lower_series(float x, uint32_t k) {
    float sum = 1.0f;
    for (uint32_t n = 24u + k / 3u; n > 0u; n--)
        sum = 1.0f + sum * (x / (float)(k + 2u * n));
    return sum;
}

/* The finite sum over its largest term, 1 + (k-2)/x (1 + (k-4)/x (... (1 + (3 or 2)/x))), x >= k.
 */
static float upper_series(float x, uint32_t k) {
    float sum = 1.0f;
    for (uint32_t d = 2u + (k & 1u); d + 2u <= k; d += 2u)
        sum = 1.0f + sum * ((float)d / x);
    return sum;
}

/* base for odd k, x >= 1. A fraction's tail from n on is about sqrt(n) + w/2. */
static float odd_base(float x) {
    float w = rlvc_sqrt(x);
    float fraction = 6.0f + 0.5f * w;
    for (int n = 36; n > 0; n--)
        fraction = w + (float)n / fraction;
    return ROOT_2_OVER_PI / fraction;
}

/* p exp(x/2), x >= k. */
static scaled upper_sum(float x, uint32_t k) {
    float base = (k & 1u) != 0u ? odd_base(x) : 0.0f; /* t(0) is in the series */
    scaled sum;
    sum.m = base;
    sum.e = 0;
    if (k > 1u) {
        sum = term(x, k - 2u); /* >= 1 */
        sum.m = sum.m * upper_series(x, k) + rlvc_scale(base, -sum.e);
    }
    return sum;
}

/* sum * exp(-x/2), for x at most 1400. */
static float damped(scaled sum, float x) {
    int32_t e;
    float m = rlvc_exp_apart(-0.5f * x, &e);
    return rlvc_scale(sum.m * m, sum.e + e);
}

static void survival(float x, uint32_t k, float *p, float *log_p) {
    if (x < STATISTIC_MIN) {
        *p = 1.0f;
        *log_p = 0.0f;
    } else if (x < (float)k) {
        scaled t = term(x, k);
        t.m *= lower_series(x, k);
        float q = damped(t, x);
        *p = 1.0f - q;
        *log_p = rlvc_ln_1_minus(q);
    } else {
        scaled sum = upper_sum(x, k);
        float e = (float)sum.e;
        *log_p = e * RLVC_LN2_HIGH + (e * RLVC_LN2_LOW + rlvc_ln(sum.m)) - 0.5f * x;
        *p = x <= DAMPED_MAX ? damped(sum, x) : 0.0f;
        if (*p >= P_MIN)
            *log_p = rlvc_ln(*p);
    }
}

rlvc_status rlvc_chi2_survival(float statistic, uint32_t degrees, float *p, float *log_p) {
    if (!(statistic >= 0.0f && statistic <= FLT_MAX))
        return RLVC_E_RANGE;
    if (degrees < 1u || degrees > RLVC_CHI2_DEGREES_MAX)
        return RLVC_E_RANGE;

    float its_p;
    float its_log_p;
    survival(statistic, degrees, &its_p, &its_log_p);
    if (p != NULL)
        *p = its_p;
    if (log_p != NULL)
        *log_p = its_log_p;
    return RLVC_OK;
}

rlvc_status rlvc_chi2_critical(float p, uint32_t degrees, float *statistic) {
    if (statistic == NULL)
        return RLVC_E_NULL;
    if (!(p >= P_MIN && p < 1.0f))
        return RLVC_E_RANGE;
    if (degrees < 1u || degrees > RLVC_CHI2_DEGREES_MAX)
        return RLVC_E_RANGE;

    /* Positive floats are ordered as their bits: halve between 0, whose survival is above p, and
     * 1024, whose is below, until they are neighbours. The logarithm tells apart what is near 1 as
     * well. */
    float wanted = rlvc_ln(p);
    uint32_t above = rlvc_bits_of(0.0f);
    uint32_t below = rlvc_bits_of(1024.0f);
    //@ loop widen_hints "all", 1149239297;
    while (below - above > 1u) {
        uint32_t middle = above / 2u + below / 2u + (above & below & 1u);
        float its_p;
        float its_log_p;
        survival(rlvc_float_of(middle), degrees, &its_p, &its_log_p);
        if (its_log_p > wanted)
            above = middle;
        else
            below = middle;
    }
    *statistic = rlvc_float_of(below);
    return RLVC_OK;
}

rlvc_status rlvc_chi2_table(uint32_t a, uint32_t b, uint32_t c, uint32_t d, float *statistic) {
    if (statistic == NULL)
        return RLVC_E_NULL;
    uint64_t n = (uint64_t)a + b + c + d;
    if (n > INT32_MAX)
        return RLVC_E_RANGE;

    uint64_t rows = ((uint64_t)a + b) * ((uint64_t)c + d);
    uint64_t columns = ((uint64_t)a + c) * ((uint64_t)b + d);
    if (rows == 0u || columns == 0u) {
        *statistic = 0.0f;
        return RLVC_OK;
    }
    /* n (ad - bc)^2 / (rows columns). The products are below 2^60, hence exact; the quotients are
     * within +-1, hence nothing overflows. */
    int64_t determinant = (int64_t)((uint64_t)a * d - (uint64_t)b * c);
    float u = (float)determinant / (float)rows;
    float v = (float)determinant / (float)columns;
    *statistic = (float)n * (u * v);
    return RLVC_OK;
}
