/* SPDX-License-Identifier: MIT */
/* Any point of a learning step will do to save at, with each ready-made domain and one of one's
 * own, while the agent acts on: what is loaded ends the step as the agent itself does, byte for
 * byte, and by as much work. Candidates of vectors go by the order of the samples, and rewards at
 * random make that another one than that of time. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "../fuzz/world.h"
#include "agent/learn.h"
#include "base/rng.h"
#define MEDIUM_BYTES 131072u
#include "block.h"
#include "store.h"

#define BLOCK_BYTES (1u << 18)
#define CAPACITY 40u
#define LARGE 200u
#define STEPS 2u
#define EVERY (5u * RLVC_STRIDE) /* points of a phase */

typedef struct outcome {
    rlvc_progress progress;
    medium medium;
} outcome;

static rlvc_config config;
static rlvc_domain domain;
static rlvc_agent *agent;
static uint64_t block[BLOCK_BYTES / 8u], loaded_block[BLOCK_BYTES / 8u], kept[BLOCK_BYTES / 8u];
static size_t bytes;
static medium m;
static outcome expected, got;
static rlvc_rng rng;
static uint32_t cell;

static void make_agent(uint32_t kind, uint32_t variant, uint32_t capacity, float alpha) {
    domain = world_domain(kind, variant);
    assert_int_equal(rlvc_config_default(&config, &domain, 2), RLVC_OK);
    config.method = &rlvc_method_classes;
    config.capacity = capacity;
    config.classes = capacity == LARGE ? RLVC_CLASSES_SMALL + 1u : 6u;
    config.min_samples = 4;
    config.features_at_once = 3;
    config.alpha = alpha;
    config.successors = domain.features_max > 0; /* one's own has no bound of them */
    assert_int_equal(rlvc_agent_size(&config, &domain, &bytes), RLVC_OK);
    assert_true(bytes <= BLOCK_BYTES);
    block_fill(block, 0, bytes);
    assert_int_equal(rlvc_agent_init(&config, &domain, block, bytes, &agent), RLVC_OK);
    rlvc_rng_seed(&rng, 11u + kind);
    cell = 0;
}

/* One interaction, or none where the ring has no room. One action leads on, the other stays;
 * episodes end at the last cells or are cut short. */
static void play_one(void) {
    unsigned char percept[PERCEPT_MAX];
    rlvc_choice choice;
    world_percept(&domain, cell, percept);
    if (rlvc_act(agent, &choice) == RLVC_E_ORDER &&
        (rlvc_begin(agent, percept) == RLVC_E_BUSY || rlvc_act(agent, &choice) != RLVC_OK))
        return;
    const uint32_t next = (cell + (choice.action ? 4u : 0u)) % CELLS;
    const uint8_t end = next >= CELLS - 2u              ? RLVC_TERMINATED
                        : rlvc_rng_below(&rng, 12) == 0 ? RLVC_TRUNCATED
                                                        : RLVC_GOES_ON;
    const float reward = (float)rlvc_rng_below(&rng, 3);
    world_percept(&domain, next, percept);
    const rlvc_status status = rlvc_observe(agent, choice, reward, percept, end);
    assert_true(status == RLVC_OK || status == RLVC_E_BUSY);
    if (status == RLVC_OK)
        cell = end == RLVC_GOES_ON ? next : rlvc_rng_below(&rng, CELLS - 1u);
}

/* Ends the step: what it took, and what the agent has then, as a snapshot. */
static void end_step(rlvc_agent *of, outcome *to) {
    const rlvc_store store = medium_store(&to->medium, &config, &domain, 0);
    assert_int_equal(rlvc_learn(of, RLVC_BUDGET_UNBOUNDED, &to->progress), RLVC_OK);
    assert_int_equal(to->progress.done, 1);
    assert_int_equal(rlvc_save(of, &store), RLVC_OK);
}

static void check_save_point(void) {
    const rlvc_store store = medium_store(&m, &config, &domain, 0);
    rlvc_agent *loaded;
    assert_int_equal(rlvc_save(agent, &store), RLVC_OK);
    block_fill(loaded_block, 0, bytes);
    const rlvc_status status =
        rlvc_load(&config, &domain, loaded_block, BLOCK_BYTES, &store, &loaded);
    if (status != RLVC_OK)
        fail_msg("domain %u, phase %u, class %u: %s", (unsigned)domain.kind,
                 (unsigned)agent->learner.phase, (unsigned)agent->learner.at,
                 rlvc_status_text(status));
    end_step(loaded, &got);
    block_copy(kept, block, bytes);
    end_step(agent, &expected);
    block_copy(block, kept, bytes);
    if (memcmp(&got.progress, &expected.progress, sizeof got.progress) != 0 ||
        memcmp(got.medium.bytes, expected.medium.bytes, MEDIUM_BYTES) != 0)
        fail_msg("domain %u, phase %u, class %u: it ends otherwise", (unsigned)domain.kind,
                 (unsigned)agent->learner.phase, (unsigned)agent->learner.at);
}

/* Some steps by a budget, an interaction now and then between calls. Counts the points of each
 * phase, and saves at some. */
static void check_steps(uint32_t steps, uint32_t before, uint32_t budget, uint32_t *points) {
    for (uint32_t k = 0; k < steps; k++) {
        rlvc_progress progress;
        uint32_t n = 0;
        for (uint32_t i = 0; i < before; i++)
            play_one();
        do {
            assert_int_equal(rlvc_learn(agent, budget, &progress), RLVC_OK);
            if (points[agent->learner.phase]++ % EVERY == 0)
                check_save_point();
            if (n++ % 4u == 0)
                play_one();
        } while (!progress.done);
    }
}

/* Rings that are in part full, just full, and went round. */
static void test_every_save_point(void **state) {
    static const uint32_t before[] = {13, CAPACITY / 2u, CAPACITY + 9u};
    (void)state;
    for (uint32_t kind = 0; kind <= RLVC_DOMAIN_BAGS; kind++) {
        uint32_t points[RLVC_PHASE_INFLUENCE + 1] = {0};
        for (uint32_t i = 0; i < 6; i++) {
            make_agent(kind, i % 2u, CAPACITY, 1.0f);
            check_steps(STEPS, before[i / 2u], RLVC_BUDGET_MIN, points);
        }
        assert_true(points[RLVC_PHASE_SEARCH] > 0);
        assert_true(!config.successors || points[RLVC_PHASE_INFLUENCE] > 0);
        /* Of so few samples no bag is influenced. */
        assert_true(!config.successors || kind == RLVC_DOMAIN_BAGS ||
                    points[RLVC_PHASE_SUCCESSORS] > 0);
    }
}

/* What is loaded does not know which searches were in vain. */
static void test_in_vain(void **state) {
    (void)state;
    uint32_t points[RLVC_PHASE_INFLUENCE + 1] = {0};
    for (uint32_t variant = 0; variant < 2; variant++) {
        make_agent(RLVC_DOMAIN_BITS, variant, LARGE, 1e-3f);
        check_steps(12, LARGE / 14u, 60u * RLVC_BUDGET_MIN, points);
    }
    assert_true(points[RLVC_PHASE_SEARCH] > 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_every_save_point),
                                       cmocka_unit_test(test_in_vain)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
