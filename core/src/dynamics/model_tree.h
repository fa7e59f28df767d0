/* SPDX-License-Identifier: MIT */
/* A model tree: predicts one number from a percept and an action, s'[k] - s[k] or the reward.
 *
 * Tests are x[i] > cut or a == k. The leaves hold linear models over the basis (basis.h). Children
 * are next to each other and after their parent. A prediction stays within the range of the leaf's
 * own targets, or on request within that range widened by half of it. A leaf's noise is the
 * standard deviation of its residuals. Everything is in units of the target's deviation. */
#ifndef RLVC_SRC_MODEL_TREE_H
#define RLVC_SRC_MODEL_TREE_H

#include "../base/arena.h"
#include "basis.h"

#define RLVC_MODEL_LEAF UINT16_MAX

typedef struct rlvc_model_node {
    float cut;
    uint16_t test; /* below components: x[test] > cut; from there on: action == test - components;
                      or RLVC_MODEL_LEAF */
    uint16_t
        child; /* the first of two children, taken where the test fails; of a leaf its number */
} rlvc_model_node;

typedef struct rlvc_model_leaf {
    float low;
    float high;
    float noise;
} rlvc_model_leaf;

typedef struct rlvc_model_tree {
    rlvc_model_node *node; /* [2 * leaves_max - 1] */
    rlvc_model_leaf *leaf; /* [leaves_max] */
    float *coefficient;    /* [leaves_max][stride of terms_max], 0 behind the terms */
    float mean;            /* of the target */
    float scale;           /* its deviation; 0: it is constant */
    uint16_t terms;        /* of the basis in use */
    uint16_t leaves;
} rlvc_model_tree;

void rlvc_model_tree_carve(rlvc_model_tree *tree, rlvc_arena *arena, uint32_t leaves_max,
                           uint32_t terms_max);

/* The leaf of a percept and an action. O(depth). By branches, which a processor foretells, as the
 * percepts of a rollout are near each other: to add what the test says to the index takes a sixth
 * longer. */
static inline uint32_t rlvc_model_tree_leaf(const rlvc_model_tree *tree, uint32_t components,
                                            const float *percept, uint32_t action) {
    const rlvc_model_node *node = tree->node;
    while (node->test != RLVC_MODEL_LEAF) {
        const rlvc_model_node *child = tree->node + node->child;
        if (node->test < components) {
            if (percept[node->test] > node->cut) {
                node = child + 1;
                continue;
            }
        } else if (action == node->test - components) {
            node = child + 1;
            continue;
        }
        node = child;
    }
    return node->child;
}

/* A leaf's coefficients take a multiple of four places, and so does a row of the basis: four sums
 * side by side are sooner done than one after another. */
static inline uint32_t rlvc_model_tree_stride(uint32_t terms) {
    return (terms + 3u) & ~3u;
}

static inline float *rlvc_model_tree_coefficients(const rlvc_model_tree *tree, uint32_t leaf) {
    return tree->coefficient + (size_t)leaf * rlvc_model_tree_stride(tree->terms);
}

/* The linear model of a leaf at a row of the basis, of which there are `stride` numbers. O(terms).
 */
static inline float rlvc_model_tree_linear(const rlvc_model_tree *tree, uint32_t leaf,
                                           const float *x) {
    const float *coefficient = rlvc_model_tree_coefficients(tree, leaf);
    float sum[4] = {0.0f, 0.0f, 0.0f, 0.0f};
    for (uint32_t i = 0; i < tree->terms; i += 4u)
        for (uint32_t k = 0; k < 4u; k++)
            sum[k] += coefficient[i + k] * x[i + k];
    return (sum[0] + sum[1]) + (sum[2] + sum[3]);
}

#endif
