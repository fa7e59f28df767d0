/* SPDX-License-Identifier: MIT */
/* The agent's policy by itself, made as small as possible, to be deployed without what learning
 * needs.
 *
 * The agent's tree separates situations that are worth different amounts. A policy only has to
 * separate situations that need different actions. So this searches for the smallest tree, over the
 * features of the agent's tree, that at each percept in the agent's ring takes the agent's action
 * or one that is as good, and then evaluates it: if it is worth less than the agent's policy, the
 * search is repeated with fewer actions allowed. See rlvc/min_tree.h for how. The tree of a planner
 * is small already, and becomes the policy as it is.
 *
 * A policy lies at the beginning of a block of the caller's and is independent of the agent from
 * then on; its domain's ctx must stay. It is used by one thread at a time. Every function here
 * returns RLVC_E_NULL for a null pointer that is not marked optional, and RLVC_E_REENTERED when a
 * callback of the domain calls it. */
#ifndef RLVC_POLICY_H
#define RLVC_POLICY_H

#include "rlvc/agent.h"
#include "rlvc/export.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct rlvc_policy rlvc_policy;

/* Options of the search. Start from rlvc_policy_default. */
typedef struct rlvc_policy_config {
    /* What the policy may lose: no class is worth less than under the agent's policy by more than
     * this share of the spread of Q, its largest less its smallest, [0, 1]. 0: it loses nothing.
     * That is checked in the model of the interactions that the agent has learnt from (section
     * 4.1); see value_after. Default 0. */
    float tolerance;

    /* Distinct ones that there is room for, [1, RLVC_MIN_TREE_ROWS_MAX]. Two are distinct if one
     * exhibits a feature of the tree that the other does not. Default the number of percepts that
     * the ring can hold, 16384 at most. */
    uint32_t percepts;

    uint32_t entries;  /* of the table, [2, RLVC_MIN_TREE_ENTRIES_MAX]. Default 65536: for up to 64
                          features that takes 1.5 MiB */
    uint32_t reserved; /* 0 */
    uint64_t effort;   /* [1, RLVC_MIN_TREE_EFFORT_MAX]. Default 2^26, some seconds of a workstation
                          at worst */
} rlvc_policy_config;

/* Fills *config with the defaults for an agent; of a planner nobody looks at them. O(1).
 * @return RLVC_OK. */
RLVC_API rlvc_status rlvc_policy_default(const rlvc_agent *agent, rlvc_policy_config *config);

/* The exact size of the block that rlvc_policy_make needs, for the agent as it is: it depends on
 * the number of classes and of the distinct features among its tests. O(classes^2) comparisons of
 * features.
 * @return RLVC_OK; RLVC_E_RANGE: a field of the config, or RLVC_E_MEMORY if no size_t holds the
 * size: *bytes is then 0. */
RLVC_API rlvc_status rlvc_policy_size(const rlvc_agent *agent, const rlvc_policy_config *config,
                                      size_t *bytes);

/* Result of the search. */
typedef struct rlvc_policy_info {
    uint32_t classes;   /* leaves of the agent's tree */
    uint32_t collapsed; /* left, once every subtree whose leaves all act alike has become one: no
                           action changes, at no percept whatever */
    uint32_t leaves;    /* of the policy */
    uint32_t percepts;  /* distinct ones in the ring that it was made for */
    uint32_t features;  /* distinct ones that the agent's tree tests */
    uint32_t bytes;     /* of the block that the policy still needs, from its beginning on */

    /* 1: no tree over these features has fewer leaves and does what is allowed at each percept of
     * the ring; 0: table or effort did not suffice to know it. */
    uint8_t exact;

    /* 1: takes the agent's action at every possible percept, since nothing smaller than the
     * collapsed tree was found, or there was no room for the percepts, or the agent has more than
     * RLVC_MIN_TREE_ACTIONS_MAX actions. 0: at a percept unlike all of the ring's it does what is
     * done at the percepts of the leaf that it comes to. */
    uint8_t as_agent;

    uint8_t reserved[2];

    /* What the agent's policy is worth, and at least this policy: the means of V, evaluated in that
     * model, over the interactions behind the classes. An action's Q stands for what follows it
     * where the ring holds none. At percepts of one class the policy may take several actions; the
     * worst of them counts. So they are equal, but for rounding, unless `tolerance` allows a loss.
     * Of a planner 0. */
    float value_before;
    float value_after;
} rlvc_policy_info;

/* Makes a policy of an agent, which is unchanged; best between learning steps, as while one is
 * under way the actions and values are those of the last solution. A step by RLVC_CRITERION_RETURNS
 * leaves the ring without percepts: then after more interactions. O(P (F + depth)) for the P
 * percepts of the ring and F features, with as many calls of exhibits(); then that of
 * rlvc_min_tree, twice at most without a tolerance, 8 times with one, and sweeps over the model's
 * transitions.
 * @param memory aligned to RLVC_ALIGNMENT; `bytes` of it, rlvc_policy_size or more
 * @param info optional
 * @return RLVC_OK; RLVC_E_RANGE: a field of the config; RLVC_E_MEMORY; RLVC_E_CALLBACK. On error
 * *policy is null. */
RLVC_API rlvc_status rlvc_policy_make(rlvc_agent *agent, const rlvc_policy_config *config,
                                      void *memory, size_t bytes, rlvc_policy **policy,
                                      rlvc_policy_info *info);

/* The action at a percept. O(depth) calls of exhibits().
 * @return RLVC_OK; RLVC_E_CALLBACK: *action unchanged. */
RLVC_API rlvc_status rlvc_policy_act(rlvc_policy *policy, const void *percept, uint32_t *action);

/* Prints the policy's tree, as rlvc_print does the agent's, but for values and numbers of
 * interactions, which its leaves do not have. O(nodes * depth).
 * @return RLVC_OK; RLVC_E_RANGE: format; RLVC_E_CALLBACK: as of rlvc_print. */
RLVC_API rlvc_status rlvc_policy_print(rlvc_policy *policy, uint32_t format, rlvc_write write,
                                       void *ctx);

/* Writes the policy as rlvc_export_c writes the agent's.
 * @return as of rlvc_export_c. */
RLVC_API rlvc_status rlvc_policy_export_c(rlvc_policy *policy, const char *name, rlvc_write write,
                                          void *ctx, rlvc_export_info *info);

#ifdef __cplusplus
}
#endif

#endif
