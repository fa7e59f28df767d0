/* SPDX-License-Identifier: MIT */
/* Aliasing by successors: a class is also aliased if a feature that the agent influences lasts in
 * it, even while all targets are equal. So the tree grows before any reward is found, which matters
 * where rewards are rare. Two questions are asked of a feature.
 *
 *   influence   in all classes: does its presence in s' depend on the action? A sensor's noise may
 *               stay for a while, cycle, or go along with other noise; but what it becomes does not
 *               depend on the action, given what it was. So in each stratum, a class and whether s
 *               exhibits the feature, the table of actions by presence in s' should show nothing if
 *               it is noise. That holds at each interaction, whatever came before, so that no
 *               dependence within a trajectory disturbs it. A table is taken apart into tables of
 *               two rows, each action beside those before it (Lancaster 1949).
 *               What an episode is about, the agent does not influence: a taxi's destination stays.
 *               But it tells which action ends the episode. So a table is added for each class and
 *               action, of presence in s by whether there is an s'.
 *   lasting     in one class: does its presence in s' depend on its presence in s, after the same
 *               action? If the class were one situation, it would not. A table for each action, of
 *               the interactions that have an s'.
 *
 * The statistics of the tables that have two rows and two columns (rlvc_table_least) are added up,
 * with a degree of freedom each, and the p-value is corrected by the number of features. Those that
 * pass as influenced, at most features_at_once and as many as have room for their counts, are the
 * block of all searches for what lasts. Of a class the one with the lowest p-value wins, of equals
 * the earlier.
 *
 * The features are the default oracle's candidates. For F features, N samples, and K that pass, in
 * C classes with A actions, that costs O((F + K) N) calls of exhibits() and O((F + K) C A). */
#ifndef RLVC_SRC_SUCCESSOR_SEARCH_H
#define RLVC_SRC_SUCCESSOR_SEARCH_H

#include "split_search.h"

/* A search, in slices. */
typedef struct rlvc_successor_cursor {
    rlvc_samples view; /* all samples, grouped by class and action */
    float log_level;   /* influence: ln of the level of one feature; else 0 */
    uint32_t pair;     /* at work: class * actions + action, */
    uint32_t end;      /* up to here */
    uint32_t at;       /* its sample, */
    uint32_t feature;  /* and the feature of the block */
    uint32_t first;    /* number of the block's first candidate */
    uint32_t room;     /* candidates that fit into the block */
    uint32_t block;    /* candidates in it */
    uint32_t kept;     /* features of earlier blocks that passed, */
    uint32_t passed;   /* and of this one */
    uint32_t best;     /* lasting: the feature, */
    uint32_t samples;  /* of how many samples, */
    float statistic;   /* its sum, */
    float log_p;       /* and ln p, not corrected */
    uint8_t phase;
    uint8_t done;
} rlvc_successor_cursor;

/* Begins the search for what is influenced, in all classes. Once done, `kept` features of the
 * workspace's block passed. O(1).
 * @param first where the samples of each of the `pairs` pairs of class and action begin */
void rlvc_influence_begin(rlvc_successor_cursor *search, const rlvc_split_input *input,
                          const uint32_t *first, uint32_t pairs, float log_level);

/* Begins the search for what lasts in a class, among so many features of the block. O(1).
 * @param first as above */
void rlvc_lasting_begin(rlvc_successor_cursor *search, const rlvc_split_input *input,
                        const uint32_t *first, uint32_t class_id, uint32_t features);

/* Works for one budget; *used becomes the work, at most budget (>= RLVC_BUDGET_MIN). Two units
 * for each feature of each sample, 64 for each feature of a pair, RLVC_TEST_UNITS for each
 * p-value.
 * @param first as at the beginning
 * @return RLVC_OK; RLVC_E_CALLBACK: try that callback again by calling again. */
rlvc_status rlvc_successor_search_step(rlvc_successor_cursor *search, const rlvc_split_input *input,
                                       const uint32_t *first, uint32_t budget, uint32_t *used);

/* Takes the smallest step that a cursor can stop after. Not to be called when done.
 * @return RLVC_OK; RLVC_E_CALLBACK. */
rlvc_status rlvc_successor_search_single(rlvc_successor_cursor *search,
                                         const rlvc_split_input *input, const uint32_t *first);

/* How far the cursor has come, for a snapshot: the same only for the same state on the same
 * input. */
void rlvc_successor_search_mark(const rlvc_successor_cursor *search, uint32_t word[5]);

/* Once done with what lasts: fills action (= actions + 1), samples, log_tests, score (the statistic
 * a sample) and log_p of *about.
 * @return the feature, in the workspace; null if no p-value is below 1. O(1). */
const void *rlvc_successor_search_result(const rlvc_successor_cursor *search,
                                         const rlvc_workspace *space, rlvc_split *about);

#endif
