/* SPDX-License-Identifier: MIT */
/* Introduces the whole loop: a block of memory, a domain, an agent that acts, observes and learns,
 * and the tree that it has learnt. README.md shows what follows. It is C99, and C++ too. */
#include <rlvc/rlvc.h>
#include <stdio.h>

static int print(void *file, const char *text, size_t bytes) {
    return fwrite(text, 1, bytes, (FILE *)file) != bytes;
}

int main(void) { /* cells 0 to 7 in a row, seen as 3 bits; reaching cell 5 pays 1 */
    static uint64_t memory[RLVC_AGENT_BYTES(2, 2000, 64, 1, 2, 3) / 8];
    rlvc_domain domain;
    rlvc_config config;
    rlvc_agent *agent;
    rlvc_choice choice;
    rlvc_progress progress;
    rlvc_bits_domain(3, &domain);
    rlvc_config_default(&config, &domain, 2); /* two actions: 0 goes left, 1 goes right */
    if (rlvc_agent_init(&config, &domain, memory, sizeof memory, &agent) != RLVC_OK)
        return 1;
    for (int episode = 0; episode < 200; episode++) {
        uint8_t cell = episode % 2 ? 0 : 7;
        rlvc_begin(agent, &cell);
        while (cell != 5 && rlvc_act(agent, &choice) == RLVC_OK) {
            cell = (uint8_t)(choice.action ? cell + (cell < 7) : cell - (cell > 0));
            rlvc_observe(agent, choice, cell == 5, &cell,
                         cell == 5 ? RLVC_TERMINATED : RLVC_GOES_ON);
        }
        if (episode % 20 == 0)
            rlvc_learn(agent, RLVC_BUDGET_UNBOUNDED, &progress);
    }
    return rlvc_print(agent, RLVC_PRINT_TEXT, print, stdout) != RLVC_OK;
}
