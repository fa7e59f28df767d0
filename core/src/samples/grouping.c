/* SPDX-License-Identifier: MIT */
/* Grouping samples by class and action: see grouping.h. */
#include "rlvc/float_rules.h"

#include "grouping.h"

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

/* The phases that pass over the ring, a sample at a time. */
static uint32_t step_samples(rlvc_grouping_cursor *grouping, const rlvc_target_input *input,
                             rlvc_sample *sample, uint32_t *first, uint32_t budget) {
    if (grouping->at >= input->returns.end) {
        enter(grouping, grouping->phase == COUNT ? SUM : SHIFT);
        return 0;
    }
    rlvc_target_cursor *target = &grouping->target;
    uint32_t used = rlvc_target_step(target, input, budget);
    if (!target->done)
        return used;
    if (target->defined) {
        const rlvc_replay *replay = input->returns.replay;
        uint32_t slot = rlvc_replay_slot(replay, grouping->at);
        size_t pair = rlvc_values_pair(input->values, replay->label[slot], replay->action[slot]);
        if (grouping->phase == COUNT) {
            first[pair + 1u]++;
        } else {
            sample[first[pair]].key = target->key;
            sample[first[pair]].slot = slot;
            first[pair]++;
        }
    }
    rlvc_target_begin(target, ++grouping->at);
    return used;
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
