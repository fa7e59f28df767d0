/* SPDX-License-Identifier: MIT */
/* A learning step that is given up: at each point of it, and by itself when its callback goes on
 * failing. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "agent/learn.h"
#include "player.h"
#include "snapshots.h"

static player p, other;
static medium m;

static void start(uint8_t criterion, uint8_t solver) {
    player_enter_world(&p, BATCH);
    p.config.criterion = criterion;
    p.config.solver = solver;
    p.config.capacity = 120;
    player_init(&p);
    player_play(&p, 100);
}

/* After a whole step every percept's label is its class. */
static void check_labels(player *of) {
    const rlvc_replay *replay = &of->agent->replay;
    rlvc_progress progress;
    assert_int_equal(rlvc_learn(of->agent, RLVC_BUDGET_UNBOUNDED, &progress), RLVC_OK);
    assert_int_equal(progress.done, 1);
    assert_int_equal(rlvc_agent_check(of->agent), RLVC_OK);
    for (uint32_t at = 0; at < replay->count; at++) {
        uint32_t slot = rlvc_replay_slot(replay, at), class_id;
        assert_int_equal(
            rlvc_predict(of->agent, rlvc_replay_percept(replay, slot), &class_id, NULL), RLVC_OK);
        if (replay->label[slot] != RLVC_NO_CLASS)
            assert_int_equal(replay->label[slot], class_id);
    }
}

/* Gives the step up after each number of slices; what comes then is sound and learns on. */
static void test_at_every_point(void **state) {
    static const uint8_t solvers[] = {RLVC_SOLVER_VALUE_ITERATION, RLVC_SOLVER_Q_LEARNING};
    (void)state;
    for (uint32_t kind = 0; kind < 4; kind++) {
        uint8_t done = 0;
        for (uint32_t slices = 0; !done && slices < 10000u; slices += 1u + slices / 4u) {
            rlvc_progress progress;
            uint32_t undone, step;
            start((uint8_t)(kind % 2u), solvers[kind / 2u]);
            for (uint32_t i = 0; i < slices && !done; i++) {
                assert_int_equal(rlvc_learn(p.agent, RLVC_BUDGET_MIN, &progress), RLVC_OK);
                done = progress.done;
            }
            step = p.agent->step;
            assert_int_equal(rlvc_learn_abandon(p.agent), RLVC_OK);
            assert_int_equal(p.agent->step, step);
            assert_int_equal(p.agent->replay.frozen, 0);
            assert_int_equal(rlvc_agent_check(p.agent), RLVC_OK);
            rlvc_store store = medium_store(&m, &p.config, &p.domain, 0);
            assert_int_equal(rlvc_save(p.agent, &store), RLVC_OK);
            assert_int_equal(load(&other, &store), RLVC_OK);
            assert_int_equal(rlvc_prune(other.agent, 0.0f, 0.0f, &undone), RLVC_OK);
            player_play(&p, 150); /* more than the ring holds */
            check_labels(&p);
        }
    }
}

/* Given up while the dependence of samples is weighed: what the next step finds is weighed anew. */
static void test_while_dependence_is_weighed(void **state) {
    static const rlvc_dependence nothing;
    uint32_t given_up = 0;
    (void)state;
    for (uint32_t slices = 1; slices < 3000u; slices += 7u) {
        rlvc_progress progress = {0};
        player_enter_world(&p, BATCH);
        p.config.successors = p.config.dependence = 1;
        p.config.min_samples = 4;
        player_init(&p);
        player_play(&p, 250);
        for (uint32_t i = 0; i < slices && !progress.done; i++)
            assert_int_equal(rlvc_learn(p.agent, RLVC_BUDGET_MIN, &progress), RLVC_OK);
        given_up += p.agent->learner.dependence.wanted;
        assert_int_equal(rlvc_learn_abandon(p.agent), RLVC_OK);
        if (!progress.done)
            assert_memory_equal(&p.agent->learner.dependence, &nothing, sizeof nothing);
        check_labels(&p);
    }
    assert_true(given_up > 3u);
}

/* Fails whenever it sees one percept, as a detector does that cannot bear it. */
static int (*exhibits)(void *ctx, const void *percept, const void *feature, uint8_t *present);
static uint32_t poison;

static int choke(void *ctx, const void *percept, const void *feature, uint8_t *present) {
    return memcmp(percept, &poison, 3) == 0 || exhibits(ctx, percept, feature, present);
}

/* The percept leaves the ring in time, and learning goes on; also if the agent is saved and loaded
 * in between. */
static void test_unbearable_percept(void **state) {
    (void)state;
    for (uint32_t lives = 0; lives < 6; lives++) {
        rlvc_domain domain;
        rlvc_config config;
        rlvc_agent *agent;
        rlvc_progress progress;
        const rlvc_choice choice = {0, 0};
        const uint32_t episodes = lives % 3u; /* of so many steps; 0: without end */
        const int loads = lives >= 3u;
        uint32_t failed = 0, refused = 0, percept = 0;
        poison = 0xffffffu;
        assert_int_equal(rlvc_bits_domain(24, &domain), RLVC_OK);
        exhibits = domain.exhibits;
        domain.exhibits = choke;
        domain.detect = NULL;
        assert_int_equal(rlvc_config_default(&config, &domain, 1), RLVC_OK);
        config.capacity = 50;
        config.classes = 4;
        config.explore = RLVC_EXPLORE_UNIFORM;
        block_fill(p.block, CANARY, sizeof p.block);
        assert_int_equal(rlvc_agent_init(&config, &domain, p.block, sizeof p.block, &agent),
                         RLVC_OK);
        rlvc_store store = medium_store(&m, &config, &domain, 0);
        for (uint32_t i = 0; i < 400u; i++) {
            const uint32_t next = i == 57u ? poison : (i + 1u) * 7u % 16u;
            const uint32_t phase = episodes ? i % episodes : i;
            if (phase == 0) {
                percept = i * 7u % 16u;
                refused += rlvc_begin(agent, &percept) != RLVC_OK;
            }
            refused +=
                rlvc_observe(agent, choice, (float)(percept & 1u), &next,
                             phase + 1u == episodes ? RLVC_TRUNCATED : RLVC_GOES_ON) != RLVC_OK;
            percept = next;
            if (i % 20u != 0)
                continue;
            failed += rlvc_learn(agent, RLVC_BUDGET_UNBOUNDED, &progress) == RLVC_E_CALLBACK;
            assert_int_equal(rlvc_agent_check(agent), RLVC_OK);
            if (loads) {
                assert_int_equal(rlvc_save(agent, &store), RLVC_OK);
                assert_int_equal(
                    rlvc_load(&config, &domain, p.block, sizeof p.block, &store, &agent), RLVC_OK);
            }
        }
        assert_true(failed > 0 && failed < 10u);
        assert_int_equal(refused, 0);
        assert_int_equal(rlvc_learn(agent, RLVC_BUDGET_UNBOUNDED, &progress), RLVC_OK);
        assert_true(agent->tree.classes >= 2u);
    }
}

static void test_arguments(void **state) {
    (void)state;
    start(RLVC_CRITERION_RESIDUAL, RLVC_SOLVER_VALUE_ITERATION);
    player_save(&p);
    assert_int_equal(rlvc_learn_abandon(NULL), RLVC_E_NULL);
    assert_int_equal(rlvc_learn_abandon(p.agent), RLVC_OK);
    player_unchanged(&p, "giving up no step");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_at_every_point),
        cmocka_unit_test(test_while_dependence_is_weighed),
        cmocka_unit_test(test_unbearable_percept),
        cmocka_unit_test(test_arguments),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
