/* SPDX-License-Identifier: MIT */
/* The decision tree: what it answers while it grows, its walk, and its invariant checker. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "block.h"
#include "rlvc/bits.h"
#include "base/rng.h"
#include "tree/tree.h"

#define CLASSES 40u
#define BITS 16u

static uint64_t block[1024];
static rlvc_domain bits;
static rlvc_tree tree;

static void make_tree(void) {
    rlvc_arena arena = {(unsigned char *)block, 0};
    assert_int_equal(rlvc_bits_domain(BITS, &bits), RLVC_OK);
    block_fill(block, 0xa5, sizeof block);
    rlvc_tree_carve(&tree, &arena, CLASSES, bits.feature_bytes);
    assert_true(arena.used <= sizeof block);
    rlvc_tree_clear(&tree);
}

static void grow(uint32_t class_id, uint32_t bit) {
    const unsigned char feature[2] = {(unsigned char)bit, 0};
    rlvc_split about;
    memset(&about, 0, sizeof about);
    about.class_id = class_id;
    about.samples = 100u * class_id + bit;
    rlvc_tree_grow(&tree, rlvc_tree_leaf(&tree, class_id), &about, feature);
}

/* The class by the history of the splits, without nodes: split j takes the percepts with its
 * feature out of its class into class j + 1. */
static uint32_t class_by_history(uint32_t percept) {
    uint32_t class_id = 0;
    for (uint32_t j = 0; j + 1u < tree.classes; j++)
        if (tree.split[j].about.class_id == class_id &&
            (percept >> rlvc_bits_feature(rlvc_tree_feature(&tree, j)) & 1u))
            class_id = j + 1u;
    return class_id;
}

/* Walks the subtree of a node by recursion, and the tree by rlvc_tree_walk: the same nodes. */
static uint32_t compare_walk(uint32_t node, uint32_t *at, uint32_t depth) {
    assert_int_equal(*at, node);
    assert_int_equal(rlvc_tree_depth(&tree, node), depth);
    *at = rlvc_tree_walk(&tree, node);
    if (rlvc_tree_is_leaf(&tree, node))
        return depth;
    uint32_t absent = tree.node[node];
    assert_int_equal(rlvc_tree_parent(&tree, absent), node);
    assert_int_equal(rlvc_tree_parent(&tree, absent + 1u), node);
    assert_int_equal(rlvc_tree_split_of(&tree, node), (absent - 1u) / 2u);
    uint32_t left = compare_walk(absent, at, depth + 1u);
    uint32_t right = compare_walk(absent + 1u, at, depth + 1u);
    return left > right ? left : right;
}

/* Built of its splits at once the tree is what it has grown to be. */
static void compare_built(void) {
    uint32_t node[2u * CLASSES - 1u], split[CLASSES];
    memcpy(node, tree.node, sizeof node);
    for (uint32_t j = 0; j + 1u < tree.classes; j++) {
        split[j] = tree.split[j].node;
        tree.split[j].node = UINT32_MAX;
    }
    memset(tree.node, 0xa5, (2u * tree.classes - 1u) * sizeof *tree.node);
    rlvc_tree_build(&tree, tree.classes);
    assert_memory_equal(tree.node, node, sizeof node);
    for (uint32_t j = 0; j + 1u < tree.classes; j++)
        assert_int_equal(tree.split[j].node, split[j]);
}

/* The leaf of a class is found at once, and step by step. */
static void check_leaf(uint32_t class_id) {
    uint32_t leaf = rlvc_tree_leaf(&tree, class_id), node = 2u * class_id;
    assert_int_equal(tree.node[leaf], RLVC_LEAF | class_id);
    assert_int_equal(rlvc_tree_seek_leaf(&tree, &node, 0), 2u * class_id == leaf);
    while (node != leaf) {
        int found = rlvc_tree_seek_leaf(&tree, &node, 1);
        assert_int_equal(found, node == leaf);
    }
    assert_true(rlvc_tree_seek_leaf(&tree, &node, 1));
    assert_int_equal(node, leaf);
}

static void check_tree(void) {
    uint32_t at = 0;
    for (uint32_t c = 0; c < tree.classes; c++)
        check_leaf(c);
    assert_true(rlvc_tree_check(&tree));
    compare_built();
    assert_int_equal(compare_walk(0, &at, 0), rlvc_tree_deepest(&tree));
    assert_int_equal(at, 0);
    for (uint32_t percept = 0; percept < 1u << BITS; percept += 37u) {
        const unsigned char bytes[2] = {(unsigned char)percept, (unsigned char)(percept >> 8)};
        uint32_t class_id = UINT32_MAX;
        assert_int_equal(rlvc_tree_classify(&tree, &bits, bytes, &class_id), RLVC_OK);
        assert_int_equal(class_id, class_by_history(percept));
    }
}

