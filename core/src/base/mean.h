/* SPDX-License-Identifier: MIT */
/* Means over very many samples, in binary32.
 *
 * A plain float sum of a million terms is wrong in its fourth digit. This one carries along what
 * rounding took from it: the true sum is sum + rest, |rest| being at most half a unit in the last
 * place of sum. Adding x is Knuth's two-sum,
 *
 *     s = sum + x,  v = s - sum,  lost = (sum - (s - v)) + (x - v)   (exactly sum + x - s),
 *
 * and a renormalisation of (s, rest + lost). Each addition so errs by some 2^-47 of the sum, and a
 * mean by at most 2e-7 of the mean of the |terms| besides. */
#ifndef RLVC_SRC_MEAN_H
#define RLVC_SRC_MEAN_H

#include "count.h"

typedef struct rlvc_sum {
    float sum;
    float rest;
    rlvc_count weight; /* of all terms so far */
} rlvc_sum;

static inline void rlvc_sum_clear(rlvc_sum *total) {
    total->sum = 0.0f;
    total->rest = 0.0f;
    total->weight = 0u;
}

/* Adds `weight` samples of value `term`; the weights of all samples add up to RLVC_COUNT_MAX at
 * most. */
inline void rlvc_sum_add(rlvc_sum *total, float term, uint32_t weight) {
    float x = term * (float)weight;
    float s = total->sum + x;
    float v = s - total->sum;
    float lost = (total->sum - (s - v)) + (x - v);
    float rest = total->rest + lost;
    total->sum = s + rest;
    total->rest = rest - (total->sum - s);
    total->weight += weight;
}

/* The mean of all samples; 0 if there is none. */
inline float rlvc_sum_mean(const rlvc_sum *total) {
    return total->weight == 0u ? 0.0f : (total->sum + total->rest) / (float)total->weight;
}

#endif
