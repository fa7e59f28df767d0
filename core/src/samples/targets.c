/* SPDX-License-Identifier: MIT */
/* The two criteria: see targets.h. */
#include "targets.h"

#include "../base/float_math.h"

uint32_t rlvc_key_of_target(float target) {
    uint32_t bits = rlvc_bits_of(target + 0.0f);
    return bits & 0x80000000u ? ~bits : bits | 0x80000000u;
}

float rlvc_target_of_key(uint32_t key) {
    return rlvc_float_of(key & 0x80000000u ? key & 0x7fffffffu : ~key);
}

int rlvc_aliasing_distinct(const rlvc_aliasing *aliasing, uint32_t lowest, uint32_t key) {
    if (aliasing->gap > 0.0f)
        return rlvc_target_of_key(key) - rlvc_target_of_key(lowest) > aliasing->gap;
    return key != lowest;
}

void rlvc_keyed_begin(rlvc_keyed *keyed, uint32_t position) {
    rlvc_window_begin(&keyed->window, position);
    keyed->key = 0;
    keyed->defined = 0;
    keyed->done = 0;
}

/* The class of s' of a stored interaction; RLVC_NO_CLASS if it terminated. */
static uint32_t successor(const rlvc_replay *replay, uint32_t slot) {
    return rlvc_replay_linked(replay, slot) ? replay->label[rlvc_replay_next(replay, slot)]
                                            : RLVC_NO_CLASS;
}

static float bellman_target(const rlvc_aliasing *aliasing, uint32_t slot) {
    const rlvc_replay *replay = aliasing->returns.replay;
    uint32_t next = successor(replay, slot);
    float value = next == RLVC_NO_CLASS ? 0.0f : aliasing->values->target[next];
    return replay->reward[slot] + aliasing->returns.discount * value;
}

uint32_t rlvc_keyed_step(rlvc_keyed *keyed, const rlvc_aliasing *aliasing, uint32_t budget) {
    if (aliasing->kind == RLVC_CRITERION_RETURNS) {
        uint32_t used = rlvc_window_step(&keyed->window, &aliasing->returns, budget);
        keyed->done = keyed->window.done;
        keyed->defined = keyed->window.defined;
        keyed->key = rlvc_key_of_target(keyed->window.value);
        return used;
    }
    const rlvc_replay *replay = aliasing->returns.replay;
    uint32_t slot = rlvc_replay_slot(replay, keyed->window.position);
    keyed->done = 1;
    keyed->defined = (replay->flags[slot] & RLVC_SLOT_STORED) != 0;
    if (keyed->defined)
        keyed->key = aliasing->kind == RLVC_KEY_SUCCESSOR
                         ? successor(replay, slot)
                         : rlvc_key_of_target(bellman_target(aliasing, slot));
    return 1;
}