/* Trees of all shapes: random ones, and chains of the oldest and of the newest class. */
static void test_growth(void **state) {
    (void)state;
    for (uint32_t seed = 0; seed < 20u; seed++) {
        rlvc_rng rng;
        rlvc_rng_seed(&rng, seed);
        make_tree();
        check_tree();
        while (tree.classes < CLASSES) {
            uint32_t newest = tree.classes - 1u;
            uint32_t random = rlvc_rng_below(&rng, tree.classes);
            grow(seed == 0 ? 0 : seed == 1u ? newest : random, rlvc_rng_below(&rng, BITS));
            check_tree();
        }
        assert_true(seed > 1u || rlvc_tree_deepest(&tree) == CLASSES - 1u);
    }
}

static int fail_after(void *ctx, const void *percept, const void *feature, uint8_t *present) {
    (void)percept;
    (void)feature;
    *present = 1;
    return (*(uint32_t *)ctx)-- == 0;
}

/* The detector fails at its first, second, ... call. */
static void test_failing_detector(void **state) {
    (void)state;
    const unsigned char percept[2] = {0xff, 0xff};
    make_tree();
    for (uint32_t class_id = 0; class_id < 5u; class_id++)
        grow(class_id, class_id);
    for (uint32_t calls = 0; calls <= rlvc_tree_deepest(&tree); calls++) {
        uint32_t left = calls, class_id = 77, node = 0;
        rlvc_domain failing = bits;
        failing.ctx = &left;
        failing.exhibits = fail_after;
        rlvc_status status = rlvc_tree_classify(&tree, &failing, percept, &class_id);
        assert_int_equal(status, calls < 5u ? RLVC_E_CALLBACK : RLVC_OK);
        assert_int_equal(class_id, calls < 5u ? 77u : 5u);
        left = 0;
        assert_int_equal(rlvc_tree_descend(&tree, &failing, percept, &node), RLVC_E_CALLBACK);
        assert_int_equal(node, 0);
    }
}

/* Some numbers to write over what says how the nodes hang together. */
static const uint32_t wrong[] = {0,
                                 1,
                                 2,
                                 3,
                                 4,
                                 5,
                                 6,
                                 7,
                                 8,
                                 9,
                                 10,
                                 99,
                                 RLVC_LEAF | 0u,
                                 RLVC_LEAF | 1u,
                                 RLVC_LEAF | 2u,
                                 RLVC_LEAF | 4u,
                                 RLVC_LEAF | 5u,
                                 RLVC_LEAF | 99u,
                                 UINT32_MAX,
                                 0x7fffffff};
#define WRONG ((uint32_t)(sizeof wrong / sizeof wrong[0]))

/* The i-th number that a tree of five classes hangs together by. */
static uint32_t *place(uint32_t i) {
    const uint32_t nodes = 9;
    if (i < nodes)
        return &tree.node[i];
    rlvc_tree_split *split = &tree.split[(i - nodes) / 2u];
    return (i - nodes) % 2u == 0 ? &split->node : &split->about.class_id;
}
#define PLACES 17u

static void make_small_tree(void) {
    make_tree();
    grow(0, 3);
    grow(1, 4);
    grow(0, 5);
    grow(2, 6);
}

/* Any one wrong number, and any two, are found; the check does not lose its way among them. */
static void test_check_finds_damage(void **state) {
    (void)state;
    make_small_tree();
    for (uint32_t i = 0; i < PLACES * WRONG; i++) {
        uint32_t *first = place(i / WRONG), first_right = *first;
        *first = wrong[i % WRONG];
        assert_int_equal(rlvc_tree_check(&tree), *first == first_right);
        for (uint32_t j = 0; j < i / WRONG * WRONG; j++) {
            uint32_t *second = place(j / WRONG), second_right = *second;
            *second = wrong[j % WRONG];
            if (*first != first_right && *second != second_right && rlvc_tree_check(&tree))
                fail_msg("%u at place %u and %u at place %u not found", *first, i / WRONG, *second,
                         j / WRONG);
            *second = second_right;
        }
        *first = first_right;
    }
    assert_true(rlvc_tree_check(&tree));
}

static void test_check_finds_wrong_sizes(void **state) {
    (void)state;
    const uint32_t classes[] = {0, 1, 4, 6, CLASSES + 1u, UINT32_MAX};
    make_small_tree();
    for (size_t i = 0; i < sizeof classes / sizeof classes[0]; i++) {
        tree.classes = classes[i];
        assert_false(rlvc_tree_check(&tree));
    }
    tree.classes = 5;
    assert_true(rlvc_tree_check(&tree));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_growth),
        cmocka_unit_test(test_failing_detector),
        cmocka_unit_test(test_check_finds_damage),
        cmocka_unit_test(test_check_finds_wrong_sizes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
