/* SPDX-License-Identifier: MIT */
/* Which level a split must pass: its share of alpha if its feature is new to the tree, alpha_known
 * if the tree tests the feature elsewhere. The class under test has one feature with a p-value
 * between the two. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "agent/state.h"
#include "rlvc/bits.h"

#include <string.h>

#define BITS 64u
#define JUNK 2u /* bits from this one on are 1 in no percept */
#define WEAK 1u /* tells rewards apart, a little */
#define CLASSES 56u
#define CAPACITY 40u

static uint64_t
    block[RLVC_AGENT_BYTES(1, CAPACITY, CLASSES, 8, RLVC_BITS_FEATURE_BYTES, BITS) / 8u];

static void grow(rlvc_agent *agent, uint32_t class_id, uint32_t bit) {
    const unsigned char feature[2] = {(unsigned char)bit, 0};
    rlvc_split about;
    uint32_t made = agent->tree.classes;
    memset(&about, 0, sizeof about);
    about.class_id = class_id;
    rlvc_tree_grow(&agent->tree, rlvc_tree_leaf(&agent->tree, class_id), &about, feature);
    rlvc_values_inherit(&agent->values, made, class_id);
    rlvc_explorer_inherit(&agent->explorer, 1, made, class_id);
    agent->pending[made] = 0;
}

/* 20 percepts with the weak bit, of which 13 are worth 1, and 20 without, of which 7 are. */
static void observe(rlvc_agent *agent) {
    for (uint32_t i = 0; i < 40u; i++) {
        unsigned char percept[8] = {(unsigned char)(i % 2u << WEAK), 0, 0, 0, 0, 0, 0, 0};
        const rlvc_choice choice = {0, 0};
        const float reward = i / 2u < (i % 2u ? 13u : 7u) ? 1.0f : 0.0f;
        assert_int_equal(rlvc_begin(agent, percept), RLVC_OK);
        assert_int_equal(rlvc_observe(agent, choice, reward, NULL, RLVC_TERMINATED), RLVC_OK);
    }
}

/* Splits that learning makes of a tree of `junk` tests; the weak bit is number `known` of them, if
 * that is below `junk`. */
static uint32_t splits_made(uint32_t junk, uint32_t known, float alpha_known) {
    rlvc_domain domain;
    rlvc_config config;
    rlvc_agent *agent;
    rlvc_progress progress;
    assert_int_equal(rlvc_bits_domain(BITS, &domain), RLVC_OK);
    assert_int_equal(rlvc_config_default(&config, &domain, 1), RLVC_OK);
    config.capacity = CAPACITY;
    config.classes = CLASSES;
    config.successors = 0;
    config.alpha = 0.01f;
    config.alpha_known = alpha_known;
    assert_int_equal(rlvc_agent_init(&config, &domain, block, sizeof block, &agent), RLVC_OK);
    for (uint32_t j = 0; j < junk; j++)
        grow(agent, j == known ? j : 0, j == known ? WEAK : JUNK + j);
    /* Behind the tree's features the weak bit does not count. */
    memset(rlvc_tree_feature(&agent->tree, junk), 0, RLVC_BITS_FEATURE_BYTES);
    *rlvc_tree_feature(&agent->tree, junk) = WEAK;
    observe(agent);
    assert_int_equal(rlvc_learn(agent, RLVC_BUDGET_UNBOUNDED, &progress), RLVC_OK);
    assert_int_equal(rlvc_agent_check(agent), RLVC_OK);
    for (uint32_t j = junk; j + 1u < agent->tree.classes; j++) {
        assert_int_equal(rlvc_bits_feature(rlvc_tree_feature(&agent->tree, j)), WEAK);
        assert_true(agent->tree.split[j].about.log_p < 0.0f);
        assert_true(agent->tree.split[j].about.log_p > -4.0f); /* ln of 0.01 is -4.6 */
    }
    return agent->tree.classes - 1u - junk;
}

static void test_new_features(void **state) {
    (void)state;
    for (uint32_t junk = 0; junk <= 50u; junk++)
        assert_int_equal(splits_made(junk, junk, 1.0f), 0);
}

/* Number 0 would be the root, which parts the class. */
static void test_known_features(void **state) {
    (void)state;
    for (uint32_t known = 1; known < 50u; known++) {
        assert_int_equal(splits_made(known + 1u, known, 1.0f), 1);
        assert_int_equal(splits_made(50u, known, 1.0f), 1);
        assert_int_equal(splits_made(50u, known, 1e-3f), 0);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_new_features),
        cmocka_unit_test(test_known_features),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
