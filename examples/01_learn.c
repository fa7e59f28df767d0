/* SPDX-License-Identifier: MIT */
/* Introduces the whole loop: a block of memory, a domain, an agent that acts, observes and learns,
 * and what it has learnt. The README shows what follows. */
#include <rlvc/rlvc.h>
#include <stdio.h>

/* A corridor of eight cells. The agent sees the number of its cell as three bits; to enter cell 5
 * from either side pays 1 and ends the episode. */
#define PRIZE 5

static int print(void *file, const char *text, size_t bytes) {
    return fwrite(text, 1, bytes, file) != bytes;
}

int main(void) {
    static uint64_t memory[RLVC_AGENT_BYTES(2, 500, 8, 1, RLVC_BITS_FEATURE_BYTES, 3) / 8];
    rlvc_domain domain;
    rlvc_config config;
    rlvc_agent *agent;
    rlvc_choice choice = {0, 0};
    rlvc_progress progress;

    rlvc_bits_domain(3, &domain);
    rlvc_config_default(&config, &domain, 2); /* two actions: 0 goes left, 1 goes right */
    config.capacity = 500;
    config.classes = 8;
    if (rlvc_agent_init(&config, &domain, memory, sizeof memory, &agent) != RLVC_OK)
        return 1;

    for (int episode = 0; episode < 200; episode++) {
        uint8_t cell = (uint8_t)(episode % 2 == 0 ? 0 : 7);
        rlvc_begin(agent, &cell);
        for (int end = RLVC_GOES_ON; end == RLVC_GOES_ON;) {
            rlvc_act(agent, &choice);
            cell = (uint8_t)(choice.action == 0 ? cell - (cell > 0) : cell + (cell < 7));
            end = cell == PRIZE ? RLVC_TERMINATED : RLVC_GOES_ON;
            rlvc_observe(agent, choice, cell == PRIZE ? 1.0f : 0.0f, &cell, (uint8_t)end);
        }
        if (episode % 20 == 19)
            rlvc_learn(agent, RLVC_BUDGET_UNBOUNDED, &progress);
    }
    return rlvc_print(agent, RLVC_PRINT_TEXT, print, stdout) != RLVC_OK;
}
