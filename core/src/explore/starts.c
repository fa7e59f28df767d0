/* SPDX-License-Identifier: MIT */
/* Where episodes begin: see starts.h. */
#include "rlvc/float_rules.h"

#include "starts.h"

/* Nothing tells whether the oldest interaction is the first of its episode: it is not counted. */
void rlvc_starts_begin(rlvc_starts_cursor *starts, uint32_t end) {
    starts->position = 1;
    starts->end = end;
    starts->episodes = 0;
    starts->once = 0;
}

uint32_t rlvc_starts_step(rlvc_starts_cursor *starts, const rlvc_replay *replay, uint32_t *begun,
                          uint32_t budget) {
    uint32_t used = 0;
    for (; used < budget && starts->position < starts->end; used++) {
        const uint32_t before = rlvc_replay_slot(replay, starts->position++ - 1u);
        if (rlvc_replay_linked(replay, before))
            continue;
        const uint32_t here = ++begun[replay->label[rlvc_replay_next(replay, before)]];
        starts->episodes++;
        if (here == 1u)
            starts->once++;
        else if (here == 2u)
            starts->once--;
    }
    return used;
}

float rlvc_starts_chance(const rlvc_starts_cursor *starts) {
    return starts->episodes == 0 ? 0.0f : (float)starts->once / (float)starts->episodes;
}
