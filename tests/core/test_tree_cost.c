/* SPDX-License-Identifier: MIT */
/* What it costs to check, to load and to grow a tree: as much for a chain as for any other. What is
 * counted are the nodes that are looked at, in the library's own tree.c, which is compiled here
 * with counters. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "tree/tree.h"

static uint64_t work;

static uint64_t counted(void) {
    return work++;
}

#define rlvc_tree_is_leaf(tree, node) (counted(), rlvc_tree_is_leaf(tree, node))
#define rlvc_tree_class(tree, node) (counted(), rlvc_tree_class(tree, node))
#define rlvc_tree_parent(tree, node) (counted(), rlvc_tree_parent(tree, node))
#define rlvc_tree_split_of(tree, node) (counted(), rlvc_tree_split_of(tree, node))
#include "tree/tree.c"
#undef rlvc_tree_is_leaf
#undef rlvc_tree_class
#undef rlvc_tree_parent
#undef rlvc_tree_split_of

#include "agent/state.h"
#include "base/rng.h"
#include "rlvc/bits.h"
#include "rlvc/snapshot.h"

#include <string.h>

#define CLASSES 20000u
#define NODES (2u * CLASSES - 1u)
#define MOST (12u * NODES) /* looks at a node */

static unsigned char *store_bytes;

static int store_read(void *ctx, uint32_t offset, void *buffer, uint32_t bytes) {
    (void)ctx;
    memcpy(buffer, store_bytes + offset, bytes);
    return 0;
}

static int store_write(void *ctx, uint32_t offset, const void *buffer, uint32_t bytes) {
    (void)ctx;
    memcpy(store_bytes + offset, buffer, bytes);
    return 0;
}

/* The class that split j is of: a chain of the oldest class, of the newest, of both in turn; or
 * any. */
static uint32_t class_of_split(uint32_t shape, uint32_t j, rlvc_rng *rng) {
    if (shape == 2)
        return j % 2u ? 0 : j;
    return shape == 0 ? 0 : shape == 1 ? j : rlvc_rng_below(rng, j + 1u);
}

static void shape_tree(rlvc_agent *agent, uint32_t shape) {
    rlvc_rng rng;
    rlvc_rng_seed(&rng, 7);
    for (uint32_t j = 0; j + 1u < CLASSES; j++) {
        rlvc_split *about = &agent->tree.split[j].about;
        memset(about, 0, sizeof *about);
        about->class_id = class_of_split(shape, j, &rng);
        memset(rlvc_tree_feature(&agent->tree, j), 0, 2);
        rlvc_values_inherit(&agent->values, j + 1u, about->class_id);
        rlvc_explorer_inherit(&agent->explorer, agent->config.actions, j + 1u, about->class_id);
        agent->pending[j + 1u] = 0;
    }
    rlvc_tree_build(&agent->tree, CLASSES);
}

/* What the tests share: an agent with room for one class more than the tree of a shape has, and
 * where it is saved to and loaded into. */
static struct {
    rlvc_domain domain;
    rlvc_config config;
    rlvc_store store;
    void *memory, *other;
    size_t bytes;
    rlvc_agent *agent;
} w;

static int make_world(void **state) {
    (void)state;
    assert_int_equal(rlvc_bits_domain(16, &w.domain), RLVC_OK);
    assert_int_equal(rlvc_config_default(&w.config, &w.domain, 2), RLVC_OK);
    w.config.capacity = 60;
    w.config.classes = CLASSES + 1u;
    w.config.successors = 0;
    assert_int_equal(rlvc_agent_size(&w.config, &w.domain, &w.bytes), RLVC_OK);
    w.store = (rlvc_store){NULL, 0, store_read, store_write, NULL, NULL};
    assert_int_equal(rlvc_snapshot_size(&w.config, &w.domain, &w.store.slot_bytes), RLVC_OK);
    store_bytes = calloc(2, w.store.slot_bytes);
    w.memory = malloc(w.bytes);
    w.other = malloc(w.bytes);
    return !store_bytes || !w.memory || !w.other;
}

static int free_world(void **state) {
    (void)state;
    free(store_bytes);
    free(w.memory);
    free(w.other);
    return 0;
}

static void make_agent(uint32_t shape) {
    assert_int_equal(rlvc_agent_init(&w.config, &w.domain, w.memory, w.bytes, &w.agent), RLVC_OK);
    work = 0;
    shape_tree(w.agent, shape);
}

