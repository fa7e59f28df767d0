/* SPDX-License-Identifier: MIT */
/* Taking tests out of the tree: what goes, what stays, and that everything still fits together. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "snapshots.h"
#include "agent/state.h"

#define BITS 3u
#define CAPACITY 512u

static uint64_t block[RLVC_AGENT_BYTES(3, CAPACITY, 16, 1, RLVC_BITS_FEATURE_BYTES, BITS) / 8u];

/* Each percept that has a label is of the class that the tree gives it. */
static void check_labels(rlvc_agent *agent) {
    for (uint32_t position = 0; position < agent->replay.count; position++) {
        const uint32_t slot = rlvc_replay_slot(&agent->replay, position);
        const void *percept = rlvc_replay_percept(&agent->replay, slot);
        uint32_t class_id;
        assert_int_equal(rlvc_predict(agent, percept, &class_id, NULL), RLVC_OK);
        if (agent->replay.label[slot] != RLVC_NO_CLASS)
            assert_int_equal(class_id, agent->replay.label[slot]);
    }
}

/* ... and each Q is the mean of its rewards, where all episodes are one interaction long. */
static void check_all(rlvc_agent *agent) {
    float sum[64][3] = {{0}};
    uint32_t count[64][3] = {{0}};
    assert_int_equal(rlvc_agent_check(agent), RLVC_OK);
    check_labels(agent);
    for (uint32_t position = 0; position < agent->replay.count; position++) {
        const uint32_t slot = rlvc_replay_slot(&agent->replay, position);
        uint32_t class_id;
        assert_int_equal(
            rlvc_predict(agent, rlvc_replay_percept(&agent->replay, slot), &class_id, NULL),
            RLVC_OK);
        sum[class_id][agent->replay.action[slot]] += agent->replay.reward[slot];
        count[class_id][agent->replay.action[slot]]++;
    }
    for (uint32_t c = 0; c < agent->tree.classes; c++) {
        for (uint32_t a = 0; a < agent->config.actions; a++) {
            float q;
            uint32_t samples;
            assert_int_equal(rlvc_q(agent, c, a, &q, &samples), RLVC_OK);
            assert_int_equal(samples, count[c][a]);
            if (samples > 0)
                assert_true(q - sum[c][a] / (float)samples < 1e-5f &&
                            q - sum[c][a] / (float)samples > -1e-5f);
        }
        assert_int_equal(agent->pending[c], 0);
    }
}

/* Interactions in a world whose rewards are said by so many bits, the highest, and by the action,
 * and are noise beside. Action 2 is only tried where bit 1 is 1, if at all. */
static void live(rlvc_agent *agent, uint32_t bits, int third) {
    rlvc_rng rng;
    rlvc_progress progress;
    rlvc_rng_seed(&rng, 3);
    for (uint32_t i = 0; i < CAPACITY; i++) {
        const unsigned char percept = (unsigned char)(i % 8u);
        rlvc_choice choice = {(uint8_t)(i / 8u % 2u), 0};
        if (third && i / 8u % 4u == 3u && (percept & 2u))
            choice.action = 2;
        const float reward = 0.5f * (rlvc_rng_uniform(&rng) - 0.5f) +
                             2.0f * (float)(percept >> (BITS - bits) << (BITS - bits)) +
                             (choice.action == 1 ? 1.0f : 0.0f);
        assert_int_equal(rlvc_begin(agent, &percept), RLVC_OK);
        assert_int_equal(rlvc_observe(agent, choice, reward, NULL, RLVC_TERMINATED), RLVC_OK);
    }
    assert_int_equal(rlvc_learn(agent, RLVC_BUDGET_UNBOUNDED, &progress), RLVC_OK);
    check_all(agent);
}

