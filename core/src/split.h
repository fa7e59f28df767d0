/* SPDX-License-Identifier: MIT */
/* Class refinement (section 4.2.3): the best feature and cutpoint for the samples of one class and
 * action, and whether it is real (section 4.2.4).
 *
 * The samples are sorted by target once. The cutpoints lie between neighbours whose targets are distinct,
 * and are kept as a string of bits. Each candidate feature becomes a column of bits in the order of the
 * samples, 1 where the sample's percept exhibits it; running counts over column and cutpoints then give
 * every 2 x 2 table. With N samples, F features and C cutpoints that costs O(N + F N / 64 + F C) beside
 * detecting, not O(F N C). Columns are made for a block of features at a time.
 *
 * The winner is the pair (feature, cutpoint) of the highest score; of equals the earlier feature, then the
 * lower cutpoint. Its chi-square p-value, with one degree of freedom, is corrected by the number of pairs
 * that were tried (Bonferroni); a feature that all samples exhibit, or none, is not tried. */
#ifndef RLVC_SRC_SPLIT_H
#define RLVC_SRC_SPLIT_H

#include "aliasing.h"
#include "cutpoint.h"
#include "sort.h"

/* The memory of a search. */
typedef struct rlvc_workspace {
    rlvc_sample *sample;     /* [capacity]: all samples, grouped; or the model's transitions */
    uint64_t *cuts;          /* [words + 1] */
    uint64_t *columns;       /* [features_at_once][words | 1], and scratch for sorting */
    unsigned char *features; /* [features_at_once] the block of candidates */
    unsigned char *winner;   /* the best feature of the group searched */
    unsigned char *chosen;   /* the best feature of the class so far, over its actions */
    uint32_t feature_bytes;
    uint32_t features_at_once;
} rlvc_workspace;

void rlvc_workspace_carve(rlvc_workspace *space, rlvc_arena *arena, const rlvc_config *config,
                          uint32_t feature_bytes);

/* Counting how a feature that the domain's own oracle proposed divides the samples. */
typedef struct rlvc_answer {
    uint32_t at;
    uint32_t present_below;
    uint32_t present;
    uint32_t considered;
} rlvc_answer;

/* The search in one group, in slices. */
typedef struct rlvc_search {
    rlvc_samples view;
    union {
        rlvc_sort sort;
        rlvc_scan scan;
        rlvc_answer answer;
    } inner;
    rlvc_cut best;
    uint64_t tests; /* (feature, cutpoint) pairs tried */
    uint32_t cuts;  /* cutpoints */
    uint32_t lowest; /* the key that began the present cluster of targets */
    uint32_t at;    /* sample or word or cutpoint, by phase */
    uint32_t first; /* number of the block's first candidate */
    uint32_t block; /* candidates in the block */
    uint32_t column;
    uint8_t phase;
    uint8_t done;
} rlvc_search;

/* Begins the search in samples [begin, end) of the workspace. O(1). */
void rlvc_search_begin(rlvc_search *search, const rlvc_workspace *space, const rlvc_replay *replay,
                       uint32_t begin, uint32_t end);

/* Works for one budget; *used becomes the work, at most budget (>= RLVC_BUDGET_MIN): a unit for each
 * sample sorted, marked or detected (with up to 64 features; without detect(), for each feature of each
 * sample), and what the scan of each column is charged.
 * @return RLVC_OK; RLVC_E_CALLBACK: try that callback again by calling again. */
rlvc_status rlvc_search_step(rlvc_search *search, const rlvc_workspace *space,
                             const rlvc_aliasing *aliasing, const rlvc_domain *domain, uint8_t score,
                             uint32_t budget, uint32_t *used);

/* Once done: fills score, samples, tests and log_p of *about, and says if there is a split at all (the
 * feature is in space->winner). O(1). */
int rlvc_search_result(const rlvc_search *search, rlvc_split *about);

#endif
