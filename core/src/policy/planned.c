/* SPDX-License-Identifier: MIT */
/* The policy that a planner has learnt, as a policy by itself: see rlvc/planner.h.
 *
 * A small tree has the layout of a tree of classes already: test j's children are nodes 2j + 1 and
 * 2j + 2, and the leaf that it splits is the one that the parent of the tested node had. */
#include "rlvc/float_rules.h"

#include "policy.h"

#include "../base/assert.h"
#include "rlvc/planner.h"
#include "rlvc/thresholds.h"

#include <string.h>

#define TESTS_MAX (RLVC_PLANNER_LEAVES_MAX - 1u)
#define NODES_MAX (2u * TESTS_MAX + 1u)

typedef struct nodes {
    const rlvc_planner_test *node;
    uint32_t count;
    uint8_t tested[TESTS_MAX]; /* the node of the j-th test */
} nodes;

static void carve(rlvc_policy *policy, rlvc_arena *arena) {
    (void)rlvc_arena_carve(arena, 1, sizeof *policy);
    rlvc_tree_carve(&policy->tree, arena, RLVC_PLANNER_LEAVES_MAX, RLVC_THRESHOLDS_FEATURE_BYTES);
    policy->action = rlvc_arena_carve(arena, RLVC_PLANNER_LEAVES_MAX, sizeof *policy->action);
}

static rlvc_threshold feature_of(const rlvc_planner_test *node) {
    const rlvc_threshold feature = {node->cutpoint, 0.0f, node->component, 0};
    return feature;
}

/* Notes node k as the test that its child names.
 * @return 1; 0: it is not a test, or its child comes before it, or has another parent already. */
static int note_test(nodes *tree, uint32_t k, const rlvc_domain *thresholds) {
    const rlvc_planner_test *node = tree->node + k;
    const rlvc_threshold feature = feature_of(node);
    uint32_t child = node->child, j = child / 2u;
    if (child % 2u == 0 || child <= k || child >= tree->count || tree->tested[j] != NODES_MAX ||
        thresholds->check_feature(thresholds->ctx, &feature) != 0)
        return 0;
    tree->tested[j] = (uint8_t)k;
    return 1;
}

/* Are the nodes a tree? Then every pair of children has a parent, as there is a test for each. */
static int is_tree(nodes *tree, uint32_t actions, const rlvc_domain *thresholds) {
    uint32_t leaves = 0;
    memset(tree->tested, NODES_MAX, sizeof tree->tested);
    for (uint32_t k = 0; k < tree->count; k++) {
        int leaf = tree->node[k].component == RLVC_PLANNER_LEAF;
        if (leaf ? tree->node[k].action >= actions : !note_test(tree, k, thresholds))
            return 0;
        leaves += (uint32_t)leaf;
    }
    return 2u * leaves == tree->count + 1u;
}

/* Splits leaves in the order of the tests, and gives each leaf its action. */
static void copy_tree(const nodes *tree, rlvc_policy *policy) {
    rlvc_tree_clear(&policy->tree);
    for (uint32_t j = 0; 2u * j + 1u < tree->count; j++) {
        const rlvc_threshold feature = feature_of(tree->node + tree->tested[j]);
        rlvc_split about;
        memset(&about, 0, sizeof about);
        about.class_id = rlvc_tree_class(&policy->tree, tree->tested[j]);
        rlvc_tree_grow(&policy->tree, tree->tested[j], &about, &feature);
    }
    for (uint32_t k = 0; k < tree->count; k++)
        if (tree->node[k].component == RLVC_PLANNER_LEAF)
            policy->action[rlvc_tree_class(&policy->tree, k)] = tree->node[k].action;
}

rlvc_status rlvc_planner_policy_of(const rlvc_planner_test *node, uint32_t count, uint32_t actions,
                                   const rlvc_domain *thresholds, void *memory, size_t bytes,
                                   rlvc_policy **policy) {
    nodes tree = {node, count, {0}};
    rlvc_arena arena = {(unsigned char *)memory, 0};
    if (!policy)
        return RLVC_E_NULL;
    *policy = NULL;
    if (!node || !thresholds)
        return RLVC_E_NULL;
    if (thresholds->kind != RLVC_DOMAIN_THRESHOLDS)
        return RLVC_E_MISMATCH;
    if (actions > RLVC_PLANNER_ACTIONS_MAX || count > NODES_MAX ||
        !is_tree(&tree, actions, thresholds))
        return RLVC_E_RANGE;
    rlvc_status status = rlvc_arena_check(memory, bytes, RLVC_PLANNER_POLICY_BYTES);
    if (status != RLVC_OK)
        return status;
    const rlvc_domain copied = *thresholds; /* it may lie in the block */
    rlvc_policy *made = memory;
    RLVC_UNPOISON(memory, RLVC_PLANNER_POLICY_BYTES);
    memset(made, 0, sizeof *made);
    carve(made, &arena);
    RLVC_ASSERT(arena.used <= RLVC_PLANNER_POLICY_BYTES);
    made->domain = copied;
    made->actions = actions;
    copy_tree(&tree, made);
    *policy = made;
    return RLVC_OK;
}

rlvc_status rlvc_planner_policy(const rlvc_planner *planner, const rlvc_domain *thresholds,
                                void *memory, size_t bytes, rlvc_policy **policy) {
    rlvc_planner_test node[NODES_MAX];
    rlvc_planner_config config;
    uint32_t count = 0;
    if (!policy)
        return RLVC_E_NULL;
    *policy = NULL;
    if (!planner || !thresholds)
        return RLVC_E_NULL;
    (void)rlvc_planner_config_of(planner, &config);
    if (thresholds->percept_bytes != RLVC_THRESHOLDS_PERCEPT_BYTES(config.components))
        return RLVC_E_MISMATCH;
    while (rlvc_planner_node(planner, count, node + count) == RLVC_OK)
        count++;
    return rlvc_planner_policy_of(node, count, config.actions, thresholds, memory, bytes, policy);
}
