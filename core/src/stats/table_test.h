/* SPDX-License-Identifier: MIT */
/* Is a 2 x 2 table more than chance (section 4.2.4)? Pearson's chi-square is an approximation for
 * large counts. Of a table by itself, Fisher's exact test takes its place where a cell is expected
 * to hold fewer than five.
 *
 * In a sum of tables exact p-values would waste evidence, as a small table has but a few of them.
 * There Pearson's statistic serves down to one expected (Cochran 1954). Below, the likelihood ratio
 * G^2 = 2 sum O ln(O / E) = 2 ln 2 N gain takes its place: the counts of what is rare are
 * Poisson's, whose tails it follows (3 where 0.1 are expected: p = 1.5e-4, by G^2 1.3e-4, by
 * chi-square 5e-20). */
#ifndef RLVC_SRC_TABLE_TEST_H
#define RLVC_SRC_TABLE_TEST_H

#include <stdint.h>

/* The table, and the letters, of score.h. */
typedef struct rlvc_table {
    uint32_t a, b, c, d;
} rlvc_table;

/* ln p of a table by itself; it has two rows and two columns. O(1). */
float rlvc_table_log_p(const rlvc_table *table);

/* What such a table adds to a sum: a statistic of one degree of freedom. O(1). */
float rlvc_table_statistic(const rlvc_table *table);

#endif
