/* SPDX-License-Identifier: MIT */
/* The agent: its memory, how it acts, what it takes in and what it tells; each error leaves every
 * byte of its block as it was. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "player.h"
#include "agent/state.h"

static player p;

#define ZERO_BYTES                                                                                 \
    { 0, 0, 0, 0, 0, 0, 0, 0 }

/* An agent that has learnt twice. */
static void make_trained(uint8_t criterion, uint8_t solver, int form) {
    player_enter_world(&p, form);
    p.config.criterion = criterion;
    p.config.solver = solver;
    p.config.epsilon = 0.5f;
    player_init(&p);
    for (int step = 0; step < 2; step++) {
        player_play(&p, 250);
        player_learn(&p, RLVC_BUDGET_UNBOUNDED, NULL);
    }
    player_play(&p, 30);
    if (!p.playing)
        player_begin(&p);
    assert_true(player_stats(&p).classes > 1u);
    player_save(&p);
    p.faulty.calls = 0;
}

/* ------------------------------------------------------------------ memory */

typedef struct shape {
    uint32_t actions, capacity, classes, percept_bytes, feature_bytes, at_once;
} shape;

static const shape shapes[] = {
    {1, 1, 1, 1, 1, 1},        {4, 2000, 64, 3, 2, 18},   {255, 1, 1, 1, 1, 64},
    {255, 63, 65535, 7, 9, 1}, {3, 64, 2, 4, 4, 64},      {3, 65, 3, 8, 8, 3},
    {2, 1000, 17, 100, 48, 2}, {1, 4096, 5, 13, 31, 64},  {5, 100000, 300, 128, 2, 64},
    {4, 129, 2, 1, 65536, 64}, {2, 3, 2, 1048576, 1, 64}, {9, 2147483647, 65535, 1, 1, 64},
    {2, 100, 512, 1, 2, 8},    {2, 100, 513, 1, 2, 8},
};
#define SHAPES (sizeof shapes / sizeof shapes[0])

static void take_shape(const shape *s) {
    player_enter_world(&p, BATCH);
    p.domain.percept_bytes = s->percept_bytes;
    p.domain.feature_bytes = s->feature_bytes;
    p.config.actions = s->actions;
    p.config.capacity = s->capacity;
    p.config.classes = s->classes;
    p.config.features_at_once = s->at_once;
}

static void test_size_and_its_bound(void **state) {
    (void)state;
    for (size_t i = 0; i < SHAPES; i++) {
        const shape *s = &shapes[i];
        size_t bytes = 0, bound = RLVC_AGENT_BYTES(s->actions, s->capacity, s->classes,
                                                   s->percept_bytes, s->feature_bytes, s->at_once);
        take_shape(s);
        assert_int_equal(rlvc_agent_size(&p.config, &p.domain, &bytes), RLVC_OK);
        assert_int_equal(bytes % RLVC_ALIGNMENT, 0);
        if (bytes > bound || bound - bytes > RLVC_AGENT_FIXED_BYTES)
            fail_msg("shape %u: %u bytes, bound %u", (unsigned)i, (unsigned)bytes, (unsigned)bound);
    }
}

/* For the bound is there to size such an array. */
static uint64_t static_block[RLVC_AGENT_BYTES(4, 300, 20, 1, 2, 6) / 8u];

static void test_static_array(void **state) {
    (void)state;
    rlvc_agent *agent = NULL;
    player_enter_world(&p, BATCH);
    assert_int_equal(
        rlvc_agent_init(&p.config, &p.domain, static_block, sizeof static_block, &agent), RLVC_OK);
    assert_int_equal(rlvc_agent_check(agent), RLVC_OK);
}

