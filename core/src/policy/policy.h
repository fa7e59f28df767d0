/* SPDX-License-Identifier: MIT */
/* What a policy's block begins with. Its tree has the layout of the agent's (tree.h). */
#ifndef RLVC_SRC_POLICY_H
#define RLVC_SRC_POLICY_H

#include "rlvc/policy.h"
#include "../tree/tree.h"

struct rlvc_policy {
    rlvc_domain domain;
    rlvc_tree tree;
    uint8_t *action; /* [classes] */
    uint32_t actions;
    uint8_t busy; /* a callback is being called */
};

/* rlvc_policy_make of an agent that is a planner, with *policy null: its block takes
 * RLVC_PLANNER_POLICY_BYTES. */
rlvc_status rlvc_policy_of_planner(rlvc_agent *agent, void *memory, size_t bytes,
                                   rlvc_policy **policy, rlvc_policy_info *info);

#endif
