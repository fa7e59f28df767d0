/* SPDX-License-Identifier: MIT */
/* Where rollouts passed: see reach.h. */
#include "rlvc/float_rules.h"

#include "reach.h"

#define NOWHERE UINT32_MAX
#define BEYOND 3e38f /* above the greatest value of a percept, negated below the least */

void rlvc_reach_carve(rlvc_reach *reach, rlvc_arena *arena, uint32_t starts, uint32_t leaves_max,
                      uint32_t components) {
    reach->components = components;
    reach->nodes = 2u * leaves_max - 1u;
    reach->box =
        rlvc_arena_carve(arena, starts, reach->nodes * 2u * components * (uint32_t)sizeof(float));
    reach->steps = rlvc_arena_carve(arena, starts, sizeof *reach->steps);
}

void rlvc_reach_clear(rlvc_reach *reach, uint32_t start) {
    float *box = rlvc_reach_boxes(reach, start);
    for (uint32_t k = 0; k < reach->nodes; k++) {
        for (uint32_t i = 0; i < reach->components; i++) {
            box[i] = BEYOND;
            box[reach->components + i] = -BEYOND;
        }
        box += 2u * reach->components;
    }
}

/* The leaf that all percepts of a box lead to, or NOWHERE if they may lead to several. */
static uint32_t leaf_of_box(const rlvc_small_tree *tree, const float *box, uint32_t components) {
    uint32_t k = 0;
    while (tree->node[k].component != RLVC_SMALL_LEAF) {
        const rlvc_small_node *node = tree->node + k;
        uint32_t holds = box[node->component] > node->cut;
        if (!holds && box[components + node->component] > node->cut)
            return NOWHERE;
        k = node->child + holds;
    }
    return k;
}

int rlvc_reach_repeats(const rlvc_reach *reach, const rlvc_small_tree *tree, uint32_t start,
                       const rlvc_small_tree *candidate, rlvc_reach *to, uint32_t *visits) {
    uint32_t d = reach->components;
    const float *box = rlvc_reach_boxes(reach, start);
    float *boxes = rlvc_reach_boxes(to, start);
    rlvc_reach_clear(to, start);
    for (uint32_t k = 0; k < tree->nodes; k++, box += 2u * d) {
        if (box[0] > box[d])
            continue;
        uint32_t leaf = leaf_of_box(candidate, box, d);
        if (leaf == NOWHERE || candidate->node[leaf].action != tree->node[k].action)
            return 0;
        rlvc_reach_note(boxes + (size_t)leaf * 2u * d, box, d);
        rlvc_reach_note(boxes + (size_t)leaf * 2u * d, box + d, d);
    }
    for (uint32_t k = 0; k < candidate->nodes; k++)
        visits[k] += boxes[(size_t)k * 2u * d] <= boxes[(size_t)k * 2u * d + d];
    to->steps[start] = reach->steps[start];
    return 1;
}
