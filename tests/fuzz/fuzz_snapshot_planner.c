/* SPDX-License-Identifier: MIT */
/* Loads forged snapshots of a planner. The first two bytes choose what planner the store once held
 * and how much it had lived through; the others change its snapshot (forged_store.h). What is
 * loaded must hold together, and every later call be clean. All sizes are the least that are
 * allowed, and a search tries one policy: most of a run is learning. */
#define STORE_BYTES 65536u
#include "forged_store.h"

#include "../core/slider.h"
#include "rlvc/thresholds.h"

#define CONFIGS 4u
#define LIVES 8u

static uint64_t memory[16384], policy_memory[RLVC_PLANNER_POLICY_BYTES / 8];

static rlvc_thresholds thresholds;
static rlvc_domain domain;

static rlvc_config config_of(uint32_t choice) {
    rlvc_config config;
    must(rlvc_thresholds_default(&thresholds, SLIDER_COMPONENTS) == RLVC_OK);
    must(rlvc_thresholds_domain(&thresholds, &domain) == RLVC_OK);
    must(rlvc_config_default(&config, &domain, SLIDER_ACTIONS) == RLVC_OK);
    config.capacity = 64;
    config.sample = 32;
    config.model_leaves = choice & 2u ? 1u : 4u;
    config.leaves = choice & 2u ? 2u : 6u;
    config.horizon = choice & 1u ? 5u : 12u;
    config.random = 32;
    config.candidates = 1;
    config.patience = 1;
    return config;
}

/* Learns, in slices, what is due. */
static void learn(rlvc_agent *planner) {
    rlvc_progress progress = {0};
    uint32_t least;
    must(rlvc_budget_min(planner, &least) == RLVC_OK);
    must(least < 1000000u);
    for (uint32_t i = 0; i < 3000u && !progress.done; i++) {
        must(rlvc_learn(planner, least + 5000u, &progress) == RLVC_OK);
        must(progress.work <= least + 5000u);
    }
    must(progress.done);
}

static void live(rlvc_agent *planner, uint32_t interactions) {
    slider world;
    rlvc_rng rng;
    rlvc_rng_seed(&rng, interactions);
    slider_reset(&world, &rng);
    must(rlvc_begin(planner, world.s) == RLVC_OK);
    for (uint32_t i = 0; i < interactions; i++) {
        rlvc_choice choice = {SLIDER_ACTIONS, 0};
        float reward;
        must(rlvc_act(planner, &choice) == RLVC_OK && choice.action < SLIDER_ACTIONS);
        uint8_t end = slider_step(&world, choice.action, &reward);
        must(rlvc_observe(planner, choice, reward, world.s, end) == RLVC_OK);
        learn(planner);
        if (end == RLVC_GOES_ON)
            continue;
        slider_reset(&world, &rng);
        must(rlvc_begin(planner, world.s) == RLVC_OK);
    }
}

/* Puts into slot 0 what the choices stand for; each is made once. */
static void save(const rlvc_config *config, uint32_t choice, uint32_t lived) {
    static unsigned char made[CONFIGS][LIVES][STORE_BYTES / 2];
    unsigned char *kept = made[choice][lived];
    memset(bytes_of_store, 0, sizeof bytes_of_store);
    if (kept[0] == 0) {
        rlvc_agent *planner;
        must(rlvc_agent_init(config, &domain, memory, sizeof memory, &planner) == RLVC_OK);
        if (lived > 0)
            live(planner, lived * lived * 6u); /* up to 294, all of it a few times the ring */
        must(rlvc_save(planner, &store) == RLVC_OK);
        memcpy(kept, bytes_of_store, STORE_BYTES / 2);
    }
    memcpy(bytes_of_store, kept, STORE_BYTES / 2);
}

/* The policy as a tree, as text and as C. */
static void show(rlvc_agent *planner, uint32_t leaves) {
    rlvc_policy_config options;
    rlvc_policy *policy;
    rlvc_planner_test node;
    for (uint32_t k = 0; k + 1u < 2u * leaves; k++)
        must(rlvc_planner_node(planner, k, &node) == RLVC_OK);
    must(rlvc_planner_node(planner, 2u * leaves - 1u, &node) == RLVC_E_RANGE);
    must(rlvc_policy_default(planner, &options) == RLVC_OK);
    must(rlvc_policy_make(planner, &options, policy_memory, sizeof policy_memory, &policy, NULL) ==
         RLVC_OK);
    must(rlvc_export_c(planner, "forged", ignore, NULL, NULL) == RLVC_OK);
    for (uint32_t format = 0; format <= RLVC_PRINT_JSON; format++)
        must(rlvc_print(planner, format, ignore, NULL) == RLVC_OK &&
             rlvc_policy_print(policy, format, ignore, NULL) == RLVC_OK);
}

static void ask(rlvc_agent *planner) {
    rlvc_planner_statistics statistics;
    must(rlvc_planner_stats(planner, &statistics) == RLVC_OK);
    must(statistics.leaves >= 1u && statistics.leaves <= RLVC_PLANNER_LEAVES_MAX);
    must(statistics.acting <= RLVC_PLANNER_AGAIN && statistics.verdict <= RLVC_PLANNER_NO_MODEL);
    must(statistics.score - statistics.score == 0.0f);
    for (uint32_t i = 0; i < 16u; i++) {
        const float percept[2] = {(float)(i % 4u) - 1.5f, (float)(i / 4u) * 1e8f - 1.5e8f};
        uint32_t action = SLIDER_ACTIONS;
        must(rlvc_predict(planner, percept, NULL, &action) == RLVC_OK);
        must(action < SLIDER_ACTIONS);
        must(rlvc_planner_act_at(planner, percept, &action) == RLVC_OK);
        must(action < SLIDER_ACTIONS);
    }
    show(planner, statistics.leaves);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    if (size < 2)
        return 0;
    const uint32_t choice = data[0] % CONFIGS;
    rlvc_config config = config_of(choice);
    rlvc_agent *planner;
    save(&config, choice, data[1] % LIVES);
    forge(data + 2, size - 2);
    rlvc_status status = rlvc_load(&config, &domain, memory, sizeof memory, &store, &planner);
    must((status == RLVC_OK) == (planner != NULL));
    must(status == RLVC_OK || status == RLVC_E_EMPTY || status == RLVC_E_DAMAGED ||
         status == RLVC_E_VERSION || status == RLVC_E_MISMATCH);
    if (status != RLVC_OK)
        return 0;
    must(rlvc_agent_check(planner) == RLVC_OK);
    ask(planner);
    learn(planner);
    live(planner, 12);
    ask(planner);
    must(rlvc_save(planner, &store) == RLVC_OK);
    return 0;
}
