/* SPDX-License-Identifier: MIT */
/* The tree of the fewest leaves, against the recursion that defines it, without table or bounds. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "block.h"
#include "rlvc/min_tree.h"
#include "base/rng.h"

#include <stdlib.h>
#include <string.h>

#define ROWS 20u
#define WORDS 3u
#define AMPLE ((uint64_t)1 << 30)
#define CANARY 0xa5

static uint64_t memory[1u << 16];

typedef struct problem {
    rlvc_min_tree_task task;
    uint64_t row[ROWS * WORDS];
    uint64_t allowed[ROWS];
} problem;

static uint32_t bit(const problem *p, uint32_t row, uint32_t feature) {
    const uint32_t words = RLVC_MIN_TREE_WORDS(p->task.features);
    return (uint32_t)(p->row[row * words + feature / 64u] >> feature % 64u) & 1u;
}

/* F of a set of rows, as bits; 0 if there is no tree. */
static uint32_t reference(const problem *p, uint32_t rows) {
    uint64_t common = UINT64_MAX;
    uint32_t best = 0;
    for (uint32_t i = 0; i < p->task.rows; i++)
        common &= rows >> i & 1u ? p->allowed[i] : UINT64_MAX;
    if (common != 0)
        return 1;
    for (uint32_t f = 0; f < p->task.features; f++) {
        uint32_t with = 0;
        for (uint32_t i = 0; i < p->task.rows; i++)
            with |= (rows >> i & bit(p, i, f)) << i;
        if (with == 0 || with == rows)
            continue;
        const uint32_t absent = reference(p, rows & ~with), present = reference(p, with);
        if (absent == 0 || present == 0)
            return 0;
        if (best == 0 || absent + present < best)
            best = absent + present;
    }
    return best;
}

/* Fails unless every row ends in a leaf whose action it allows. */
static void check_tree(const problem *p, const rlvc_min_tree_result *tree) {
    for (uint32_t i = 0; i < p->task.rows; i++) {
        uint32_t leaf = 0;
        for (uint32_t j = 0; j + 1u < tree->leaves; j++) {
            assert_true(tree->split[j].leaf <= j && tree->split[j].feature < p->task.features);
            if (tree->split[j].leaf == leaf && bit(p, i, tree->split[j].feature))
                leaf = j + 1u;
        }
        assert_true(p->allowed[i] >> tree->action[leaf] & 1u);
    }
}

/* Solves in a block of just the size, behind which nothing is touched. */
static rlvc_status solve(const problem *p, rlvc_min_tree_result *tree) {
    size_t bytes = 0;
    assert_int_equal(rlvc_min_tree_size(&p->task, &bytes), RLVC_OK);
    assert_true(bytes + sizeof *memory <= sizeof memory);
    block_fill(memory, CANARY, bytes + sizeof *memory);
    const rlvc_status status = rlvc_min_tree(&p->task, memory, bytes, tree);
    for (size_t i = 0; i < sizeof *memory; i++)
        assert_int_equal(((const unsigned char *)memory)[bytes + i], CANARY);
    return status;
}

/* Rows of `used` features, which are `apart` columns apart, with sets of some of `actions`
 * actions. */
static void draw(problem *p, rlvc_rng *rng, uint32_t used, uint32_t apart, uint32_t actions) {
    memset(p, 0, sizeof *p);
    p->task.row = p->row;
    p->task.allowed = p->allowed;
    p->task.rows = 1u + rlvc_rng_below(rng, ROWS);
    p->task.features = used * apart;
    p->task.entries = 512;
    p->task.effort = AMPLE;
    const uint32_t words = RLVC_MIN_TREE_WORDS(p->task.features);
    for (uint32_t i = 0; i < p->task.rows; i++) {
        for (uint32_t f = 0; f < used; f++) {
            const uint32_t column = f * apart + apart / 2u;
            p->row[i * words + column / 64u] |= (uint64_t)rlvc_rng_below(rng, 2) << column % 64u;
        }
        while (p->allowed[i] == 0)
            for (uint32_t a = 0; a < actions; a++)
                p->allowed[i] |= (uint64_t)(rlvc_rng_below(rng, 3) == 0) << (a * 63u / actions);
    }
}

