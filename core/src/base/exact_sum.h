/* SPDX-License-Identifier: MIT */
/* Sums of binary32 numbers without any rounding: the same in whatever order they are added.
 *
 * A finite float is a multiple of 2^-149. Of numbers up to RLVC_REWARD_MAX, which is below 2^40,
 * 2^48 in all add up to less than 2^88: 237 bits and a sign hold the sum as an integer, in units of
 * 2^-149. Adding is public (rlvc/counts.h), since who counts must do it. */
#ifndef RLVC_SRC_EXACT_SUM_H
#define RLVC_SRC_EXACT_SUM_H

#include "rlvc/counts.h"

/* The sum, rounded once. O(1). */
float rlvc_exact_sum_float(const rlvc_exact_sum *sum);

#endif
