/* SPDX-License-Identifier: MIT */
/* Makes the calls that it reads, one a line, and prints what each answers and the tree at the end:
 *
 *     bits actions capacity classes seed solver criterion
 *     b PERCEPT                              rlvc_begin
 *     a                                      rlvc_act
 *     o ACTION EXPLOITED REWARD PERCEPT END  rlvc_observe; "-" is no percept
 *     l BUDGET                               rlvc_learn
 *     p PERCEPT                              rlvc_predict
 *
 * Percepts are hexadecimal, rewards C's hexadecimal floats. */
#include <rlvc/rlvc.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static int print(void *file, const char *text, size_t bytes) {
    return fwrite(text, 1, bytes, file) != bytes;
}

static const unsigned char *percept(const char *hex, unsigned char *bytes) {
    if (strcmp(hex, "-") == 0)
        return NULL;
    for (size_t i = 0; hex[2 * i]; i++) {
        unsigned byte;
        if (sscanf(hex + 2 * i, "%2x", &byte) != 1)
            exit(3);
        bytes[i] = (unsigned char)byte;
    }
    return bytes;
}

static void call(rlvc_agent *agent, const char *line) {
    char hex[512] = "";
    unsigned char bytes[256];
    unsigned action = 0, exploited = 0, end = 0, budget = 0;
    float reward = 0;
    rlvc_choice choice = {0, 0};
    rlvc_progress progress = {0, 0, 0, 0, {0, 0, 0}};
    uint32_t class_id = 0, greedy = 0;
    if (sscanf(line, "b %511s", hex) == 1) {
        printf("%d\n", rlvc_begin(agent, percept(hex, bytes)));
    } else if (line[0] == 'a') {
        int status = rlvc_act(agent, &choice);
        printf("%d %u %u\n", status, choice.action, choice.exploited);
    } else if (sscanf(line, "o %u %u %f %511s %u", &action, &exploited, &reward, hex, &end) == 5) {
        choice.action = (uint8_t)action;
        choice.exploited = (uint8_t)exploited;
        printf("%d\n", rlvc_observe(agent, choice, reward, percept(hex, bytes), (uint8_t)end));
    } else if (sscanf(line, "l %u", &budget) == 1) {
        int status = rlvc_learn(agent, budget, &progress);
        printf("%d %u %u\n", status, progress.splits, progress.done);
    } else if (sscanf(line, "p %511s", hex) == 1) {
        int status = rlvc_predict(agent, percept(hex, bytes), &class_id, &greedy);
        printf("%d %u %u\n", status, (unsigned)class_id, (unsigned)greedy);
    } else {
        exit(2);
    }
}

int main(void) {
    char line[1024];
    unsigned bits, actions, capacity, classes, seed, solver, criterion;
    rlvc_domain domain;
    rlvc_config config;
    rlvc_agent *agent;
    size_t size;
    if (!fgets(line, sizeof line, stdin) ||
        sscanf(line, "%u %u %u %u %u %u %u", &bits, &actions, &capacity, &classes, &seed, &solver,
               &criterion) != 7)
        return 1;
    rlvc_bits_domain(bits, &domain);
    rlvc_config_default(&config, &domain, actions);
    config.capacity = capacity;
    config.classes = classes;
    config.seed = seed;
    config.solver = (uint8_t)solver;
    config.criterion = (uint8_t)criterion;
    if (rlvc_agent_size(&config, &domain, &size) != RLVC_OK)
        return 1;
    void *memory = malloc(size);
    if (!memory || rlvc_agent_init(&config, &domain, memory, size, &agent) != RLVC_OK)
        return 1;
    while (fgets(line, sizeof line, stdin))
        call(agent, line);
    rlvc_print(agent, RLVC_PRINT_JSON, print, stdout);
    free(memory);
    return 0;
}
