/* SPDX-License-Identifier: MIT */
/* A planner's policy from nodes that were kept. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "rlvc/planner.h"
#include "rlvc/thresholds.h"
#include <math.h>
#include <string.h>

#define LEAF RLVC_PLANNER_LEAF
#define COUNT 7u

static uint64_t block[RLVC_PLANNER_POLICY_BYTES / 8u];

/* x[1] > 0.5 ? (x[0] > -1 ? 2 : 1) : (x[0] > 1 ? 0 : 3); the last test split first. */
static const rlvc_planner_test nodes[COUNT] = {
    {0.5f, 1, 1, 0},    {1.0f, 0, 5, 0},    {-1.0f, 0, 3, 0},   {0.0f, LEAF, 0, 1},
    {0.0f, LEAF, 0, 2}, {0.0f, LEAF, 0, 3}, {0.0f, LEAF, 0, 0},
};

static uint32_t expected(const float *x) {
    if (x[1] > 0.5f)
        return x[0] > -1.0f ? 2u : 1u;
    return x[0] > 1.0f ? 0u : 3u;
}

static rlvc_domain domain_of(rlvc_thresholds *thresholds, uint32_t components) {
    rlvc_domain domain;
    assert_int_equal(rlvc_thresholds_default(thresholds, components), RLVC_OK);
    assert_int_equal(rlvc_thresholds_domain(thresholds, &domain), RLVC_OK);
    return domain;
}

static void test_it_acts_as_the_nodes_say(void **state) {
    (void)state;
    rlvc_thresholds thresholds;
    rlvc_domain domain = domain_of(&thresholds, 2);
    rlvc_policy *policy;
    assert_int_equal(rlvc_planner_policy_of(nodes, COUNT, 4, &domain, block, sizeof block, &policy),
                     RLVC_OK);
    for (int i = -20; i <= 20; i++) {
        for (int j = -20; j <= 20; j++) {
            float x[2] = {0.125f * (float)i, 0.125f * (float)j};
            uint32_t action;
            assert_int_equal(rlvc_policy_act(policy, x, &action), RLVC_OK);
            assert_int_equal(action, expected(x));
        }
    }
    assert_int_equal(rlvc_planner_policy_of(nodes + 3, 1, 2, &domain, block, sizeof block, &policy),
                     RLVC_OK);
    uint32_t action;
    assert_int_equal(rlvc_policy_act(policy, (const float[]){0.0f, 0.0f}, &action), RLVC_OK);
    assert_int_equal(action, 1);
}

static rlvc_status made_of(const rlvc_planner_test *node, uint32_t count, uint32_t actions) {
    rlvc_thresholds thresholds;
    rlvc_domain domain = domain_of(&thresholds, 2);
    rlvc_policy *policy;
    rlvc_status status =
        rlvc_planner_policy_of(node, count, actions, &domain, block, sizeof block, &policy);
    assert_int_equal(policy == NULL, status != RLVC_OK);
    return status;
}

/* With one node changed. */
static rlvc_status changed(uint32_t k, rlvc_planner_test to) {
    rlvc_planner_test node[COUNT];
    memcpy(node, nodes, sizeof node);
    node[k] = to;
    return made_of(node, COUNT, 4);
}

