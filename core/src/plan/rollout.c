/* SPDX-License-Identifier: MIT */
/* Rollouts in the model: see rollout.h. */
#include "rlvc/float_rules.h"

#include "rollout.h"

#include "cells.h"

#define ALIVE_LEAST 0.01f
#define RANDOM_SHARE 0.02f

void rlvc_rollout_begin(rlvc_rollout *rollout, const rlvc_rollout_input *in, const float *percept,
                        uint32_t start) {
    rlvc_rng rng;
    rlvc_rng_seed(&rng, in->seed + start * UINT32_C(0x9e3779b9));
    rollout->stream = rlvc_rng_next(&rng);
    for (uint32_t i = 0; i < in->model->basis.components; i++)
        rollout->s[i] = percept[i];
    rollout->box = NULL;
    rollout->alive = 1.0f;
    rollout->total = rollout->novelty = 0.0f;
    rollout->step = 0;
    rollout->plain = in->plain || (start & 1u);
    rollout->model = (start >> 1) & 1u;
    rollout->done = in->horizon == 0;
}

void rlvc_rollout_step(rlvc_rollout *rollout, const rlvc_rollout_input *in,
                       const rlvc_small_tree *policy, uint32_t *visits) {
    const rlvc_dynamics *dynamics = in->model + rollout->model;
    rlvc_outcome outcome;
    rlvc_rng rng;
    rlvc_rng_seed(&rng, rollout->stream + rollout->step);
    uint32_t leaf = rlvc_small_tree_leaf(policy, rollout->s), action = policy->node[leaf].action;
    if (visits)
        visits[leaf]++;
    if (rollout->box)
        rlvc_reach_note(rollout->box + (size_t)leaf * 2u * dynamics->basis.components, rollout->s,
                        dynamics->basis.components);
    if (!rollout->plain && rlvc_rng_uniform(&rng) < RANDOM_SHARE)
        action = rlvc_rng_below(&rng, dynamics->basis.actions);
    rlvc_dynamics_step(dynamics, rollout->s, action, &rng, &outcome);
    rollout->total +=
        rollout->alive * ((1.0f - outcome.end) * outcome.reward + outcome.end * outcome.end_reward);
    rollout->alive *= 1.0f - outcome.end;
    if (in->fresh)
        rollout->novelty +=
            rollout->alive * (float)rlvc_cells_mark(dynamics, rollout->s, in->fresh);
    rollout->step++;
    rollout->done = rollout->step == in->horizon || rollout->alive < ALIVE_LEAST;
}
