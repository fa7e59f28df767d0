/* SPDX-License-Identifier: MIT */
#include "cases.h"

#include "gridworld.h"
#include <stdio.h>
#include <stdlib.h>

#define BITS_MAX 300u
#define BYTES_MAX GRIDWORLD_PERCEPT_BYTES(BITS_MAX)

static union {
    uint64_t aligned;
    unsigned char bytes[RLVC_AGENT_BYTES(4, 45000, 400, BYTES_MAX, RLVC_BITS_FEATURE_BYTES, 64)];
} memory;

static void must(rlvc_status status, const char *what) {
    if (status != RLVC_OK) {
        printf("%s: %s\n", what, rlvc_status_text(status));
        exit(2);
    }
}

static void learn(rlvc_agent *agent) {
    rlvc_progress progress;
    do
        must(rlvc_learn(agent, RLVC_BUDGET_UNBOUNDED, &progress), "learn");
    while (!progress.done);
}

static void learn_maze(rlvc_agent *agent) {
    gridworld world;
    unsigned char percept[BYTES_MAX];
    if (gridworld_init(&world, &gridworld_sutton, 11, 0.0f, 1) != 0)
        exit(2);
    gridworld_percept(&world, percept);
    must(rlvc_begin(agent, percept), "begin");
    for (uint32_t i = 1; i <= 4000; i++) {
        rlvc_choice choice;
        float reward = 0.0f;
        must(rlvc_act(agent, &choice), "act");
        int over = gridworld_step(&world, choice.action, &reward);
        if (over)
            gridworld_reset(&world);
        gridworld_percept(&world, percept);
        must(rlvc_observe(agent, choice, reward, percept, over ? RLVC_TERMINATED : RLVC_GOES_ON),
             "observe");
        if (over)
            must(rlvc_begin(agent, percept), "begin");
        if (i % 200 == 0)
            learn(agent);
    }
}

/* What to do at a percept, by a random decision tree of the given depth over the percept's bits: which
 * bit a node tests, and which action a leaf takes, comes from the path. */
static uint32_t wanted(const unsigned char *percept, uint32_t bits, uint32_t depth) {
    uint32_t path = 1;
    for (uint32_t level = 0; level < depth; level++) {
        uint32_t bit = path * 2654435761u % 4294967291u % bits;
        path = 2u * path + (percept[bit / 8u] >> bit % 8u & 1u);
    }
    return (path * 2246822519u >> 13) % 4u;
}

/* One decision an episode: 1 for the wanted action, else 0. */
static void learn_decisions(rlvc_agent *agent, uint32_t bits, uint32_t depth, uint32_t count) {
    gridworld_random random;
    unsigned char percept[BYTES_MAX];
    gridworld_random_seed(&random, 1);
    for (uint32_t i = 0; i < count; i++) {
        rlvc_choice choice;
        /* A maze of one cell has no bits of its own: all are random. */
        static const unsigned char cell[1] = {GRIDWORLD_FREE};
        const gridworld_maze nowhere = {1, 1, 1, cell};
        uint32_t own = gridworld_bits(&nowhere, 0);
        gridworld_encode(&nowhere, bits - own, 0, &random, percept);
        must(rlvc_begin(agent, percept), "begin");
        must(rlvc_act(agent, &choice), "act");
        float reward = choice.action == wanted(percept, bits, depth) ? 1.0f : 0.0f;
        must(rlvc_observe(agent, choice, reward, NULL, RLVC_TERMINATED), "observe");
    }
    learn(agent);
}

learnt learn_case(uint32_t i) {
    static const uint32_t bits[CASES] = {18, 7, 40, BITS_MAX, 40};
    static const uint32_t capacity[CASES] = {4000, 100, 30000, 30000, 45000};
    static const uint32_t depth[CASES] = {0, 0, 4, 5, 6};
    learnt made = {NULL, bits[i]};
    rlvc_domain domain;
    rlvc_config config;
    must(rlvc_bits_domain(bits[i], &domain), "domain");
    must(rlvc_config_default(&config, &domain, 4), "config");
    config.capacity = capacity[i];
    config.classes = 400;
    config.epsilon = i == 0 ? 0.9f : 1.0f;
    must(rlvc_agent_init(&config, &domain, &memory, sizeof memory, &made.agent), "init");
    if (i == 0)
        learn_maze(made.agent);
    else
        learn_decisions(made.agent, bits[i], depth[i], capacity[i]);
    return made;
}
