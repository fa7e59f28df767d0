/* SPDX-License-Identifier: MIT */
/* Gram matrices and ridge regression.
 *
 * The Gram matrix of rows x (of `order` numbers, x[0] = 1) is G = sum of x x^T, of which the lower
 * triangle is kept, row by row: G[i][j] at i (i + 1) / 2 + j, j <= i. G[0][0] counts the rows.
 * Where the last number of a row is a target y and the others are a basis, the ridge regression
 *
 *     minimise |X b - y|^2 + k |b|^2
 *
 * follows from the Cholesky factor L of G + k I (but for y's own diagonal): L's last row l solves
 * for b, and its last pivot squared is the minimum. */
#ifndef RLVC_SRC_GRAM_H
#define RLVC_SRC_GRAM_H

#include <stdint.h>

#define RLVC_GRAM_FLOATS(order) ((order) * ((order) + 1u) / 2u)

void rlvc_gram_clear(float *gram, uint32_t order);

/* Adds a row. O(order^2 / 2). */
void rlvc_gram_add(float *gram, const float *row, uint32_t order);

/* to += from; to = total - part. O(order^2 / 2). */
void rlvc_gram_sum(float *to, const float *from, uint32_t order);
void rlvc_gram_difference(float *to, const float *total, const float *part, uint32_t order);

/* Turns a Gram matrix into its Cholesky factor, with `ridge` added to the diagonal.
 * @return the minimum: the sum of squares left, ridge included. O(order^3 / 6). */
float rlvc_gram_factor(float *gram, uint32_t order, float ridge);

/* Adds the regression's coefficients, of a factor, to coefficient[0 .. order - 2].
 * @param work [order - 1]. O(order^2 / 2). */
void rlvc_gram_solve(const float *factor, uint32_t order, float *work, float *coefficient);

#endif
