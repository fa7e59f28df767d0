/* SPDX-License-Identifier: MIT */
/* The elementary functions that the method needs, in binary32 out of + - * / and bit moves only.
 *
 * The functions of C libraries differ in their last bits from one library to the next, and so would
 * the trees; these do not. A float is taken apart as x = m * 2^e, and
 *
 *     ln(m * 2^e) = e ln 2 + 2 artanh(s),  s = (m - 1) / (m + 1),  m in [sqrt(1/2), sqrt(2))
 *     artanh(s)   = s + s^3/3 + s^5/5 + s^7/7 + s^9/9 + ...,      |s| < 0.1716
 *     exp(x)      = 2^n exp(x - n ln 2),  n the integer nearest to x / ln 2.
 *
 * m - 1 is exact and e is 0 around 1, hence logarithms are accurate relative to themselves there
 * too. ln is free of branches, for the search evaluates the score very often. Largest relative
 * errors found in sweeps over the floats: ln 1.8e-7, ln_1_minus 2.4e-7, exp and sqrt 0.9e-7. */
#ifndef RLVC_SRC_FLOAT_MATH_H
#define RLVC_SRC_FLOAT_MATH_H

#include <stdint.h>

/* ln 2 in two parts: the first has 12 bits, so that its product with an exponent is exact. */
#define RLVC_LN2_HIGH 0.693115234375f
#define RLVC_LN2_LOW 3.19461833e-05f
#define RLVC_LOG2_E 1.44269504f

typedef union rlvc_float_bits {
    float value;
    uint32_t bits;
} rlvc_float_bits;

static inline uint32_t rlvc_bits_of(float x) {
    rlvc_float_bits pun;
    pun.value = x;
    return pun.bits;
}

static inline float rlvc_float_of(uint32_t bits) {
    rlvc_float_bits pun;
    pun.bits = bits;
    return pun.value;
}

/* m of x = m * 2^e with m in [least, 2 * least), where least has the bits `least_bits` and lies in
 * (1/2, 1]. x is positive and normal. */
static inline float rlvc_take_apart(float x, uint32_t least_bits, int32_t *e) {
    const uint32_t one_bits = 0x3f800000u;
    uint32_t shifted = rlvc_bits_of(x) + (one_bits - least_bits);
    *e = (int32_t)(shifted >> 23) - 127;
    return rlvc_float_of((shifted & 0x007fffffu) + least_bits);
}

/* Natural logarithm of a positive normal x. */
float rlvc_ln(float x);

/* ln(1 - q) for q in [0, 1), accurate relative to itself for small q too. */
float rlvc_ln_1_minus(float q);

/* x * 2^e, rounded once, for x in [1/64, 64] and e <= 120; 0 for e < -200. */
float rlvc_scale(float x, int32_t e);

/* exp(x) for x <= 0; 0 below ln of the least float. */
float rlvc_exp(float x);

/* exp(x) = result * 2^e, result in [0.7, 1.42], for x in [-1400, 0]: where exp(x) itself would
 * underflow before what it is multiplied with makes up for it. */
float rlvc_exp_apart(float x, int32_t *e);

/* Square root of a positive normal x. */
float rlvc_sqrt(float x);

#endif
