/* SPDX-License-Identifier: MIT */
/* The two criteria: see targets.h. */
#include "rlvc/float_rules.h"

#include "targets.h"

#include "../base/float_math.h"
#include "../base/solver_select.h"

uint32_t rlvc_target_key(float target) {
    uint32_t bits = rlvc_bits_of(target + 0.0f);
    return bits & 0x80000000u ? ~bits : bits | 0x80000000u;
}

float rlvc_target_of(uint32_t key) {
    return rlvc_float_of(key & 0x80000000u ? key & 0x7fffffffu : ~key);
}

int rlvc_target_distinct(const rlvc_target_input *input, uint32_t lowest, uint32_t key) {
    if (input->gap > 0.0f)
        return rlvc_target_of(key) - rlvc_target_of(lowest) > input->gap;
    return key != lowest;
}

void rlvc_target_begin(rlvc_target_cursor *target, uint32_t position) {
    rlvc_return_begin(&target->window, position);
    target->key = 0;
    target->defined = 0;
    target->done = 0;
}

/* The class of s' of a stored interaction; RLVC_NO_CLASS if it terminated. */
static uint32_t successor(const rlvc_replay *replay, uint32_t slot) {
    return rlvc_replay_linked(replay, slot) ? replay->label[rlvc_replay_next(replay, slot)]
                                            : RLVC_NO_CLASS;
}

static float bellman_target(const rlvc_target_input *input, uint32_t slot) {
    const rlvc_replay *replay = input->returns.replay;
    uint32_t next = successor(replay, slot);
    float value = next == RLVC_NO_CLASS ? 0.0f : input->values->target[next];
    return replay->reward[slot] + input->returns.discount * value;
}

uint32_t rlvc_target_key_at(const rlvc_target_input *input, uint32_t slot) {
    return input->kind == RLVC_TARGET_SUCCESSOR ? successor(input->returns.replay, slot)
                                                : rlvc_target_key(bellman_target(input, slot));
}

uint32_t rlvc_target_step(rlvc_target_cursor *target, const rlvc_target_input *input,
                          uint32_t budget) {
    if (RLVC_BY_RETURNS(input->kind)) {
        uint32_t used = rlvc_return_step(&target->window, &input->returns, budget);
        target->done = target->window.done;
        target->defined = target->window.defined;
        target->key = rlvc_target_key(target->window.value);
        return used;
    }
    const rlvc_replay *replay = input->returns.replay;
    uint32_t slot = rlvc_replay_slot(replay, target->window.position);
    target->done = 1;
    target->defined = (replay->flags[slot] & RLVC_SLOT_STORED) != 0;
    if (target->defined)
        target->key = rlvc_target_key_at(input, slot);
    return 1;
}
