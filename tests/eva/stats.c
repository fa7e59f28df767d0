/* SPDX-License-Identifier: MIT */
/* Chi-square, Fisher's test and critical values, of any arguments at all. */
#include "any.h"
#include "rlvc/chi2.h"

static uint32_t any_count(void) {
    return any_in(0, UINT32_MAX);
}

int eva_stats(void) {
    float p, log_p, statistic;
    (void)rlvc_chi2_survival(any_real(-3e38f, 3e38f), any_count(), &p, &log_p);
    (void)rlvc_chi2_critical(any_real(-3e38f, 3e38f), any_count(), &statistic);
    (void)rlvc_chi2_table(any_count(), any_count(), any_count(), any_count(), &statistic);
    (void)rlvc_fisher_table(any_count(), any_count(), any_count(), any_count(), &p, &log_p);
    return 0;
}
