/* SPDX-License-Identifier: MIT */
/* Truncated discounted returns: see returns.h. */
#include "returns.h"

void rlvc_window_begin(rlvc_window *window, uint32_t position) {
    window->position = position;
    window->offset = 0;
    window->summing = 0;
    window->defined = 0;
    window->done = 0;
    window->value = 0.0f;
}

/* May interaction i of the window be part of it? */
static int admits(const rlvc_window *window, const rlvc_returns *returns) {
    uint64_t position = (uint64_t)window->position + window->offset;
    if (position >= returns->end)
        return 0;
    uint8_t flags = returns->replay->flags[rlvc_replay_slot(returns->replay, (uint32_t)position)];
    /* A slot without an interaction is where an episode was truncated or torn. */
    if (!(flags & RLVC_SLOT_STORED) || !(flags & RLVC_SLOT_EXPLOITED))
        return 0;
    return window->offset == returns->horizon || !(flags & RLVC_SLOT_TERMINATED) ||
           returns->continuing;
}

uint32_t rlvc_window_step(rlvc_window *window, const rlvc_returns *returns, uint32_t budget) {
    uint32_t used = 0;
    while (used < budget && !window->done) {
        used++;
        if (!window->summing) {
            if (!admits(window, returns))
                window->done = 1;
            else if (window->offset == returns->horizon)
                window->summing = 1;
            else
                window->offset++;
        } else {
            uint32_t slot = rlvc_replay_slot(returns->replay, window->position + window->offset);
            window->value = returns->replay->reward[slot] + returns->discount * window->value;
            window->defined = window->done = window->offset == 0;
            window->offset -= window->offset != 0;
        }
    }
    return used;
}
