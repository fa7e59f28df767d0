/* SPDX-License-Identifier: MIT */
/* Incremental solvers (section 2.3): Q-learning and Sarsa.
 *
 *     Q(c, a) := Q(c, a) + alpha (target - Q(c, a))
 *     Q-learning: target = r + gamma max_a' Q(c', a'), at once
 *     Sarsa:      target = r + gamma Q(c', a') with the action a' that was taken, so one step later
 *
 * and r alone where the episode terminated. Where it was truncated nobody acts after s', and Sarsa
 * too takes the maximum; where it was
 * interrupted, Sarsa's last update is not made. */
#ifndef RLVC_SRC_TD_H
#define RLVC_SRC_TD_H

#include "../samples/replay.h"
#include "../tree/tree.h"
#include "../tree/values.h"

/* What an observation is about to change in Q: made ready first, since classifying may fail, and
 * then carried out, which cannot. */
typedef struct rlvc_td_update {
    uint32_t class_id;
    uint32_t action;
    float target;
} rlvc_td_update;

typedef struct rlvc_td_updates {
    rlvc_td_update update[2];
    uint32_t count;
} rlvc_td_updates;

/* Makes the updates for an interaction whose s is the current percept of the replay and that is not
 * stored yet. O(depth) calls of exhibits().
 * @return RLVC_OK; RLVC_E_CALLBACK. */
rlvc_status rlvc_td_prepare(rlvc_td_updates *updates, const rlvc_config *config,
                            const rlvc_domain *domain, const rlvc_tree *tree,
                            const rlvc_replay *replay, const rlvc_values *values,
                            rlvc_choice choice, float reward, const void *next, uint8_t end);

/* Carries them out: Q, V and the policy of the classes concerned. O(actions). */
void rlvc_td_apply(const rlvc_td_updates *updates, float learning_rate, rlvc_values *values);

#endif
