/* SPDX-License-Identifier: MIT */
/* The decision tree: see tree.h for its layout. */
#include "rlvc/float_rules.h"

#include "tree.h"

#include "../base/assert.h"
#include <string.h>

void rlvc_tree_carve(rlvc_tree *tree, rlvc_arena *arena, uint32_t classes_max,
                     uint32_t feature_bytes) {
    tree->node = rlvc_arena_carve(arena, 2u * classes_max - 1u, sizeof *tree->node);
    tree->split = rlvc_arena_carve(arena, classes_max - 1u, sizeof *tree->split);
    tree->feature = rlvc_arena_carve(arena, classes_max - 1u, feature_bytes);
    tree->classes_max = classes_max;
    tree->feature_bytes = feature_bytes;
}

void rlvc_tree_clear(rlvc_tree *tree) {
    tree->node[0] = RLVC_LEAF | 0u;
    tree->classes = 1;
}

rlvc_status rlvc_tree_descend(const rlvc_tree *tree, const rlvc_domain *domain, const void *percept,
                              uint32_t *node) {
    uint8_t present = 0;
    const void *feature = rlvc_tree_feature(tree, rlvc_tree_split_of(tree, *node));
    if (domain->exhibits(domain->ctx, percept, feature, &present) != 0)
        return RLVC_E_CALLBACK;
    *node = tree->node[*node] + (present != 0 ? 1u : 0u);
    return RLVC_OK;
}

rlvc_status rlvc_tree_classify(const rlvc_tree *tree, const rlvc_domain *domain,
                               const void *percept, uint32_t *class_id) {
    uint32_t node = 0;
    while (!rlvc_tree_is_leaf(tree, node)) {
        rlvc_status status = rlvc_tree_descend(tree, domain, percept, &node);
        if (status != RLVC_OK)
            return status;
    }
    *class_id = rlvc_tree_class(tree, node);
    return RLVC_OK;
}

int rlvc_tree_seek_leaf(const rlvc_tree *tree, uint32_t *node, uint32_t steps) {
    for (; steps > 0 && !rlvc_tree_is_leaf(tree, *node); steps--)
        *node = tree->node[*node];
    return rlvc_tree_is_leaf(tree, *node);
}

uint32_t rlvc_tree_leaf(const rlvc_tree *tree, uint32_t class_id) {
    uint32_t node = 2u * class_id;
    (void)rlvc_tree_seek_leaf(tree, &node, UINT32_MAX);
    return node;
}

void rlvc_tree_grow(rlvc_tree *tree, uint32_t leaf, const rlvc_split *about, const void *feature) {
    RLVC_ASSERT(tree->classes < tree->classes_max && about->class_id < tree->classes);
    RLVC_ASSERT(tree->node[leaf] == (RLVC_LEAF | about->class_id));
    uint32_t j = tree->classes - 1u;
    tree->split[j].node = leaf;
    tree->split[j].about = *about;
    memcpy(rlvc_tree_feature(tree, j), feature, tree->feature_bytes);
    tree->node[2u * j + 1u] = RLVC_LEAF | about->class_id;
    tree->node[2u * j + 2u] = RLVC_LEAF | (j + 1u);
    tree->node[leaf] = 2u * j + 1u;
    tree->classes++;
}

uint32_t rlvc_tree_walk(const rlvc_tree *tree, uint32_t node) {
    if (!rlvc_tree_is_leaf(tree, node))
        return tree->node[node];
    /* Up past the present children, which are the even ones; then over to the present sibling. */
    while (node != 0 && node % 2u == 0)
        node = rlvc_tree_parent(tree, node);
    return node == 0 ? 0 : node + 1u;
}

uint32_t rlvc_tree_depth(const rlvc_tree *tree, uint32_t node) {
    uint32_t depth = 0;
    for (; node != 0; node = rlvc_tree_parent(tree, node))
        depth++;
    return depth;
}

uint32_t rlvc_tree_first_class(const rlvc_tree *tree, uint32_t node) {
    return node % 2u == 0 ? node / 2u : tree->split[(node - 1u) / 2u].about.class_id;
}

/* Counted along the walk, as it goes down and up. */
uint32_t rlvc_tree_deepest(const rlvc_tree *tree) {
    uint32_t node = 0, depth = 0, most = 0;
    for (;;) {
        for (; !rlvc_tree_is_leaf(tree, node); depth++)
            node = tree->node[node];
        most = depth > most ? depth : most;
        for (; node != 0 && node % 2u == 0; depth--)
            node = rlvc_tree_parent(tree, node);
        if (node == 0)
            return most;
        node++;
    }
}

/* While the splits are gone through, node[2c] is the leaf that class c has come to. */
void rlvc_tree_build(rlvc_tree *tree, uint32_t classes) {
    RLVC_ASSERT(classes >= 1 && classes <= tree->classes_max);
    tree->classes = classes;
    for (uint32_t c = 0; c < classes; c++)
        tree->node[2u * c] = 2u * c;
    for (uint32_t j = 0; j + 1u < classes; j++) {
        uint32_t *leaf = &tree->node[2u * tree->split[j].about.class_id];
        tree->split[j].node = *leaf;
        *leaf = 2u * j + 1u;
    }
    for (uint32_t node = 0; node < 2u * classes - 1u; node++)
        tree->node[node] = RLVC_LEAF | rlvc_tree_first_class(tree, node);
    for (uint32_t j = 0; j + 1u < classes; j++)
        tree->node[tree->split[j].node] = 2u * j + 1u;
}

/* Was split j made of an older node of its class, which leads to the two that it made? Where that
 * is so of all splits before j, this node ends the chain of the class. */
static int split_is_sound(const rlvc_tree *tree, uint32_t j) {
    const rlvc_tree_split *split = &tree->split[j];
    return split->node <= 2u * j && tree->node[split->node] == 2u * j + 1u &&
           rlvc_tree_first_class(tree, split->node) == split->about.class_id;
}

/* Is a node a leaf of its class, or the node of some split? With sound splits every way down the
 * tree then leads to younger nodes, and ends. */
static int node_is_sound(const rlvc_tree *tree, uint32_t node) {
    if (rlvc_tree_is_leaf(tree, node))
        return rlvc_tree_class(tree, node) == rlvc_tree_first_class(tree, node);
    uint32_t split = rlvc_tree_split_of(tree, node);
    return split < tree->classes - 1u && tree->split[split].node == node;
}

/* In an order in which each loop may rely on those before it, so that no damage leads it astray. */
int rlvc_tree_check(const rlvc_tree *tree) {
    if (tree->classes < 1 || tree->classes > tree->classes_max)
        return 0;
    for (uint32_t j = 0; j + 1u < tree->classes; j++) {
        if (!split_is_sound(tree, j))
            return 0;
    }
    for (uint32_t node = 0; node < 2u * tree->classes - 1u; node++) {
        if (!node_is_sound(tree, node))
            return 0;
    }
    return 1;
}
