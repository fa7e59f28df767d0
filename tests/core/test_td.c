/* SPDX-License-Identifier: MIT */
/* Q-learning and Sarsa, observation by observation, against their formulas in double. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "player.h"
#include "agent/state.h"

#define CLASSES_MAX 20u
#define ACTIONS GRIDWORLD_ACTIONS

static player p;

/* What the tables should be. */
static double q[CLASSES_MAX][ACTIONS];
static uint32_t tried[CLASSES_MAX][ACTIONS];

/* The interaction before, which Sarsa has yet to learn from. */
typedef struct waiting {
    uint32_t class_id, action;
    double reward;
    int any;
} waiting;

static uint32_t class_of(const unsigned char *percept) {
    uint32_t class_id = UINT32_MAX;
    assert_int_equal(rlvc_predict(p.agent, percept, &class_id, NULL), RLVC_OK);
    return class_id;
}

static double value_of(uint32_t class_id) {
    double best = 0.0;
    int any = 0;
    for (uint32_t a = 0; a < ACTIONS; a++)
        if (tried[class_id][a] > 0 && (!any || q[class_id][a] > best)) {
            best = q[class_id][a];
            any = 1;
        }
    return best;
}

static void update(uint32_t class_id, uint32_t action, double target) {
    q[class_id][action] += (double)p.config.learning_rate * (target - q[class_id][action]);
    tried[class_id][action]++;
}

static void read_tables(void) {
    for (uint32_t c = 0; c < player_stats(&p).classes; c++)
        for (uint32_t a = 0; a < ACTIONS; a++) {
            float got;
            assert_int_equal(rlvc_q(p.agent, c, a, &got, &tried[c][a]), RLVC_OK);
            q[c][a] = (double)got;
        }
}

static void compare_tables(void) {
    for (uint32_t c = 0; c < player_stats(&p).classes; c++) {
        float got;
        uint32_t samples, action;
        for (uint32_t a = 0; a < ACTIONS; a++) {
            assert_int_equal(rlvc_q(p.agent, c, a, &got, &samples), RLVC_OK);
            assert_int_equal(samples, tried[c][a]);
            assert_true(fabs((double)got - q[c][a]) < 1e-4 * (1.0 + fabs(q[c][a])));
        }
        assert_int_equal(rlvc_value(p.agent, c, &got, &action), RLVC_OK);
        assert_true(fabs((double)got - value_of(c)) < 1e-4 * (1.0 + fabs(value_of(c))));
    }
}

/* What one observation should do to the tables. */
static void learn_plainly(waiting *before, uint32_t class_id, uint32_t action, double reward,
                          uint32_t next, uint8_t end) {
    const double gamma = (double)p.config.discount;
    const int sarsa = p.config.solver == RLVC_SOLVER_SARSA;
    double target = end == RLVC_TERMINATED ? reward : reward + gamma * value_of(next);
    double q_now = q[class_id][action];
    if (sarsa && before->any)
        update(before->class_id, before->action, before->reward + gamma * q_now);
    if (!sarsa || end != RLVC_GOES_ON)
        update(class_id, action, target);
    *before = (waiting){class_id, action, reward, end == RLVC_GOES_ON};
}

static void play_and_compare(uint32_t interactions) {
    waiting before = {0, 0, 0.0, 0};
    read_tables();
    p.playing = 0;
    for (uint32_t i = 0; i < interactions; i++) {
        rlvc_choice choice;
        float reward;
        if (!p.playing) {
            player_begin(&p);
            before.any = 0;
        }
        uint32_t class_id = class_of(p.percept);
        assert_int_equal(rlvc_act(p.agent, &choice), RLVC_OK);
        int at_exit = gridworld_step(&p.world, choice.action, &reward);
        uint8_t end = at_exit ? RLVC_TERMINATED : i % 9u == 8u ? RLVC_TRUNCATED : RLVC_GOES_ON;
        gridworld_percept(&p.world, p.percept);
        learn_plainly(&before, class_id, choice.action, (double)reward, class_of(p.percept), end);
        assert_int_equal(rlvc_observe(p.agent, choice, reward, p.percept, end), RLVC_OK);
        compare_tables();
        p.playing = end == RLVC_GOES_ON && i % 13u != 12u; /* or it is torn */
        if (end != RLVC_GOES_ON)
            gridworld_reset(&p.world);
    }
}

static void test_against_the_formulas(void **state) {
    (void)state;
    for (uint32_t i = 0; i < 12u; i++) {
        player_enter_world(&p, BATCH);
        p.config.solver = (uint8_t)(RLVC_SOLVER_Q_LEARNING + i % 2u);
        p.config.capacity = i < 4u ? 300 : i < 8u ? 1 : 2;
        p.config.min_samples = 2;
        player_init(&p);
        for (int step = 0; step < 3; step++) {
            play_and_compare(250);
            player_learn(&p, RLVC_BUDGET_UNBOUNDED, NULL);
        }
        assert_true(i >= 4u || player_stats(&p).classes > 1u);
    }
}

/* The count of interactions stops where it cannot go on. */
static void test_very_many_interactions(void **state) {
    (void)state;
    const rlvc_choice choice = {2, 0};
    uint32_t samples = 0;
    player_enter_world(&p, BATCH);
    p.config.solver = RLVC_SOLVER_Q_LEARNING;
    player_init(&p);
    p.agent->values.tried[2] = UINT32_MAX - 1u;
    for (int i = 0; i < 3; i++) {
        player_begin(&p);
        assert_int_equal(rlvc_observe(p.agent, choice, 1.0f, NULL, RLVC_TERMINATED), RLVC_OK);
        assert_int_equal(rlvc_q(p.agent, 0, 2, NULL, &samples), RLVC_OK);
        assert_int_equal(samples, UINT32_MAX);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_against_the_formulas),
        cmocka_unit_test(test_very_many_interactions),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
