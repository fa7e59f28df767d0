/* SPDX-License-Identifier: MIT */
/* The fuzz targets of snapshots, one for each kind of domain (RLVC_FUZZ_DOMAIN): loads forged ones.
 * The first two bytes choose what agent the store once held and how far it had come in a learning
 * step; the others change its snapshot (forged_store.h). What is loaded must be sound, and every
 * later call clean. */
#ifndef RLVC_TESTS_FORGED_SNAPSHOT_H
#define RLVC_TESTS_FORGED_SNAPSHOT_H

#ifndef CAPACITY
#define CAPACITY 16u
#define STORE_BYTES 4096u
#endif
#include "forged_store.h"
#include "rlvc/export.h"
#include "rlvc/policy.h"
#include "world.h"

#define CONFIGS 16u
#define SLICES 32u

static uint64_t memory[8192], policy_memory[8192];

static rlvc_config config_of(const rlvc_domain *domain, uint32_t choice) {
    rlvc_config config;
    must(rlvc_config_default(&config, domain, 2) == RLVC_OK);
    config.method = &rlvc_method_classes;
    config.capacity = CAPACITY;
    config.classes = 6;
    config.features_at_once = 16;
    config.successors = domain->kind == RLVC_DOMAIN_BITS;
    config.min_samples = 4;
    config.alpha = 1.0f;
    config.max_sweeps = 50;
    config.criterion = choice & 1u;
    config.solver = (uint8_t)(choice >> 1 & 3u);
    return config;
}

/* Puts into slot 0 what the choices stand for; each is made once. */
static void save(const rlvc_config *config, const rlvc_domain *domain, uint32_t choice,
                 uint32_t slices) {
    static unsigned char made[CONFIGS][SLICES][STORE_BYTES / 2];
    unsigned char *kept = made[choice][slices], percept[PERCEPT_MAX];
    rlvc_agent *agent;
    rlvc_progress progress;
    uint32_t cell = 5;
    memset(bytes_of_store, 0, sizeof bytes_of_store);
    if (kept[0] == 0) {
        must(rlvc_agent_init(config, domain, memory, sizeof memory, &agent) == RLVC_OK);
        world_percept(domain, cell, percept);
        must(rlvc_begin(agent, percept) == RLVC_OK);
        for (uint32_t i = 0; i < CAPACITY + 4u; i++) {
            rlvc_choice action;
            must(rlvc_act(agent, &action) == RLVC_OK);
            world_step(agent, domain, &cell, action);
        }
        for (uint32_t i = 0; i < slices * slices; i++)
            must(rlvc_learn(agent, RLVC_BUDGET_MIN, &progress) == RLVC_OK);
        must(rlvc_save(agent, &store) == RLVC_OK);
        memcpy(kept, bytes_of_store, STORE_BYTES / 2);
    }
    memcpy(bytes_of_store, kept, STORE_BYTES / 2);
}

static void show(rlvc_agent *agent, const rlvc_domain *domain) {
    rlvc_policy_config config;
    rlvc_policy *policy;
    size_t bytes;
    for (uint32_t format = 0; format <= RLVC_PRINT_JSON; format++)
        must(rlvc_print(agent, format, ignore, NULL) == RLVC_OK);
    must(rlvc_export_c(agent, "forged", ignore, NULL, NULL) ==
         (domain->kind == RLVC_DOMAIN_OWN ? RLVC_E_CONFIG : RLVC_OK));
    must(rlvc_policy_default(agent, &config) == RLVC_OK);
    config.entries = 64;
    config.effort = 2000;
    must(rlvc_policy_size(agent, &config, &bytes) == RLVC_OK && bytes <= sizeof policy_memory);
    must(rlvc_policy_make(agent, &config, policy_memory, bytes, &policy, NULL) == RLVC_OK);
    must(rlvc_policy_print(policy, RLVC_PRINT_TEXT, ignore, NULL) == RLVC_OK);
}

static void predict_all(rlvc_agent *agent, const rlvc_domain *domain) {
    for (uint32_t cell = 0; cell < CELLS; cell++) {
        unsigned char percept[PERCEPT_MAX];
        uint32_t class_id, action;
        world_percept(domain, cell, percept);
        must(rlvc_predict(agent, percept, &class_id, &action) == RLVC_OK);
        must(class_id < 6u && action < 2u);
    }
}

static void go_on(rlvc_agent *agent, const rlvc_domain *domain) {
    rlvc_progress progress = {0};
    unsigned char percept[PERCEPT_MAX];
    uint32_t cell = 3;
    must(rlvc_agent_check(agent) == RLVC_OK);
    predict_all(agent, domain);
    show(agent, domain);
    for (uint32_t i = 0; i < 200u && !progress.done; i++)
        must(rlvc_learn(agent, 300, &progress) == RLVC_OK);
    must(rlvc_learn_abandon(agent) == RLVC_OK);
    world_percept(domain, cell, percept);
    must(rlvc_begin(agent, percept) == RLVC_OK);
    for (uint32_t i = 0; i < CAPACITY + 5u; i++) {
        rlvc_choice choice;
        must(rlvc_act(agent, &choice) == RLVC_OK);
        world_step(agent, domain, &cell, choice);
    }
    must(rlvc_learn(agent, 3000, &progress) == RLVC_OK);
    predict_all(agent, domain);
    must(rlvc_agent_check(agent) == RLVC_OK);
    must(rlvc_save(agent, &store) == RLVC_OK);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    if (size < 2)
        return 0;
    uint32_t choice = data[0] % CONFIGS;
    rlvc_domain domain = world_domain(RLVC_FUZZ_DOMAIN, choice >> 3);
    rlvc_config config = config_of(&domain, choice);
    rlvc_agent *agent;
    save(&config, &domain, choice, data[1] % SLICES);
    forge(data + 2, size - 2);
    rlvc_status status = rlvc_load(&config, &domain, memory, sizeof memory, &store, &agent);
    must((status == RLVC_OK) == (agent != NULL));
    must(status == RLVC_OK || status == RLVC_E_EMPTY || status == RLVC_E_DAMAGED ||
         status == RLVC_E_VERSION || status == RLVC_E_MISMATCH);
    if (status == RLVC_OK)
        go_on(agent, &domain);
    return 0;
}

#endif
