/* SPDX-License-Identifier: MIT */
/* Is a 2 x 2 table more than chance (section 4.2.4)? Pearson's chi-square is an approximation for large
 * counts; where a cell is expected to hold fewer than five, Fisher's exact test takes its place.
 *
 * Statistics of several tables are added. Chi-square then serves down to one expected (Cochran 1954); below,
 * the statistic is the one that has the p-value of the exact test. Small counts leave p few values, and
 * its mean is well above 1 / 2: in a sum that would add up to much evidence lost. So it is the mid-p-value
 * (Lancaster's): tables as probable as the observed one count half, and the mean is 1 / 2. */
#ifndef RLVC_SRC_FISHER_H
#define RLVC_SRC_FISHER_H

#include <stdint.h>

/* The table, and the letters, of score.h. */
typedef struct rlvc_table {
    uint32_t a, b, c, d;
} rlvc_table;

/* Has a cell of a table with two rows and two columns an expected count below 1? O(1). */
int rlvc_table_small(const rlvc_table *table);

/* ln p of one table that has two rows and two columns. O(1). */
float rlvc_table_log_p(const rlvc_table *table);

/* The statistic of such a table, of one degree of freedom, for a sum. O(1). */
float rlvc_table_statistic(const rlvc_table *table);

#endif
