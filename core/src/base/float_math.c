/* SPDX-License-Identifier: MIT */
/* Elementary functions in binary32: see float_math.h. */
#include "rlvc/float_rules.h"

#include "float_math.h"

#include "assert.h"

#define SQRT_HALF_BITS 0x3f3504f3u

/* 2^e as a float, for e in [-126, 127]. */
static float power_of_two(int32_t e) {
    return rlvc_float_of((uint32_t)(e + 127) << 23);
}

/* 2 artanh(s) = ln((1 + s) / (1 - s)) for |s| < 0.1716. */
static float artanh_twice(float s) {
    float square = s * s;
    float twice = s + s;
    float series = 0.333333333f + square * (0.2f + square * (0.142857143f + square * 0.111111111f));
    return twice + twice * (square * series);
}

float rlvc_ln(float x) {
    int32_t e;
    float m = rlvc_take_apart(x, SQRT_HALF_BITS, &e);
    float ln_m = artanh_twice((m - 1.0f) / (m + 1.0f));
    return (float)e * RLVC_LN2_HIGH + ((float)e * RLVC_LN2_LOW + ln_m);
}

float rlvc_ln_1_minus(float q) {
    RLVC_ASSERT(q >= 0.0f && q < 1.0f);
    /* 1 - q = (1 - s) / (1 + s) with s = q / (2 - q), so that small q never meet a rounded 1 - q.
     */
    return q < 0.25f ? -artanh_twice(q / (2.0f - q)) : rlvc_ln(1.0f - q);
}

float rlvc_scale(float x, int32_t e) {
    RLVC_ASSERT(e <= 120);
    if (e < -200)
        return 0.0f;
    if (e < -100)
        return x * power_of_two(-100) * power_of_two(e + 100); /* only the last product rounds */
    return x * power_of_two(e);
}

float rlvc_exp_apart(float x, int32_t *e) {
    RLVC_ASSERT(x <= 0.0f && x >= -1400.0f);
    int32_t n = (int32_t)(x * RLVC_LOG2_E - 0.5f);
    /* n has 11 bits: its product with the high part is exact, and so is the first difference. */
    float r = (x - (float)n * RLVC_LN2_HIGH) - (float)n * RLVC_LN2_LOW;
    float series = 1.0f / 120.0f + r * (1.0f / 720.0f + r * (1.0f / 5040.0f));
    *e = n;
    return 1.0f + (r + r * r * (0.5f + r * (1.0f / 6.0f + r * (1.0f / 24.0f + r * series))));
}

float rlvc_exp(float x) {
    RLVC_ASSERT(x <= 0.0f);
    if (x < -104.0f)
        return 0.0f;
    int32_t e;
    float m = rlvc_exp_apart(x, &e);
    return rlvc_scale(m, e);
}

float rlvc_sqrt(float x) {
    RLVC_ASSERT(x > 0.0f);
    /* Halving the exponent is right to 4 %; each step of Newton's squares that error. */
    float root = rlvc_float_of((rlvc_bits_of(x) >> 1) + 0x1fbd1df5u);
    for (int i = 0; i < 3; i++)
        root = 0.5f * (root + x / root);
    return root;
}
