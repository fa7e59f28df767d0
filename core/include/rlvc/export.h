/* SPDX-License-Identifier: MIT */
/* The learnt policy as constant C, for a controller that only acts. */
#ifndef RLVC_EXPORT_H
#define RLVC_EXPORT_H

#include "rlvc/agent.h"

#ifdef __cplusplus
extern "C" {
#endif

/* What was exported. */
typedef struct rlvc_export_info {
    uint32_t leaves;  /* of the tree */
    uint32_t compact; /* leaves left, once every subtree whose leaves all act alike has become one */
    uint32_t bytes;   /* of constant data in the export */
} rlvc_export_info;

/* Writes a C99 header that holds the policy of an agent on the domain of bits, and needs nothing:
 *
 *     unsigned NAME_act(const unsigned char *percept);   the action of rlvc_predict, for every percept
 *
 * The tree is made compact first, which changes no action. Where the tests look at few bits it becomes a
 * table of the action by those bits, which takes the same short time for every percept; else a table of
 * nodes. The header says which, and shows the tree in its comments.
 *
 * While a learning step is under way the policy is that of the last solution. O(nodes^2) at worst, nearer
 * to O(nodes * depth); for the table of actions O(2^bits * depth) more, with 2^bits at most 16 a leaf.
 * @param name a C identifier of at most 48 characters: begins everything that the header defines
 * @param info optional
 * @return RLVC_OK; RLVC_E_NULL; RLVC_E_REENTERED; RLVC_E_RANGE: name; RLVC_E_CONFIG: the domain is not
 *         of bits; RLVC_E_CALLBACK: a write failed, and the text ends where it did. */
RLVC_API rlvc_status rlvc_export_c(rlvc_agent *agent, const char *name, rlvc_write write, void *ctx,
                                   rlvc_export_info *info);

#ifdef __cplusplus
}
#endif

#endif
