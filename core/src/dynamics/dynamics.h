/* SPDX-License-Identifier: MIT */
/* The learnt model of the world. It predicts s' and the reward of an action in s, and whether the
 * episode ends there.
 *
 * It consists of model trees (model_tree.h), one for each component of s' - s and one for the
 * reward of interactions that do not terminate, and of a tree of the endings (ending.h). A model
 * tree uses the short basis or the full one, whichever has the shorter description (tree_fit.h).
 * Predicted rewards stay within the range that was seen, predicted percepts within that range
 * widened by half of it. */
#ifndef RLVC_SRC_DYNAMICS_H
#define RLVC_SRC_DYNAMICS_H

#include "ending.h"
#include "tree_fit.h"

typedef struct rlvc_dynamics {
    rlvc_basis basis;
    rlvc_model_tree *tree; /* [components + 1], the last the reward's */
    rlvc_ending ending;
    float *low; /* [components] bounds of a percept */
    float *high;
    float reward_low;
    float reward_high;
    float *x; /* [terms_max] a row of the basis */
    uint32_t terms_max;
    uint32_t leaves_max;
} rlvc_dynamics;

typedef struct rlvc_dynamics_fit_cursor {
    rlvc_dynamics *dynamics;
    rlvc_experience *experience;
    rlvc_row_sample *sample;
    rlvc_tree_fit_space space;
    rlvc_model_tree spare;      /* the other basis's tree */
    rlvc_ending_window *window; /* [components] */
    float *sum;                 /* [components] */
    rlvc_sampling_cursor sampling;
    rlvc_tree_fit_cursor tree;
    rlvc_ending_fit_cursor ending;
    float moment;
    float length; /* of the tree with the short basis */
    uint32_t at;
    uint32_t output;
    uint8_t phase;
    uint8_t done;
} rlvc_dynamics_fit_cursor;

void rlvc_dynamics_carve(rlvc_dynamics *dynamics, rlvc_arena *arena, uint32_t components,
                         uint32_t actions, uint32_t leaves_max);

/* A fit's memory serves any number of models of the same shape. */
void rlvc_dynamics_fit_carve(rlvc_dynamics_fit_cursor *fit, rlvc_arena *arena, uint32_t components,
                             uint32_t actions, uint32_t leaves_max);

/* Begins to fit to a sample of the experience, which is frozen until the fit is done. There is an
 * interaction in what stays. O(1). */
void rlvc_dynamics_fit_begin(rlvc_dynamics_fit_cursor *fit, rlvc_dynamics *dynamics,
                             rlvc_experience *experience, rlvc_row_sample *sample, uint32_t seed);

/* As rlvc_tree_fit_step. */
uint32_t rlvc_dynamics_fit_step(rlvc_dynamics_fit_cursor *fit, uint32_t budget);

/* What happened in the model. */
typedef struct rlvc_outcome {
    float reward;     /* if the episode goes on */
    float end;        /* the probability that it ends */
    float end_reward; /* if it does */
} rlvc_outcome;

/* Turns s into s'. With an rng the leaves' noise is added to what they predict.
 * O((components + 1) * terms). */
void rlvc_dynamics_step(const rlvc_dynamics *dynamics, float *s, uint32_t action, rlvc_rng *rng,
                        rlvc_outcome *outcome);

#endif
