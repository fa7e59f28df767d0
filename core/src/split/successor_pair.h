/* SPDX-License-Identifier: MIT */
/* A pair of features, f of s and g of s': whether f tells what follows, and how sure that is, as
 * successor_search.h says. It is all that is known once the tables are there; these come from
 * columns of bits (successor_search.c) or from counts (counts/successors.c). Inline, as in
 * evidence.h. */
#ifndef RLVC_SRC_SUCCESSOR_PAIR_H
#define RLVC_SRC_SUCCESSOR_PAIR_H

#include "evidence.h"

/* The sum over the actions for one pair (f, g). All 0 at first. */
typedef struct rlvc_successor_pair {
    float statistic;
    float evidence;
    uint32_t degrees;
    uint32_t feature;  /* f */
    uint32_t persists; /* g = f? */
} rlvc_successor_pair;

/* Adds the table of one action, if it has two rows and two columns. O(1).
 * @param size             samples of the action
 * @param now, next, both  of how many s exhibits f, of how many s' exhibits g, of how many both */
static inline void rlvc_successor_pair_add(rlvc_successor_pair *pair, rlvc_count size,
                                           rlvc_count now, rlvc_count next, rlvc_count both) {
    if (now > 0 && now < size && next > 0 && next < size) {
        const rlvc_table table = {both, now - both, next - both, size - now - next + both};
        pair->statistic += rlvc_table_statistic(&table);
        pair->degrees++;
    }
}

/* ln of the number of tests that a pair is corrected by (Bonferroni). Whether s' exhibits what s
 * exhibits is mostly told by s: the F pairs with g = f have half of the level, and the other F (F -
 * 1) the other half. */
static inline float rlvc_successor_pair_log_tests(const rlvc_successor_pair *pair, uint32_t count) {
    float features = (float)count;
    return rlvc_ln(2.0f * features * (pair->persists ? 1.0f : features - 1.0f));
}

/* Ends the pair (f, g) of so many features, which becomes *best if it is the best so far; the pair
 * is all 0 again. O(1). */
static inline void rlvc_successor_pair_close(rlvc_successor_pair *pair, uint32_t f, uint32_t g,
                                             uint32_t features, rlvc_successor_pair *best) {
    static const rlvc_successor_pair nothing = {0.0f, 0.0f, 0, 0, 0};
    if (pair->degrees > 0) {
        pair->feature = f;
        pair->persists = f == g;
        pair->evidence = pair->statistic - 2.0f * rlvc_successor_pair_log_tests(pair, features);
        if (best->degrees == 0 || pair->evidence > best->evidence)
            *best = *pair;
    }
    *pair = nothing;
}

/* ln p of the best pair, not yet corrected; 0 if there is none. O(degrees). */
static inline float rlvc_successor_pair_log_p(const rlvc_successor_pair *best) {
    float log_p = 0.0f;
    if (best->degrees > 0)
        (void)rlvc_chi2_survival(best->statistic, best->degrees, NULL, &log_p);
    return log_p;
}

/* Fills action, samples, log_tests, score and log_p of *about for the best pair of a class.
 * @return 0 if there is none, and then *about is as it was. O(1). */
static inline int rlvc_successor_pair_result(const rlvc_successor_pair *best, float log_p,
                                             uint32_t features, rlvc_count samples,
                                             uint32_t actions, rlvc_split *about) {
    if (best->degrees == 0)
        return 0;
    about->action = actions + 1u;
    about->samples = rlvc_count_stored(samples);
    about->score = best->statistic / (float)samples;
    about->log_tests = rlvc_successor_pair_log_tests(best, features);
    about->log_p = log_p + about->log_tests;
    about->log_p = about->log_p < 0.0f ? about->log_p : 0.0f;
    return 1;
}

#endif