static void test_what_is_no_tree(void **state) {
    (void)state;
    static const struct {
        uint32_t k;
        rlvc_planner_test to;
    } wrong[] = {
        {1, {1.0f, 0, 4, 0}},     /* an even child */
        {1, {1.0f, 0, 1, 0}},     /* itself */
        {2, {1.0f, 0, 1, 0}},     /* a child before it */
        {1, {1.0f, 0, 7, 0}},     /* a child that there is not */
        {1, {1.0f, 0, 3, 0}},     /* the child of another, too */
        {1, {1.0f, 2, 5, 0}},     /* a component that there is not */
        {1, {INFINITY, 0, 5, 0}}, /* a cutpoint that is no number */
        {1, {NAN, 0, 5, 0}},      /* nor is this */
        {1, {0.0f, LEAF, 0, 0}},  /* a pair of nodes without a parent */
        {3, {0.0f, LEAF, 0, 4}},  /* an action that there is not */
        {3, {0.0f, 0, 7, 0}},     /* a test more */
    };
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++)
        assert_int_equal(changed(wrong[i].k, wrong[i].to), RLVC_E_RANGE);
    assert_int_equal(changed(1, nodes[1]), RLVC_OK);
    static const uint32_t counts[] = {0, 2, 3, 5, 6, 2u * RLVC_PLANNER_LEAVES_MAX, UINT32_MAX};
    for (size_t i = 0; i < sizeof counts / sizeof *counts; i++)
        assert_int_equal(made_of(nodes, counts[i], 4), RLVC_E_RANGE);
    assert_int_equal(made_of(nodes, COUNT, 3), RLVC_E_RANGE);
    assert_int_equal(made_of(nodes, COUNT, 0), RLVC_E_RANGE);
    assert_int_equal(made_of(nodes, COUNT, RLVC_PLANNER_ACTIONS_MAX + 1u), RLVC_E_RANGE);
    assert_int_equal(made_of(nodes, COUNT, RLVC_PLANNER_ACTIONS_MAX), RLVC_OK);
}

static void test_the_most_leaves(void **state) {
    (void)state;
    rlvc_planner_test node[2u * RLVC_PLANNER_LEAVES_MAX + 1u]; /* a chain */
    for (uint32_t k = 0; k < 2u * RLVC_PLANNER_LEAVES_MAX + 1u; k++) {
        node[k] = (rlvc_planner_test){(float)k, 0, (uint8_t)(k + 1u), 0};
        if (k % 2u != 0 || k >= 2u * RLVC_PLANNER_LEAVES_MAX - 2u)
            node[k] = (rlvc_planner_test){0.0f, LEAF, 0, (uint8_t)(k / 2u)};
    }
    assert_int_equal(made_of(node, 2u * RLVC_PLANNER_LEAVES_MAX - 1u, 64), RLVC_OK);
    node[2u * RLVC_PLANNER_LEAVES_MAX - 2u] =
        (rlvc_planner_test){0.0f, 0, (uint8_t)(2u * RLVC_PLANNER_LEAVES_MAX - 1u), 0};
    assert_int_equal(made_of(node, 2u * RLVC_PLANNER_LEAVES_MAX + 1u, 64), RLVC_E_RANGE);
}

static void test_other_arguments(void **state) {
    (void)state;
    rlvc_thresholds thresholds;
    rlvc_domain domain = domain_of(&thresholds, 2);
    rlvc_policy *policy = (rlvc_policy *)block;
    size_t bytes = sizeof block;
    assert_int_equal(rlvc_planner_policy_of(nodes, COUNT, 4, &domain, block, bytes, NULL),
                     RLVC_E_NULL);
    assert_int_equal(rlvc_planner_policy_of(NULL, COUNT, 4, &domain, block, bytes, &policy),
                     RLVC_E_NULL);
    assert_null(policy);
    assert_int_equal(rlvc_planner_policy_of(nodes, COUNT, 4, NULL, block, bytes, &policy),
                     RLVC_E_NULL);
    assert_int_equal(rlvc_planner_policy_of(nodes, COUNT, 4, &domain, NULL, bytes, &policy),
                     RLVC_E_NULL);
    assert_int_equal(rlvc_planner_policy_of(nodes, COUNT, 4, &domain, block, bytes - 1u, &policy),
                     RLVC_E_MEMORY);
    domain.kind = RLVC_DOMAIN_OWN;
    assert_int_equal(rlvc_planner_policy_of(nodes, COUNT, 4, &domain, block, bytes, &policy),
                     RLVC_E_MISMATCH);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_it_acts_as_the_nodes_say),
        cmocka_unit_test(test_what_is_no_tree),
        cmocka_unit_test(test_the_most_leaves),
        cmocka_unit_test(test_other_arguments),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
