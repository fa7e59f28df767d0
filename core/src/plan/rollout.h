/* SPDX-License-Identifier: MIT */
/* Rollouts: what a policy earns from one start in the learnt dynamics.
 *
 * Whether the episode ends is not drawn. Each later reward is weighted by the probability that it
 * is reached.
 *
 * There are four kinds of rollouts, which take turns by the number of the start: in either of two
 * models, with random actions (one in fifty) or without. The models are fitted to different
 * samples, so that one does not confirm what a search finds in the errors of the other. Random
 * actions free a policy that goes in a circle. Rollouts without them do not disturb one that
 * balances.
 *
 * The random numbers of a step depend on the seed, the start and the step alone. So two policies
 * meet the same luck (common random numbers), however the work is sliced. */
#ifndef RLVC_SRC_ROLLOUT_H
#define RLVC_SRC_ROLLOUT_H

#include "../dynamics/dynamics.h"
#include "reach.h"

#define RLVC_ROLLOUT_MODELS 2u

typedef struct rlvc_rollout_input {
    const rlvc_dynamics *model; /* [RLVC_ROLLOUT_MODELS] */
    uint32_t horizon;
    uint32_t seed;
    uint8_t *fresh; /* optional: cells marked as visited; then new ones are counted */
    uint8_t plain;  /* 1: the policy's action always */
} rlvc_rollout_input;

typedef struct rlvc_rollout {
    uint32_t stream; /* the seeds of its steps begin here */
    float *s;        /* [components] */
    float *box;      /* optional: the boxes of the tree's nodes (reach.h), which it widens */
    float alive;     /* the probability that the episode goes on */
    float total;     /* expected return so far */
    float novelty;   /* new cells so far, each by the probability that it is reached */
    uint32_t step;
    uint8_t model; /* of the two */
    uint8_t plain; /* no action is random */
    uint8_t done;
} rlvc_rollout;

/* Begins at a percept, which is copied to the rollout's own s. O(components). */
void rlvc_rollout_begin(rlvc_rollout *rollout, const rlvc_rollout_input *in, const float *percept,
                        uint32_t start);

/* One step of the model. @param visits optional, of the policy's nodes. */
void rlvc_rollout_step(rlvc_rollout *rollout, const rlvc_rollout_input *in,
                       const rlvc_small_tree *policy, uint32_t *visits);

/* The multiplications of a step, about. */
static inline uint32_t rlvc_rollout_units(const rlvc_dynamics *dynamics) {
    return (dynamics->basis.components + 1u) * (dynamics->terms_max + 8u);
}

#endif
