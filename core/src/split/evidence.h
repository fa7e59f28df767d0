/* SPDX-License-Identifier: MIT */
/* The evidence for splitting a class, and its significance (sections 4.2.3 and 4.2.4): which
 * feature wins, per action and pooled, and its corrected p-value, as split_search.h says.
 *
 * It is all that is known once the tables are there. Where they come from does not matter: columns
 * of bits (split_search.c) and counts (counts/search.c) give the same for the same samples. Inline,
 * since a controller has one caller of each, and not a byte to spare. */
#ifndef RLVC_SRC_EVIDENCE_H
#define RLVC_SRC_EVIDENCE_H

#include "../base/float_math.h"
#include "../base/solver_select.h"
#include "../stats/table_test.h"
#include "rlvc/agent.h"
#include "rlvc/chi2.h"
#include <stddef.h>

/* Decided when the library is built, where it has one score. */
#define RLVC_BY_RANKS(by_ranks) (RLVC_HAS_SCORE(RLVC_SCORE_RANKS) && (by_ranks))

/* Evidence for one feature, pooled over the groups so far. */
typedef struct rlvc_pooled {
    float evidence;
    float statistic;
    float log_tests; /* of combinations of cutpoints */
    uint32_t degrees;
} rlvc_pooled;

/* The best feature of one action. */
typedef struct rlvc_per_action {
    float evidence;
    float score;
    rlvc_table table;
    uint32_t action;
} rlvc_per_action;

/* What has been found in a class; all 0 at first. */
typedef struct rlvc_evidence {
    rlvc_per_action per_action;
    rlvc_pooled pooled;
    uint64_t features;      /* F; with the domain's own oracle, what it considered in all */
    rlvc_count samples;     /* in the groups that take part */
    rlvc_count cuts;        /* in all groups */
    uint32_t groups;        /* that take part */
    float per_action_log_p; /* of the winners' statistics, not yet corrected */
    float pooled_log_p;
} rlvc_evidence;

/* A count as a record of the tree, or a table by class and action, holds it: 2^32 - 1 stands for
 * more. O(1). */
static inline uint32_t rlvc_count_stored(rlvc_count count) {
    return RLVC_COUNT_BITS == 32 || count < UINT32_MAX ? (uint32_t)count : UINT32_MAX;
}

static inline rlvc_count rlvc_table_size(const rlvc_table *table) {
    return table->a + table->b + table->c + table->d;
}

/* Takes note of a group of `size` samples with `cuts` cutpoints. O(1). */
static inline void rlvc_evidence_group(rlvc_evidence *evidence, rlvc_count size, rlvc_count cuts) {
    evidence->groups += cuts > 0;
    evidence->samples += cuts > 0 ? size : 0;
    evidence->cuts += cuts;
}

/* Weighs a cutpoint's table and its score. By ranks the score is the statistic. O(1). */
static inline rlvc_per_action rlvc_evidence_weigh(const rlvc_table *table, float score,
                                                  uint32_t action, int by_ranks) {
    const float size = (float)rlvc_table_size(table);
    const rlvc_per_action weighed = {RLVC_BY_RANKS(by_ranks) ? score : score * size, score, *table,
                                     action};
    return weighed;
}

/* Adds to a feature's pool that it divides a group with so many cutpoints. O(1). */
static inline void rlvc_evidence_divides(rlvc_pooled *pool, rlvc_count cuts) {
    pool->degrees++;
    pool->log_tests += rlvc_ln((float)cuts);
}

/* Adds to a feature's pool what it has at its best cutpoint. O(1). */
static inline void rlvc_evidence_pool(rlvc_pooled *pool, const rlvc_per_action *weighed,
                                      int by_ranks) {
    pool->evidence += weighed->evidence;
    pool->statistic +=
        RLVC_BY_RANKS(by_ranks) ? weighed->evidence : rlvc_table_statistic(&weighed->table);
}

/* Keeps the best of one action.
 * @return 1 if it is the best so far: the caller keeps its feature. O(1). */