static void test_against_the_recursion(void **unused) {
    (void)unused;
    static const uint32_t entries[] = {2, 3, 8, 31, 128}, efforts[] = {1, 40, 300, 3000};
    rlvc_rng rng;
    uint32_t torn = 0, parted = 0, worse = 0;
    rlvc_rng_seed(&rng, 5);
    for (uint32_t k = 0; k < 600; k++) {
        problem p;
        rlvc_min_tree_result tree;
        const uint32_t used = rlvc_rng_below(&rng, 6), apart = k % 3u == 2u ? 31u : 1u;
        draw(&p, &rng, used, apart, 2u + rlvc_rng_below(&rng, 4));
        const uint32_t fewest = reference(&p, (1u << p.task.rows) - 1u);
        if (fewest == 0) {
            assert_int_equal(solve(&p, &tree), RLVC_E_RANGE);
            p.task.effort = 1;
            assert_int_equal(solve(&p, &tree), RLVC_E_RANGE);
            torn++;
            continue;
        }
        assert_int_equal(solve(&p, &tree), RLVC_OK);
        if (tree.leaves != fewest || !tree.exact)
            fail_msg("problem %u: %u leaves instead of %u", k, tree.leaves, fewest);
        check_tree(&p, &tree);
        for (uint32_t i = 0; i < 20; i++) {
            p.task.entries = i < 5 ? entries[i] : 512;
            p.task.effort = i < 5 ? AMPLE : efforts[i % 4u];
            assert_int_equal(solve(&p, &tree), RLVC_OK);
            check_tree(&p, &tree);
            assert_true(tree.exact ? tree.leaves == fewest : tree.leaves >= fewest);
            parted += !tree.exact;
            worse += tree.leaves > fewest;
        }
    }
    assert_true(torn > 50 && parted > 500 && worse > 20);
}

/* Exclusive or of all features: no part of the table helps. */
/* What most rows allow of what one allows; of equals the lowest. */
static uint32_t favourite(const problem *p, uint32_t row) {
    uint32_t best = 64, most = 0;
    for (uint32_t a = 0; a < 64u; a++) {
        uint32_t count = 0;
        for (uint32_t i = 0; i < p->task.rows; i++)
            count += (uint32_t)(p->allowed[i] >> a & 1u);
        if ((p->allowed[row] >> a & 1u) && count > most) {
            most = count;
            best = a;
        }
    }
    return best;
}

/* The sum of n_a^2 / n over the sides of a feature, in the order of the library. */
static float purity(const problem *p, uint32_t feature) {
    float sum = 0.0f;
    for (uint32_t side = 0; side < 2; side++) {
        uint32_t favours[64] = {0}, rows = 0;
        for (uint32_t i = 0; i < p->task.rows; i++)
            if (bit(p, i, feature) == side) {
                favours[favourite(p, i)]++;
                rows++;
            }
        if (rows == 0)
            return 0.0f;
        for (uint32_t a = 0; a < 64u; a++)
            sum += (float)favours[a] * (float)favours[a] / (float)rows;
    }
    return sum;
}

/* Without room or effort all rows are parted first by the feature that leaves them purest. */
static void test_the_greedy_way(void **unused) {
    (void)unused;
    rlvc_rng rng;
    uint32_t parted = 0;
    rlvc_rng_seed(&rng, 9);
    for (uint32_t round = 0; round < 2000u; round++) {
        problem p;
        rlvc_min_tree_result tree;
        draw(&p, &rng, 2u + rlvc_rng_below(&rng, 5), 1u + 20u * rlvc_rng_below(&rng, 2),
             2u + rlvc_rng_below(&rng, 4));
        p.task.entries = 2;
        p.task.effort = 1;
        if (solve(&p, &tree) != RLVC_OK || tree.exact)
            continue;
        float most = 0.0f;
        uint32_t purest = 0;
        for (uint32_t f = 0; f < p.task.features; f++)
            if (purity(&p, f) > most) {
                most = purity(&p, f);
                purest = f;
            }
        assert_int_equal(tree.split[0].leaf, 0);
        assert_int_equal(tree.split[0].feature, purest);
        parted++;
    }
    assert_true(parted > 200u);
}

static void test_parity(void **unused) {
    (void)unused;
    problem p;
    rlvc_min_tree_result tree;
    memset(&p, 0, sizeof p);
    p.task.row = p.row;
    p.task.allowed = p.allowed;
    p.task.rows = 16;
    p.task.features = 4;
    p.task.entries = 256;
    p.task.effort = AMPLE;
    for (uint32_t i = 0; i < 16; i++) {
        p.row[i] = i;
        p.allowed[i] = (uint64_t)1 << 63u * ((i ^ i >> 1 ^ i >> 2 ^ i >> 3) & 1u);
    }
    assert_int_equal(solve(&p, &tree), RLVC_OK);
    assert_int_equal(tree.leaves, 16);
    assert_int_equal(tree.exact, 1);
    check_tree(&p, &tree);
}

