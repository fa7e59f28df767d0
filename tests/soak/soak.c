/* SPDX-License-Identifier: MIT */
/* A controller that learns for ever: each tick it acts, observes and learns for a slice. A new
 * learning step begins every so many ticks; now and then every invariant is checked and the agent
 * is saved and loaded. The count of interactions passes 2^32 half-way. Fails if a slice exceeds its
 * budget, or a step of the last quarter takes more than twice the work of those of the first.
 *
 *     soak [TICKS]
 */
#include "agent/state.h"
#include "rlvc/snapshot.h"
#include "world.h"

#include <inttypes.h>

#define BUDGET 500u
#define TICKS_A_STEP 2000u
#define TICKS_A_CHECK 100000u
#define STORE_BYTES 32768u

static uint64_t memory[20000];
static unsigned char bytes_of_store[STORE_BYTES], before[STORE_BYTES / 2];

static int read_store(void *ctx, uint32_t offset, void *buffer, uint32_t bytes) {
    (void)ctx;
    memcpy(buffer, bytes_of_store + offset, bytes);
    return 0;
}

static int write_store(void *ctx, uint32_t offset, const void *buffer, uint32_t bytes) {
    (void)ctx;
    memcpy(bytes_of_store + offset, buffer, bytes);
    return 0;
}

static const rlvc_store store = {NULL, STORE_BYTES / 2, read_store, write_store, NULL, NULL};

/* The agent goes on from its snapshot. What is saved again differs in the sequence number and the
 * CRC alone. */
static rlvc_agent *reborn(rlvc_agent *agent, const rlvc_config *config, const rlvc_domain *domain) {
    rlvc_snapshot_info info, again;
    must(rlvc_agent_check(agent) == RLVC_OK);
    must(rlvc_save(agent, &store) == RLVC_OK && rlvc_snapshot_peek(&store, &info) == RLVC_OK);
    memcpy(before, bytes_of_store + info.slot * store.slot_bytes, info.bytes);
    must(rlvc_load(config, domain, memory, sizeof memory, &store, &agent) == RLVC_OK);
    must(rlvc_save(agent, &store) == RLVC_OK && rlvc_snapshot_peek(&store, &again) == RLVC_OK);
    must(again.bytes == info.bytes && again.sequence == info.sequence + 1u);
    const unsigned char *after = bytes_of_store + again.slot * store.slot_bytes;
    must(memcmp(before + 12, after + 12, info.bytes - 16u) == 0);
    return agent;
}

typedef struct learning {
    int under_way;
    uint64_t work;    /* of this step */
    uint64_t most[4]; /* of a step, by quarter of the run */
    uint32_t steps, splits;
} learning;

static void learn(rlvc_agent *agent, learning *l, uint32_t quarter) {
    rlvc_progress progress;
    must(rlvc_learn(agent, BUDGET, &progress) == RLVC_OK && progress.work <= BUDGET);
    l->work += progress.work;
    l->splits += progress.splits;
    if (!progress.done)
        return;
    l->most[quarter] = l->work > l->most[quarter] ? l->work : l->most[quarter];
    l->steps++;
    l->work = 0;
    l->under_way = 0;
}

/* One interaction of the row of cells. Where the ring has no room yet, learning goes on first. */
static void interact(rlvc_agent *agent, const rlvc_domain *domain, uint32_t *cell, learning *l,
                     uint32_t quarter) {
    unsigned char percept[PERCEPT_MAX];
    rlvc_choice choice;
    must(rlvc_act(agent, &choice) == RLVC_OK);
    *cell = (*cell + (choice.action ? 1u : CELLS - 1u)) % CELLS;
    const uint8_t end = *cell == CELLS - 1u ? RLVC_TERMINATED : RLVC_GOES_ON;
    world_percept(domain, *cell, percept);
    while (rlvc_observe(agent, choice, end ? 1.0f : 0.0f, percept, end) == RLVC_E_BUSY)
        learn(agent, l, quarter);
    if (end != RLVC_TERMINATED)
        return;
    *cell = (*cell * 5u + 3u) % (CELLS - 1u);
    world_percept(domain, *cell, percept);
    while (rlvc_begin(agent, percept) == RLVC_E_BUSY)
        learn(agent, l, quarter);
}

int main(int argc, char **argv) {
    const uint64_t ticks = argc > 1 ? strtoull(argv[1], NULL, 10) : UINT64_C(2000000);
    rlvc_domain domain = world_domain(RLVC_DOMAIN_BITS, 1);
    rlvc_config config;
    rlvc_agent *agent;
    learning l = {0};
    unsigned char percept[PERCEPT_MAX];
    uint32_t cell = 5;
    must(rlvc_config_default(&config, &domain, 2) == RLVC_OK);
    config.capacity = 300;
    config.classes = 16;
    must(rlvc_agent_init(&config, &domain, memory, sizeof memory, &agent) == RLVC_OK);
    agent->interactions = (UINT64_C(1) << 32) - ticks / 2;
    world_percept(&domain, cell, percept);
    must(rlvc_begin(agent, percept) == RLVC_OK);
    for (uint64_t tick = 0; tick < ticks; tick++) {
        const uint32_t quarter = (uint32_t)(tick * 4u / ticks);
        interact(agent, &domain, &cell, &l, quarter);
        l.under_way |= tick % TICKS_A_STEP == 0;
        if (l.under_way)
            learn(agent, &l, quarter);
        if (tick % TICKS_A_CHECK == 0)
            agent = reborn(agent, &config, &domain);
    }
    rlvc_statistics statistics;
    must(rlvc_stats(agent, &statistics) == RLVC_OK);
    must(l.most[3] <= 2u * l.most[0]);
    must(statistics.step == l.steps && statistics.interactions > UINT32_MAX);
    printf("%" PRIu64 " ticks, interactions up to %" PRIu64
           ", %u steps, %u splits, %u classes; most work of a "
           "step by quarter: %" PRIu64 " %" PRIu64 " %" PRIu64 " %" PRIu64 "\n",
           ticks, statistics.interactions, (unsigned)l.steps, (unsigned)l.splits,
           (unsigned)statistics.classes, l.most[0], l.most[1], l.most[2], l.most[3]);
    return 0;
}
