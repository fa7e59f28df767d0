/* SPDX-License-Identifier: MIT */
/* The smallest learner: eight cells in a row, within 16 KiB of memory. Prints its tree as JSON, by
 * both criteria and with every solver. */
#include <rlvc/rlvc.h>
#include <stdio.h>

#define ACTIONS 2u
#define CAPACITY 160u
#define CLASSES 8u
#define BITS 3u

static uint64_t
    block[RLVC_AGENT_BYTES(ACTIONS, CAPACITY, CLASSES, 1, RLVC_BITS_FEATURE_BYTES, BITS) /
          sizeof(uint64_t)];

static int print(void *file, const char *text, size_t bytes) {
    return fwrite(text, 1, bytes, (FILE *)file) != bytes;
}

/* Cells 0 to 7, each seen as its number in 3 bits. Cell 5 pays 1 and ends an episode. */
static rlvc_status live(rlvc_agent *agent) {
    rlvc_status status = RLVC_OK;
    for (uint32_t episode = 0; episode < 120 && status == RLVC_OK; episode++) {
        uint8_t cell = episode % 2u ? 0 : 7;
        rlvc_choice choice;
        rlvc_progress progress;
        status = rlvc_begin(agent, &cell);
        while (status == RLVC_OK && cell != 5 && (status = rlvc_act(agent, &choice)) == RLVC_OK) {
            cell = (uint8_t)(choice.action ? cell + (cell < 7) : cell - (cell > 0));
            uint8_t end = cell == 5 ? RLVC_TERMINATED : RLVC_GOES_ON;
            status = rlvc_observe(agent, choice, cell == 5 ? 1.0f : 0.0f, &cell, end);
        }
        if (status == RLVC_OK && episode % 20u == 19u) {
            status = rlvc_learn(agent, RLVC_BUDGET_UNBOUNDED, &progress);
        }
    }
    return status;
}

static rlvc_status run(uint8_t criterion, uint8_t solver) {
    rlvc_domain domain;
    rlvc_config config;
    rlvc_agent *agent;
    rlvc_status status = rlvc_bits_domain(BITS, &domain);
    if (status == RLVC_OK) {
        status = rlvc_config_default(&config, &domain, ACTIONS);
    }
    config.capacity = CAPACITY;
    config.classes = CLASSES;
    config.criterion = criterion;
    config.solver = solver;
    config.epsilon = 0.6f;
    if (status == RLVC_OK) {
        status = rlvc_agent_init(&config, &domain, block, sizeof block, &agent);
    }
    if (status == RLVC_OK) {
        status = live(agent);
    }
    if (status == RLVC_OK) {
        status = rlvc_print(agent, RLVC_PRINT_JSON, print, stdout);
    }
    return status;
}

int main(void) {
    rlvc_status status = RLVC_OK;
    printf("{\"trees\": [\n");
    for (uint8_t i = 0; i < 8u && status == RLVC_OK; i++) {
        printf("%s", i > 0 ? "," : "");
        status = run(i / 4u, i % 4u);
    }
    printf("]}\n");
    return status == RLVC_OK ? 0 : 1;
}
