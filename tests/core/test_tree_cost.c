/* SPDX-License-Identifier: MIT */
/* What it costs to check and to load a tree: as much for a chain as for any other. What is counted
 * are the nodes that are looked at, in the library's own tree.c, which is compiled here with
 * counters. */
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

static void test_any_shape_is_linear(void **state) {
    rlvc_domain domain;
    rlvc_config config;
    rlvc_agent *agent, *loaded;
    rlvc_store store = {NULL, 0, store_read, store_write, NULL, NULL};
    size_t bytes;
    (void)state;
    assert_int_equal(rlvc_bits_domain(16, &domain), RLVC_OK);
    assert_int_equal(rlvc_config_default(&config, &domain, 2), RLVC_OK);
    config.capacity = 10;
    config.classes = CLASSES;
    assert_int_equal(rlvc_agent_size(&config, &domain, &bytes), RLVC_OK);
    assert_int_equal(rlvc_snapshot_size(&config, &domain, &store.slot_bytes), RLVC_OK);
    store_bytes = calloc(2, store.slot_bytes);
    void *memory = malloc(bytes), *other = malloc(bytes);
    assert_non_null(store_bytes && memory && other ? memory : NULL);
    for (uint32_t shape = 0; shape < 4; shape++) {
        assert_int_equal(rlvc_agent_init(&config, &domain, memory, bytes, &agent), RLVC_OK);
        work = 0;
        shape_tree(agent, shape);
        assert_true(work <= MOST);
        assert_true(shape > 1u || agent->tree.depth == CLASSES - 1u);
        work = 0;
        assert_int_equal(rlvc_agent_check(agent), RLVC_OK);
        assert_true(work > NODES && work <= MOST);
        assert_int_equal(rlvc_save(agent, &store), RLVC_OK);
        work = 0;
        assert_int_equal(rlvc_load(&config, &domain, other, bytes, &store, &loaded), RLVC_OK);
        assert_true(work > NODES && work <= 2u * MOST);
        assert_int_equal(loaded->tree.depth, agent->tree.depth);
        assert_memory_equal(loaded->tree.node, agent->tree.node, NODES * sizeof(uint32_t));
    }
    free(store_bytes);
    free(memory);
    free(other);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_any_shape_is_linear),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