static void refuse(const problem *p, rlvc_status expected) {
    size_t bytes = 1;
    rlvc_min_tree_result tree;
    assert_int_equal(rlvc_min_tree_size(&p->task, &bytes), expected);
    assert_int_equal(bytes, 0);
    assert_int_equal(rlvc_min_tree(&p->task, memory, sizeof memory, &tree), expected);
}

static void test_refusals(void **unused) {
    (void)unused;
    problem p, q;
    rlvc_rng rng;
    rlvc_min_tree_result tree;
    size_t bytes = 0;
    rlvc_rng_seed(&rng, 1);
    draw(&p, &rng, 5, 1, 2);
    assert_int_equal(rlvc_min_tree_size(NULL, &bytes), RLVC_E_NULL);
    assert_int_equal(rlvc_min_tree_size(&p.task, NULL), RLVC_E_NULL);
    assert_int_equal(rlvc_min_tree(NULL, memory, sizeof memory, &tree), RLVC_E_NULL);
    assert_int_equal(rlvc_min_tree(&p.task, NULL, sizeof memory, &tree), RLVC_E_NULL);
    assert_int_equal(rlvc_min_tree(&p.task, memory, sizeof memory, NULL), RLVC_E_NULL);
    q = p;
    q.task.row = NULL;
    assert_int_equal(rlvc_min_tree(&q.task, memory, sizeof memory, &tree), RLVC_E_NULL);
    q = p;
    q.task.allowed = NULL;
    assert_int_equal(rlvc_min_tree(&q.task, memory, sizeof memory, &tree), RLVC_E_NULL);
#define REFUSED(field, value)                                                                      \
    do {                                                                                           \
        q = p;                                                                                     \
        q.task.field = value;                                                                      \
        refuse(&q, RLVC_E_RANGE);                                                                  \
    } while (0)
    REFUSED(rows, 0);
    REFUSED(rows, RLVC_MIN_TREE_ROWS_MAX + 1u);
    REFUSED(features, RLVC_MIN_TREE_FEATURES_MAX + 1u);
    REFUSED(entries, 1);
    REFUSED(entries, RLVC_MIN_TREE_ENTRIES_MAX + 1u);
    REFUSED(reserved, 1);
    REFUSED(effort, 0);
    REFUSED(effort, RLVC_MIN_TREE_EFFORT_MAX + 1u);
    q = p;
    q.task.row = q.row;
    q.task.allowed = q.allowed;
    q.allowed[q.task.rows - 1u] = 0;
    assert_int_equal(rlvc_min_tree(&q.task, memory, sizeof memory, &tree), RLVC_E_RANGE);
    q.allowed[q.task.rows - 1u] = 1;
    q.row[q.task.rows - 1u] |= 1u << 5;
    assert_int_equal(rlvc_min_tree(&q.task, memory, sizeof memory, &tree), RLVC_E_RANGE);
    assert_int_equal(rlvc_min_tree_size(&p.task, &bytes), RLVC_OK);
    assert_int_equal(rlvc_min_tree(&p.task, memory, bytes - 1u, &tree), RLVC_E_MEMORY);
    assert_int_equal(rlvc_min_tree(&p.task, (unsigned char *)memory + 4, bytes, &tree),
                     RLVC_E_MEMORY);
}

/* Rows that need no test need no features. */
static void test_nothing_to_tell_apart(void **unused) {
    (void)unused;
    const uint64_t allowed[] = {3, 2, 6};
    rlvc_min_tree_task task = {NULL, allowed, 3, 0, 2, 0, 1};
    rlvc_min_tree_result tree;
    assert_int_equal(rlvc_min_tree(&task, memory, sizeof memory, &tree), RLVC_OK);
    assert_int_equal(tree.leaves, 1);
    assert_int_equal(tree.exact, 1);
    assert_int_equal(tree.action[0], 1);
}

/* Without features, rows that differ in their actions cannot be told apart; there is no row to
 * read. */
static void test_no_features(void **unused) {
    (void)unused;
    const uint64_t allowed[] = {1, 2, 1};
    unsigned char *nothing = malloc(1);
    for (uint32_t i = 0; i < 2; i++) {
        rlvc_min_tree_task task = {
            i ? (const uint64_t *)nothing : NULL, allowed, 3, 0, 16, 0, 1000};
        rlvc_min_tree_result tree;
        assert_int_equal(rlvc_min_tree(&task, memory, sizeof memory, &tree), RLVC_E_RANGE);
    }
    free(nothing);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_against_the_recursion),
        cmocka_unit_test(test_the_greedy_way),
        cmocka_unit_test(test_parity),
        cmocka_unit_test(test_refusals),
        cmocka_unit_test(test_nothing_to_tell_apart),
        cmocka_unit_test(test_no_features),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
