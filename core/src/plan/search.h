/* SPDX-License-Identifier: MIT */
/* The search for a small tree that earns much in the model: one move at a time (moves.h), from a
 * tree that is given.
 *
 * A candidate is rolled out from each start. It is given up once it is more than a twentieth behind
 * the present tree over four starts or more. It replaces the present tree if its return, less a
 * price for each leaf, is no lower. Equals are accepted, since many moves change nothing yet.
 *
 * The search ends after `candidates` candidates, after 2,500 times as many steps of the model, or
 * after `patience` candidates in a row without gain. A quarter of that is enough where the present
 * tree earns the greatest reward at each step, since then only leaves can be saved.
 *
 * With memory for it, rollouts that would repeat those of the present tree are not made (reach.h),
 * which are half of the steps and more. They count as if they were, and so are spared only where
 * all of their steps fit into the budget: neither what is found nor in which slice depends on it.
 */
#ifndef RLVC_SRC_SEARCH_H
#define RLVC_SRC_SEARCH_H

#include "moves.h"
#include "rollout.h"

#define RLVC_SEARCH_STARTS 64u

typedef struct rlvc_search_input {
    rlvc_rollout_input rollout;
    rlvc_moves_input moves;
    const float *start;   /* [starts][components] */
    const uint8_t *known; /* the cells visited so far, [cells_bytes], where novelty is sought */
    uint32_t cells_bytes;
    uint32_t starts; /* [1, RLVC_SEARCH_STARTS] */
    uint32_t candidates;
    uint32_t patience; /* candidates without gain */
    uint32_t seed;
} rlvc_search_input;

typedef struct rlvc_search_cursor {
    rlvc_search_input in;
    rlvc_small_tree tree; /* in hand */
    rlvc_small_tree candidate;
    rlvc_rollout rollout;
    rlvc_reach reach[2]; /* of the tree in hand and of the candidate, in either order; optional */
    float reference[RLVC_SEARCH_STARTS]; /* what the tree in hand earns from each start */
    float earned[RLVC_SEARCH_STARTS];    /* what the candidate does */
    uint32_t visits[RLVC_SMALL_NODES_MAX];
    uint32_t candidate_visits[RLVC_SMALL_NODES_MAX];
    float best;  /* mean of the reference */
    float price; /* of a leaf */
    float sum;   /* of earned so far */
    float reference_sum;
    uint32_t start;
    uint32_t steps;  /* of the model so far */
    uint32_t tried;  /* candidates so far */
    uint32_t gained; /* the last of these that gained */
    uint8_t hand;    /* which reach is the tree's in hand */
    uint8_t rolling; /* a rollout is under way */
    uint8_t first;   /* the tree in hand itself is being rolled out */
    uint8_t done;
} rlvc_search_cursor;

/* Begins at a tree. search->rollout.s is the caller's memory, and so is what search->reach points
 * to: without it (box is null), and where novelty is sought, all rollouts are made. O(nodes). */
void rlvc_search_begin(rlvc_search_cursor *search, const rlvc_search_input *in,
                       const rlvc_small_tree *tree);

/* Works on for at least `budget` multiplications, and one step of the model more at most. */
uint32_t rlvc_search_step(rlvc_search_cursor *search, uint32_t budget);

#endif
