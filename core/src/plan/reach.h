/* SPDX-License-Identifier: MIT */
/* Where rollouts passed: of each start and each leaf of a tree the box of the percepts that the
 * leaf was reached with, which is the range of each component.
 *
 * A candidate differs from the tree in hand by a few moves, and from most starts it still does the
 * same. If all of its tests send a leaf's box one way, and so to one leaf of its own, whose action
 * is the same, and if that holds for all the boxes of a start, then the two trees agree at each
 * step of the rollout: its first percept is the same, and so is the luck of each step (rollout.h).
 * So both earn the same, and the rollout need not be made again. */
#ifndef RLVC_SRC_REACH_H
#define RLVC_SRC_REACH_H

#include "small_tree.h"

typedef struct rlvc_reach {
    float *box;      /* [starts][nodes][2][components]: least values, greatest ones; of a leaf that
                        was not reached the least is above the greatest */
    uint32_t *steps; /* [starts] of each rollout */
    uint32_t components;
    uint32_t nodes;
} rlvc_reach;

void rlvc_reach_carve(rlvc_reach *reach, rlvc_arena *arena, uint32_t starts, uint32_t leaves_max,
                      uint32_t components);

/* The boxes of a start. */
static inline float *rlvc_reach_boxes(const rlvc_reach *reach, uint32_t start) {
    return reach->box + (size_t)start * reach->nodes * 2u * reach->components;
}

/* Of a start, no leaf was reached. O(nodes * components). */
void rlvc_reach_clear(rlvc_reach *reach, uint32_t start);

/* Widens a box so that it holds a percept. O(components). */
static inline void rlvc_reach_note(float *box, const float *percept, uint32_t components) {
    float *low = box, *high = box + components;
    for (uint32_t i = 0; i < components; i++) {
        low[i] = percept[i] < low[i] ? percept[i] : low[i];
        high[i] = percept[i] > high[i] ? percept[i] : high[i];
    }
}

/* Is it certain that a candidate does what the tree does from a start, of which `reach` is known?
 * If so, `to` is told what the candidate reaches, and its leaves' visits grow by one each; else
 * what `to` holds of the start is undefined. O(leaves * (depth + components)). */
int rlvc_reach_repeats(const rlvc_reach *reach, const rlvc_small_tree *tree, uint32_t start,
                       const rlvc_small_tree *candidate, rlvc_reach *to, uint32_t *visits);

#endif
