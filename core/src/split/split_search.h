/* SPDX-License-Identifier: MIT */
/* Class refinement (section 4.2.3): the best feature for one class, and its significance (4.2.4).
 *
 * The samples of each action are a group. A group is sorted by target once. Its cutpoints lie
 * between neighbours with distinct targets, and are kept as a string of bits. Each candidate
 * feature becomes a column of bits in the order of the samples, 1 where the sample's percept
 * exhibits it. Running counts over column and cutpoints then give every 2 x 2 table. With N
 * samples, F features and C cutpoints that costs O(N + F N / 64 + F C) besides detecting, instead
 * of O(F N C). Columns are made for one block of features at a time.
 *
 * By ranks a feature has one statistic in each group instead (rank_sum.h). It is the score, the
 * evidence and, with one degree of freedom, the test. A group with cutpoints then counts as C = 1.
 *
 * The evidence of a feature and a cutpoint in a group is its score times the samples of the group.
 * Two features are tested:
 *
 *   per action   the one with the most evidence at one cutpoint of one group; ties: the lower
 *                action, then the earlier feature, then the lower cutpoint. Its table is tested
 *                (table_test.h). Its p-value is corrected by F times the sum of the groups' C.
 *   pooled       the one with the most evidence summed over the groups, in each at its best
 *                cutpoint; ties: the earlier feature. The statistics of its tables (table_test.h)
 *                are added, with a degree of freedom for each group that it divides. Its p-value is
 *                corrected by F times the product of their C. Two situations mostly differ a little
 *                after each action, and this test adds that up.
 *
 * The split has the lower p-value. With more than one group both tests are made, and the p-value is
 * corrected by 2 (all these corrections are Bonferroni's). F counts the features that divide some
 * group. Under the returns criterion a class has one group, of its greedy action, and the split is
 * the published one. With config.smallest_effect there is none if it is surely worth less
 * (effect.h). */
#ifndef RLVC_SRC_SPLIT_SEARCH_H
#define RLVC_SRC_SPLIT_SEARCH_H

#include "../samples/targets.h"
#include "cutpoint.h"
#include "effect.h"
#include "evidence.h"
#include "../base/solver_select.h"
#include "../samples/rows.h"
#include "../samples/sort.h"

/* The samples of the class after one action. */
typedef struct rlvc_group {
    uint32_t begin; /* samples [begin, end) of the class */
    uint32_t end;
    uint32_t cuts; /* C: cutpoints; by ranks at most 1. A group without one takes no part */
    uint32_t word; /* where its words begin in the cutpoints and in each column */
} rlvc_group;

/* The samples of a class after one action, without a feature and with it: see dependence.h. */
typedef struct rlvc_sides {
    float sum[2]; /* of their targets */
    uint32_t count[2];
} rlvc_sides;

/* What a p-value is charged: a sum of dozens of terms (chi2.c, table_test.c). */
#define RLVC_TEST_UNITS RLVC_BUDGET_MIN

/* The memory of a search. */
typedef struct rlvc_workspace {
    rlvc_rows rows;          /* [capacity + 1] */
    uint64_t *cutpoints;     /* [words] a bit for each sample: where a cluster of targets begins */
    uint64_t *columns;       /* [features_at_once][words | 1], and scratch */
    uint32_t column_words;   /* of all columns */
    unsigned char *features; /* [features_at_once] the block of candidates */
    unsigned char *per_action; /* the winner per_action, */
    unsigned char *pooled;     /* and together */
    union {
        rlvc_group *group; /* while a class is searched */
        rlvc_sides *sides; /* while a feature that was found is weighed */
    } of_action;           /* [actions] */
    rlvc_pooled *pool;     /* [features_at_once] */
    struct {               /* where there may be more than RLVC_CLASSES_SMALL classes: */
        uint64_t *order;   /* [classes] of samples and cutpoints when a search was in vain, */
        uint32_t *units;   /* [classes] and what it is charged from there on; 0: none was */
    } in_vain;
    uint32_t feature_bytes;
    uint32_t features_at_once;
    uint32_t actions;
    uint8_t remembers; /* what is in_vain */
} rlvc_workspace;

/* Whether searches in vain are remembered: where many classes may stay as they are while others
 * change. O(1). */
static inline int rlvc_workspace_remembers(const rlvc_workspace *space) {
    return RLVC_CLASSES_MAX > RLVC_CLASSES_SMALL && space->remembers;
}

/* Column j of the block, when all groups together have `words` words. An odd number of words apart,
 * so that the words of one place in all columns do not fall on the same lines of a cache. O(1). */
static inline uint64_t *rlvc_workspace_column(const rlvc_workspace *space, uint32_t words,
                                              uint32_t j) {
    return space->columns + (size_t)(words | 1u) * j;
}

