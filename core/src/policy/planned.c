/* SPDX-License-Identifier: MIT */
/* The policy that a planner has learnt, as a policy by itself: see rlvc/policy.h and
 * rlvc/planner.h.
 *
 * A small tree has the layout of a tree of classes already: test j's children are nodes 2j + 1 and
 * 2j + 2, and the leaf that it splits is the one that the parent of the tested node had. */
#include "rlvc/float_rules.h"

#include "policy.h"

#include "../base/assert.h"
#include "../base/method.h"
#include "../plan/small_tree.h"
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

/* Makes an empty policy in a block.
 * @return RLVC_OK; as of rlvc_arena_check. */
static rlvc_status make(const rlvc_domain *domain, uint32_t actions, void *memory, size_t bytes,
                        rlvc_policy **policy) {
    rlvc_arena arena = {(unsigned char *)memory, 0};
    const rlvc_status status = rlvc_arena_check(memory, bytes, RLVC_PLANNER_POLICY_BYTES);
    if (status != RLVC_OK)
        return status;
    const rlvc_domain copied = *domain; /* it may lie in the block */
    rlvc_policy *made = memory;
    RLVC_UNPOISON(memory, RLVC_PLANNER_POLICY_BYTES);
    memset(made, 0, sizeof *made);
    carve(made, &arena);
    RLVC_ASSERT(arena.used <= RLVC_PLANNER_POLICY_BYTES);
    made->domain = copied;
    made->actions = actions;
    *policy = made;
    return RLVC_OK;
}

static void copy_node(const rlvc_planner_test *from, rlvc_small_node *node) {
    node->cut = from->cutpoint;
    node->component = from->component;
    node->child = from->child;
    node->action = from->action;
}

/* In pairs of children: test j has nodes 2j + 1 and 2j + 2. */
static void copy_nodes(const nodes *from, rlvc_small_tree *tree) {
    const uint32_t tests = from->count / 2u;
    copy_node(from->node, tree->node);
    for (uint32_t j = 0; j < tests; j++) {
        copy_node(from->node + 2u * j + 1u, tree->node + 2u * j + 1u);
        copy_node(from->node + 2u * j + 2u, tree->node + 2u * j + 2u);
    }
    tree->nodes = (uint8_t)(2u * tests + 1u);
    tree->leaves = (uint8_t)(tests + 1u);
}

rlvc_status rlvc_planner_policy_of(const rlvc_planner_test *node, uint32_t count, uint32_t actions,
                                   const rlvc_domain *thresholds, void *memory, size_t bytes,
                                   rlvc_policy **policy) {
    nodes tree = {node, count, {0}};
    rlvc_small_tree copied;
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
    copy_nodes(&tree, &copied); /* it may lie in the block */
    const rlvc_status status = make(thresholds, actions, memory, bytes, policy);
    if (status == RLVC_OK)
        rlvc_small_tree_grow(&copied, &(*policy)->tree, (*policy)->action);
    return status;
}

rlvc_status rlvc_policy_of_planner(rlvc_agent *agent, void *memory, size_t bytes,
                                   rlvc_policy **policy, rlvc_policy_info *info) {
    rlvc_learnt learnt;
    rlvc_view(agent, &learnt);
    if (*learnt.busy)
        return RLVC_E_REENTERED;
    const rlvc_tree *tree = learnt.tree;
    const rlvc_status status = make(learnt.domain, learnt.actions, memory, bytes, policy);
    if (status != RLVC_OK)
        return status;
    rlvc_tree_clear(&(*policy)->tree);
    for (uint32_t j = 0; j + 1u < tree->classes; j++)
        rlvc_tree_grow(&(*policy)->tree, tree->split[j].node, &tree->split[j].about,
                       rlvc_tree_feature(tree, j));
    memcpy((*policy)->action, learnt.policy, tree->classes);
    if (info) {
        memset(info, 0, sizeof *info);
        info->classes = info->collapsed = info->leaves = tree->classes;
        info->bytes = RLVC_PLANNER_POLICY_BYTES;
        info->as_agent = 1;
    }
    return RLVC_OK;
}
