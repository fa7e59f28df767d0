/* SPDX-License-Identifier: MIT */
/* Novelty: how near a class is to a class-action pair that was little tried. Value iteration on the
 * class-level model, with rewards of its own.
 *
 *     U(c, a) = 1 if (c, a) was tried fewer than m times,
 *     U(c, a) = 0.95 * sum over c' of n(c, a, c') / n(c, a) * U(c') otherwise,
 *     U(c)    = max_a U(c, a),
 *
 * and U after the end of an episode is the chance that the next one begins where none has begun yet
 * (starts.h). Such a class is worth as much as a little-tried pair, and perhaps no way leads there.
 *
 * This is R-max (Brafman and Tennenholtz, 2002) without the rewards of the task: no bound of the
 * rewards is needed, a reward that was not found yet is searched for like any other, and costs do
 * not deter exploration. In a deterministic world U(c) is 0.95 to the power of the moves to the
 * nearest little-tried pair.
 *
 * First it is counted where episodes began. The sweeps begin at U = 0 and only raise it; the last
 * one is that which raises no U by more than 0.001, and what is worth no more than that counts as
 * out of reach. Tried means tried in the ring: what has left it is explored again. U is in
 * values.pair.nearness, an array that is free between a solution and the next model.
 */
#ifndef RLVC_SRC_NOVELTY_H
#define RLVC_SRC_NOVELTY_H

#include "explore.h"
#include "starts.h"
#include "../base/mean.h"
#include "../solve/value_iteration.h"

typedef struct rlvc_novelty_cursor {
    rlvc_starts_cursor starts;
    rlvc_sum sum;
    float ended;   /* U after the end of an episode, once starts have been counted */
    float largest; /* change of U so far in this sweep */
    float best;    /* max U(c, a) over the actions of the class so far */
    uint32_t sweeps;
    uint32_t class_id; /* where the sweep is: class, action, transition */
    uint32_t action;
    uint32_t transition;
    uint8_t action_best; /* the action that attains best */
    uint8_t counting;    /* 1: it is still being counted where episodes began */
    uint8_t done;
} rlvc_novelty_cursor;

/* Begins; explorer->min_tried is m, and episodes at positions [0, end) of the ring are counted.
 * O(classes). */
void rlvc_novelty_begin(rlvc_novelty_cursor *cursor, const rlvc_solver_input *input,
                        rlvc_values *values, uint32_t end);

/* Works for one budget on the tables of the explorer. The first sweep counts n(c, a), unless
 * explorer->count is null: when a snapshot's cursor is brought where it was, what has been counted
 * since must stay.
 * @return the work, at most budget (>= 1): a unit for each position, and for each transition and
 * each pair in each sweep.
 */
uint32_t rlvc_novelty_step(rlvc_novelty_cursor *cursor, const rlvc_solver_input *input,
                           rlvc_values *values, const rlvc_replay *replay, rlvc_explorer *explorer,
                           uint32_t budget);

/* How far the cursor has come, for a snapshot: the same only for the same state on the same
 * input. */
void rlvc_novelty_mark(const rlvc_novelty_cursor *cursor, uint32_t word[5]);

#endif
