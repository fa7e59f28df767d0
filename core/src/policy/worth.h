/* SPDX-License-Identifier: MIT */
/* What policies are worth in the class-level model of the agent's ring: the agent's own, and one
 * that takes other actions in some classes.
 *
 * The model is of the interactions that the last learning step has labelled. Of a pair without any
 * the agent's Q stands for what follows. A policy is evaluated by sweeps,
 *     V(c) := r(c, a) + gamma * sum over c' of n(c, a, c') / n(c, a) * V(c')
 * until no V changes at all, since far from a reward all values are small. A small tree may take
 * several actions in one class, at different percepts. Then the worst of them counts in each sweep:
 * so its V is a lower bound.
 *
 * A policy that in each class takes an action whose Q, under the agent's policy, is no less than V
 * is worth as much (policy improvement). Ties differ by rounding, and so does what they add up to:
 * so what was chosen is evaluated afterwards. */
#ifndef RLVC_SRC_WORTH_H
#define RLVC_SRC_WORTH_H

#include "../agent/learn.h"

typedef struct rlvc_worth {
    const rlvc_agent *agent;
    rlvc_values model; /* Q and V of the agent's policy */
    rlvc_rows rows;
    float *least;    /* [classes] V of the policy that takes what is taken */
    uint64_t *taken; /* [classes] sets of actions */
    float spread;    /* of Q: its largest less its smallest */
    void *scratch;
} rlvc_worth;

/* Carves the tables. O(1). */
void rlvc_worth_carve(rlvc_worth *worth, rlvc_arena *arena, const rlvc_agent *agent);

/* Makes the model, and evaluates the agent's policy. O(interactions + transitions * sweeps). */
void rlvc_worth_begin(rlvc_worth *worth);

/* The actions that cost no more than `loss` (>= 0) in the next step, if the agent acts afterwards;
 * its own action is among them. Others are if both were tried three times. O(actions). */
uint64_t rlvc_worth_allowed(const rlvc_worth *worth, uint32_t class_id, float loss);

/* Makes the agent's action the one that is taken, in each class. O(classes). */
void rlvc_worth_take_none(rlvc_worth *worth);

/* Adds an action to those that are taken in a class. O(1). */
void rlvc_worth_take(rlvc_worth *worth, uint32_t class_id, uint32_t action);

/* Evaluates what is taken.
 * @return 1 if no class is worth less by more than `loss` (and rounding). As rlvc_worth_begin. */
int rlvc_worth_is_kept(rlvc_worth *worth, float loss);

/* The mean of values of the classes, each weighted by the interactions behind it. O(classes *
 * actions). */
float rlvc_worth_mean(const rlvc_worth *worth, const float *value);

#endif