/* Exactly the size is enough, and no byte behind it is touched; one less touches none at all. */
static void test_exact_memory(void **state) {
    (void)state;
    for (size_t i = 0; i < SHAPES; i++) {
        rlvc_agent *agent;
        unsigned char *block = (unsigned char *)p.block;
        take_shape(&shapes[i]);
        assert_int_equal(rlvc_agent_size(&p.config, &p.domain, &p.bytes), RLVC_OK);
        if (p.bytes + RLVC_ALIGNMENT > sizeof p.block)
            continue;
        block_fill(p.block, CANARY, sizeof p.block);
        player_save(&p);
        for (size_t wrong = 0; wrong < 3u; wrong++) {
            agent = (rlvc_agent *)p.block;
            assert_int_equal(rlvc_agent_init(&p.config, &p.domain, wrong == 2u ? block + 4 : block,
                                             wrong == 0    ? p.bytes - 1u
                                             : wrong == 1u ? 0
                                                           : p.bytes,
                                             &agent),
                             RLVC_E_MEMORY);
            assert_null(agent);
            player_unchanged(&p, "RLVC_E_MEMORY");
        }
        assert_int_equal(rlvc_agent_init(&p.config, &p.domain, block, p.bytes, &agent), RLVC_OK);
        assert_int_equal(rlvc_agent_check(agent), RLVC_OK);
        assert_memory_equal(block + p.bytes, p.saved + p.bytes, sizeof p.block - p.bytes);
    }
    player_enter_world(&p, BATCH); /* nor does a life of learning touch any */
    player_init(&p);
    player_save(&p);
    player_play(&p, 300);
    player_learn(&p, RLVC_BUDGET_UNBOUNDED, NULL);
    assert_memory_equal((unsigned char *)p.block + p.bytes, p.saved + p.bytes,
                        sizeof p.block - p.bytes);
}

static void test_init_arguments(void **state) {
    (void)state;
    rlvc_agent *agent = NULL;
    size_t bytes = 77;
    player_enter_world(&p, BATCH);
    assert_int_equal(rlvc_agent_size(&p.config, &p.domain, NULL), RLVC_E_NULL);
    assert_int_equal(rlvc_agent_size(NULL, &p.domain, &bytes), RLVC_E_NULL);
    assert_int_equal(rlvc_agent_size(&p.config, NULL, &bytes), RLVC_E_NULL);
    assert_int_equal(bytes, 77);
    assert_int_equal(rlvc_agent_init(&p.config, &p.domain, p.block, sizeof p.block, NULL),
                     RLVC_E_NULL);
    assert_int_equal(rlvc_agent_init(&p.config, &p.domain, NULL, sizeof p.block, &agent),
                     RLVC_E_NULL);
    assert_int_equal(rlvc_agent_init(NULL, &p.domain, p.block, sizeof p.block, &agent),
                     RLVC_E_NULL);
    assert_null(agent);
    p.config.actions = 0;
    assert_int_equal(rlvc_agent_size(&p.config, &p.domain, &bytes), RLVC_E_CONFIG);
    assert_int_equal(bytes, 0);
    assert_int_equal(rlvc_agent_init(&p.config, &p.domain, p.block, sizeof p.block, &agent),
                     RLVC_E_CONFIG);
}

/* ------------------------------------------------------------------ acting */

/* epsilon = 0 exploits always, epsilon = 1 never; both as the choice says. */
static void test_epsilon(void **state) {
    (void)state;
    for (int always = 0; always < 2; always++) {
        uint32_t seen[GRIDWORLD_ACTIONS] = {0};
        player_enter_world(&p, BATCH);
        p.config.epsilon = always ? 1.0f : 0.0f;
        player_init(&p);
        player_begin(&p);
        for (int i = 0; i < 1000; i++) {
            rlvc_choice choice = {99, 99};
            assert_int_equal(rlvc_act(p.agent, &choice), RLVC_OK);
            assert_int_equal(choice.exploited, !always);
            assert_in_range(choice.action, 0, GRIDWORLD_ACTIONS - 1u);
            seen[choice.action]++;
        }
        for (uint32_t a = 0; a < GRIDWORLD_ACTIONS; a++)
            assert_in_range(seen[a],
                            always   ? 200
                            : a == 0 ? 1000
                                     : 0,
                            always   ? 300
                            : a == 0 ? 1000
                                     : 0);
    }
}

/* Exploitation comes in runs of k + 1 under the returns criterion, of 1 under the residual one; a
 * run ends with its episode, and goes on through a terminated one if the task is continuing. */
static void test_runs(void **state) {
    (void)state;
    const unsigned char percept[8] = ZERO_BYTES;
    for (uint32_t i = 0; i < 2u * 4u * 6u; i++) {
        const uint32_t steps = i % 4u, how = i / 8u % 6u;
        const int returns = i / 4u % 2u == 0, continuing = how % 2u == 1u;
        const uint8_t end = (uint8_t)(how / 2u); /* goes on here: torn */
        const uint32_t length = returns ? steps + 1u : 1u;
        uint32_t run = 0;
        player_enter_world(&p, BATCH);
        p.config.criterion = (uint8_t)(returns ? RLVC_CRITERION_RETURNS : RLVC_CRITERION_RESIDUAL);
        p.config.continuing = (uint8_t)continuing;
        p.config.epsilon = 0.5f;
        player_init(&p);
        for (uint32_t k = 0; k < steps; k++)
            player_learn(&p, RLVC_BUDGET_UNBOUNDED, NULL);
        player_begin(&p);
        for (uint32_t n = 0; n < 2000u; n++) {
            rlvc_choice choice;
            assert_int_equal(rlvc_act(p.agent, &choice), RLVC_OK);
            if (!choice.exploited) {
                assert_int_equal(run % length, 0);
                run = 0;
                assert_int_equal(rlvc_observe(p.agent, choice, 0.0f, percept, RLVC_GOES_ON),
                                 RLVC_OK);
                continue;
            }
            run++;
            int ends = n % 5u == 3u;
            assert_int_equal(
                rlvc_observe(p.agent, choice, 0.0f, percept, ends ? end : RLVC_GOES_ON), RLVC_OK);
            if (ends) {
                player_begin(&p);
                if (!(continuing && end == RLVC_TERMINATED))
                    run = 0;
            }
        }
    }
}

