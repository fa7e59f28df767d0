/* SPDX-License-Identifier: MIT */
/* How well a feature explains a partition of a class's samples (section 4.2.3).
 *
 * A cutpoint and a feature make a 2 x 2 table of counts, O:
 *
 *                 present   absent
 *      below         a         b      r1
 *      above         c         d      r2
 *                   c1        c2      N
 *
 * Were the two independent, a cell would hold E = r * c / N. All four cells miss that by the same
 * amount, |O - E| = |n| / N with n = a d - b c, which integers hold exactly; so nothing here is a
 * difference of large numbers that nearly agree, and binary32 keeps its 24 bits up to N =
 * RLVC_COUNT_MAX:
 *
 * The score is the information gain in bits per sample,
 *
 *      sum over the cells of (O ln(O / E) - (O - E)) / (N ln 2).
 *
 * For one column (c1 and c2 fixed) it is a convex function of the point (a, b), and is 0 exactly on
 * the line n = 0: cutpoint.c prunes by this. Tables that differ by exchanged rows or columns, and
 * transposed ones, score the same to the last bit, so that exact ties are ties. */
#ifndef RLVC_SRC_SCORE_H
#define RLVC_SRC_SCORE_H

#include "../base/count.h"

/* The computed score is within this of the exact one, relatively: 128 units in the last place,
 * about twice the sum of all the roundings where they weigh most (a cell with P / Q near 1.7, see
 * score.c). */
#define RLVC_SCORE_ERROR (1.0f / 131072.0f)

/* The score of a table, 0 or more; 0 if a row or a column is empty. O(1).
 * @param present_below ... absent_above  a, b, c, d: their sum at most RLVC_COUNT_MAX */
float rlvc_score(rlvc_count present_below, rlvc_count absent_below, rlvc_count present_above,
                 rlvc_count absent_above);

/* p ln(p / q) - (p - q) >= 0, for p >= 0 and q > 0, without cancelling where they nearly agree.
 * O(1).
 * @param difference, sum  p - q and p + q, as exactly as they are known */
float rlvc_excess(float p, float q, float difference, float sum);

#endif
