/* SPDX-License-Identifier: MIT */
/* Truncated discounted returns: see returns.h. */
#include "rlvc/float_rules.h"

#include "returns.h"

void rlvc_return_begin(rlvc_return_cursor *window, uint32_t position) {
    window->position = position;
    window->offset = 0;
    window->summing = 0;
    window->defined = 0;
    window->done = 0;
    window->value = 0.0f;
}

/* May interaction i of the window be part of it? */
static int admits(const rlvc_return_cursor *window, const rlvc_return_input *input) {
    uint64_t position = (uint64_t)window->position + window->offset;
    if (position >= input->end)
        return 0;
    uint8_t flags = input->replay->flags[rlvc_replay_slot(input->replay, (uint32_t)position)];
    /* A slot without an interaction is where an episode was truncated or interrupted. */
    if (!(flags & RLVC_SLOT_STORED) || !(flags & RLVC_SLOT_EXPLOITED))
        return 0;
    return window->offset == input->horizon || !(flags & RLVC_SLOT_TERMINATED) || input->continuing;
}

uint32_t rlvc_return_step(rlvc_return_cursor *window, const rlvc_return_input *input,
                          uint32_t budget) {
    uint32_t used = 0;
    while (used < budget && !window->done) {
        used++;
        if (!window->summing) {
            if (!admits(window, input))
                window->done = 1;
            else if (window->offset == input->horizon)
                window->summing = 1;
            else
                window->offset++;
        } else {
            uint32_t slot = rlvc_replay_slot(input->replay, window->position + window->offset);
            window->value = input->replay->reward[slot] + input->discount * window->value;
            window->defined = window->done = window->offset == 0;
            window->offset -= window->offset != 0;
        }
    }
    return used;
}
