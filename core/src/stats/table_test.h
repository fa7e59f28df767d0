/* SPDX-License-Identifier: MIT */
/* Significance of a 2 x 2 table (section 4.2.4). Pearson's chi-square is an approximation for large
 * counts. A single table is tested by Fisher's exact test if an expected count is below five.
 *
 * In a sum of tables exact p-values would waste evidence, since a small table has few possible
 * values. There Pearson's statistic is used down to an expected count of one (Cochran 1954). Below,
 * the likelihood ratio G^2 = 2 sum O ln(O / E) = 2 ln 2 N gain is used. Rare counts have Poisson's
 * law, whose tails it follows: for 3 where 0.1 are expected p is 1.5e-4, by G^2 1.3e-4, by
 * chi-square 5e-20. */
#ifndef RLVC_SRC_TABLE_TEST_H
#define RLVC_SRC_TABLE_TEST_H

#include "../base/count.h"

/* The table, and the letters, of score.h; of RLVC_COUNT_MAX samples at most. */
typedef struct rlvc_table {
    rlvc_count a, b, c, d;
} rlvc_table;

/* ln p of a table by itself; it has two rows and two columns. O(1). */
float rlvc_table_log_p(const rlvc_table *table);

/* What such a table adds to a sum: a statistic of one degree of freedom. O(1). */
float rlvc_table_statistic(const rlvc_table *table);

/* What it adds to a sum of very many tables, however small: the least of G^2 and Pearson's
 * statistic times (N - 1) / N, N samples in all. That has a mean of exactly 1 if rows and columns
 * are independent, given their sums. So the sum has no bias that would grow with it, and a rare
 * count no more than its own tail. O(1). */
float rlvc_table_least(const rlvc_table *table);

#endif
