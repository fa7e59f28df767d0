/* SPDX-License-Identifier: MIT */
/* Sorting samples by key, in place and in slices: a radix sort from the highest differing bit down,
 * with insertion for short runs. The order of samples with equal keys depends only on the input.
 * See sort.c. */
#ifndef RLVC_SRC_SORT_H
#define RLVC_SRC_SORT_H

#include "rlvc/domain.h"

#define RLVC_SORT_SCRATCH_BYTES 2048u

/* The whole, and a distribution by each of at most eight digits. */
#define RLVC_SORT_LEVELS 9u

typedef struct rlvc_sort_cursor {
    rlvc_sample *sample;
    uint32_t *scratch;
    uint32_t level_end[RLVC_SORT_LEVELS]; /* where the range of each level ends, */
    uint8_t shift[RLVC_SORT_LEVELS];      /* and the lowest bit of the digit it is distributed by */
    uint8_t level;
    uint8_t phase; /* what is being done: see sort.c */
    uint8_t done;
    uint32_t begin;    /* of the run at work; all before it are where they belong */
    uint32_t at;       /* the next sample of it to look at */
    uint32_t differ;   /* the bits in which its keys differ, as far as seen */
    uint32_t buckets;  /* values of the deepest level's digit; */
    uint32_t bucket;   /* the one whose places are being filled, */
    uint32_t unplaced; /* and how many samples of the run are not yet where it wants them */
} rlvc_sort_cursor;

/* Begins to sort sample[0 .. count) by ascending key. O(1).
 * @param count   at most 2^31 - 1
 * @param scratch RLVC_SORT_SCRATCH_BYTES, aligned to 4, the cursor's until it is done */
void rlvc_sort_begin(rlvc_sort_cursor *sort, rlvc_sample *sample, uint32_t count, void *scratch);

/* Goes on for at most `budget` (>= RLVC_BUDGET_MIN) units; returns the units used, at least 1
 * unless done. A sample looked at is charged 1 unit, moved by insertion 1 a place, exchanged 2; a
 * counter 1/8 when it is cleared, 1/4 when it is summed, 1 each time that its bucket is visited.
 * What comes out does not depend on the budgets. About 15 units a sample. */
uint32_t rlvc_sort_step(rlvc_sort_cursor *sort, uint32_t budget);

/* Takes the smallest step that a cursor can stop after, so that every state that some budgets lead
 * to is passed through. Not to be called when done. */
void rlvc_sort_single(rlvc_sort_cursor *sort);

/* How far the cursor has come, for a snapshot: the same only for the same state on the same
 * input. */
void rlvc_sort_mark(const rlvc_sort_cursor *sort, uint32_t word[5]);

#endif
