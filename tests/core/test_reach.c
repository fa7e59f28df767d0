/* SPDX-License-Identifier: MIT */
/* What rollouts passed, and whether a candidate would do the same there: against looking at every
 * point of a grid. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "block.h"
#include "base/rng.h"
#include "plan/reach.h"

#define COMPONENTS 2u
#define SIDE 8u /* points of the grid in each direction */
#define LEAVES 6u
#define NODES (2u * LEAVES - 1u)
#define STARTS 3u

static uint64_t block[STARTS * NODES * 2u * 2u * COMPONENTS + 200u];
static rlvc_reach known, made;

static int carve(void **state) {
    rlvc_arena arena = {NULL, 0};
    (void)state;
    rlvc_reach_carve(&known, &arena, STARTS, LEAVES, COMPONENTS);
    rlvc_reach_carve(&made, &arena, STARTS, LEAVES, COMPONENTS);
    assert_true(arena.used <= sizeof block);
    block_fill(block, 0x5a, sizeof block);
    arena.base = (unsigned char *)block;
    arena.used = 0;
    rlvc_reach_carve(&known, &arena, STARTS, LEAVES, COMPONENTS);
    rlvc_reach_carve(&made, &arena, STARTS, LEAVES, COMPONENTS);
    assert_int_equal(known.nodes, NODES);
    return 0;
}

/* A tree of at most `leaves` leaves, whose cuts are at points of the grid. */
static void draw_tree(rlvc_small_tree *tree, uint32_t leaves, rlvc_rng *rng) {
    rlvc_small_node node[NODES];
    uint32_t nodes = 1;
    rlvc_small_tree_constant(tree, rlvc_rng_below(rng, 2));
    node[0] = tree->node[0];
    while (nodes + 2u <= 2u * leaves - 1u) {
        uint32_t k = rlvc_rng_below(rng, nodes);
        if (node[k].component != RLVC_SMALL_LEAF)
            continue;
        node[k].component = (uint16_t)rlvc_rng_below(rng, COMPONENTS);
        node[k].cut = (float)rlvc_rng_below(rng, SIDE);
        node[k].child = (uint8_t)nodes;
        for (uint32_t side = 0; side < 2u; side++) {
            node[nodes + side] = tree->node[0];
            node[nodes + side].action = (uint8_t)rlvc_rng_below(rng, 2);
        }
        nodes += 2u;
    }
    assert_true(rlvc_small_tree_compact(node, nodes, LEAVES, tree));
}

static void note(const rlvc_small_tree *tree, const float *percept, uint32_t start) {
    uint32_t leaf = rlvc_small_tree_leaf(tree, percept);
    rlvc_reach_note(rlvc_reach_boxes(&known, start) + (size_t)leaf * 2u * COMPONENTS, percept,
                    COMPONENTS);
}

/* Some points of a random part of the grid. */
static void walk(const rlvc_small_tree *tree, uint32_t start, rlvc_rng *rng) {
    uint32_t from[COMPONENTS], size = 1u + rlvc_rng_below(rng, 5);
    from[0] = rlvc_rng_below(rng, SIDE - 1u);
    from[1] = rlvc_rng_below(rng, SIDE - 1u);
    rlvc_reach_clear(&known, start);
    known.steps[start] = 10u + start;
    for (uint32_t i = 0; i < 5; i++) {
        float percept[COMPONENTS];
        for (uint32_t c = 0; c < COMPONENTS; c++)
            percept[c] = (float)((from[c] + rlvc_rng_below(rng, size)) % SIDE);
        note(tree, percept, start);
    }
}

static int within(const float *box, const float *percept) {
    return percept[0] >= box[0] && percept[0] <= box[2] && percept[1] >= box[1] &&
           percept[1] <= box[3];
}

/* The candidate's leaf at all points of a box, or NODES if they lead to several. */
static uint32_t leaf_of_points(const rlvc_small_tree *candidate, const float *box) {
    uint32_t found = NODES + 1u;
    for (uint32_t i = 0; i < SIDE * SIDE; i++) {
        const float percept[COMPONENTS] = {(float)(i / SIDE), (float)(i % SIDE)};
        uint32_t leaf = rlvc_small_tree_leaf(candidate, percept);
        if (!within(box, percept))
            continue;
        if (found <= NODES && found != leaf)
            return NODES;
        found = leaf;
    }
    return found;
}

