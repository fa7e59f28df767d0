/* SPDX-License-Identifier: MIT */
/* The policy that a planner has learnt, as a policy by itself: see rlvc/planner.h.
 *
 * A small tree has the layout of a tree of classes already: test j's children are nodes 2j + 1 and
 * 2j + 2, and the leaf that it splits is the one that the parent of the tested node had. */
#include "policy.h"

#include "../base/assert.h"
#include "rlvc/planner.h"
#include "rlvc/thresholds.h"

#include <string.h>

static void carve(rlvc_policy *policy, rlvc_arena *arena) {
    (void)rlvc_arena_carve(arena, 1, sizeof *policy);
    rlvc_tree_carve(&policy->tree, arena, RLVC_PLANNER_LEAVES_MAX, RLVC_THRESHOLDS_FEATURE_BYTES);
    policy->action = rlvc_arena_carve(arena, RLVC_PLANNER_LEAVES_MAX, sizeof *policy->action);
}

/* Splits leaves in the order of the tests, and gives each leaf its action. */
static void copy_tree(const rlvc_planner *planner, uint32_t nodes, rlvc_policy *policy) {
    uint8_t tested[RLVC_PLANNER_LEAVES_MAX]; /* the node of the j-th test */
    rlvc_planner_test node;
    for (uint32_t k = 0; k < nodes; k++) {
        (void)rlvc_planner_node(planner, k, &node);
        if (node.component != RLVC_PLANNER_LEAF)
            tested[node.child / 2u] = (uint8_t)k;
    }
    rlvc_tree_clear(&policy->tree);
    for (uint32_t j = 0; 2u * j + 1u < nodes; j++) {
        (void)rlvc_planner_node(planner, tested[j], &node);
        rlvc_threshold feature = {node.cutpoint, 0.0f, node.component, 0};
        rlvc_split about;
        memset(&about, 0, sizeof about);
        about.class_id = rlvc_tree_class(&policy->tree, tested[j]);
        rlvc_tree_grow(&policy->tree, &about, &feature);
    }
    for (uint32_t k = 0; k < nodes; k++) {
        (void)rlvc_planner_node(planner, k, &node);
        if (node.component == RLVC_PLANNER_LEAF)
            policy->action[rlvc_tree_class(&policy->tree, k)] = node.action;
    }
}

rlvc_status rlvc_planner_policy(const rlvc_planner *planner, const rlvc_domain *thresholds,
                                void *memory, size_t bytes, rlvc_policy **policy) {
    rlvc_planner_statistics statistics;
    rlvc_planner_config config;
    rlvc_arena arena = {(unsigned char *)memory, 0};
    if (!policy)
        return RLVC_E_NULL;
    *policy = NULL;
    if (!planner || !thresholds || !memory)
        return RLVC_E_NULL;
    (void)rlvc_planner_stats(planner, &statistics);
    (void)rlvc_planner_config_of(planner, &config);
    if (thresholds->kind != RLVC_DOMAIN_THRESHOLDS ||
        thresholds->percept_bytes != RLVC_THRESHOLDS_PERCEPT_BYTES(config.components))
        return RLVC_E_MISMATCH;
    if ((uintptr_t)memory % RLVC_ALIGNMENT != 0 || bytes < RLVC_PLANNER_POLICY_BYTES)
        return RLVC_E_MEMORY;
    const rlvc_domain copied = *thresholds; /* it may lie in the block */
    rlvc_policy *made = memory;
    RLVC_UNPOISON(memory, RLVC_PLANNER_POLICY_BYTES);
    memset(made, 0, sizeof *made);
    carve(made, &arena);
    RLVC_ASSERT(arena.used <= RLVC_PLANNER_POLICY_BYTES);
    made->domain = copied;
    made->actions = config.actions;
    copy_tree(planner, 2u * statistics.leaves - 1u, made);
    *policy = made;
    return RLVC_OK;
}
