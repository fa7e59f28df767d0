/* SPDX-License-Identifier: MIT */
/* What follows an action, and how sure that is: of a feature, whether the agent influences it and
 * whether it lasts, as successor_search.h says. It is all that is known once the counts are there;
 * these come from words of bits (successor_search.c) or from tables (counts/successors.c). Inline,
 * as in evidence.h. */
#ifndef RLVC_SRC_SUCCESSOR_EVIDENCE_H
#define RLVC_SRC_SUCCESSOR_EVIDENCE_H

#include "evidence.h"
#include <string.h>

/* The interactions of a class and action: [does s exhibit the feature?][does s'?]; there is no s'
 * where the episode ended. */
#define RLVC_ENDED 2u
typedef struct rlvc_following {
    rlvc_count n[2][RLVC_ENDED + 1u];
} rlvc_following;

/* Evidence for one feature. All 0 at first. */
typedef struct rlvc_successor_evidence {
    rlvc_count before[2][2]; /* influence: the sum of the actions of the class so far */
    float statistic;
    uint32_t degrees;
} rlvc_successor_evidence;

/* Adds one table if it has two rows and two columns. O(1). */
static inline void rlvc_successor_evidence_table(rlvc_successor_evidence *evidence, rlvc_count a,
                                                 rlvc_count b, rlvc_count c, rlvc_count d) {
    const rlvc_table table = {a, b, c, d};
    if (a + b > 0 && c + d > 0 && a + c > 0 && b + d > 0) {
        evidence->statistic += rlvc_table_least(&table);
        evidence->degrees++;
    }
}

/* Influence: adds by which percepts one action of a class ended the episode, and what followed it
 * to that of the actions before it. O(1).
 * @param last 1 for the last action of the class */
static inline void rlvc_influence_add(rlvc_successor_evidence *evidence,
                                      const rlvc_following *action, int last) {
    const rlvc_count *without = action->n[0], *with = action->n[1];
    rlvc_successor_evidence_table(evidence, with[0] + with[1], with[RLVC_ENDED],
                                  without[0] + without[1], without[RLVC_ENDED]);
    for (uint32_t v = 0; v < 2; v++) {
        rlvc_count *before = evidence->before[v];
        const rlvc_count *now = action->n[v];
        rlvc_successor_evidence_table(evidence, before[1], before[0], now[1], now[0]);
        before[0] += now[0];
        before[1] += now[1];
    }
    if (last)
        memset(evidence->before, 0, sizeof evidence->before);
}

/* Lasting: adds what followed one action of a class. O(1). */
static inline void rlvc_lasting_add(rlvc_successor_evidence *evidence,
                                    const rlvc_following *action) {
    rlvc_successor_evidence_table(evidence, action->n[1][1], action->n[1][0], action->n[0][1],
                                  action->n[0][0]);
}

/* The most degrees of freedom of a p-value, which bounds what it costs a controller in one step. */
#define RLVC_SUCCESSOR_DEGREES_MAX 24u

/* Odd ones, which cost more, are rounded up above this. */
#define RLVC_SUCCESSOR_ODD_MAX 3u

/* ln p, not corrected; 0 where the sum is no larger than its mean. One degree of freedom more makes
 * it no less. Of more than RLVC_SUCCESSOR_DEGREES_MAX it is that of as many, for a sum as many
 * standard deviations above its mean: as the tails get shorter, no less than the true one. O(1). */
static inline float rlvc_successor_evidence_log_p(const rlvc_successor_evidence *evidence) {
    const float most = (float)RLVC_SUCCESSOR_DEGREES_MAX, mean = (float)evidence->degrees;
    float statistic = evidence->statistic, log_p = 0.0f;
    uint32_t degrees = evidence->degrees;
    if (!(statistic > mean))
        return 0.0f;
    if (degrees > RLVC_SUCCESSOR_DEGREES_MAX) {
        statistic = most + (statistic - mean) * rlvc_sqrt(most / mean);
        degrees = RLVC_SUCCESSOR_DEGREES_MAX;
    }
    if (degrees > RLVC_SUCCESSOR_ODD_MAX)
        degrees += degrees % 2u;
    (void)rlvc_chi2_survival(statistic, degrees, NULL, &log_p);
    return log_p;
}

/* ln of the number of tests that the p-value of one of so many features is corrected by
 * (Bonferroni). O(1). */
static inline float rlvc_successor_evidence_log_tests(uint32_t features) {
    return rlvc_ln((float)features);
}

#endif
