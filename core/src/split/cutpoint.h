/* SPDX-License-Identifier: MIT */
/* The best cutpoint of one presence column (section 4.2.3), exactly, in slices.
 *
 * With the samples sorted by target, a column has a bit for each sample (1: it exhibits the
 * feature), and the cutpoint `below = i` makes the 2 x 2 table of x present and y absent samples, x
 * + y = i, below it. cutpoint.c says how most cutpoints are skipped, and why the result is
 * still that of a sweep over all of them. By ranks no cutpoint is sought: the column's score is
 * the statistic of rank_sum.h. */
#ifndef RLVC_SRC_CUTPOINT_H
#define RLVC_SRC_CUTPOINT_H

#include "../stats/rank_sum.h"

typedef struct rlvc_cutpoint {
    float score;            /* -1 if there is none */
    uint32_t below;         /* samples [0, below) are below the cutpoint; by ranks 0 */
    uint32_t present_below; /* how many of these exhibit the feature; by ranks 0 */
    uint32_t present;       /* how many of all do */
} rlvc_cutpoint;

/* What the scan charges, in units of work. */
#define RLVC_CUTPOINT_WORD_UNITS 1u   /* counting the bits of a word of 64 samples */
#define RLVC_CUTPOINT_BOUND_UNITS 4u  /* comparing with the bound that needs no logarithm */
#define RLVC_CUTPOINT_SCORE_UNITS 20u /* a score; by ranks, a word that has cutpoints */

/* Stretches of words that get a first look before the sweep. */
#define RLVC_CUTPOINT_CHUNKS 16u

typedef struct rlvc_cutpoint_cursor {
    rlvc_cutpoint best;
    uint8_t done;
    uint8_t by_ranks;   /* no cutpoint is sought: the score is the statistic of rank_sum.h */
    uint8_t phase;      /* what is being done: see cutpoint.c */
    uint8_t level;      /* the next block has 2^level words */
    uint32_t count;     /* samples */
    uint32_t word;      /* the next word, */
    uint32_t bit;       /* in it the next bit, if it is swept bit by bit, */
    uint32_t present;   /* and the samples before these that exhibit the feature */
    float bar;          /* a score must be above it: best.score, or beat while there is none */
    float narrow, wide; /* the bar, as bounds of n^2: see cutpoint.c */
    const uint64_t *column;
    const uint64_t *cuts;
    rlvc_rank_sum ranks; /* the sums before `word`, if there is no cutpoint to seek */
    uint32_t
        chunk_present[RLVC_CUTPOINT_CHUNKS]; /* samples of each chunk that exhibit the feature */
} rlvc_cutpoint_cursor;

/* Begins the search for the cutpoint of the highest score, the lowest among equals, if that score
 * is above beat and above 0. By ranks the column's statistic is found, whatever it is, unless all
 * samples exhibit the feature or none does. O(1).
 * @param column bit i % 64 of word i / 64 is 1 if sample i (by ascending target) exhibits the
 *               feature; bits count and above are 0
 * @param cuts   bit i, i >= 1, is 1 if samples i - 1 and i have distinct targets: `below = i` is a
 *               cutpoint; bit 0 and bits count and above are 0. By ranks there is one
 * @param count  [1, 2^31 - 1]; by ranks [1, RLVC_RANK_SUM_MAX]
 * @param by_ranks 1: the rank-sum test; 0: the information gain
 * @param beat   the best score of earlier columns, which win a tie; or 0, or less */
void rlvc_cutpoint_begin(rlvc_cutpoint_cursor *scan, const uint64_t *column, const uint64_t *cuts,
                         uint32_t count, uint8_t by_ranks, float beat);

/* Goes on for at most `budget` (>= RLVC_BUDGET_MIN) units; returns the units used, at least 1
 * unless done. The answer is in scan->best once scan->done is 1, and neither it nor the sum of the
 * units depends on the budgets. Rarely more than 4 units a word of a long column; at the worst
 * little more than 64 scores a word. */
uint32_t rlvc_cutpoint_step(rlvc_cutpoint_cursor *scan, uint32_t budget);

/* Takes the smallest step that a cursor can stop after. Not to be called when done. */
void rlvc_cutpoint_single(rlvc_cutpoint_cursor *scan);

/* How far the cursor has come, for a snapshot: the same only for the same state on the same
 * input. */
void rlvc_cutpoint_mark(const rlvc_cutpoint_cursor *scan, uint32_t word[3]);

#endif
