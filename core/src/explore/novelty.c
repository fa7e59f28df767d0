/* SPDX-License-Identifier: MIT */
/* How near a class is to what was little tried: see novelty.h. */
#include "rlvc/float_rules.h"

#include "novelty.h"

#include "../base/solver_select.h"
#include "../solve/model.h"

#define NOVELTY_DISCOUNT 0.95f
#define OUT_OF_REACH 0.001f

static void begin_class(rlvc_novelty_cursor *cursor) {
    cursor->best = 0.0f;
    cursor->action_best = 0;
    cursor->action = 0;
}

static void begin_sweep(rlvc_novelty_cursor *cursor) {
    cursor->largest = 0.0f;
    cursor->class_id = 0;
    cursor->transition = 0;
    rlvc_sum_clear(&cursor->sum);
    begin_class(cursor);
}

static void clear(float *nearness, uint32_t classes) {
    for (uint32_t c = 0; c < classes; c++)
        nearness[c] = 0.0f;
}

void rlvc_novelty_begin(rlvc_novelty_cursor *cursor, const rlvc_solver_input *input,
                        rlvc_values *values, uint32_t end) {
    clear(values->pair.nearness, input->classes);
    if (RLVC_STARTS) {
        rlvc_starts_begin(&cursor->starts, end);
        cursor->counting = 1;
    }
    cursor->sweeps = 0;
    cursor->done = 0;
    begin_sweep(cursor);
}

/* Looks where episodes began, and then goes on to the first sweep. */
static uint32_t count_starts(rlvc_novelty_cursor *cursor, const rlvc_solver_input *input,
                             rlvc_values *values, const rlvc_replay *replay, uint32_t budget) {
    uint32_t used = rlvc_starts_step(&cursor->starts, replay, values->pair.begun, budget);
    if (used == 0) {
        cursor->counting = 0;
        cursor->ended = rlvc_starts_chance(&cursor->starts);
        clear(values->pair.nearness, input->classes);
    }
    return used;
}

/* U(c), once every U(c, a) of the class is there. */
static void close_class(rlvc_novelty_cursor *cursor, const rlvc_solver_input *input,
                        float *nearness, rlvc_explorer *explorer) {
    uint32_t c = cursor->class_id;
    float change = cursor->best - nearness[c];
    cursor->largest = change > cursor->largest ? change : cursor->largest;
    nearness[c] = cursor->best;
    int leads = cursor->best > OUT_OF_REACH && cursor->best < 1.0f;
    explorer->to_novel[c] = leads ? cursor->action_best : (uint8_t)RLVC_NO_ACTION;
    begin_class(cursor);
    if (++cursor->class_id < input->classes)
        return;
    cursor->sweeps++;
    cursor->done = cursor->largest <= OUT_OF_REACH || cursor->sweeps >= input->max_sweeps;
    begin_sweep(cursor);
}

/* U(c, a), once all its n transitions are added, and the mean of what they lead to is known. */
static void close_pair(rlvc_novelty_cursor *cursor, const rlvc_solver_input *input,
                       const rlvc_values *values, rlvc_explorer *explorer, rlvc_count n,
                       float mean) {
    size_t pair = rlvc_values_pair(values, cursor->class_id, cursor->action);
    float u = n < explorer->min_tried ? 1.0f : NOVELTY_DISCOUNT * mean;
    if (cursor->sweeps == 0 && explorer->count)
        explorer->count[pair] = (uint8_t)(n < UINT8_MAX ? n : UINT8_MAX);
    if (u > cursor->best) {
        cursor->best = u;
        cursor->action_best = (uint8_t)cursor->action;
    }
    rlvc_sum_clear(&cursor->sum);
    if (++cursor->action == values->actions)
        close_class(cursor, input, values->pair.nearness, explorer);
}

/* As many whole pairs as the budget allows, unless one is half done: the same arithmetic, with a
 * copy of the cursor, for the registers. @return the units. */
static uint32_t step_pairs(rlvc_novelty_cursor *cursor, const rlvc_solver_input *input,
                           const rlvc_values *values, rlvc_explorer *explorer, uint32_t budget) {
    rlvc_novelty_cursor now = *cursor;
    uint32_t used = 0;
    while (!now.done && now.sum.weight == 0) {
        const size_t pair = rlvc_values_pair(values, now.class_id, now.action);
        const uint32_t at = now.transition, end = values->begin.transition[pair + 1u];
        const uint32_t units = end - at + 1u;
        if (budget - used < units)
            break;
        const rlvc_sum sum = rlvc_model_sum(input->transition, at, end, values->pair.nearness,
                                            RLVC_STARTS ? now.ended : 0.0f);
        now.transition = end;
        close_pair(&now, input, values, explorer, sum.weight,
                   at < end ? rlvc_model_mean(&sum) : 0.0f);
        used += units;
    }
    *cursor = now;
    return used;
}

uint32_t rlvc_novelty_step(rlvc_novelty_cursor *cursor, const rlvc_solver_input *input,
                           rlvc_values *values, const rlvc_replay *replay, rlvc_explorer *explorer,
                           uint32_t budget) {
    if (RLVC_STARTS && cursor->counting) {
        uint32_t counted = count_starts(cursor, input, values, replay, budget);
        if (counted > 0)
            return counted;
    }
    uint32_t used = RLVC_AT_ONCE ? step_pairs(cursor, input, values, explorer, budget) : 0u;
    while (used < budget && !cursor->done) {
        size_t pair = rlvc_values_pair(values, cursor->class_id, cursor->action);
        uint32_t end = values->begin.transition[pair + 1u];
        if (cursor->transition < end) {
            used += rlvc_model_add(&cursor->sum, input->transition, &cursor->transition, end,
                                   budget - used, values->pair.nearness,
                                   RLVC_STARTS ? cursor->ended : 0.0f);
        } else {
            close_pair(cursor, input, values, explorer, cursor->sum.weight,
                       rlvc_sum_mean(&cursor->sum));
            used++;
        }
    }
    return used;
}

void rlvc_novelty_mark(const rlvc_novelty_cursor *cursor, uint32_t word[5]) {
    word[0] = cursor->sweeps;
    word[1] = cursor->class_id;
    word[2] = cursor->action;
    word[3] = cursor->transition;
    word[4] = RLVC_STARTS && cursor->counting ? cursor->starts.position : 0;
}
