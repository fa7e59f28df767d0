/* SPDX-License-Identifier: MIT */
/* Tables by class and action: see values.h. */
#include "rlvc/float_rules.h"

#include "values.h"

void rlvc_values_carve(rlvc_values *values, rlvc_arena *arena, const rlvc_config *config) {
    uint32_t pairs = config->classes * config->actions;
    values->q = rlvc_arena_carve(arena, pairs, sizeof *values->q);
    values->pair.reward = rlvc_arena_carve(arena, pairs, sizeof *values->pair.reward);
    values->tried = rlvc_arena_carve(arena, pairs, sizeof *values->tried);
    values->begin.sample = rlvc_arena_carve(arena, pairs + 1u, sizeof *values->begin.sample);
    values->value = rlvc_arena_carve(arena, config->classes, sizeof *values->value);
    values->policy = rlvc_arena_carve(arena, config->classes, sizeof *values->policy);
    values->trial = rlvc_arena_carve(arena, config->classes, sizeof *values->trial);
    values->target = config->solver == RLVC_SOLVER_Q_LEARNING || config->solver == RLVC_SOLVER_SARSA
                         ? values->pair.target
                         : values->value;
    values->actions = config->actions;
}

void rlvc_values_clear(rlvc_values *values) {
    for (uint32_t a = 0; a < values->actions; a++) {
        values->q[a] = 0.0f;
        values->pair.reward[a] = 0.0f;
        values->tried[a] = 0;
    }
    values->value[0] = 0.0f;
    values->policy[0] = 0;
    values->trial[0] = 0;
}

void rlvc_values_note_reward(rlvc_values *values, size_t pair) {
    const float reward = values->pair.reward[pair];
    const float size = reward < 0.0f ? -reward : reward;
    if (pair == 0 || size > values->reward_most)
        values->reward_most = size;
}

void rlvc_values_inherit(rlvc_values *values, uint32_t new_class, uint32_t old_class) {
    for (uint32_t a = 0; a < values->actions; a++) {
        size_t to = rlvc_values_pair(values, new_class, a);
        size_t from = rlvc_values_pair(values, old_class, a);
        values->q[to] = values->q[from];
        values->pair.reward[to] = values->pair.reward[from];
        values->tried[to] = values->tried[from];
    }
    values->value[new_class] = values->value[old_class];
    values->policy[new_class] = values->policy[old_class];
    values->trial[new_class] = values->trial[old_class];
}

void rlvc_values_forget(rlvc_values *values, uint32_t class_id) {
    for (uint32_t a = 0; a < values->actions; a++)
        values->tried[rlvc_values_pair(values, class_id, a)] = 0;
}

uint32_t rlvc_values_greedy(const rlvc_values *values, uint32_t class_id) {
    uint32_t best = values->actions;
    for (uint32_t a = 0; a < values->actions; a++) {
        size_t pair = rlvc_values_pair(values, class_id, a);
        if (!rlvc_values_counts(values, pair))
            continue;
        if (best == values->actions ||
            values->q[pair] > values->q[rlvc_values_pair(values, class_id, best)])
            best = a;
    }
    return best == values->actions ? values->policy[class_id] : best;
}

float rlvc_values_best(const rlvc_values *values, uint32_t class_id) {
    size_t pair = rlvc_values_pair(values, class_id, rlvc_values_greedy(values, class_id));
    return rlvc_values_counts(values, pair) ? values->q[pair] : values->value[class_id];
}

static int is_number(float x) {
    return x - x == 0.0f;
}

int rlvc_values_check(const rlvc_values *values, uint32_t classes) {
    for (uint32_t c = 0; c < classes; c++) {
        if (values->policy[c] >= values->actions || values->trial[c] >= values->actions ||
            !is_number(values->value[c]))
            return 0;
        for (uint32_t a = 0; a < values->actions; a++) {
            if (!is_number(values->q[rlvc_values_pair(values, c, a)]))
                return 0;
        }
    }
    return 1;
}
