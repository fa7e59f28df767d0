/* SPDX-License-Identifier: MIT */
/* Gram matrices and ridge regression: see gram.h. */
#include "rlvc/float_rules.h"

#include "gram.h"

#include "../base/float_math.h"

/* A pivot below this share of its diagonal is what rounding left. A column of which no more is left
 * depends on those before it: an infinite pivot, as it were, makes its coefficient 0. */
#define PIVOT_LEAST 1e-7f
#define COLUMN_LEAST 1e-6f
#define PIVOT_OF_NOTHING 1e30f

/* The least pivot is positive, whatever the diagonal: of a difference of sums, rounding may leave
 * less than nothing. */
static float least_pivot(float diagonal, float share) {
    return share * (diagonal > 0.0f ? diagonal : 0.0f) + 1e-30f;
}

void rlvc_gram_clear(float *gram, uint32_t order) {
    for (uint32_t i = 0; i < RLVC_GRAM_FLOATS(order); i++)
        gram[i] = 0.0f;
}

void rlvc_gram_add(float *gram, const float *row, uint32_t order) {
    float *at = gram;
    for (uint32_t i = 0; i < order; i++) {
        float x = row[i];
        for (uint32_t j = 0; j <= i; j++)
            at[j] += x * row[j];
        at += i + 1u;
    }
}

void rlvc_gram_sum(float *to, const float *from, uint32_t order) {
    for (uint32_t i = 0; i < RLVC_GRAM_FLOATS(order); i++)
        to[i] += from[i];
}

void rlvc_gram_difference(float *to, const float *total, const float *part, uint32_t order) {
    for (uint32_t i = 0; i < RLVC_GRAM_FLOATS(order); i++)
        to[i] = total[i] - part[i];
}

float rlvc_gram_factor(float *gram, uint32_t order, float ridge) {
    float *row = gram, left = 0.0f;
    for (uint32_t i = 0; i < order; i++) {
        const float *above = gram;
        float diagonal = row[i] + (i + 1u < order ? ridge : 0.0f);
        left = diagonal;
        for (uint32_t j = 0; j < i; j++) {
            float sum = row[j];
            for (uint32_t k = 0; k < j; k++)
                sum -= row[k] * above[k];
            row[j] = sum / above[j];
            left -= row[j] * row[j];
            above += j + 1u;
        }
        int last = i + 1u == order;
        float least = least_pivot(diagonal, last ? PIVOT_LEAST : COLUMN_LEAST);
        if (left < least)
            left = last ? least : PIVOT_OF_NOTHING;
        row[i] = rlvc_sqrt(left);
        row += i + 1u;
    }
    return left;
}

void rlvc_gram_solve(const float *factor, uint32_t order, float *work, float *coefficient) {
    uint32_t p = order - 1u;
    const float *last = factor + RLVC_GRAM_FLOATS(p);
    for (uint32_t i = 0; i < p; i++)
        work[i] = last[i];
    for (uint32_t i = p; i-- > 0;) {
        const float *row = factor + RLVC_GRAM_FLOATS(i);
        work[i] /= row[i];
        for (uint32_t j = 0; j < i; j++)
            work[j] -= row[j] * work[i];
        coefficient[i] += work[i];
    }
}
