/* SPDX-License-Identifier: MIT */
/* The rank-sum test (Wilcoxon 1945, Mann and Whitney 1947) of one presence column: do the samples
 * that exhibit a feature have higher or lower targets than the others? It needs no cutpoint.
 *
 * With the samples sorted by target, a cluster of targets that count as equal takes the places
 * [s, e), and each of its t = e - s samples the mean of their ranks: twice that less one is s + e.
 * Of N samples A exhibit the feature and B do not. Were targets and feature independent, the sum D
 * of s + e over the A samples, less A N, would have the mean 0 and the variance
 *
 *      v = A B (N^3 - sum of t^3) / (3 N (N - 1)),
 *
 * and z^2 = D^2 / v would be about chi-square's with one degree of freedom; without ties less, far
 * out, as D is bounded. But the more ties, the more D is a mere count, and counts of what is rare
 * have Poisson's tails, which are far longer. So the statistic is
 *
 *      T = 2 v / j^2 h(j |D| / v),   h(u) = (1 + u) ln(1 + u) - u,
 *      j^2 = ((A - B)^2 + 1) tau,    tau = sum of t^3 / N^3,
 *
 * twice the exponent of Poisson's tails with jumps of j (h as in Bennett's inequality, 1962).
 * It is at most z^2, and tends to that as j does to 0: without ties, and where A is near B. Where
 * nearly all targets are equal and the feature is rare, D / N counts the samples that are neither,
 * j / N is about 1, and T about the likelihood ratio of a table.
 *
 * The jump is one by which Poisson's tails are no shorter than those of D. Let m2, m3, m4 be the
 * moments of the ranks, centred and scaled to [-1, 1]. Then m2 = (1 - tau) / 3 and m4 <= m2, hence
 * m4 / m2 - 3 m2 <= tau; and |m3| / m2 <= sqrt(tau), as a test finds. For large N the third and
 * fourth cumulants of D, drawn without replacement, have these two as factors, beside |A - B| / N
 * and at most its square. Poisson's have j and j^2. */
#ifndef RLVC_SRC_RANK_SUM_H
#define RLVC_SRC_RANK_SUM_H

#include <stdint.h>

#define RLVC_RANK_SUM_MAX (UINT32_C(1) << 21) /* samples: their number cubed fits into 64 bits */

/* All 0 at the beginning of a column. Of the clusters before the present one: */
typedef struct rlvc_rank_sum {
    uint64_t sum;    /* of s + e, over the samples that exhibit the feature */
    uint64_t cubes;  /* sum of t^3 */
    uint32_t begin;  /* of the present cluster */
    uint32_t inside; /* samples in it so far that exhibit the feature */
} rlvc_rank_sum;

/* Adds 32 samples from number `at` on, by ascending target. O(1).
 * @param column bit i is 1 if sample at + i exhibits the feature; 0 where there is no such sample
 * @param cuts   bit i is 1 if a cluster begins with sample at + i, which is not the first of all */
void rlvc_rank_sum_add(rlvc_rank_sum *ranks, uint32_t at, uint32_t column, uint32_t cuts);

/* T. Once only, after all samples: of these some exhibit the feature and some do not, and they are
 * of two clusters or more. O(1).
 * @param present A, within (0, count)
 * @param count   N, [2, RLVC_RANK_SUM_MAX] */
float rlvc_rank_sum_statistic(rlvc_rank_sum *ranks, uint32_t present, uint32_t count);

#endif
