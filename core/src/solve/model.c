/* SPDX-License-Identifier: MIT */
/* The sparse class-level model: see model.h. */
#include "rlvc/float_rules.h"

#include "model.h"

#include "../base/solver_select.h"

enum { GROUP, OPEN, REWARD, SORT, COUNT, DONE };

void rlvc_model_begin(rlvc_model_cursor *model, uint32_t pairs) {
    rlvc_grouping_begin(&model->grouping, pairs);
    model->pair = 0;
    model->end = 0;
    model->packed = 0;
    model->phase = GROUP;
    model->done = 0;
}

/* Takes up the next pair. Its end must be read before first[] is overwritten with packed places,
 * and its begin is the end of the one before. */
static void open_pair(rlvc_model_cursor *model, rlvc_values *values) {
    if (model->pair == model->grouping.pairs) {
        values->begin.transition[model->pair] = model->packed;
        model->phase = DONE;
        model->done = 1;
        return;
    }
    model->begin = model->end;
    model->end = values->begin.sample[model->pair + 1u];
    values->begin.transition[model->pair] = model->packed;
    if (model->end > model->begin)
        values->tried[model->pair] = model->end - model->begin;
    model->at = model->begin;
    rlvc_sum_clear(&model->sum);
    model->phase = REWARD;
}

static void add_reward(rlvc_model_cursor *model, const rlvc_replay *replay, rlvc_values *values,
                       rlvc_rows rows, void *scratch) {
    if (model->at < model->end) {
        rlvc_sum_add(&model->sum, replay->reward[rows.sample[model->at++].slot], 1);
        return;
    }
    values->pair.reward[model->pair] = rlvc_sum_mean(&model->sum);
    if (RLVC_HAS_UNDISCOUNTED)
        rlvc_values_note_reward(values, model->pair);
    model->at = model->begin;
    rlvc_sort_begin(&model->sort, rows.sample + model->begin, model->end - model->begin, scratch);
    model->phase = SORT;
}

/* Counts a sample to the transition before it, if that leads to the same class. Packing goes on in
 * place, since there are never more transitions than samples. */
static void count_sample(rlvc_model_cursor *model, const rlvc_values *values, rlvc_rows rows) {
    if (model->at == model->end) {
        model->pair++;
        model->phase = OPEN;
        return;
    }
    rlvc_transition *transition = rows.transition;
    uint32_t next = rows.sample[model->at++].key;
    if (model->packed > values->begin.transition[model->pair] &&
        transition[model->packed - 1u].next == next) {
        transition[model->packed - 1u].count++;
        return;
    }
    transition[model->packed].next = next;
    transition[model->packed++].count = 1;
}

#define REWARD_UNITS 2u /* adding is arithmetic, where other units but look */

/* The units that the phase needs to get on; a step of the sort is not divided further. */
static uint32_t needed(const rlvc_model_cursor *model) {
    return model->phase == SORT ? RLVC_BUDGET_MIN : model->phase == REWARD ? REWARD_UNITS : 1u;
}

uint32_t rlvc_model_step(rlvc_model_cursor *model, const rlvc_target_input *input,
                         rlvc_values *values, rlvc_rows rows, void *scratch, uint32_t budget) {
    uint32_t used = 0;
    while (!model->done && budget - used >= needed(model)) {
        switch (model->phase) {
        case GROUP:
            used += rlvc_grouping_step(&model->grouping, input, rows.sample, values->begin.sample,
                                       budget - used);
            model->phase = model->grouping.done ? OPEN : GROUP;
            break;
        case OPEN:
            open_pair(model, values);
            used++;
            break;
        case REWARD:
            add_reward(model, input->returns.replay, values, rows, scratch);
            used += REWARD_UNITS;
            break;
        case SORT:
            used += rlvc_sort_step(&model->sort, budget - used);
            model->phase = model->sort.done ? COUNT : SORT;
            break;
        default:
            count_sample(model, values, rows);
            used++;
            break;
        }
    }
    return used;
}

void rlvc_model_single(rlvc_model_cursor *model, const rlvc_target_input *input,
                       rlvc_values *values, rlvc_rows rows, void *scratch) {
    if (model->phase == GROUP) {
        (void)rlvc_grouping_step(&model->grouping, input, rows.sample, values->begin.sample, 1);
        model->phase = model->grouping.done ? OPEN : GROUP;
    } else if (model->phase == SORT) {
        if (!model->sort.done)
            rlvc_sort_single(&model->sort);
        model->phase = model->sort.done ? COUNT : SORT;
    } else {
        (void)rlvc_model_step(model, input, values, rows, scratch, needed(model));
    }
}

void rlvc_model_mark(const rlvc_model_cursor *model, uint32_t word[8]) {
    word[0] = model->phase;
    if (model->phase == GROUP) {
        rlvc_grouping_mark(&model->grouping, word + 1);
        return;
    }
    word[1] = model->pair;
    word[2] = model->at;
    if (model->phase == SORT)
        rlvc_sort_mark(&model->sort, word + 3);
}

uint32_t rlvc_model_add(rlvc_sum *sum, const rlvc_transition *transition, uint32_t *at,
                        uint32_t end, uint32_t budget, const float *value, float ended) {
    rlvc_sum total = *sum;
    uint32_t from = *at;
    uint32_t to = end - from < budget ? end : from + budget;
    for (uint32_t i = from; i < to; i++) {
        uint32_t next = transition[i].next;
        rlvc_sum_add(&total, next == RLVC_NO_CLASS ? ended : value[next], transition[i].count);
    }
    *sum = total;
    *at = to;
    return to - from;
}