static rlvc_agent *make_new(void) {
    rlvc_domain domain;
    rlvc_config config;
    rlvc_agent *agent;
    assert_int_equal(rlvc_bits_domain(BITS, &domain), RLVC_OK);
    assert_int_equal(rlvc_config_default(&config, &domain, 3), RLVC_OK);
    config.capacity = CAPACITY;
    config.classes = 16;
    assert_int_equal(rlvc_agent_init(&config, &domain, block, sizeof block, &agent), RLVC_OK);
    return agent;
}

/* An agent that has learnt to tell all percepts apart, since when the world has changed: only bit 2
 * matters. */
static rlvc_agent *make(int third) {
    rlvc_agent *agent = make_new();
    live(agent, 3, third);
    assert_int_equal(agent->tree.classes, 8);
    live(agent, 1, third);
    return agent;
}

static uint32_t prune(rlvc_agent *agent, float tolerance, float deviations) {
    uint32_t undone = 77, before = agent->tree.classes, action[1u << BITS];
    for (unsigned char percept = 0; percept < 1u << BITS; percept++)
        assert_int_equal(rlvc_predict(agent, &percept, NULL, &action[percept]), RLVC_OK);
    assert_int_equal(rlvc_prune(agent, tolerance, deviations, &undone), RLVC_OK);
    assert_int_equal(agent->tree.classes, before - undone);
    check_all(agent);
    for (unsigned char percept = 0; percept < 1u << BITS; percept++) {
        uint32_t now;
        assert_int_equal(rlvc_predict(agent, &percept, NULL, &now), RLVC_OK);
        assert_int_equal(now, action[percept]);
    }
    return undone;
}

static void test_a_world_that_changed(void **unused) {
    (void)unused;
    rlvc_statistics statistics;
    rlvc_agent *agent = make(0);
    assert_int_equal(prune(agent, 0.0f, 0.0f), 0);
    assert_int_equal(prune(agent, 0.0f, 4.0f), 6);
    unsigned char feature[RLVC_BITS_FEATURE_BYTES];
    assert_int_equal(rlvc_split_at(agent, 0, NULL, feature), RLVC_OK);
    assert_int_equal(rlvc_bits_feature(feature), 2);
    assert_int_equal(prune(agent, 0.0f, 4.0f), 0);
    assert_int_equal(prune(agent, 9.0f, 0.0f), 1);
    assert_int_equal(rlvc_stats(agent, &statistics), RLVC_OK);
    assert_int_equal(statistics.classes, 1);
    assert_int_equal(statistics.depth, 0);
    assert_int_equal(statistics.last_split, 0);
}

/* The step of the newest split that is left: here of all, as there was nothing to learn before. */
static void test_the_newest_split(void **unused) {
    (void)unused;
    rlvc_statistics statistics;
    rlvc_split split;
    rlvc_agent *agent = make_new();
    live(agent, 0, 0);
    assert_int_equal(agent->tree.classes, 1);
    live(agent, 3, 0);
    live(agent, 1, 0);
    assert_int_equal(prune(agent, 0.0f, 4.0f), 6);
    assert_int_equal(rlvc_split_at(agent, 0, &split, NULL), RLVC_OK);
    assert_true(split.step > 0);
    assert_int_equal(rlvc_stats(agent, &statistics), RLVC_OK);
    assert_int_equal(statistics.last_split, split.step);
}

/* What was tried on one side only tells them apart; so does another greedy action. */
static void test_what_stays(void **unused) {
    (void)unused;
    rlvc_agent *agent = make(1);
    (void)prune(agent, RLVC_REWARD_MAX, 0.0f);
    assert_true(agent->tree.classes >= 2);
    for (uint32_t c = 0; c < agent->tree.classes; c++) {
        uint32_t samples;
        assert_int_equal(rlvc_q(agent, c, 2, NULL, &samples), RLVC_OK);
        assert_true(samples == 0 || samples > 8);
    }
}

