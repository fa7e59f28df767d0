/* SPDX-License-Identifier: MIT */
/* Batch solvers over the class-level model (section 2.3): value iteration, policy iteration and
 * prioritized sweeping.
 *
 * The first two sweep over the classes,
 *     Q(c, a) := r(c, a) + gamma * sum over c' of n(c, a, c') / n(c, a) * V(c')
 * and put V(c) in place as they go (Gauss-Seidel). Value iteration takes V(c) := max_a Q(c, a),
 * that is equation (2). Policy iteration takes V(c) := Q(c, pi(c)) until that has settled, then
 * makes pi greedy, until nothing changes.
 *
 * A sweep contracts the error by gamma, so that after one that changed no V by more than delta, V
 * is within delta * gamma / (1 - gamma) of its fixed point: a sweep is the last when that is at
 * most config.tolerance. (For gamma = 1 nothing is known; then delta itself is held to the
 * tolerance.) Where binary32 cannot resolve so much, a few units in the last place of the largest
 * value do.
 *
 * Prioritized sweeping (Moore and Atkeson, 1993) backs up, by value iteration's rule, only classes
 * whose V may change much, largest first. The priority of a class is a bound on how far V(c) is
 * from max_a Q(c, a): 0 after its backup; when V(c') changes by d, it grows by gamma n(c, a, c') /
 * n(c, a) |d| for each a. A pass over the classes backs up those above a level, which then falls to
 * an eighth of the highest priority that is left. It is over when that is at most (1 - gamma)
 * tolerance: then V is within the tolerance of its fixed point. A priority is the upper half of a
 * binary32, rounded up; its order is that of whole numbers. `classes` backups are called a sweep.
 * Where predecessors do not fit (predecessors.h), value iteration is done instead. */
#ifndef RLVC_SRC_VALUE_ITERATION_H
#define RLVC_SRC_VALUE_ITERATION_H

#include "../base/mean.h"
#include "predecessors.h"
#include "../tree/values.h"

typedef struct rlvc_solver {
    rlvc_sum sum;
    rlvc_predecessors predecessors;
    float residual; /* max |V_new - V_old| so far in this sweep; at the end, of the last sweep.
                       Prioritized: |V_new - V_old| of the last backup; at the end, the highest
                       priority */
    float largest;  /* max |V| likewise */
    uint32_t sweeps;
    uint32_t class_id; /* where the sweep is: class, action, transition */
    uint32_t action;
    uint32_t transition; /* or predecessor */
    uint16_t level;      /* prioritized: classes above it are backed up in this pass; */
    uint16_t highest;    /* the highest priority left by this pass; */
    uint16_t backups;    /* since the last whole sweep */
    uint8_t prioritized;
    uint8_t turned;  /* the predecessors are there */
    uint8_t improve; /* policy iteration */
    uint8_t changed; /* the policy, in this improvement */
    uint8_t phase;
    uint8_t done;
} rlvc_solver;

/* What does not change during a solution. */
typedef struct rlvc_solving {
    rlvc_sample *transition; /* the model's: see model.h */
    uint32_t classes;
    uint32_t max_sweeps;
    float discount;
    float tolerance;
    uint32_t slots;     /* samples that the array of the transitions has room for; */
    uint16_t *priority; /* [classes], zeros at the end: both for prioritized sweeping alone */
} rlvc_solving;

void rlvc_solver_begin(rlvc_solver *solver, uint8_t kind);

/* @return the work, at most budget (>= 1): a unit for each transition and each pair, in each sweep;
 *         prioritized, a unit for each of a class that is backed up, for each predecessor of it and
 * one more, and for each class in each pass; two for each class besides, and those of
 *         rlvc_predecessors_step. */
uint32_t rlvc_solver_step(rlvc_solver *solver, const rlvc_solving *solving, rlvc_values *values,
                          uint32_t budget);

/* The cursor as words, for a snapshot. */
void rlvc_solver_mark(const rlvc_solver *solver, uint32_t word[10]);

/* Puts a cursor that has just begun where such words, which need not be trusted, say.
 * @return 0 if it cannot be there. O(1); prioritized, that of rlvc_predecessors_step. */
int rlvc_solver_restore(rlvc_solver *solver, const rlvc_solving *solving, const rlvc_values *values,
                        const uint32_t word[10]);

#endif