/* Feature j of the block. O(1). */
static inline void *rlvc_workspace_feature(const rlvc_workspace *space, uint32_t j) {
    return space->features + (size_t)j * space->feature_bytes;
}

void rlvc_workspace_carve(rlvc_workspace *space, rlvc_arena *arena, const rlvc_config *config,
                          uint32_t feature_bytes);

/* Counting how a feature that the domain's own oracle proposed divides a group. */
typedef struct rlvc_answer {
    uint32_t at;
    uint32_t present_below;
    uint32_t present;
    uint32_t considered;
} rlvc_answer;

/* The search in one class, in slices. */
typedef struct rlvc_split_cursor {
    rlvc_samples view; /* the class */
    union {
        rlvc_sort_cursor sort;
        rlvc_cutpoint_cursor scan;
        rlvc_answer answer;
        rlvc_effect effect;
    } inner;
    rlvc_evidence evidence;
    uint64_t order;  /* if the workspace remembers: a hash of samples and cutpoints so far */
    uint32_t action; /* the group at work */
    uint32_t words;  /* of all groups */
    uint32_t at;     /* sample of the group */
    uint32_t lowest; /* the key that began the present cluster of targets */
    uint32_t first;  /* number of the block's first candidate */
    uint32_t block;  /* candidates in the block */
    uint32_t column; /* of the block */
    uint8_t phase;
    uint8_t done;
} rlvc_split_cursor;

/* What does not change while a step is under way. */
typedef struct rlvc_split_input {
    const rlvc_workspace *space;
    const rlvc_replay *replay;
    const rlvc_target_input *aliasing;
    const rlvc_domain *domain;
    uint32_t min_samples;
    float smallest_effect;
    uint8_t by_ranks; /* config.score is RLVC_SCORE_RANKS */
} rlvc_split_input;

/* Does the percept in a slot exhibit a feature?
 * @return RLVC_OK; RLVC_E_CALLBACK. */
rlvc_status rlvc_split_input_exhibits(const rlvc_split_input *input, uint32_t slot,
                                      const void *feature, uint8_t *present);

/* Detects a block of features in samples of a view from number *at on, which becomes that of the
 * next: with the domain's detect(), up to 64 and as many as there are, *at a multiple of 64; else
 * in one. For sample i the bit i % 64 of word[j * stride] becomes 1 if it exhibits feature j, and
 * the bits after the last become 0. *used becomes the work.
 * @return RLVC_OK; RLVC_E_CALLBACK: *at unchanged. */
rlvc_status rlvc_split_input_detect(const rlvc_split_input *input, const rlvc_samples *view,
                                    uint32_t *at, const unsigned char *features, uint32_t block,
                                    uint64_t *word, uint32_t stride, uint32_t *used);

/* Begins the search in a class whose groups are first[0], first[1], ..., first[actions] of the
 * workspace's samples. O(actions). */
void rlvc_split_search_begin(rlvc_split_cursor *search, const rlvc_split_input *input,
                             const uint32_t *first);

/* Brings the samples of a class into the order in which a search leaves them, and nothing else. The
 * cursor is lost. `first` is as above. About 16 units a sample. */
void rlvc_split_search_sort(rlvc_split_cursor *search, const rlvc_split_input *input,
                            const uint32_t *first);

/* Works for one budget; *used becomes the work, at most budget (>= RLVC_BUDGET_MIN): a unit for
 * each sample marked or detected (with up to 64 features; without detect(), for each feature of
 * each sample), what sorting and the scan of each column are charged, one for each feature of a
 * block, RLVC_TEST_UNITS for each of the two p-values, and for the effect one for each sample.
 * @return RLVC_OK; RLVC_E_CALLBACK: try that callback again by calling again. */
rlvc_status rlvc_split_search_step(rlvc_split_cursor *search, const rlvc_split_input *input,
                                   uint32_t budget, uint32_t *used);

/* Whether all samples are in order, and no feature was looked for yet: search->order is that of
 * all, if the workspace remembers, and then a call of rlvc_split_search_step ends there, unless
 * less than RLVC_BUDGET_MIN is left. O(1). */
int rlvc_split_search_is_sorted(const rlvc_split_cursor *search);

/* Takes the smallest step that a cursor can stop after. Not to be called when done.
 * @return RLVC_OK; RLVC_E_CALLBACK. */
rlvc_status rlvc_split_search_single(rlvc_split_cursor *search, const rlvc_split_input *input);

/* How far the cursor has come, for a snapshot: the same only for the same state on the same
 * input. */
void rlvc_split_search_mark(const rlvc_split_cursor *search, uint32_t word[10]);

/* Once done: fills action, samples, log_tests, score and log_p of *about.
 * @return the feature, in the workspace; null if no feature separates the samples.
 * O(degrees). */
const void *rlvc_split_search_result(const rlvc_split_cursor *search, const rlvc_workspace *space,
                                     rlvc_split *about);

#endif