/* A learning step cuts a run off: the windows of the next step are longer. */
static void test_learning_ends_a_run(void **state) {
    (void)state;
    rlvc_choice choice;
    player_enter_world(&p, BATCH);
    p.config.criterion = RLVC_CRITERION_RETURNS;
    p.config.epsilon = 0.0f;
    player_init(&p);
    for (uint32_t k = 0; k < 5u; k++) {
        player_begin(&p);
        assert_int_equal(rlvc_act(p.agent, &choice), RLVC_OK);
        assert_int_equal(p.agent->run, k);
        player_learn(&p, RLVC_BUDGET_UNBOUNDED, NULL);
        assert_int_equal(p.agent->run, 0);
    }
}

/* ------------------------------------------------------------------ errors leave no trace */

static const unsigned char some_percept[8] = ZERO_BYTES;

static void test_observe_arguments(void **state) {
    (void)state;
    const float zero = 0.0f;
    const struct {
        rlvc_choice choice;
        float reward;
        const void *next;
        uint8_t end;
        rlvc_status status;
    } cases[] = {
        {{0, 0}, 0.0f, NULL, RLVC_GOES_ON, RLVC_E_NULL},
        {{0, 0}, 0.0f, NULL, RLVC_TRUNCATED, RLVC_E_NULL},
        {{0, 0}, 0.0f, some_percept, 3, RLVC_E_RANGE},
        {{0, 0}, 0.0f, some_percept, UINT8_MAX, RLVC_E_RANGE},
        {{GRIDWORLD_ACTIONS, 0}, 0.0f, some_percept, RLVC_GOES_ON, RLVC_E_RANGE},
        {{UINT8_MAX, 0}, 0.0f, some_percept, RLVC_GOES_ON, RLVC_E_RANGE},
        {{0, 2}, 0.0f, some_percept, RLVC_GOES_ON, RLVC_E_RANGE},
        {{0, 0}, zero / zero, some_percept, RLVC_GOES_ON, RLVC_E_REWARD},
        {{0, 0}, 1.0f / zero, some_percept, RLVC_GOES_ON, RLVC_E_REWARD},
        {{0, 0}, -1.0f / zero, some_percept, RLVC_GOES_ON, RLVC_E_REWARD},
        {{0, 0}, 1.0001e12f, some_percept, RLVC_GOES_ON, RLVC_E_REWARD},
        {{0, 0}, -1.0001e12f, some_percept, RLVC_TERMINATED, RLVC_E_REWARD},
        {{0, 0}, RLVC_REWARD_MAX, some_percept, RLVC_GOES_ON, RLVC_OK},
        {{0, 1}, -RLVC_REWARD_MAX, some_percept, RLVC_TRUNCATED, RLVC_OK},
        {{GRIDWORLD_ACTIONS - 1u, 1}, 0.0f, NULL, RLVC_TERMINATED, RLVC_OK},
    };
    make_trained(RLVC_CRITERION_RESIDUAL, RLVC_SOLVER_SARSA, BATCH);
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        player_restore(&p);
        rlvc_status status =
            rlvc_observe(p.agent, cases[i].choice, cases[i].reward, cases[i].next, cases[i].end);
        if (status != cases[i].status)
            fail_msg("case %u: %d", (unsigned)i, status);
        if (status != RLVC_OK)
            player_unchanged(&p, "a refused observation");
        assert_int_equal(rlvc_agent_check(p.agent), RLVC_OK);
    }
}

