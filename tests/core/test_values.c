/* SPDX-License-Identifier: MIT */
/* Tables by class and action: the greedy action and its ties, untried pairs, inheritance,
 * checking. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "block.h"
#include "tree/values.h"

#define CLASSES 3u
#define ACTIONS 3u

static uint64_t block[256];
static rlvc_values values;

static void make(void) {
    rlvc_arena arena = {(unsigned char *)block, 0};
    rlvc_config config;
    memset(&config, 0, sizeof config);
    config.classes = CLASSES;
    config.actions = ACTIONS;
    block_fill(block, 0xa5, sizeof block);
    rlvc_values_carve(&values, &arena, &config);
    assert_true(arena.used <= sizeof block);
    rlvc_values_clear(&values);
}

static void test_new_class(void **state) {
    (void)state;
    make();
    for (uint32_t a = 0; a < ACTIONS; a++) {
        assert_float_equal(values.q[a], 0.0f, 0.0f);
        assert_int_equal(values.tried[a], 0);
    }
    assert_float_equal(rlvc_values_best(&values, 0), 0.0f, 0.0f);
    assert_int_equal(rlvc_values_greedy(&values, 0), 0);
    assert_true(rlvc_values_check(&values, 1));
}

/* A class that was greedy for action 1 and worth 9. */
static void test_greedy(void **state) {
    (void)state;
    const struct {
        float q[ACTIONS];
        uint32_t tried[ACTIONS];
        uint32_t action;
        float value;
    } cases[] = {
        {{1.0f, 2.0f, 3.0f}, {1, 1, 1}, 2, 3.0f},
        {{3.0f, 2.0f, 3.0f}, {1, 1, 1}, 0, 3.0f}, /* the lower of equals */
        {{-0.0f, 0.0f, -1.0f}, {1, 1, 1}, 0, 0.0f},
        {{9.0f, 2.0f, 3.0f}, {0, 1, 1}, 2, 3.0f},
        {{9.0f, -2.0f, 3.0f}, {0, 1, 0}, 1, -2.0f},
        {{8.0f, 7.0f, 6.0f}, {0, 0, 0}, 1, 9.0f}, /* all as it was */
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        make();
        memcpy(values.q, cases[i].q, sizeof cases[i].q);
        memcpy(values.tried, cases[i].tried, sizeof cases[i].tried);
        values.value[0] = 9.0f;
        values.policy[0] = 1;
        assert_int_equal(rlvc_values_greedy(&values, 0), cases[i].action);
        assert_float_equal(rlvc_values_best(&values, 0), cases[i].value, 0.0f);
    }
}

static void test_inherit_and_forget(void **state) {
    (void)state;
    make();
    for (uint32_t a = 0; a < ACTIONS; a++) {
        values.q[a] = 1.5f * (float)a;
        values.pair.reward[a] = -(float)a;
        values.tried[a] = 10u + a;
    }
    values.value[0] = 4.0f;
    values.policy[0] = 2;
    values.trial[0] = 1;
    rlvc_values_inherit(&values, 2, 0);
    assert_memory_equal(values.q + 2u * ACTIONS, values.q, ACTIONS * sizeof *values.q);
    assert_memory_equal(values.pair.reward + 2u * ACTIONS, values.pair.reward,
                        ACTIONS * sizeof *values.q);
    assert_memory_equal(values.tried + 2u * ACTIONS, values.tried, ACTIONS * sizeof *values.tried);
    assert_float_equal(values.value[2], 4.0f, 0.0f);
    assert_int_equal(values.policy[2], 2);
    assert_int_equal(values.trial[2], 1);
    rlvc_values_forget(&values, 0);
    for (uint32_t a = 0; a < ACTIONS; a++) {
        assert_int_equal(values.tried[a], 0);
        assert_int_equal(values.tried[2u * ACTIONS + a], 10u + a);
        assert_float_equal(values.q[a], 1.5f * (float)a, 0.0f);
    }
}

static void test_check_finds_damage(void **state) {
    (void)state;
    const float zero = 0.0f;
    for (int damage = 0; damage < 6; damage++) {
        make();
        rlvc_values_inherit(&values, 1, 0);
        assert_true(rlvc_values_check(&values, 2));
        if (damage < 2)
            (damage == 0 ? values.policy : values.trial)[1] = ACTIONS;
        else
            (damage < 4 ? values.value : values.q + ACTIONS)[1] =
                damage % 2 == 0 ? zero / zero : 1.0f / zero;
        assert_false(rlvc_values_check(&values, 2));
        assert_true(rlvc_values_check(&values, 1));
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_new_class),
        cmocka_unit_test(test_greedy),
        cmocka_unit_test(test_inherit_and_forget),
        cmocka_unit_test(test_check_finds_damage),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
