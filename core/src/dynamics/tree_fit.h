/* SPDX-License-Identifier: MIT */
/* Growing a model tree, best split first.
 *
 * A node's linear model is a ridge regression, whose ridge is relative to the number of rows, begun
 * at its parent's model: what is fitted is what that one leaves, e = y - x b. So little is left to
 * cancel in binary32, and where rows are few the parent's model stands. A second pass over the
 * rows takes the sum of squares that the model leaves.
 *
 * A split is judged by the exact likelihoods of the linear models on both sides. With E the sum of
 * squares that a side leaves and n its rows, the gain is
 *
 *     n ln(E / n) - n1 ln(E1 / n1) - n2 ln(E2 / n2) - price,   price = 1.5 p ln N + 2 ln(tests),
 *
 * for p terms and N rows of the tree. The tests of a component are at the quartiles of 63 of the
 * node's rows. Gram matrices of the four quarters give all of them from one pass over the rows. Of
 * a node of many rows one in so many is looked at, and their gain counts for the others too. */
#ifndef RLVC_SRC_TREE_FIT_H
#define RLVC_SRC_TREE_FIT_H

#include "experience.h"
#include "model_tree.h"

#define RLVC_TREE_FIT_CUTS 3u
#define RLVC_TREE_FIT_QUANTILE_ROWS 63u

/* What a tree is fitted to. */
typedef struct rlvc_tree_fit_input {
    const rlvc_experience *experience;
    const rlvc_basis *basis;
    uint32_t *row; /* [count], which the fit permutes */
    uint32_t count;
    uint32_t output; /* k of s'[k] - s[k], or `components` for the reward */
    uint32_t terms;
    uint32_t leaves_max;
    uint32_t leaf_rows; /* a leaf has at least so many rows, and two for each term */
    float ridge;        /* relative to the rows */
    float slack;        /* by which share of its range a leaf may exceed it */
} rlvc_tree_fit_input;

/* What is known of a node while the tree grows. */
typedef struct rlvc_fit_node {
    uint32_t first; /* its rows are row[first .. first + count - 1] */
    uint32_t count;
    float squares; /* left by its linear model */
    float gain;    /* of its best split, less the price; 0 or less: none */
    float cut;
    uint16_t test;
} rlvc_fit_node;

/* The memory of a fit; its content is not kept between fits. */
typedef struct rlvc_tree_fit_space {
    rlvc_fit_node *node; /* [2 * leaves_max - 1] */
    float *total;        /* Gram matrices of order terms_max + 1 */
    float *bucket[RLVC_TREE_FIT_CUTS];
    float *factor;
    float *x;      /* [terms_max + 1] */
    float *work;   /* [terms_max + 1] */
    float *sorted; /* [RLVC_TREE_FIT_QUANTILE_ROWS] */
} rlvc_tree_fit_space;

typedef struct rlvc_tree_fit_cursor {
    rlvc_tree_fit_input in;
    rlvc_tree_fit_space *space;
    rlvc_model_tree *tree;
    float cut[RLVC_TREE_FIT_CUTS];
    float low; /* of the node's targets */
    float high;
    float price;
    uint32_t at;  /* the next of the node's rows */
    uint32_t end; /* of a partition: rows from here on pass the test */
    uint32_t nodes;
    uint32_t node; /* being fitted or split */
    uint32_t test; /* being looked at */
    uint32_t cuts;
    uint32_t gained; /* cuts whose gain is known */
    uint32_t least;  /* rows of a leaf */
    uint32_t thin;   /* splits are judged by one row in so many of the node */
    uint8_t phase;
    uint8_t done;
} rlvc_tree_fit_cursor;

void rlvc_tree_fit_carve(rlvc_tree_fit_space *space, rlvc_arena *arena, uint32_t leaves_max,
                         uint32_t terms_max);

/* Begins to grow `tree`, whose mean and scale are set. Needs at least one row. O(terms). */
void rlvc_tree_fit_begin(rlvc_tree_fit_cursor *fit, const rlvc_tree_fit_input *in,
                         rlvc_tree_fit_space *space, rlvc_model_tree *tree);

/* Works on for at least `budget` multiplications, and at most one elementary step more: a row added
 * to a Gram matrix, or two factorisations. @return the multiplications done. */
uint32_t rlvc_tree_fit_step(rlvc_tree_fit_cursor *fit, uint32_t budget);

/* Of a fit that is done: the description length of the targets, to compare trees of the same rows
 * by, sum of n ln(E / n) over the leaves and the price of the leaves. O(leaves). */
float rlvc_tree_fit_length(const rlvc_tree_fit_cursor *fit);

/* The target of a row for an output, neither centred nor scaled. O(1). */
static inline float rlvc_fit_target(const rlvc_experience *experience, uint32_t output,
                                    uint32_t row) {
    if (output == experience->components)
        return experience->reward[row];
    uint32_t next = rlvc_experience_next(experience, row);
    return rlvc_experience_percept(experience, next)[output] -
           rlvc_experience_percept(experience, row)[output];
}

#endif
