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
    uint32_t compact; /* leaves left, once every subtree whose leaves all act alike has become
                         one */
    uint32_t bytes;   /* of constant data in the export */
} rlvc_export_info;

/* Writes a C99 header that holds the policy of an agent on one of the ready-made domains, and needs
 * no memory beside its constants and a few locals. It defines the action of rlvc_predict, for every
 * percept:
 *
 *     unsigned NAME_act(const unsigned char *percept);   of bits; includes nothing
 *     unsigned NAME_act(const void *percept);            of descriptors, also
 *                                                        in pairs or bags; includes <stdint.h>
 *     unsigned NAME_act(const float *percept);           of thresholds; includes nothing
 *
 * The tree is made compact first, which changes no action. Of bits: where the tests look at few it
 * becomes a table of the action by those bits, which takes the same short time for every percept;
 * else a table of nodes. The header says which, and shows the tree in its comments.
 *
 * Of descriptors: a table of nodes, and the features' radii and vectors, each feature once; of
 * pairs also scales, displacements and second vectors, which are 0 of a feature of one vector; of
 * bags in place of radii what is needed and how many vectors there are, and room for K each. A
 * percept is the domain's record, aligned to 4, and its count must be at most P. The detector is
 * that of the domain bit for bit, if compiled with -ffp-contract=off as the library is.
 *
 * Of thresholds: tables of nodes and cutpoints, and of slopes if any test is oblique. A percept is
 * the domain's record. The same holds of it bit for bit.
 *
 * While a learning step is under way the policy is that of the last solution; of a planner it is
 * the learnt policy. O(nodes^2) at worst, nearer to O(nodes * depth), for bits and thresholds; for
 * the table of actions O(2^bits * depth) more, with 2^bits at most 16 a leaf. For descriptors
 * O(nodes^2) comparisons of features, and as many again for each node whose feature an earlier one
 * has.
 * @param name a C identifier of at most 48 characters: begins everything that the header defines
 * @param info optional
 * @return RLVC_OK; RLVC_E_NULL; RLVC_E_REENTERED; RLVC_E_RANGE: name; RLVC_E_CONFIG: the domain is
 * not ready-made; RLVC_E_CALLBACK: a write failed, and the text ends where it did. */
RLVC_API rlvc_status rlvc_export_c(rlvc_agent *agent, const char *name, rlvc_write write, void *ctx,
                                   rlvc_export_info *info);

#ifdef __cplusplus
}
#endif

#endif
