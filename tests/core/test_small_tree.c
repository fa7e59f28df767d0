/* SPDX-License-Identifier: MIT */
/* Small trees and the moves between them. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "plan/moves.h"
#include <string.h>

#define ROWS 64u

static uint64_t block[512];
static rlvc_experience ring;
static float scale[3] = {1.0f, 2.0f, 0.5f};

static void make_ring(void) {
    rlvc_arena arena = {(unsigned char *)block, 0};
    rlvc_rng rng;
    rlvc_rng_seed(&rng, 1);
    rlvc_experience_carve(&ring, &arena, 3, ROWS);
    assert_true(arena.used <= sizeof block);
    for (uint32_t i = 0; i < ROWS; i++) {
        float s[3];
        for (uint32_t k = 0; k < 3; k++)
            s[k] = rlvc_rng_uniform(&rng);
        rlvc_experience_begin(&ring, s);
    }
}

static rlvc_small_node test_of(uint32_t component, float cut, uint32_t child) {
    rlvc_small_node node = {cut, (uint16_t)component, (uint8_t)child, 0};
    return node;
}

static rlvc_small_node leaf_of(uint32_t action) {
    rlvc_small_node node = {0.0f, RLVC_SMALL_LEAF, 0, (uint8_t)action};
    return node;
}

/* Children come in pairs after their parent, leaves are counted, and no test's sides act alike. */
static void check(const rlvc_small_tree *tree, uint32_t actions, uint32_t leaves_max) {
    uint32_t leaves = 0, tests = 0;
    assert_true(tree->leaves >= 1 && tree->leaves <= leaves_max);
    assert_int_equal(tree->nodes, 2u * tree->leaves - 1u);
    for (uint32_t k = 0; k < tree->nodes; k++) {
        const rlvc_small_node *node = tree->node + k;
        if (node->component == RLVC_SMALL_LEAF) {
            assert_true(node->action < actions);
            leaves++;
            continue;
        }
        tests++;
        assert_true(node->component < 3);
        assert_true(node->child > k && node->child % 2u == 1u && node->child + 1u < tree->nodes);
        const rlvc_small_node *child = tree->node + node->child;
        assert_false(child[0].component == RLVC_SMALL_LEAF &&
                     child[1].component == RLVC_SMALL_LEAF && child[0].action == child[1].action);
    }
    assert_int_equal(leaves, tree->leaves);
    assert_int_equal(tests + 1u, leaves);
}

static void test_one_leaf(void **state) {
    (void)state;
    rlvc_small_tree tree;
    float s[3] = {0};
    rlvc_small_tree_constant(&tree, 4);
    check(&tree, 5, 1);
    assert_int_equal(rlvc_small_tree_act(&tree, s), 4);
}

static void test_tests_are_strictly_above(void **state) {
    (void)state;
    rlvc_small_tree tree;
    const rlvc_small_node node[] = {test_of(1, 0.5f, 1), leaf_of(0), leaf_of(1)};
    const float below[3] = {1, 0.25f, 1}, at[3] = {1, 0.5f, 1}, above[3] = {0, 0.75f, 0};
    assert_true(rlvc_small_tree_compact(node, 3, 2, &tree));
    assert_int_equal(rlvc_small_tree_act(&tree, below), 0);
    assert_int_equal(rlvc_small_tree_act(&tree, at), 0);
    assert_int_equal(rlvc_small_tree_act(&tree, above), 1);
}

/* What acts alike becomes one leaf, and what cannot be reached goes. */
static void test_compacting(void **state) {
    (void)state;
    rlvc_small_tree tree;
    const rlvc_small_node alike[] = {test_of(0, 0.5f, 3), leaf_of(7),          leaf_of(8),
                                     test_of(1, 0.5f, 5), test_of(2, 0.1f, 7), leaf_of(2),
                                     leaf_of(2),          leaf_of(2),          leaf_of(2)};
    assert_true(rlvc_small_tree_compact(alike, 9, 4, &tree));
    check(&tree, 3, 1);
    assert_int_equal(tree.node[0].action, 2);
    rlvc_small_node mixed[9];
    memcpy(mixed, alike, sizeof mixed);
    mixed[8] = leaf_of(1);
    assert_true(rlvc_small_tree_compact(mixed, 9, 3, &tree));
    check(&tree, 3, 3);
    assert_int_equal(tree.leaves, 3);
    assert_int_equal(tree.node[tree.node[0].child].action, 2);
    assert_false(rlvc_small_tree_compact(mixed, 9, 2, &tree));
}

/* However long one moves, trees stay sound and no greater than allowed; and all actions, components
 * and sizes are met. */
static void test_moves_make_sound_trees(void **state) {
    (void)state;
    for (uint32_t actions = 2; actions <= 4; actions++) {
        rlvc_moves_input in = {&ring, scale, actions, 6};
        uint32_t visits[RLVC_SMALL_NODES_MAX], sizes[RLVC_SMALL_LEAVES_MAX + 1u] = {0};
        uint32_t components[3] = {0}, acts[4] = {0}, refused = 0;
        rlvc_small_tree tree, to;
        rlvc_rng rng;
        rlvc_rng_seed(&rng, actions);
        make_ring();
        rlvc_small_tree_constant(&tree, 0);
        for (uint32_t i = 0; i < 5000; i++) {
            for (uint32_t k = 0; k < RLVC_SMALL_NODES_MAX; k++)
                visits[k] = rlvc_rng_below(&rng, 3);
            if (!rlvc_moves_make(&in, &tree, visits, &rng, &to)) {
                refused++;
                continue;
            }
            tree = to;
            check(&tree, actions, 6);
            sizes[tree.leaves]++;
            for (uint32_t k = 0; k < tree.nodes; k++) {
                if (tree.node[k].component == RLVC_SMALL_LEAF)
                    acts[tree.node[k].action]++;
                else
                    components[tree.node[k].component]++;
            }
        }
        for (uint32_t leaves = 1; leaves <= 6; leaves++)
            assert_true(sizes[leaves] > 20);
        for (uint32_t a = 0; a < actions; a++)
            assert_true(acts[a] > 500);
        for (uint32_t k = 0; k < 3; k++)
            assert_true(components[k] > 500);
        assert_true(refused > 50);
    }
}

/* A leaf that was never visited is split more seldom. */
static void test_visited_leaves_are_preferred(void **state) {
    (void)state;
    rlvc_moves_input in = {&ring, scale, 3, 3};
    const rlvc_small_node node[] = {test_of(0, 0.5f, 1), leaf_of(0), leaf_of(1)};
    const uint32_t visits[3] = {0, 0, 9};
    rlvc_small_tree tree, to;
    uint32_t split[2] = {0};
    rlvc_rng rng;
    rlvc_rng_seed(&rng, 3);
    make_ring();
    assert_true(rlvc_small_tree_compact(node, 3, 3, &tree));
    for (uint32_t i = 0; i < 3000; i++) {
        if (!rlvc_moves_make(&in, &tree, visits, &rng, &to) || to.leaves != 3)
            continue;
        split[0] += to.node[1].component != RLVC_SMALL_LEAF;
        split[1] += to.node[2].component != RLVC_SMALL_LEAF;
    }
    assert_true(split[1] > 4u * split[0] && split[0] > 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_one_leaf),
        cmocka_unit_test(test_tests_are_strictly_above),
        cmocka_unit_test(test_compacting),
        cmocka_unit_test(test_moves_make_sound_trees),
        cmocka_unit_test(test_visited_leaves_are_preferred),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