static inline int rlvc_evidence_keep(rlvc_evidence *evidence, const rlvc_per_action *weighed) {
    rlvc_per_action *best = &evidence->per_action;
    int better = weighed->evidence > best->evidence ||
                 (weighed->evidence == best->evidence && weighed->action < best->action);
    if (better) { /* not as a whole: the bytes between its fields are not set */
        best->evidence = weighed->evidence;
        best->score = weighed->score;
        best->table = weighed->table;
        best->action = weighed->action;
    }
    return better;
}

/* Ends a feature that all groups have seen.
 * @return 1 if it is the best of all together so far: the caller keeps it. O(1). */
static inline int rlvc_evidence_close(rlvc_evidence *evidence, const rlvc_pooled *pool) {
    int better = pool->evidence > evidence->pooled.evidence;
    evidence->features += pool->degrees > 0;
    if (better)
        evidence->pooled = *pool;
    return better;
}

/* Whether a feature was found, and so whether its p-value is to be found; and whether there is a
 * second one, pooled. O(1). */
static inline int rlvc_evidence_found(const rlvc_evidence *evidence) {
    return evidence->per_action.evidence > 0.0f;
}
static inline int rlvc_evidence_is_pooled(const rlvc_evidence *evidence) {
    return evidence->groups > 1 && evidence->pooled.degrees > 0;
}

/* Find the p-values of the two winners. O(degrees). */
static inline void rlvc_evidence_test_per_action(rlvc_evidence *evidence, int by_ranks) {
    if (RLVC_BY_RANKS(by_ranks))
        (void)rlvc_chi2_survival(evidence->per_action.score, 1, NULL, &evidence->per_action_log_p);
    else
        evidence->per_action_log_p = rlvc_table_log_p(&evidence->per_action.table);
}
static inline void rlvc_evidence_test_pooled(rlvc_evidence *evidence) {
    const rlvc_pooled *pooled = &evidence->pooled;
    (void)rlvc_chi2_survival(pooled->statistic, pooled->degrees, NULL, &evidence->pooled_log_p);
}

/* Makes both as if each statistic rested on `effect` times fewer samples, effect >= 1. An exact
 * p-value has no statistic, but its logarithm goes as one does. O(degrees). */
static inline void rlvc_evidence_discount(rlvc_evidence *evidence, float effect) {
    evidence->per_action_log_p /= effect;
    evidence->pooled.statistic /= effect;
    rlvc_evidence_test_pooled(evidence); /* without a table there is none, and nothing changes */
}

/* Fills action, samples, log_tests, score and log_p of *about, once all that is to be tested is.
 * More samples than 2^32 - 1 are given as that. O(1). */
static inline void rlvc_evidence_result(const rlvc_evidence *evidence, uint32_t actions,
                                        rlvc_split *about) {
    const rlvc_per_action *per_action = &evidence->per_action;
    const rlvc_pooled *pooled = &evidence->pooled;
    float log_features = rlvc_ln((float)evidence->features);
    about->action = per_action->action;
    about->samples = rlvc_count_stored(rlvc_table_size(&per_action->table));
    about->score = per_action->score;
    about->log_tests = log_features;
    /* The domain's own oracle already counts a feature for each cutpoint, and makes no sum. */
    if (pooled->degrees > 0)
        about->log_tests += rlvc_ln((float)evidence->cuts);
    about->log_p = evidence->per_action_log_p + about->log_tests;
    if (rlvc_evidence_is_pooled(evidence)) {
        float log_tests = log_features + pooled->log_tests;
        float log_p = evidence->pooled_log_p + log_tests;
        if (log_p < about->log_p) {
            about->action = actions;
            about->samples = rlvc_count_stored(evidence->samples);
            about->score = pooled->evidence / (float)evidence->samples;
            about->log_tests = log_tests;
            about->log_p = log_p;
        }
        about->log_tests += 0.693147181f; /* ln 2: two tests */
        about->log_p += 0.693147181f;
    }
    about->log_p = about->log_p < 0.0f ? about->log_p : 0.0f;
}

#endif
