/* SPDX-License-Identifier: MIT */
/* How sure Q is: see q_variance.h. */
#include "rlvc/float_rules.h"

#include "q_variance.h"

void rlvc_q_variance_measure(const rlvc_q_variance *variance, const rlvc_replay *replay,
                             const rlvc_values *values, float discount, uint32_t classes) {
    const size_t pairs = (size_t)classes * values->actions;
    for (size_t pair = 0; pair < pairs; pair++) {
        variance->squares[pair] = 0.0f;
        variance->count[pair] = 0;
    }
    for (uint32_t position = 0; position < replay->count; position++) {
        const uint32_t slot = rlvc_replay_slot(replay, position);
        float target = replay->reward[slot];
        if (!(replay->flags[slot] & RLVC_SLOT_STORED) || replay->label[slot] == RLVC_NO_CLASS)
            continue;
        if (rlvc_replay_linked(replay, slot)) {
            const uint16_t next = replay->label[rlvc_replay_next(replay, slot)];
            if (next == RLVC_NO_CLASS)
                continue;
            target += discount * values->value[next];
        }
        const size_t pair = rlvc_values_pair(values, replay->label[slot], replay->action[slot]);
        const float off = target - values->q[pair];
        variance->squares[pair] += off * off;
        variance->count[pair]++;
    }
}