static rlvc_agent *loaded(void) {
    rlvc_agent *agent;
    work = 0;
    assert_int_equal(rlvc_load(&w.config, &w.domain, w.other, w.bytes, &w.store, &agent), RLVC_OK);
    return agent;
}

static void test_any_shape_is_linear(void **state) {
    (void)state;
    for (uint32_t shape = 0; shape < 4; shape++) {
        make_agent(shape);
        assert_true(work <= MOST);
        assert_true(shape > 1u || rlvc_tree_deepest(&w.agent->tree) == CLASSES - 1u);
        work = 0;
        assert_int_equal(rlvc_agent_check(w.agent), RLVC_OK);
        assert_true(work > NODES && work <= MOST);
        assert_int_equal(rlvc_save(w.agent, &w.store), RLVC_OK);
        const rlvc_agent *again = loaded();
        assert_true(work > NODES && work <= 2u * MOST);
        assert_memory_equal(again->tree.node, w.agent->tree.node, NODES * sizeof(uint32_t));
    }
}

/* ------------------------------------------------------------------ growing */

/* Class 0, at the end of a chain, is to be split by bit 1. */
static void make_split_worthwhile(void) {
    unsigned char percept[2] = {0, 0};
    const rlvc_choice choice = {0, 0};
    make_agent(0);
    for (uint32_t i = 0; i < w.config.capacity; i++) {
        percept[0] = (unsigned char)(i % 2u << 1);
        assert_int_equal(rlvc_begin(w.agent, percept), RLVC_OK);
        assert_int_equal(rlvc_observe(w.agent, choice, (float)(i % 2u), percept, RLVC_TERMINATED),
                         RLVC_OK);
    }
}

/* Learns in the least slices. @return the most nodes that one of them looked at. */
static uint64_t learn_until(rlvc_agent *agent, int growing) {
    rlvc_progress progress;
    uint64_t most = 0;
    do {
        work = 0;
        assert_int_equal(rlvc_learn(agent, RLVC_BUDGET_MIN, &progress), RLVC_OK);
        most = work > most ? work : most;
        if (growing && agent->learner.searching == RLVC_GROWING)
            return most;
    } while (!progress.done);
    assert_false(growing);
    return most;
}

/* The leaf of a class is as far away as the tree is deep: no slice looks at more nodes for that. */
static void test_growing_in_slices(void **state) {
    (void)state;
    make_split_worthwhile();
    assert_true(learn_until(w.agent, 0) <= 3u * RLVC_BUDGET_MIN);
    assert_int_equal(w.agent->tree.classes, CLASSES + 1u);
    assert_int_equal(w.agent->tree.split[CLASSES - 1u].about.class_id, 0);
    assert_int_equal(rlvc_agent_check(w.agent), RLVC_OK);
}

/* On the way to the leaf an agent is saved, loaded, and makes the same split. */
static void test_growing_is_resumed(void **state) {
    (void)state;
    make_split_worthwhile();
    for (uint32_t i = 0; i < 3; i++)
        (void)learn_until(w.agent, 1);
    assert_int_equal(rlvc_save(w.agent, &w.store), RLVC_OK);
    rlvc_agent *again = loaded();
    assert_int_equal(again->learner.searching, RLVC_GROWING);
    assert_int_equal(again->learner.walk.node, w.agent->learner.walk.node);
    (void)learn_until(w.agent, 0);
    (void)learn_until(again, 0);
    assert_int_equal(again->tree.classes, CLASSES + 1u);
    assert_memory_equal(again->tree.node, w.agent->tree.node, NODES * sizeof(uint32_t));
}

/* A forged way that leads to another class's leaf, and one of no class. */
static void test_forged_ways(void **state) {
    (void)state;
    for (uint32_t forged = 0; forged < 2; forged++) {
        rlvc_agent *again;
        make_split_worthwhile();
        (void)learn_until(w.agent, 1);
        if (forged == 0)
            w.agent->learner.walk.node = 2;
        else
            w.agent->learner.at = w.agent->learner.classes;
        assert_int_equal(rlvc_save(w.agent, &w.store), RLVC_OK);
        assert_int_equal(rlvc_load(&w.config, &w.domain, w.other, w.bytes, &w.store, &again),
                         RLVC_E_DAMAGED);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_any_shape_is_linear),
        cmocka_unit_test(test_growing_in_slices),
        cmocka_unit_test(test_growing_is_resumed),
        cmocka_unit_test(test_forged_ways),
    };
    return cmocka_run_group_tests(tests, make_world, free_world);
}
