/* SPDX-License-Identifier: MIT */
/* The chi-square distribution (section 4.2.4), in binary32 and without a C library. */
#ifndef RLVC_CHI2_H
#define RLVC_CHI2_H

#include "rlvc/status.h"
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define RLVC_CHI2_DEGREES_MAX 255u

/* The survival function P(X >= statistic) for X chi-square distributed, and its natural logarithm,
 * which stays exact where p underflows to 0. Relative error at most 1e-5 in p where p >= 1e-30, and
 * in log_p wherever it is a normal float; measured, 3e-6 over all degrees and 6e-7 for one degree.
 * O(degrees).
 * @param statistic [0, FLT_MAX], finite; below 1e-37 it counts as 0
 * @param degrees   of freedom, [1, RLVC_CHI2_DEGREES_MAX]
 * @param p, log_p  each optional
 * @return RLVC_OK; RLVC_E_RANGE: statistic or degrees. */
RLVC_API rlvc_status rlvc_chi2_survival(float statistic, uint32_t degrees, float *p, float *log_p);

/* The critical value: the statistic whose survival is p, to 1e-5 relative. O(degrees), at most 32
 * evaluations of the survival function.
 * @param p [1e-30, 1)
 * @return RLVC_OK; RLVC_E_NULL; RLVC_E_RANGE: p or degrees. */
RLVC_API rlvc_status rlvc_chi2_critical(float p, uint32_t degrees, float *statistic);

/* Pearson's statistic of a 2 x 2 table of counts, without continuity correction; 0 if a row or a
 * column is empty. Each count [0, 2^31 - 1], their sum too. O(1).
 *                 present   absent
 *      below         a         b
 *      above         c         d
 * @return RLVC_OK; RLVC_E_NULL; RLVC_E_RANGE: the sum. */
RLVC_API rlvc_status rlvc_chi2_table(uint32_t a, uint32_t b, uint32_t c, uint32_t d,
                                     float *statistic);

#define RLVC_FISHER_EXPECTED_MAX 25u

/* Fisher's exact test of such a table, two-sided: twice the probability, if rows and columns are
 * independent, of all tables with the same sums that are as far from independence on the same side,
 * or farther, at most 1; and its natural logarithm. For tables that are too small for chi-square.
 * The error is at most 2e-5 (1 - ln p), relative to p. O(1).
 * @param a, b, c, d as for rlvc_chi2_table; 1 and 0 if a row or a column is empty
 * @param p, log_p   each optional
 * @return RLVC_OK; RLVC_E_RANGE: the sum, or the least expected count is not below
 *         RLVC_FISHER_EXPECTED_MAX + 1. */
RLVC_API rlvc_status rlvc_fisher_table(uint32_t a, uint32_t b, uint32_t c, uint32_t d, float *p,
                                       float *log_p);

#ifdef __cplusplus
}
#endif

#endif
