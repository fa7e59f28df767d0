/* SPDX-License-Identifier: MIT */
/* Grouping samples by class and action: see grouping.h. */
#include "rlvc/float_rules.h"

#include "grouping.h"

#include "../base/solver_select.h"

enum { ZERO, COUNT, SUM, FILL, SHIFT, DONE };

void rlvc_grouping_begin(rlvc_grouping_cursor *grouping, uint32_t pairs) {
    rlvc_target_begin(&grouping->target, 0);
    grouping->at = 0;
    grouping->pairs = pairs;
    grouping->phase = ZERO;
    grouping->done = 0;
}

static void enter(rlvc_grouping_cursor *grouping, uint8_t phase) {
    grouping->phase = phase;
    grouping->at = 0;
    grouping->done = phase == DONE;
    rlvc_target_begin(&grouping->target, 0);
}

/* Counts the interaction in a slot. @return its place, once all are counted; else null. */
static rlvc_sample *place_of(const rlvc_grouping_cursor *grouping, const rlvc_target_input *input,
                             rlvc_sample *sample, uint32_t *first, uint32_t slot) {
    const rlvc_replay *replay = input->returns.replay;
    const size_t pair = rlvc_values_pair(input->values, replay->label[slot], replay->action[slot]);
    if (grouping->phase == COUNT) {
        first[pair + 1u]++;
        return NULL;
    }
    sample += first[pair]++;
    sample->slot = slot;
    return sample;
}

/* Passes over the ring where a target is a return: looks at some interactions of a window. */
static uint32_t step_window(rlvc_grouping_cursor *grouping, const rlvc_target_input *input,
                            rlvc_sample *sample, uint32_t *first, uint32_t budget) {
    rlvc_target_cursor *target = &grouping->target;
    const uint32_t used = rlvc_target_step(target, input, budget);
    if (!target->done)
        return used;
    if (target->defined) {
        rlvc_sample *place = place_of(grouping, input, sample, first,
                                      rlvc_replay_slot(input->returns.replay, grouping->at));
        if (place)
            place->key = target->key;
    }
    rlvc_target_begin(target, ++grouping->at);
    return used;
}

/* ... where a target is of one interaction: as many of these as the budget allows. */
static uint32_t step_interactions(rlvc_grouping_cursor *grouping, const rlvc_target_input *input,
                                  rlvc_sample *sample, uint32_t *first, uint32_t budget) {
    const rlvc_replay *replay = input->returns.replay;
    uint32_t used = 0;
    for (; used < budget && grouping->at < input->returns.end; used++) {
        const uint32_t slot = rlvc_replay_slot(replay, grouping->at++);
        rlvc_sample *place = replay->flags[slot] & RLVC_SLOT_STORED
                                 ? place_of(grouping, input, sample, first, slot)
                                 : NULL;
        if (place)
            place->key = rlvc_target_key_at(input, slot);
    }
    return used;
}

/* The phases that pass over the ring. */
static uint32_t step_samples(rlvc_grouping_cursor *grouping, const rlvc_target_input *input,
                             rlvc_sample *sample, uint32_t *first, uint32_t budget) {
    if (grouping->at >= input->returns.end) {
        enter(grouping, grouping->phase == COUNT ? SUM : SHIFT);
        return 0;
    }
    return RLVC_BY_RETURNS(input->kind) ? step_window(grouping, input, sample, first, budget)
                                        : step_interactions(grouping, input, sample, first, budget);
}

/* The phases that pass over the table of pairs. FILL leaves in first[p] where p + 1 begins; SHIFT,
 * from the end, puts that right. */
static uint32_t step_pairs(rlvc_grouping_cursor *grouping, uint32_t *first) {
    uint32_t at = grouping->at;
    if (at > grouping->pairs) {
        enter(grouping, grouping->phase == ZERO ? COUNT : grouping->phase == SUM ? FILL : DONE);
        return 0;
    }
    if (grouping->phase == ZERO)
        first[at] = 0;
    else if (grouping->phase == SUM)
        first[at] += at == 0 ? 0 : first[at - 1u];
    else
        first[grouping->pairs - at] = at == grouping->pairs ? 0 : first[grouping->pairs - at - 1u];
    grouping->at++;
    return 1;
}

uint32_t rlvc_grouping_step(rlvc_grouping_cursor *grouping, const rlvc_target_input *input,
                            rlvc_sample *sample, uint32_t *first, uint32_t budget) {
    uint32_t used = 0;
    while (used < budget && !grouping->done) {
        if (grouping->phase == COUNT || grouping->phase == FILL)
            used += step_samples(grouping, input, sample, first, budget - used);
        else
            used += step_pairs(grouping, first);
    }
    return used;
}

void rlvc_grouping_mark(const rlvc_grouping_cursor *grouping, uint32_t word[4]) {
    word[0] = grouping->phase;
    word[1] = grouping->at;
    word[2] = grouping->target.window.offset;
    word[3] = grouping->target.window.summing;
}
