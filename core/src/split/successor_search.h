/* SPDX-License-Identifier: MIT */
/* Aliasing by successors: a class is also aliased if a feature of its percepts predicts a feature
 * of the percepts that follow the same action, even while all targets are equal. So the tree grows
 * before any reward is found, which matters where rewards are rare.
 *
 * For features f of s and g of s', and each action, a 2 x 2 table counts the class's samples by
 * whether s exhibits f and s' exhibits g (after a terminated interaction there is no s', which
 * exhibits nothing). The statistics of the actions' tables that have two rows and two columns
 * (table_test.h) are added up, with a degree of freedom each. The p-value of each pair is corrected
 * by a number of pairs (Bonferroni), fewer where g = f. The pair wins whose statistic, less twice
 * the logarithm of that number, is the largest (it goes nearly as the p-value, which for each pair
 * would cost too much), of equals the lower g, then the lower f; and f is the split's feature. If
 * the class were one situation, then s' would not depend on f, whatever the distribution of either.
 *
 * The features are the default oracle's candidates for the class, which must fit into one block of
 * columns. For F features, N samples and A actions that costs O(F N) calls of exhibits() and O(F^2
 * (N / 64 + A)). */
#ifndef RLVC_SRC_SUCCESSOR_SEARCH_H
#define RLVC_SRC_SUCCESSOR_SEARCH_H

#include "split_search.h"
#include "successor_pair.h"

/* The search in one class, in slices. */
typedef struct rlvc_successor_cursor {
    rlvc_samples view;       /* the class */
    rlvc_successor_pair sum; /* of the pair at work */
    rlvc_successor_pair best;
    uint32_t features; /* F */
    uint32_t words;    /* of all groups */
    uint32_t now;      /* f */
    uint32_t next;     /* g */
    uint32_t action;
    uint32_t at;        /* sample or word of the action's group */
    uint32_t with_now;  /* samples of the group, so far, whose s exhibits f, */
    uint32_t with_next; /* whose s' exhibits g, */
    uint32_t with_both; /* and both */
    float log_p;        /* of the best, not yet corrected */
    uint8_t phase;
    uint8_t done;
} rlvc_successor_cursor;

/* Begins the search in a class whose groups are first[0], first[1], ..., first[actions] of the
 * workspace's samples. O(actions). */
void rlvc_successor_search_begin(rlvc_successor_cursor *search, const rlvc_split_input *input,
                                 const uint32_t *first);

/* Works for one budget; *used becomes the work, at most budget (>= RLVC_BUDGET_MIN): a unit for the
 * candidates, one for each call of exhibits(), two for each 64 samples of a table, 24 for each
 * table, RLVC_TEST_UNITS for the p-value.
 * @return RLVC_OK; RLVC_E_CALLBACK: try that callback again by calling again. */
rlvc_status rlvc_successor_search_step(rlvc_successor_cursor *search, const rlvc_split_input *input,
                                       uint32_t budget, uint32_t *used);

/* Takes the smallest step that a cursor can stop after. Not to be called when done.
 * @return RLVC_OK; RLVC_E_CALLBACK. */
rlvc_status rlvc_successor_search_single(rlvc_successor_cursor *search,
                                         const rlvc_split_input *input);

/* How far the cursor has come, for a snapshot: the same only for the same state on the same
 * input. */
void rlvc_successor_search_mark(const rlvc_successor_cursor *search, uint32_t word[5]);

/* Once done: fills action (= actions + 1), samples, log_tests, score (the statistic a sample) and
 * log_p of
 * *about.
 * @return the feature, in the workspace; null if nothing could be told apart. O(1). */
const void *rlvc_successor_search_result(const rlvc_successor_cursor *search,
                                         const rlvc_workspace *space, rlvc_split *about);

#endif
