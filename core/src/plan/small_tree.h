/* SPDX-License-Identifier: MIT */
/* A small tree, which is a policy: tests x[component] > cut, and an action at each leaf.
 *
 * The j-th test's children are nodes 2j + 1 (the test fails) and 2j + 2 (it holds), as in the tree
 * of classes; they come after their parent, so that one pass forwards reaches every node before its
 * children, and one pass backwards after them. */
#ifndef RLVC_SRC_SMALL_TREE_H
#define RLVC_SRC_SMALL_TREE_H

#include "../tree/tree.h"

#define RLVC_SMALL_LEAVES_MAX 16u
#define RLVC_SMALL_NODES_MAX (2u * RLVC_SMALL_LEAVES_MAX - 1u)
#define RLVC_SMALL_LEAF UINT16_MAX

typedef struct rlvc_small_node {
    float cut;
    uint16_t component; /* or RLVC_SMALL_LEAF */
    uint8_t child;      /* of a test: the first of its two children */
    uint8_t action;     /* of a leaf */
} rlvc_small_node;

typedef struct rlvc_small_tree {
    rlvc_small_node node[RLVC_SMALL_NODES_MAX];
    uint8_t nodes; /* leaves * 2 - 1 */
    uint8_t leaves;
} rlvc_small_tree;

/* The tree of one leaf. O(1). */
void rlvc_small_tree_constant(rlvc_small_tree *tree, uint32_t action);

/* The leaf's node of a percept. O(depth). */
static inline uint32_t rlvc_small_tree_leaf(const rlvc_small_tree *tree, const float *percept) {
    uint32_t k = 0;
    while (tree->node[k].component != RLVC_SMALL_LEAF)
        k = tree->node[k].child + (uint32_t)(percept[tree->node[k].component] > tree->node[k].cut);
    return k;
}

static inline uint32_t rlvc_small_tree_act(const rlvc_small_tree *tree, const float *percept) {
    return tree->node[rlvc_small_tree_leaf(tree, percept)].action;
}

/* The class of a leaf: of percepts that fail a test's node it is that of the node, of those that
 * pass the j-th test j + 1. O(leaves^2). */
uint32_t rlvc_small_tree_class(const rlvc_small_tree *tree, uint32_t leaf);

/* Tests on the longest path. O(nodes). */
uint32_t rlvc_small_tree_depth(const rlvc_small_tree *tree);

/* Makes the same tree with features of rlvc/thresholds.h, which has room for its leaves, and writes
 * the action of each class. O(leaves^2). */
void rlvc_small_tree_grow(const rlvc_small_tree *from, rlvc_tree *tree, uint8_t *action);

/* Copies what can be reached from node[0], without tests whose sides act alike. Children must come
 * after their parents. @return 1; or 0: it has more than leaves_max leaves, and *tree is undefined.
 * O(nodes). */
int rlvc_small_tree_compact(const rlvc_small_node *node, uint32_t nodes, uint32_t leaves_max,
                            rlvc_small_tree *tree);

#endif
