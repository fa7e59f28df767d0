/* SPDX-License-Identifier: MIT */
/* The class-level decision process that the database shows (section 4.1), as a sparse table.
 *
 * For each pair (c, a): the mean reward, how often it was tried, and for each class c' that
 * followed, how often. The transitions lie in the array of the samples (rows.h), which are not
 * needed while the values are solved for. So the model takes no memory of its own. The transitions
 * of the pair p are those at [begin.transition[p], begin.transition[p + 1]).
 *
 * A pair that has been tried, but whose interactions have all left the ring, has no transitions.
 * The batch solvers leave its Q as it was, so that what was learnt is not lost. */
#ifndef RLVC_SRC_MODEL_H
#define RLVC_SRC_MODEL_H

#include "../base/mean.h"
#include "../samples/grouping.h"
#include "../samples/rows.h"
#include "../samples/sort.h"

typedef struct rlvc_model_cursor {
    rlvc_grouping_cursor grouping;
    rlvc_sort_cursor sort;
    rlvc_sum sum;
    uint32_t pair;
    uint32_t at;    /* sample under work */
    uint32_t begin; /* the pair's samples, before they are counted together: [begin, end) */
    uint32_t end;
    uint32_t packed; /* transitions written so far */
    uint8_t phase;
    uint8_t done;
} rlvc_model_cursor;

void rlvc_model_begin(rlvc_model_cursor *model, uint32_t pairs);

/* Works on the model for one budget. input->kind is RLVC_TARGET_SUCCESSOR.
 * @param scratch RLVC_SORT_SCRATCH_BYTES, aligned to 8, the model's until it is done
 * @return the work, at most budget (>= RLVC_BUDGET_MIN): that of the grouping and of sorting each
 * pair, and three units for each interaction. */
uint32_t rlvc_model_step(rlvc_model_cursor *model, const rlvc_target_input *input,
                         rlvc_values *values, rlvc_rows rows, void *scratch, uint32_t budget);

/* Takes the smallest step that a cursor can stop after. Not to be called when done. */
void rlvc_model_single(rlvc_model_cursor *model, const rlvc_target_input *input,
                       rlvc_values *values, rlvc_rows rows, void *scratch);

/* How far the cursor has come, for a snapshot: the same only for the same state on the same
 * input. */
void rlvc_model_mark(const rlvc_model_cursor *model, uint32_t word[8]);

/* Adds the values of the classes that transitions [*at, end) lead to, of at most `budget` (>= 1) of
 * them. *at becomes the next one. A terminated episode leads to the value `ended`.
 * @return how many were added. O(budget). */
uint32_t rlvc_model_add(rlvc_sum *sum, const rlvc_transition *transition, uint32_t *at,
                        uint32_t end, uint32_t budget, const float *value, float ended);

/* What rlvc_model_add makes of transitions [at, end), from nothing: inline, and the first term
 * needs no compensation. O(end - at). */
static inline rlvc_sum rlvc_model_sum(const rlvc_transition *transition, uint32_t at, uint32_t end,
                                      const float *value, float ended) {
    rlvc_sum sum = {0.0f, 0.0f, 0u};
    for (uint32_t i = at; i < end; i++) {
        const uint32_t next = transition[i].next;
        const float term = next == RLVC_NO_CLASS ? ended : value[next];
        if (i > at) {
            rlvc_sum_add(&sum, term, transition[i].count);
        } else {
            sum.sum = term * (float)transition[i].count + 0.0f; /* not -0 */
            sum.weight = transition[i].count;
        }
    }
    return sum;
}

/* The mean of a sum that is not empty: a signed integer becomes a float sooner. O(1). */
static inline float rlvc_model_mean(const rlvc_sum *sum) {
    return (sum->sum + sum->rest) / (float)(int64_t)sum->weight;
}

#endif
