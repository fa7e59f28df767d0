/* SPDX-License-Identifier: MIT */
/* The functions of mean.h for where they are not inlined: a compiler that is asked for speed
 * inlines them, one that is asked for few bytes calls these. */
#include "rlvc/float_rules.h"

#include "mean.h"

extern inline void rlvc_sum_add(rlvc_sum *total, float term, uint32_t weight);
extern inline float rlvc_sum_mean(const rlvc_sum *total);
