/* SPDX-License-Identifier: MIT */
/* The moves of the search: see moves.h. */
#include "rlvc/float_rules.h"

#include "moves.h"

#include "../base/float_math.h"
#include <string.h>

/* The tree under way. Nodes that were cut off stay where they are until it is compacted. */
typedef struct draft {
    rlvc_small_node node[RLVC_MOVES_NODES];
    uint8_t list[RLVC_MOVES_NODES]; /* the tests, or leaves, that can be reached */
    uint32_t nodes;
    const rlvc_moves_input *in;
    uint8_t visited[RLVC_MOVES_NODES]; /* a rollout passed the node, as far as is known */
    rlvc_rng *rng;
} draft;

/* Lists what can be reached: the leaves, or the tests. */
static uint32_t list_nodes(draft *tree, int leaves) {
    uint8_t reached[RLVC_MOVES_NODES] = {1u};
    uint32_t count = 0;
    for (uint32_t k = 0; k < tree->nodes; k++) {
        int leaf = tree->node[k].component == RLVC_SMALL_LEAF;
        if (!reached[k])
            continue;
        if (!leaf)
            reached[tree->node[k].child] = reached[tree->node[k].child + 1u] = 1u;
        if (leaf == leaves)
            tree->list[count++] = (uint8_t)k;
    }
    return count;
}

/* One of those listed; up to four draws to find one that was visited. */
static uint32_t draw_node(draft *tree, uint32_t count) {
    uint32_t k = tree->list[rlvc_rng_below(tree->rng, count)];
    for (int again = 0; again < 3 && !tree->visited[k]; again++)
        k = tree->list[rlvc_rng_below(tree->rng, count)];
    return k;
}

static void draw_cut(draft *tree, uint32_t k) {
    const rlvc_experience *experience = tree->in->experience;
    uint32_t row = rlvc_experience_row(experience, rlvc_rng_below(tree->rng, experience->count));
    tree->node[k].cut = rlvc_experience_percept(experience, row)[tree->node[k].component];
}

static void draw_test(draft *tree, uint32_t k) {
    uint32_t components = tree->in->experience->components;
    tree->node[k].component = (uint16_t)rlvc_rng_below(tree->rng, components);
    draw_cut(tree, k);
}

static void split_leaf(draft *tree) {
    uint32_t leaves = list_nodes(tree, 1), k = draw_node(tree, leaves);
    uint32_t action = tree->node[k].action, child = tree->nodes;
    uint32_t other = rlvc_rng_below(tree->rng, tree->in->actions - 1u);
    other += other >= action;
    draw_test(tree, k);
    uint32_t side = rlvc_rng_next(tree->rng) >> 31;
    tree->node[k].child = (uint8_t)child;
    memset(tree->node + child, 0, 2u * sizeof *tree->node);
    tree->node[child].component = tree->node[child + 1u].component = RLVC_SMALL_LEAF;
    tree->node[child + side].action = (uint8_t)action;
    tree->node[child + 1u - side].action = (uint8_t)other;
    tree->visited[child] = tree->visited[child + 1u] = 1;
    tree->nodes += 2u;
}

/* By a share of the component's deviation that is between 1 and 1/300, on a logarithmic scale. */
static void shift_cut(draft *tree, uint32_t k) {
    float share = rlvc_exp(-5.756f * rlvc_rng_uniform(tree->rng));
    float sum = 0.0f;
    for (int i = 0; i < 4; i++)
        sum += rlvc_rng_uniform(tree->rng);
    float scale = tree->in->scale[tree->node[k].component];
    tree->node[k].cut += (sum - 2.0f) * 1.7320508f * scale * share;
}

static void swap_sides(draft *tree, uint32_t k) {
    rlvc_small_node *child = tree->node + tree->node[k].child, first = child[0];
    child[0] = child[1];
    child[1] = first;
}

static void move_test(draft *tree, uint32_t tests, float u) {
    uint32_t k = draw_node(tree, tests);
    if (u < 0.42f) {
        draw_cut(tree, k);
    } else if (u < 0.7f) {
        shift_cut(tree, k);
    } else if (u < 0.8f) {
        draw_test(tree, k);
    } else if (u < 0.95f) {
        tree->node[k] = tree->node[tree->node[k].child + (rlvc_rng_next(tree->rng) >> 31)];
    } else {
        swap_sides(tree, k);
    }
}

static void move(draft *tree) {
    uint32_t tests = list_nodes(tree, 0);
    float u = rlvc_rng_uniform(tree->rng);
    if (tests == 0 || u < 0.3f) {
        split_leaf(tree);
    } else if (u >= 0.8f && u < 0.9f) {
        uint32_t k = draw_node(tree, list_nodes(tree, 1));
        tree->node[k].action = (uint8_t)rlvc_rng_below(tree->rng, tree->in->actions);
    } else {
        move_test(tree, tests, u);
    }
}

/* Visits are of leaves; a test was passed if a leaf below it was. */
static void mark_visited(draft *tree, const uint32_t *visits) {
    for (uint32_t k = tree->nodes; k-- > 0;) {
        uint32_t child = tree->node[k].child;
        tree->visited[k] = tree->node[k].component == RLVC_SMALL_LEAF
                               ? visits[k] > 0
                               : tree->visited[child] || tree->visited[child + 1u];
    }
}

int rlvc_moves_make(const rlvc_moves_input *in, const rlvc_small_tree *from, const uint32_t *visits,
                    rlvc_rng *rng, rlvc_small_tree *to) {
    draft tree;
    memcpy(tree.node, from->node, from->nodes * sizeof *tree.node);
    tree.nodes = from->nodes;
    tree.in = in;
    tree.rng = rng;
    mark_visited(&tree, visits);
    float u = rlvc_rng_uniform(rng), v = rlvc_rng_uniform(rng);
    uint32_t moves = 1u + (u < 0.3f) + (v < 0.1f);
    for (uint32_t i = 0; i < moves; i++)
        move(&tree);
    return rlvc_small_tree_compact(tree.node, tree.nodes, in->leaves_max, to);
}