/* Must the candidate be known to do the same, by what all points say? Counts the leaves. */
static int expected(const rlvc_small_tree *tree, const rlvc_small_tree *candidate, uint32_t start,
                    uint32_t *visits) {
    for (uint32_t k = 0; k < tree->nodes; k++) {
        const float *box = rlvc_reach_boxes(&known, start) + (size_t)k * 2u * COMPONENTS;
        if (box[0] > box[COMPONENTS])
            continue;
        uint32_t leaf = leaf_of_points(candidate, box);
        if (leaf == NODES || candidate->node[leaf].action != tree->node[k].action)
            return 0;
        visits[leaf] = 1;
    }
    return 1;
}

/* All boxes of the tree lie in those of the candidate, which are no larger than that takes. */
static void check_boxes(const rlvc_small_tree *tree, const rlvc_small_tree *candidate,
                        uint32_t start) {
    float wanted[NODES][2u * COMPONENTS];
    for (uint32_t k = 0; k < NODES; k++) {
        wanted[k][0] = wanted[k][1] = 3e38f;
        wanted[k][2] = wanted[k][3] = -3e38f;
    }
    for (uint32_t k = 0; k < tree->nodes; k++) {
        const float *box = rlvc_reach_boxes(&known, start) + (size_t)k * 2u * COMPONENTS;
        if (box[0] > box[COMPONENTS])
            continue;
        float *to = wanted[leaf_of_points(candidate, box)];
        for (uint32_t c = 0; c < COMPONENTS; c++) {
            to[c] = box[c] < to[c] ? box[c] : to[c];
            to[2u + c] = box[2u + c] > to[2u + c] ? box[2u + c] : to[2u + c];
        }
    }
    assert_memory_equal(rlvc_reach_boxes(&made, start), wanted, sizeof wanted);
    assert_int_equal(made.steps[start], 10u + start);
}

static void test_what_repeats(void **state) {
    (void)state;
    uint32_t same = 0, rounds = 20000;
    rlvc_rng rng;
    rlvc_rng_seed(&rng, 5);
    for (uint32_t round = 0; round < rounds; round++) {
        rlvc_small_tree tree, candidate;
        uint32_t visits[NODES] = {0}, wanted[NODES] = {0}, start = round % STARTS;
        draw_tree(&tree, 1u + rlvc_rng_below(&rng, LEAVES), &rng);
        draw_tree(&candidate, 1u + rlvc_rng_below(&rng, LEAVES), &rng);
        walk(&tree, start, &rng);
        int repeats = rlvc_reach_repeats(&known, &tree, start, &candidate, &made, visits);
        if (repeats != expected(&tree, &candidate, start, wanted))
            fail_msg("round %u: %d", (unsigned)round, repeats);
        if (!repeats)
            continue;
        assert_memory_equal(visits, wanted, sizeof visits);
        check_boxes(&tree, &candidate, start);
        same++;
    }
    assert_true(same > rounds / 20u && same < rounds / 2u);
}

/* A tree itself repeats what it did; its visits are added to. */
static void test_a_tree_repeats_itself(void **state) {
    (void)state;
    rlvc_rng rng;
    rlvc_rng_seed(&rng, 6);
    for (uint32_t round = 0; round < 200; round++) {
        rlvc_small_tree tree;
        uint32_t visits[NODES], start = round % STARTS;
        for (uint32_t k = 0; k < NODES; k++)
            visits[k] = 7;
        draw_tree(&tree, LEAVES, &rng);
        walk(&tree, start, &rng);
        assert_int_equal(rlvc_reach_repeats(&known, &tree, start, &tree, &made, visits), 1);
        assert_memory_equal(rlvc_reach_boxes(&made, start), rlvc_reach_boxes(&known, start),
                            NODES * 2u * COMPONENTS * sizeof(float));
        for (uint32_t k = 0; k < tree.nodes; k++) {
            const float *box = rlvc_reach_boxes(&known, start) + (size_t)k * 2u * COMPONENTS;
            assert_int_equal(visits[k], 7u + (box[0] <= box[COMPONENTS]));
        }
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_what_repeats),
        cmocka_unit_test(test_a_tree_repeats_itself),
    };
    return cmocka_run_group_tests(tests, carve, NULL);
}
