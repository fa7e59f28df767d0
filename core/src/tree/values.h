/* SPDX-License-Identifier: MIT */
/* The tables of the class-level decision process: Q by class and action, V and the policy by
 * class. */
#ifndef RLVC_SRC_VALUES_H
#define RLVC_SRC_VALUES_H

#include "../base/arena.h"

/* No value that is learnt is further from 0: returns are sums of at most 2^31 rewards, or, with an
 * incremental solver, grow by a reward each interaction. 2^31 of them can be summed. */
#define RLVC_VALUE_MAX 1e28f

/* Tables with more than one content, at different times. */
typedef union rlvc_pair_floats {
    float *reward;   /* [classes_max][actions] mean reward: from the model to the solution */
    float *nearness; /* [classes_max] U(c): see novelty.h */
    uint32_t *begun; /* [classes_max] before U: see starts.h */
    float *squares;  /* [classes_max][actions] while pruning: see q_variance.h */
    float *target;   /* [classes_max] an incremental solver's copy of V */
} rlvc_pair_floats;

typedef union rlvc_pair_counts {
    uint32_t *sample;     /* [classes_max * actions + 1] where the samples of (c, a) begin, */
    uint32_t *transition; /* or its transitions: see rows.h */
    uint32_t *targets;    /* [classes_max][actions] while pruning: see q_variance.h */
} rlvc_pair_counts;

typedef struct rlvc_values {
    rlvc_pair_floats pair;
    rlvc_pair_counts begin;
    float *q;        /* [classes_max][actions] Q(c, a) */
    float *target;   /* [classes_max] V as the targets of a learning step have it: `value` of a
                        batch solver; of an incremental one, whose V changes with each
                        observation, the copy pair.target */
    uint32_t *tried; /* [classes_max][actions] interactions behind Q(c, a); 0: untried */
    float *value;    /* [classes_max] V(c) */
    uint8_t *policy; /* [classes_max] the greedy action of the last solution */
    uint8_t *trial;  /* [classes_max] the policy under evaluation (policy iteration) */
    uint32_t actions;
    float reward_most; /* the greatest |mean reward| of a pair in the model */
} rlvc_values;

/* Carves the tables. O(1). */
void rlvc_values_carve(rlvc_values *values, rlvc_arena *arena, const rlvc_config *config);

/* Makes class 0 unknown: untried, worth nothing, action 0. O(actions). */
void rlvc_values_clear(rlvc_values *values);

/* Where the pair (c, a) stands in a table. O(1). */
static inline size_t rlvc_values_pair(const rlvc_values *values, uint32_t class_id,
                                      uint32_t action) {
    return (size_t)class_id * values->actions + action;
}

/* Has the model's reward_most include the mean reward of a pair. O(1). */
void rlvc_values_note_reward(rlvc_values *values, size_t pair);

/* Gives a new class what is known of the class that it was split from. O(actions). */
void rlvc_values_inherit(rlvc_values *values, uint32_t new_class, uint32_t old_class);

/* Makes every action of a class untried: the interactions behind its Q were not its own.
 * O(actions). */
void rlvc_values_forget(rlvc_values *values, uint32_t class_id);

/* Is the pair part of the maximum over actions? An untried one is not. O(1). */
static inline int rlvc_values_counts(const rlvc_values *values, size_t pair) {
    return values->tried[pair] > 0;
}

/* The greedy action argmax_a Q(c, a) among the pairs that count; of equals the lowest. If none
 * counts, the one that was greedy before. O(actions). */
uint32_t rlvc_values_greedy(const rlvc_values *values, uint32_t class_id);

/* max_a Q(c, a) likewise; V(c) as it was if no pair counts. O(actions). */
float rlvc_values_best(const rlvc_values *values, uint32_t class_id);

/* @return 1 if every number is sound. O(classes * actions). */
int rlvc_values_check(const rlvc_values *values, uint32_t classes);

#endif
