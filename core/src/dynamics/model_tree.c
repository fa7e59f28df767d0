/* SPDX-License-Identifier: MIT */
/* Model trees: see model_tree.h. */
#include "rlvc/float_rules.h"

#include "model_tree.h"

#include <string.h>

void rlvc_model_tree_carve(rlvc_model_tree *tree, rlvc_arena *arena, uint32_t leaves_max,
                           uint32_t terms_max) {
    memset(tree, 0, sizeof *tree);
    tree->node = rlvc_arena_carve(arena, 2u * leaves_max - 1u, sizeof *tree->node);
    tree->leaf = rlvc_arena_carve(arena, leaves_max, sizeof *tree->leaf);
    tree->coefficient = rlvc_arena_carve(
        arena, leaves_max, rlvc_model_tree_stride(terms_max) * (uint32_t)sizeof(float));
}