static void test_order(void **state) {
    (void)state;
    const rlvc_choice choice = {0, 0};
    rlvc_choice chosen;
    make_trained(RLVC_CRITERION_RESIDUAL, RLVC_SOLVER_Q_LEARNING, BATCH);
    assert_int_equal(rlvc_observe(p.agent, choice, 1.0f, NULL, RLVC_TERMINATED), RLVC_OK);
    player_save(&p);
    assert_int_equal(rlvc_act(p.agent, &chosen), RLVC_E_ORDER);
    assert_int_equal(rlvc_observe(p.agent, choice, 1.0f, some_percept, RLVC_GOES_ON), RLVC_E_ORDER);
    assert_int_equal(rlvc_observe(p.agent, choice, 1.0f, NULL, RLVC_TERMINATED), RLVC_E_ORDER);
    player_unchanged(&p, "RLVC_E_ORDER");
}

static void test_null(void **state) {
    (void)state;
    const rlvc_choice choice = {0, 0};
    rlvc_choice chosen;
    rlvc_statistics statistics;
    make_trained(RLVC_CRITERION_RESIDUAL, RLVC_SOLVER_VALUE_ITERATION, BATCH);
    const rlvc_status statuses[] = {
        rlvc_begin(NULL, some_percept),
        rlvc_begin(p.agent, NULL),
        rlvc_act(NULL, &chosen),
        rlvc_act(p.agent, NULL),
        rlvc_observe(NULL, choice, 0.0f, some_percept, RLVC_GOES_ON),
        rlvc_predict(NULL, some_percept, NULL, NULL),
        rlvc_predict(p.agent, NULL, NULL, NULL),
        rlvc_stats(NULL, &statistics),
        rlvc_stats(p.agent, NULL),
        rlvc_q(NULL, 0, 0, NULL, NULL),
        rlvc_value(NULL, 0, NULL, NULL),
        rlvc_split_at(NULL, 0, NULL, NULL),
        rlvc_agent_check(NULL),
    };
    for (size_t i = 0; i < sizeof statuses / sizeof statuses[0]; i++)
        assert_int_equal(statuses[i], RLVC_E_NULL);
    player_unchanged(&p, "RLVC_E_NULL");
}

/* Calls one function of those that call the domain back. */
static rlvc_status call(int function) {
    const rlvc_choice choice = {1, 0};
    rlvc_choice chosen = {77, 77};
    uint32_t class_id = 77, action = 77;
    rlvc_status status = RLVC_OK;
    if (function == 0) {
        status = rlvc_act(p.agent, &chosen);
        assert_true(status == RLVC_OK || (chosen.action == 77 && chosen.exploited == 77));
    } else if (function == 1) {
        status = rlvc_predict(p.agent, some_percept, &class_id, &action);
        assert_true(status == RLVC_OK || (class_id == 77 && action == 77));
    } else {
        status = rlvc_observe(p.agent, choice, 1.0f, some_percept,
                              (uint8_t)(function == 2 ? RLVC_GOES_ON : RLVC_TERMINATED));
    }
    return status;
}

/* Each callback of each function fails once, and calls back once. */
static void test_callbacks(void **state) {
    (void)state;
    for (uint8_t solver = 0; solver < 4u; solver++) {
        make_trained(RLVC_CRITERION_RESIDUAL, solver, ONE_BY_ONE);
        for (int function = 0; function < 4; function++) {
            player_restore(&p);
            while (function == 0 && p.faulty.calls == 0) { /* until it exploits */
                player_save(&p);
                assert_int_equal(call(function), RLVC_OK);
            }
            player_restore(&p);
            p.faulty.agent = p.agent;
            assert_int_equal(call(function), RLVC_OK);
            p.faulty.agent = NULL;
            uint64_t calls = p.faulty.calls;
            assert_int_equal(calls > 0, function < 2 || solver == RLVC_SOLVER_Q_LEARNING ||
                                            solver == RLVC_SOLVER_SARSA);
            for (uint64_t n = 1; n <= calls; n++) {
                player_restore(&p);
                p.faulty.fail_at = n;
                assert_int_equal(call(function), RLVC_E_CALLBACK);
                player_unchanged(&p, "RLVC_E_CALLBACK");
            }
        }
    }
}

/* ------------------------------------------------------------------ asking */

