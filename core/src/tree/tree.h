/* SPDX-License-Identifier: MIT */
/* The classifier: a binary decision tree (section 4.3). Classes are its leaves; an internal node
 * tests the presence of one feature.
 *
 * The tree only grows, and by splits alone, so its layout is its history: split j turns one leaf
 * into an internal node and appends two nodes, 2j + 1 for the percepts without the feature and 2j +
 * 2 for those with it. The former keep their class; the latter get the new class j + 1. Hence the
 * chain of absent children that begins at node 2c ends in the leaf of class c. */
#ifndef RLVC_SRC_TREE_H
#define RLVC_SRC_TREE_H

#include "../base/arena.h"

#define RLVC_LEAF 0x80000000u /* node[n] of a leaf: this and its class; else the absent child */

/* What is known of split j, beside its feature. */
typedef struct rlvc_tree_split {
    uint32_t node; /* the node that became internal */
    rlvc_split about;
} rlvc_tree_split;

typedef struct rlvc_tree {
    uint32_t *node;         /* [2 * classes_max - 1] */
    rlvc_tree_split *split; /* [classes_max - 1] */
    unsigned char *feature; /* [classes_max - 1][feature_bytes] */
    uint32_t classes_max;
    uint32_t feature_bytes;
    uint32_t classes;
} rlvc_tree;

/* Carves the arrays. O(1). */
void rlvc_tree_carve(rlvc_tree *tree, rlvc_arena *arena, uint32_t classes_max,
                     uint32_t feature_bytes);

/* Makes a carved tree the single class 0. O(1). */
void rlvc_tree_clear(rlvc_tree *tree);

static inline int rlvc_tree_is_leaf(const rlvc_tree *tree, uint32_t node) {
    return (tree->node[node] & RLVC_LEAF) != 0;
}

static inline uint32_t rlvc_tree_class(const rlvc_tree *tree, uint32_t leaf) {
    return tree->node[leaf] & ~RLVC_LEAF;
}

/* The split that made an internal node. O(1). */
static inline uint32_t rlvc_tree_split_of(const rlvc_tree *tree, uint32_t node) {
    return (tree->node[node] - 1u) / 2u;
}

static inline unsigned char *rlvc_tree_feature(const rlvc_tree *tree, uint32_t split) {
    return tree->feature + (size_t)split * tree->feature_bytes;
}

/* One step down from an internal node: the child that the percept belongs to.
 * @return RLVC_OK; RLVC_E_CALLBACK: *node unchanged. O(1) calls of exhibits(). */
rlvc_status rlvc_tree_descend(const rlvc_tree *tree, const rlvc_domain *domain, const void *percept,
                              uint32_t *node);

/* The class of a percept. O(depth) calls of exhibits().
 * @return RLVC_OK; RLVC_E_CALLBACK: *class_id unchanged. */
rlvc_status rlvc_tree_classify(const rlvc_tree *tree, const rlvc_domain *domain,
                               const void *percept, uint32_t *class_id);

/* Goes down the chain of a class, which begins at node 2c, by so many nodes at most.
 * @return 1 if *node is its end, the leaf of the class. O(steps). */
int rlvc_tree_seek_leaf(const rlvc_tree *tree, uint32_t *node, uint32_t steps);

/* The leaf of a class. O(depth). */
uint32_t rlvc_tree_leaf(const rlvc_tree *tree, uint32_t class_id);

/* Splits the leaf of about->class_id by a feature, which is copied; needs classes < classes_max.
 * O(feature_bytes). */
void rlvc_tree_grow(rlvc_tree *tree, uint32_t leaf, const rlvc_split *about, const void *feature);

/* Makes the tree of splits [0, classes - 1), whose `about` and features are in their places: as if
 * they had been grown one after another. about.class_id of split j is at most j. O(classes). */
void rlvc_tree_build(rlvc_tree *tree, uint32_t classes);

/* The node above a node other than the root. O(1). */
static inline uint32_t rlvc_tree_parent(const rlvc_tree *tree, uint32_t node) {
    return tree->split[(node - 1u) / 2u].node;
}

/* The node that follows in pre-order (absent before present), or 0 after the last. O(depth),
 * without a stack: a walk over the whole tree is amortized O(1) a node. */
uint32_t rlvc_tree_walk(const rlvc_tree *tree, uint32_t node);

/* Tests above a node. O(depth). */
uint32_t rlvc_tree_depth(const rlvc_tree *tree, uint32_t node);

/* Tests on the longest path. O(nodes). */
uint32_t rlvc_tree_deepest(const rlvc_tree *tree);

/* The class of the percepts that came to a node when it was made. O(1). */
uint32_t rlvc_tree_first_class(const rlvc_tree *tree, uint32_t node);

/* @return 1 if every invariant holds. O(nodes). */
int rlvc_tree_check(const rlvc_tree *tree);

#endif
