/* SPDX-License-Identifier: MIT */
/* Where episodes terminate: a tree over s' whose leaves hold the probability that an interaction
 * which leads there terminates, and the mean reward of those that did.
 *
 * It grows best split first, over weighted rows, by what a split takes away from two errors. One is
 * Gini's index of those that terminated and those that went on. The other is the squared error of
 * the terminal rewards, in such units that Gini's index is the same where there are two rewards. Of
 * it counts only what exceeds what the best of so many cuts takes away by chance.
 *
 * A cut is found without sorting. The node's values are counted in bins over a window, which is the
 * whole range at first. The window then shrinks to the bins around the best boundary, three times.
 */
#ifndef RLVC_SRC_ENDING_H
#define RLVC_SRC_ENDING_H

#include "sample.h"

#define RLVC_ENDING_LEAVES 16u
#define RLVC_ENDING_NODES (2u * RLVC_ENDING_LEAVES - 1u)
#define RLVC_ENDING_BINS 16u
#define RLVC_ENDING_PASSES 3u
#define RLVC_ENDING_LEAF UINT16_MAX

typedef struct rlvc_ending_node {
    float cut;          /* s'[component] > cut leads to child + 1 */
    float probability;  /* of a leaf: that s' ends the episode */
    float reward;       /* of a leaf: mean reward of the interactions that did */
    uint16_t component; /* or RLVC_ENDING_LEAF */
    uint16_t child;
} rlvc_ending_node;

typedef struct rlvc_ending {
    rlvc_ending_node node[RLVC_ENDING_NODES];
} rlvc_ending;

/* The leaf of a percept. O(depth). By branches, as rlvc_model_tree_leaf. */
static inline const rlvc_ending_node *rlvc_ending_at(const rlvc_ending *ending,
                                                     const float *percept) {
    const rlvc_ending_node *node = ending->node;
    while (node->component != RLVC_ENDING_LEAF) {
        const rlvc_ending_node *child = ending->node + node->child;
        if (percept[node->component] > node->cut) {
            node = child + 1;
            continue;
        }
        node = child;
    }
    return node;
}

/* Some of a node's rows. */
typedef struct rlvc_ending_tally {
    float going;  /* weight of those that go on */
    float ended;  /* and of those that terminated */
    float reward; /* of these the weighted sum of reward less the node's mean */
} rlvc_ending_tally;

/* The window of a component's values, and the rows that were counted in it. */
typedef struct rlvc_ending_window {
    float low;
    float width; /* of a bin; 0: nothing to cut */
    rlvc_ending_tally below;
    rlvc_ending_tally bin[RLVC_ENDING_BINS];
    float gain; /* of the best boundary */
    float cut;
} rlvc_ending_window;

typedef struct rlvc_ending_fit_cursor {
    const rlvc_experience *experience;
    const rlvc_row_sample *sample;
    rlvc_ending *ending;
    rlvc_ending_window *window;        /* [components] */
    uint32_t first[RLVC_ENDING_NODES]; /* the node's rows */
    uint32_t count[RLVC_ENDING_NODES];
    float gain[RLVC_ENDING_NODES];
    rlvc_ending_tally all; /* of the node under way */
    float reward;          /* weighted sum of its terminal rewards */
    float error;           /* their squared error */
    float chance;          /* of it, what the best cut takes away by chance */
    float reward_low;      /* of all terminal rewards */
    float reward_high;
    uint32_t at;
    uint32_t end;
    uint32_t nodes;
    uint32_t leaves;
    uint32_t node;
    uint32_t pass;
    uint8_t phase;
    uint8_t done;
} rlvc_ending_fit_cursor;

/* Begins to fit `ending` to a sample, whose rows it permutes. The windows are the caller's memory.
 * O(1). */
void rlvc_ending_fit_begin(rlvc_ending_fit_cursor *fit, const rlvc_experience *experience,
                           const rlvc_row_sample *sample, rlvc_ending *ending,
                           rlvc_ending_window *window);

/* Works on for at least `budget` units of a component looked at, and one row more at most.
 * @return the units done. */
uint32_t rlvc_ending_fit_step(rlvc_ending_fit_cursor *fit, uint32_t budget);

#endif