/* Few samples are no evidence: only the tolerance counts. */
static void test_few_samples(void **unused) {
    (void)unused;
    rlvc_agent *agent = make(0);
    agent->config.min_samples = 100;
    assert_int_equal(prune(agent, 0.0f, 1000.0f), 0);
    agent->config.min_samples = 33; /* of 32 a class and action */
    assert_int_equal(prune(agent, 0.0f, 1000.0f), 0);
    agent->config.min_samples = 32;
    assert_int_equal(prune(agent, 0.0f, 1000.0f), 7);
    agent = make(1);
    assert_int_equal(prune(agent, 1.0f, 0.0f), 4); /* those by bit 0 */
    agent->config.min_samples =
        40; /* of action 1 there are 64 where bit 1 is 0, and 32 where it is 1 */
    assert_int_equal(prune(agent, 0.0f, 1000.0f), 0);
}

/* Any tree, at any time between two steps; then it is saved and loaded, and both go on alike. */
static void test_in_the_maze(void **unused) {
    (void)unused;
    static content before, after;
    uint32_t all = 0;
    prepare_holding(200);
    p.config.explore = RLVC_EXPLORE_UNIFORM; /* a poor walk: later data do not support every
                                                split */
    player_init(&p);
    for (uint32_t k = 0; k < 30; k++) {
        uint32_t undone = 0;
        player_play(&p, 60);
        player_learn(&p, RLVC_BUDGET_UNBOUNDED, NULL);
        if (k % 2u == 1u)
            player_play(&p, 7); /* not labelled yet */
        assert_int_equal(rlvc_prune(p.agent, k % 3u ? 20.0f : 0.02f, k % 5u ? 1.0f : 0.0f, &undone),
                         RLVC_OK);
        assert_int_equal(rlvc_agent_check(p.agent), RLVC_OK);
        check_labels(p.agent);
        all += undone;
        rlvc_store store = medium_store(&m, &p.config, &p.domain, 0);
        assert_int_equal(rlvc_save(p.agent, &store), RLVC_OK);
        assert_int_equal(load(&other, &store), RLVC_OK);
        player_learn(&p, RLVC_BUDGET_UNBOUNDED, NULL);
        player_learn(&other, RLVC_BUDGET_UNBOUNDED, NULL);
        content_of(&p, &before);
        content_of(&other, &after);
        assert_true(same_content(&before, &after));
    }
    assert_true(all >= 15);
}

static void test_refusals(void **unused) {
    (void)unused;
    uint32_t undone = 77;
    rlvc_progress progress;
    rlvc_agent *agent = make(0);
    assert_int_equal(rlvc_prune(NULL, 0.0f, 0.0f, &undone), RLVC_E_NULL);
    assert_int_equal(rlvc_prune(agent, 0.0f, 0.0f, NULL), RLVC_E_NULL);
    assert_int_equal(rlvc_prune(agent, -1.0f, 0.0f, &undone), RLVC_E_RANGE);
    assert_int_equal(rlvc_prune(agent, 2e12f, 0.0f, &undone), RLVC_E_RANGE);
    assert_int_equal(rlvc_prune(agent, 0.0f, -1.0f, &undone), RLVC_E_RANGE);
    assert_int_equal(rlvc_prune(agent, 0.0f, 1001.0f, &undone), RLVC_E_RANGE);
    const unsigned char percept = 0;
    const rlvc_choice choice = {0, 0};
    assert_int_equal(rlvc_begin(agent, &percept), RLVC_OK);
    assert_int_equal(rlvc_observe(agent, choice, 0.0f, NULL, RLVC_TERMINATED), RLVC_OK);
    assert_int_equal(rlvc_learn(agent, RLVC_BUDGET_MIN, &progress), RLVC_OK);
    assert_int_equal(progress.done, 0);
    assert_int_equal(rlvc_prune(agent, 0.0f, 0.0f, &undone), RLVC_E_BUSY);
    assert_int_equal(undone, 77);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_a_world_that_changed), cmocka_unit_test(test_the_newest_split),
        cmocka_unit_test(test_what_stays),           cmocka_unit_test(test_few_samples),
        cmocka_unit_test(test_in_the_maze),          cmocka_unit_test(test_refusals),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