static void test_answers(void **state) {
    (void)state;
    make_trained(RLVC_CRITERION_RESIDUAL, RLVC_SOLVER_VALUE_ITERATION, BATCH);
    rlvc_statistics statistics = player_stats(&p);
    assert_int_equal(statistics.interactions, 530);
    assert_in_range(statistics.stored, 280, 300);
    assert_int_equal(statistics.step, 2);
    assert_in_range(statistics.last_split, 0, 1);
    assert_in_range(statistics.depth, 1, statistics.classes - 1u);
    assert_true(statistics.sweeps > 0);
    for (unsigned char percept = 0; percept < 64u; percept++) {
        uint32_t class_id = UINT32_MAX, action = UINT32_MAX, greedy = UINT32_MAX;
        float value = -1.0f, best = -1e9f;
        assert_int_equal(rlvc_predict(p.agent, &percept, &class_id, &action), RLVC_OK);
        assert_int_equal(rlvc_predict(p.agent, &percept, NULL, NULL), RLVC_OK);
        assert_true(class_id < statistics.classes);
        assert_int_equal(rlvc_value(p.agent, class_id, &value, &greedy), RLVC_OK);
        assert_int_equal(rlvc_value(p.agent, class_id, NULL, NULL), RLVC_OK);
        assert_int_equal(action, greedy);
        for (uint32_t a = 0; a < GRIDWORLD_ACTIONS; a++) {
            float q;
            uint32_t samples;
            assert_int_equal(rlvc_q(p.agent, class_id, a, &q, &samples), RLVC_OK);
            assert_int_equal(rlvc_q(p.agent, class_id, a, NULL, NULL), RLVC_OK);
            best = samples > 0 && q > best ? q : best;
        }
        assert_float_equal(value, best, 0.0f);
    }
    for (uint32_t j = 0; j + 1u < statistics.classes; j++) {
        rlvc_split split;
        unsigned char feature[2] = {99, 99};
        assert_int_equal(rlvc_split_at(p.agent, j, &split, feature), RLVC_OK);
        assert_int_equal(rlvc_split_at(p.agent, j, NULL, NULL), RLVC_OK);
        assert_true(split.class_id <= j && split.action <= GRIDWORLD_ACTIONS + 1u);
        assert_true(split.log_p < -2.99f && split.score > 0.0f && split.samples >= 8u);
        assert_in_range(rlvc_bits_feature(feature), 0, 5);
    }
    player_unchanged(&p, "asking");
}

static void test_ranges(void **state) {
    (void)state;
    make_trained(RLVC_CRITERION_RESIDUAL, RLVC_SOLVER_VALUE_ITERATION, BATCH);
    const uint32_t classes = player_stats(&p).classes;
    const uint32_t beyond[] = {0, 1, 1000, UINT32_MAX / 2u, UINT32_MAX};
    for (size_t i = 0; i < sizeof beyond / sizeof beyond[0]; i++) {
        uint32_t class_id = beyond[i] < 2u ? classes + beyond[i] : beyond[i];
        uint32_t action = beyond[i] < 2u ? GRIDWORLD_ACTIONS + beyond[i] : beyond[i];
        assert_int_equal(rlvc_q(p.agent, class_id, 0, NULL, NULL), RLVC_E_RANGE);
        assert_int_equal(rlvc_q(p.agent, 0, action, NULL, NULL), RLVC_E_RANGE);
        assert_int_equal(rlvc_value(p.agent, class_id, NULL, NULL), RLVC_E_RANGE);
        assert_int_equal(rlvc_split_at(p.agent, class_id - 1u, NULL, NULL), RLVC_E_RANGE);
    }
    player_unchanged(&p, "RLVC_E_RANGE");
}

/* Each part of the invariant checker has its say. */
static void test_check(void **state) {
    (void)state;
    const size_t damages = 4;
    for (size_t i = 0; i <= damages; i++) {
        make_trained(RLVC_CRITERION_RESIDUAL, RLVC_SOLVER_VALUE_ITERATION, BATCH);
        struct rlvc_agent *agent = p.agent;
        if (i == 1u)
            agent->config.actions = 0;
        if (i == 2u)
            agent->tree.node[0] ^= 1u;
        if (i == 3u)
            agent->replay.stored++;
        if (i == 4u)
            agent->values.policy[0] = 99;
        assert_int_equal(rlvc_agent_check(p.agent), i == 0 ? RLVC_OK : RLVC_E_MEMORY);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_size_and_its_bound),
        cmocka_unit_test(test_static_array),
        cmocka_unit_test(test_exact_memory),
        cmocka_unit_test(test_init_arguments),
        cmocka_unit_test(test_epsilon),
        cmocka_unit_test(test_runs),
        cmocka_unit_test(test_learning_ends_a_run),
        cmocka_unit_test(test_observe_arguments),
        cmocka_unit_test(test_order),
        cmocka_unit_test(test_null),
        cmocka_unit_test(test_callbacks),
        cmocka_unit_test(test_answers),
        cmocka_unit_test(test_ranges),
        cmocka_unit_test(test_check),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
