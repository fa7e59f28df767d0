/* SPDX-License-Identifier: MIT */
/* Directed exploration: see explore.h. */
#include "rlvc/float_rules.h"

#include "explore.h"

#define ENOUGH 8u
#define PERSISTENCE 4.0f
#define MIN_TRIED_MIN 3u
#define MEAN_PARTS 4u

void rlvc_explorer_carve(rlvc_explorer *explorer, rlvc_arena *arena, const rlvc_config *config) {
    uint32_t pairs = config->classes * config->actions;
    explorer->count = rlvc_arena_carve(arena, pairs, sizeof *explorer->count);
    explorer->to_novel = rlvc_arena_carve(arena, config->classes, sizeof *explorer->to_novel);
}

void rlvc_explorer_clear(rlvc_explorer *explorer, uint32_t actions) {
    for (uint32_t a = 0; a < actions; a++)
        explorer->count[a] = 0;
    explorer->to_novel[0] = RLVC_NO_ACTION;
    explorer->min_tried = 0;
    explorer->last = RLVC_NO_ACTION;
}

static uint8_t *counts_of(const rlvc_explorer *explorer, uint32_t actions, uint32_t class_id) {
    return explorer->count + (size_t)class_id * actions;
}

void rlvc_explorer_inherit(rlvc_explorer *explorer, uint32_t actions, uint32_t new_class,
                           uint32_t old_class) {
    for (uint32_t a = 0; a < actions; a++)
        counts_of(explorer, actions, new_class)[a] = counts_of(explorer, actions, old_class)[a];
    explorer->to_novel[new_class] = explorer->to_novel[old_class];
}

void rlvc_explorer_join(rlvc_explorer *explorer, uint32_t actions, uint32_t class_id,
                        uint32_t other) {
    for (uint32_t a = 0; a < actions; a++) {
        uint8_t *count = counts_of(explorer, actions, class_id) + a;
        uint32_t sum = (uint32_t)*count + counts_of(explorer, actions, other)[a];
        *count = (uint8_t)(sum < UINT8_MAX ? sum : UINT8_MAX);
    }
}

uint8_t rlvc_explorer_min_tried(uint32_t interactions, uint32_t pairs) {
    uint32_t count = interactions / MEAN_PARTS / pairs;
    count = count > MIN_TRIED_MIN ? count : MIN_TRIED_MIN;
    return (uint8_t)(count < UINT8_MAX ? count : UINT8_MAX);
}

/* w(a). */
static float weight(const rlvc_explorer *explorer, uint32_t n, uint32_t action) {
    static const float weight_of[ENOUGH + 1u] = {
        1.0f,           1.0f / 16.0f,   1.0f / 81.0f,   1.0f / 256.0f, 1.0f / 625.0f,
        1.0f / 1296.0f, 1.0f / 2401.0f, 1.0f / 4096.0f, 1.0f / 6561.0f}; /* (1 + n)^-4 */
    float alone = weight_of[n < ENOUGH ? n : ENOUGH];
    return action == explorer->last ? PERSISTENCE * alone : alone;
}

static uint32_t draw(const rlvc_explorer *explorer, uint32_t actions, uint32_t class_id,
                     rlvc_rng *rng) {
    const uint8_t *count = counts_of(explorer, actions, class_id);
    float sum = 0.0f;
    for (uint32_t a = 0; a < actions; a++)
        sum += weight(explorer, count[a], a);
    float left = rlvc_rng_uniform(rng) * sum;
    uint32_t action = 0;
    while (action + 1u < actions && left >= weight(explorer, count[action], action)) {
        left -= weight(explorer, count[action], action);
        action++;
    }
    return action;
}

/* The action that goes after little-tried pairs. */
static uint32_t seek(const rlvc_explorer *explorer, uint32_t actions, uint32_t class_id,
                     rlvc_rng *rng) {
    const uint8_t *count = counts_of(explorer, actions, class_id);
    uint32_t action = 0, to_novel = explorer->to_novel[class_id];
    for (uint32_t a = 1; a < actions; a++)
        action = count[a] < count[action] ? a : action;
    if (count[action] < explorer->min_tried)
        return action;
    return to_novel != RLVC_NO_ACTION ? to_novel : draw(explorer, actions, class_id, rng);
}

uint32_t rlvc_explorer_choose(const rlvc_explorer *explorer, uint32_t actions, uint32_t class_id,
                              rlvc_rng *rng) {
    if (explorer->min_tried > 0 && rlvc_rng_uniform(rng) < 0.5f)
        return seek(explorer, actions, class_id, rng);
    return draw(explorer, actions, class_id, rng);
}

void rlvc_explorer_note(rlvc_explorer *explorer, uint32_t actions, uint32_t class_id,
                        uint32_t action) {
    uint8_t *count = counts_of(explorer, actions, class_id) + action;
    *count = (uint8_t)(*count + (*count < UINT8_MAX));
    explorer->last = (uint8_t)action;
}

int rlvc_explorer_check(const rlvc_explorer *explorer, uint32_t actions, uint32_t classes) {
    if (explorer->last != RLVC_NO_ACTION && explorer->last >= actions)
        return 0;
    for (uint32_t c = 0; c < classes; c++) {
        if (explorer->to_novel[c] != RLVC_NO_ACTION && explorer->to_novel[c] >= actions)
            return 0;
    }
    return 1;
}
