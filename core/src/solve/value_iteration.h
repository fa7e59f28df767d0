/* SPDX-License-Identifier: MIT */
/* Batch solvers over the class-level model (section 2.3): value iteration and policy iteration.
 *
 * Both sweep over the classes,
 *     Q(c, a) := r(c, a) + gamma * sum over c' of n(c, a, c') / n(c, a) * V(c')
 * and put V(c) in place as they go (Gauss-Seidel). Value iteration takes V(c) := max_a Q(c, a),
 * that is equation (2). Policy iteration takes V(c) := Q(c, pi(c)) until that has settled, then
 * makes pi greedy, until nothing changes.
 *
 * A sweep contracts the error by gamma, so that after one that changed no V by more than delta, V
 * is within delta * gamma / (1 - gamma) of its fixed point: a sweep is the last when that is at
 * most config.tolerance. Where binary32 cannot resolve so much, a few units in the last place of
 * the largest value do.
 *
 * Value iteration on a large model, of more than RLVC_CLASSES_SMALL classes, is modified policy
 * iteration (Puterman and Shin 1978). After a sweep by all actions, which makes pi greedy, come
 * eight that evaluate it, V(c) := Q(c, pi(c)), for an n-th of the work each with n actions; so the
 * last sweep is one by all actions. Every other sweep goes from the last class to the first, so
 * that what is known of one class comes soon to those before it as well. An evaluation adds up
 * plainly, as what it rounds is made good by the next sweep by all actions. Small models, which
 * take no time, are solved by plain sweeps; so are those without a discount, where a policy need
 * not end.
 *
 * For gamma = 1 delta itself is held to the tolerance, and a class from which the model knows no
 * way to an end has no value: a sum of rewards that goes on for ever. A sweep adds a step to it. So
 * no V is taken further from 0 than half of max_sweeps times the greatest mean reward, as much as a
 * solution could add up otherwise: a class that comes there stays, and the others settle. */
#ifndef RLVC_SRC_VALUE_ITERATION_H
#define RLVC_SRC_VALUE_ITERATION_H

#include "../base/mean.h"
#include "../tree/values.h"
#include "../base/solver_select.h"
#include "../samples/rows.h"

typedef struct rlvc_solver_cursor {
    rlvc_sum sum;
    float residual; /* max |V_new - V_old| so far in this sweep; at the end, of the last sweep */
    float largest;  /* max |V| likewise */
    uint32_t sweeps;
    uint32_t class_id; /* where the sweep is: class, action, transition */
    uint32_t action;
    uint32_t transition;
    uint8_t improve;    /* policy iteration */
    uint8_t changed;    /* the policy, in this improvement */
    uint8_t endless;    /* in this sweep a V was held at its bound */
    uint8_t large;      /* value iteration on a large model, where this sweep */
    uint8_t evaluating; /* backs up but the greedy action of the last one by all; */
    uint8_t backwards;  /* goes from the last class to the first */
    uint8_t phase;
    uint8_t done;
} rlvc_solver_cursor;

/* What does not change during a solution. */
typedef struct rlvc_solver_input {
    const rlvc_transition *transition; /* the model's: see model.h */
    uint32_t classes;
    uint32_t max_sweeps;
    float discount;
    float tolerance;
} rlvc_solver_input;

/* What statistics.residual says of a solution that is done. O(1). */
static inline float rlvc_solver_residual(const rlvc_solver_cursor *solver) {
    return RLVC_HAS_UNDISCOUNTED && solver->endless ? RLVC_RESIDUAL_ENDLESS : solver->residual;
}

void rlvc_solver_begin(rlvc_solver_cursor *solver, uint8_t kind);

/* @return the work, at most budget (>= 1): a unit for each transition and each pair, in each sweep.
 */
uint32_t rlvc_solver_step(rlvc_solver_cursor *solver, const rlvc_solver_input *input,
                          rlvc_values *values, uint32_t budget);

/* The cursor as words, for a snapshot. */
void rlvc_solver_mark(const rlvc_solver_cursor *solver, uint32_t word[10]);

/* Puts a cursor that has just begun where such words, which need not be trusted, say.
 * @return 0 if it cannot be there. O(1). */
int rlvc_solver_restore(rlvc_solver_cursor *solver, const rlvc_solver_input *input,
                        const rlvc_values *values, const uint32_t word[10]);

#endif
