/* SPDX-License-Identifier: MIT */
/* Chi-square and critical values of any arguments at all; Fisher's test of most tables. */
#include "any.h"
#include "rlvc/chi2.h"

#define SMALL 0x100000u

static uint32_t any_count(void) {
    return any_in(0, UINT32_MAX);
}

/* A table whose counts are up to SMALL, but those whose bits are in `large`: these are up to an
 * equal share of all that a table may count. So the analyser sees that it counts no more. */
static void fisher(uint32_t large) {
    const uint32_t share = (INT32_MAX - 4u * SMALL) /
                           ((large & 1u) + (large >> 1 & 1u) + (large >> 2 & 1u) + (large >> 3));
    uint32_t count[4];
    float p, log_p;
    //@ loop unroll 4;
    for (uint32_t i = 0; i < 4u; i++)
        count[i] = any_in(0, large >> i & 1u ? share : SMALL);
    (void)rlvc_fisher_table(count[0], count[1], count[2], count[3], &p, &log_p);
}

int eva_stats(void) {
    float p, log_p, statistic;
    (void)rlvc_chi2_survival(any_real(-3e38f, 3e38f), any_count(), &p, &log_p);
    (void)rlvc_chi2_critical(any_real(-3e38f, 3e38f), any_count(), &statistic);
    (void)rlvc_chi2_table(any_count(), any_count(), any_count(), any_count(), &statistic);
    //@ loop unroll 15;
    for (uint32_t large = 1; large < 16u; large++)
        fisher(large);
    return 0;
}
