/* SPDX-License-Identifier: MIT */
/* Small trees: see small_tree.h. */
#include "rlvc/float_rules.h"

#include "small_tree.h"

#include "../base/assert.h"
#include "moves.h"
#include "rlvc/thresholds.h"
#include <string.h>

#define MIXED 0xffffu

void rlvc_small_tree_constant(rlvc_small_tree *tree, uint32_t action) {
    tree->node[0].cut = 0.0f;
    tree->node[0].component = RLVC_SMALL_LEAF;
    tree->node[0].child = 0;
    tree->node[0].action = (uint8_t)action;
    tree->nodes = tree->leaves = 1;
}

/* The test whose child a node is. */
static uint32_t parent_of(const rlvc_small_tree *tree, uint32_t child) {
    uint32_t k = 0;
    while (tree->node[k].component == RLVC_SMALL_LEAF || tree->node[k].child != child)
        k++;
    return k;
}

uint32_t rlvc_small_tree_class(const rlvc_small_tree *tree, uint32_t leaf) {
    while (leaf % 2u == 1u)
        leaf = parent_of(tree, leaf);
    return leaf / 2u;
}

uint32_t rlvc_small_tree_depth(const rlvc_small_tree *tree) {
    uint8_t depth[RLVC_SMALL_NODES_MAX] = {0};
    uint32_t most = 0;
    for (uint32_t k = 0; k < tree->nodes; k++) {
        if (tree->node[k].component != RLVC_SMALL_LEAF)
            depth[tree->node[k].child] = depth[tree->node[k].child + 1u] = (uint8_t)(depth[k] + 1u);
        if (depth[k] > most)
            most = depth[k];
    }
    return most;
}

void rlvc_small_tree_grow(const rlvc_small_tree *from, rlvc_tree *tree, uint8_t *action) {
    rlvc_tree_clear(tree);
    for (uint32_t child = 1; child < from->nodes; child += 2u) {
        const uint32_t test = parent_of(from, child);
        const rlvc_small_node *node = from->node + test;
        const rlvc_threshold feature = {node->cut, 0.0f, node->component, 0};
        rlvc_split about;
        memset(&about, 0, sizeof about);
        about.class_id = rlvc_tree_class(tree, test);
        rlvc_tree_grow(tree, test, &about, &feature);
    }
    for (uint32_t k = 0; k < from->nodes; k++)
        if (from->node[k].component == RLVC_SMALL_LEAF)
            action[rlvc_tree_class(tree, k)] = from->node[k].action;
}

int rlvc_small_tree_compact(const rlvc_small_node *node, uint32_t nodes, uint32_t leaves_max,
                            rlvc_small_tree *tree) {
    uint16_t all[RLVC_MOVES_NODES];  /* the action of all leaves below, or MIXED */
    uint8_t place[RLVC_MOVES_NODES]; /* where a node is copied to; 0xff: nowhere */
    RLVC_ASSERT(nodes <= RLVC_MOVES_NODES);
    for (uint32_t k = nodes; k-- > 0;) {
        uint32_t child = node[k].child;
        place[k] = 0xffu;
        if (node[k].component == RLVC_SMALL_LEAF)
            all[k] = node[k].action;
        else
            all[k] = all[child] == all[child + 1u] ? all[child] : MIXED;
    }
    uint32_t made = 1;
    place[0] = 0;
    for (uint32_t k = 0; k < nodes; k++) {
        if (place[k] == 0xffu)
            continue;
        rlvc_small_node *to = tree->node + place[k];
        *to = node[k];
        to->child = (uint8_t)made;
        if (all[k] != MIXED) {
            to->cut = 0.0f;
            to->component = RLVC_SMALL_LEAF;
            to->child = 0;
            to->action = (uint8_t)all[k];
            continue;
        }
        to->action = 0;
        if (made + 2u > 2u * leaves_max - 1u)
            return 0;
        place[node[k].child] = (uint8_t)made;
        place[node[k].child + 1u] = (uint8_t)(made + 1u);
        made += 2u;
    }
    tree->nodes = (uint8_t)made;
    tree->leaves = (uint8_t)((made + 1u) / 2u);
    return 1;
}
