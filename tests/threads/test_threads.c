/* SPDX-License-Identifier: MIT */
/* Threads that share a domain and nothing else: each has an agent or a planner, and does all that
 * one can with it. What comes out is what comes out of one after another, and the thread sanitizer
 * sees no race. */
#include "base/crc.h"
#include "rlvc/export.h"
#include "rlvc/planner.h"
#include "rlvc/policy.h"
#include "rlvc/snapshot.h"
#include "slider.h"
#include "world.h"

#include <pthread.h>

#define DOMAINS (RLVC_DOMAIN_BAGS + 1u) /* of agents, by their kinds */
#define KINDS (DOMAINS + 1u)            /* and a planner */
#define THREADS (2u * KINDS)
#define STORE_BYTES 65536u

typedef struct task {
    uint32_t kind;
    uint32_t crc; /* of all that came out */
    uint64_t memory[20000], policy_memory[8192];
    unsigned char store[STORE_BYTES];
} task;

static rlvc_domain domains[DOMAINS];
static task tasks[THREADS];

/* ------------------------------------------------------------------ what comes out */

static int write_text(void *ctx, const char *text, size_t bytes) {
    task *t = (task *)ctx;
    t->crc = rlvc_crc(t->crc, text, bytes);
    return 0;
}

static int read_store(void *ctx, uint32_t offset, void *buffer, uint32_t bytes) {
    memcpy(buffer, ((task *)ctx)->store + offset, bytes);
    return 0;
}

static int write_store(void *ctx, uint32_t offset, const void *buffer, uint32_t bytes) {
    memcpy(((task *)ctx)->store + offset, buffer, bytes);
    return 0;
}

static void show(task *t, rlvc_agent *agent) {
    rlvc_policy_config config;
    rlvc_policy *policy;
    must(rlvc_print(agent, RLVC_PRINT_JSON, write_text, t) == RLVC_OK);
    if (t->kind != RLVC_DOMAIN_OWN)
        must(rlvc_export_c(agent, "policy", write_text, t, NULL) == RLVC_OK);
    must(rlvc_policy_default(agent, &config) == RLVC_OK);
    config.entries = 64;
    must(rlvc_policy_make(agent, &config, t->policy_memory, sizeof t->policy_memory, &policy,
                          NULL) == RLVC_OK);
    must(rlvc_policy_print(policy, RLVC_PRINT_TEXT, write_text, t) == RLVC_OK);
}

/* ------------------------------------------------------------------ the tasks */

static void use_agent(task *t) {
    const rlvc_store store = {t, STORE_BYTES / 2, read_store, write_store, NULL, NULL};
    const rlvc_domain *domain = &domains[t->kind];
    rlvc_config config;
    rlvc_agent *agent;
    rlvc_progress progress;
    unsigned char percept[PERCEPT_MAX];
    uint32_t cell = 5, undone;
    must(rlvc_config_default(&config, domain, 2) == RLVC_OK);
    config.method = &rlvc_method_classes;
    config.capacity = 200;
    config.classes = 16;
    must(rlvc_agent_init(&config, domain, t->memory, sizeof t->memory, &agent) == RLVC_OK);
    world_percept(domain, cell, percept);
    must(rlvc_begin(agent, percept) == RLVC_OK);
    for (uint32_t round = 0; round < 5u; round++) {
        for (uint32_t i = 0; i < 60u; i++) {
            rlvc_choice choice;
            must(rlvc_act(agent, &choice) == RLVC_OK);
            world_step(agent, domain, &cell, choice);
        }
        do {
            must(rlvc_learn(agent, 2000, &progress) == RLVC_OK);
        } while (!progress.done);
        must(rlvc_save(agent, &store) == RLVC_OK);
        must(rlvc_load(&config, domain, t->memory, sizeof t->memory, &store, &agent) == RLVC_OK);
    }
    must(rlvc_prune(agent, 0.1f, 2.0f, &undone) == RLVC_OK);
    must(rlvc_agent_check(agent) == RLVC_OK);
    show(t, agent);
}

static void use_planner(task *t) {
    const rlvc_store store = {t, STORE_BYTES / 2, read_store, write_store, NULL, NULL};
    rlvc_thresholds thresholds;
    rlvc_domain domain;
    rlvc_config config;
    rlvc_agent *planner;
    rlvc_progress progress;
    rlvc_rng rng;
    slider world;
    uint32_t interactions = 0;
    rlvc_rng_seed(&rng, 1);
    must(rlvc_thresholds_default(&thresholds, SLIDER_COMPONENTS) == RLVC_OK);
    must(rlvc_thresholds_domain(&thresholds, &domain) == RLVC_OK);
    must(rlvc_config_default(&config, &domain, SLIDER_ACTIONS) == RLVC_OK);
    config.capacity = 400;
    config.sample = 300;
    config.random = 100;
    config.candidates = 20;
    config.model_leaves = 8;
    must(rlvc_agent_init(&config, &domain, t->memory, sizeof t->memory, &planner) == RLVC_OK);
    while (interactions < 300u) {
        uint8_t end;
        slider_reset(&world, &rng);
        must(rlvc_begin(planner, world.s) == RLVC_OK);
        do {
            rlvc_choice choice;
            float reward;
            must(rlvc_act(planner, &choice) == RLVC_OK);
            end = slider_step(&world, choice.action, &reward);
            must(rlvc_observe(planner, choice, reward, world.s, end) == RLVC_OK);
            t->crc = rlvc_crc(t->crc, world.s, sizeof world.s);
            interactions++;
        } while (end == RLVC_GOES_ON);
        do {
            must(rlvc_learn(planner, 5000, &progress) == RLVC_OK);
        } while (!progress.done);
        must(rlvc_save(planner, &store) == RLVC_OK);
        must(rlvc_load(&config, &domain, t->memory, sizeof t->memory, &store, &planner) == RLVC_OK);
    }
    must(rlvc_print(planner, RLVC_PRINT_JSON, write_text, t) == RLVC_OK);
    must(rlvc_export_c(planner, "policy", write_text, t, NULL) == RLVC_OK);
}

static void *run(void *argument) {
    task *t = (task *)argument;
    t->crc = 0;
    if (t->kind < DOMAINS)
        use_agent(t);
    else
        use_planner(t);
    return NULL;
}

int main(void) {
    pthread_t threads[THREADS];
    uint32_t alone[KINDS];
    for (uint32_t kind = 0; kind < DOMAINS; kind++)
        domains[kind] = world_domain(kind, 0);
    for (uint32_t i = 0; i < THREADS; i++)
        tasks[i].kind = i % KINDS;
    for (uint32_t kind = 0; kind < KINDS; kind++) {
        run(&tasks[kind]);
        alone[kind] = tasks[kind].crc;
    }
    for (uint32_t i = 0; i < THREADS; i++)
        must(pthread_create(&threads[i], NULL, run, &tasks[i]) == 0);
    for (uint32_t i = 0; i < THREADS; i++)
        must(pthread_join(threads[i], NULL) == 0);
    for (uint32_t i = 0; i < THREADS; i++)
        must(tasks[i].crc == alone[i % KINDS] && tasks[i].crc != 0);
    printf("%u threads as alone\n", (unsigned)THREADS);
    return 0;
}
