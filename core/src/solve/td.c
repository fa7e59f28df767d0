/* SPDX-License-Identifier: MIT */
/* Q-learning and Sarsa: see td.h. */
#include "rlvc/float_rules.h"

#include "td.h"

static void add(rlvc_td_updates *updates, uint32_t class_id, uint32_t action, float target) {
    rlvc_td_update *update = &updates->update[updates->count++];
    update->class_id = class_id;
    update->action = action;
    update->target = target;
}

/* Sarsa's update for the interaction before this one, now that its a' is known. */
static rlvc_status add_previous(rlvc_td_updates *updates, const rlvc_config *config,
                                const rlvc_domain *domain, const rlvc_tree *tree,
                                const rlvc_replay *replay, float q_now) {
    if (replay->count < 2)
        return RLVC_OK;
    uint32_t slot = rlvc_replay_slot(replay, replay->count - 2);
    if (!rlvc_replay_linked(replay, slot))
        return RLVC_OK;
    uint32_t class_id = 0;
    rlvc_status status =
        rlvc_tree_classify(tree, domain, rlvc_replay_percept(replay, slot), &class_id);
    if (status == RLVC_OK)
        add(updates, class_id, replay->action[slot],
            replay->reward[slot] + config->discount * q_now);
    return status;
}

rlvc_status rlvc_td_prepare(rlvc_td_updates *updates, const rlvc_config *config,
                            const rlvc_domain *domain, const rlvc_tree *tree,
                            const rlvc_replay *replay, const rlvc_values *values,
                            rlvc_choice choice, float reward, const void *next, uint8_t end) {
    int sarsa = config->solver == RLVC_SOLVER_SARSA;
    uint32_t class_id = 0, next_class = 0;
    uint32_t slot = rlvc_replay_slot(replay, replay->count - 1);
    updates->count = 0;
    rlvc_status status =
        rlvc_tree_classify(tree, domain, rlvc_replay_percept(replay, slot), &class_id);
    if (status == RLVC_OK && end != RLVC_TERMINATED)
        status = rlvc_tree_classify(tree, domain, next, &next_class);
    if (status == RLVC_OK && sarsa) {
        float q_now = values->q[rlvc_values_pair(values, class_id, choice.action)];
        status = add_previous(updates, config, domain, tree, replay, q_now);
    }
    if (status != RLVC_OK)
        return status;
    if (end == RLVC_TERMINATED)
        add(updates, class_id, choice.action, reward);
    else if (!sarsa || end == RLVC_TRUNCATED)
        add(updates, class_id, choice.action,
            reward + config->discount * values->value[next_class]);
    return RLVC_OK;
}

void rlvc_td_apply(const rlvc_td_updates *updates, float learning_rate, rlvc_values *values) {
    for (uint32_t i = 0; i < updates->count; i++) {
        const rlvc_td_update *update = &updates->update[i];
        size_t pair = rlvc_values_pair(values, update->class_id, update->action);
        values->q[pair] += learning_rate * (update->target - values->q[pair]);
        values->tried[pair] += values->tried[pair] < UINT32_MAX;
        values->value[update->class_id] = rlvc_values_best(values, update->class_id);
        values->policy[update->class_id] = (uint8_t)rlvc_values_greedy(values, update->class_id);
    }
}
