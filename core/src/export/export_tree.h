/* SPDX-License-Identifier: MIT */
/* Exporting a tree with an action for each class: see rlvc_export_c. */
#ifndef RLVC_SRC_EXPORT_TREE_H
#define RLVC_SRC_EXPORT_TREE_H

#include "rlvc/export.h"
#include "../tree/tree.h"

/* @param policy [classes]
 * @return as of rlvc_export_c, which has looked at the pointers. */
rlvc_status rlvc_export_tree(const rlvc_domain *domain, const rlvc_tree *tree,
                             const uint8_t *policy, uint32_t actions, const char *name,
                             rlvc_write write, void *ctx, rlvc_export_info *info);

#endif
