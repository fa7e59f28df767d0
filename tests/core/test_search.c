/* SPDX-License-Identifier: MIT */
/* Rollouts in a model, new cells, and the search for a small tree. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "block.h"
#include "plan/cells.h"
#include "plan/search.h"
#include "slider.h"
#include <math.h>
#include <string.h>

#define ROWS 1200u
#define STARTS 6u

static uint64_t block[60000];
static rlvc_reach reach[2];
static rlvc_experience ring;
static rlvc_dynamics model[RLVC_ROLLOUT_MODELS];
static rlvc_dynamics_fit_cursor fit;
static rlvc_row_sample sample;
static rlvc_search_cursor search;
static float start[STARTS * 2u];
static uint8_t known[RLVC_CELLS_BYTES], fresh[RLVC_CELLS_BYTES];

static void carve(rlvc_arena *arena) {
    rlvc_experience_carve(&ring, arena, 2, ROWS);
    for (uint32_t k = 0; k < RLVC_ROLLOUT_MODELS; k++)
        rlvc_dynamics_carve(model + k, arena, 2, 3, 8);
    rlvc_dynamics_fit_carve(&fit, arena, 2, 3, 8);
    sample.room = ROWS;
    sample.row = rlvc_arena_carve(arena, ROWS, sizeof *sample.row);
    search.rollout.s = rlvc_arena_carve(arena, 2, sizeof(float));
    for (uint32_t k = 0; k < 2; k++)
        rlvc_reach_carve(reach + k, arena, STARTS, RLVC_SMALL_LEAVES_MAX, 2);
}

/* A model of the slider. */
static int make_model(void **state) {
    rlvc_arena arena = {NULL, 0};
    rlvc_rng rng;
    slider world;
    carve(&arena);
    assert_true(arena.used <= sizeof block);
    block_fill(block, 0, sizeof block);
    arena.base = (unsigned char *)block;
    arena.used = 0;
    carve(&arena);
    rlvc_rng_seed(&rng, 2);
    for (uint32_t i = 0; i < 1000; i++) {
        float reward;
        if (i == 0 || ring.end[ring.head == 0 ? 0 : ring.head - 1u] != RLVC_GOES_ON) {
            slider_reset(&world, &rng);
            rlvc_experience_begin(&ring, world.s);
        }
        uint32_t action = rlvc_rng_below(&rng, 3);
        uint8_t end = slider_step(&world, action, &reward);
        rlvc_experience_append(&ring, (uint8_t)action, reward, world.s, end);
    }
    for (uint32_t k = 0; k < RLVC_ROLLOUT_MODELS; k++) {
        rlvc_dynamics_fit_begin(&fit, model + k, &ring, &sample, 1 + k);
        while (!fit.done)
            (void)rlvc_dynamics_fit_step(&fit, UINT32_MAX);
    }
    for (uint32_t i = 0; i < STARTS; i++) {
        slider_reset(&world, &rng);
        memcpy(start + 2u * i, world.s, sizeof world.s);
    }
    (void)state;
    return 0;
}

static rlvc_rollout_input rolled(uint32_t horizon) {
    rlvc_rollout_input in;
    memset(&in, 0, sizeof in);
    in.model = model;
    in.horizon = horizon;
    in.seed = 4;
    return in;
}

static void roll(rlvc_rollout *rollout, const rlvc_rollout_input *in, const rlvc_small_tree *policy,
                 const float *from, uint32_t *visits) {
    rollout->s = search.rollout.s;
    rlvc_rollout_begin(rollout, in, from, 2);
    while (!rollout->done)
        rlvc_rollout_step(rollout, in, policy, visits);
}

/* Pushes against the speed and the place: it stays in the middle. */
static void damped(rlvc_small_tree *tree) {
    const rlvc_small_node node[] = {{0.0f, 1, 1, 0},
                                    {-0.3f, 0, 3, 0},
                                    {0.3f, 0, 5, 0},
                                    {0.0f, RLVC_SMALL_LEAF, 0, 2},
                                    {0.0f, RLVC_SMALL_LEAF, 0, 2},
                                    {0.0f, RLVC_SMALL_LEAF, 0, 0},
                                    {0.0f, RLVC_SMALL_LEAF, 0, 0}};
    assert_true(rlvc_small_tree_compact(node, 7, 4, tree));
}

/* ------------------------------------------------------------------ rollouts */

static void test_a_rollout_earns_what_the_world_gives(void **state) {
    (void)state;
    rlvc_small_tree policy;
    rlvc_rollout rollout;
    rlvc_rollout_input in = rolled(40);
    uint32_t visits[RLVC_SMALL_NODES_MAX] = {0};
    damped(&policy);
    in.plain = 1;
    roll(&rollout, &in, &policy, start, visits);
    slider world = {{start[0], start[1]}, 0};
    float earned = 0.0f, reward;
    for (uint32_t i = 0; i < 40; i++) {
        assert_int_equal(slider_step(&world, rlvc_small_tree_act(&policy, world.s), &reward), 0);
        earned += reward;
    }
    assert_int_equal(rollout.step, 40);
    assert_true(fabsf(rollout.total - earned) < 1.0f && rollout.alive > 0.9f);
    assert_int_equal(visits[1] + visits[2], 40);
    assert_int_equal(visits[0], 0); /* no leaf */
}

static void test_a_rollout_ends_where_episodes_do(void **state) {
    (void)state;
    rlvc_small_tree right;
    rlvc_rollout rollout;
    rlvc_rollout_input in = rolled(500);
    rlvc_small_tree_constant(&right, 2);
    roll(&rollout, &in, &right, start, NULL);
    assert_true(rollout.step < 60 && rollout.alive < 0.01f);
    in = rolled(0);
    roll(&rollout, &in, &right, start, NULL);
    assert_true(rollout.total == 0.0f && rollout.step == 0);
}

/* Two models, with random actions and without, take turns. */
static void test_kinds_of_rollouts(void **state) {
    (void)state;
    rlvc_rollout rollout;
    rollout.s = search.rollout.s;
    for (uint32_t k = 0; k < 8; k++) {
        rlvc_rollout_input in = rolled(40);
        rlvc_rollout_begin(&rollout, &in, start, k);
        assert_int_equal(rollout.plain, k % 2u);
        assert_int_equal(rollout.model, k / 2u % 2u);
        in.plain = 1;
        rlvc_rollout_begin(&rollout, &in, start, k);
        assert_int_equal(rollout.plain, 1);
    }
}

/* The luck of a step depends on seed, start and step. */
static void test_common_random_numbers(void **state) {
    (void)state;
    rlvc_small_tree policy;
    rlvc_rollout one, other;
    rlvc_rollout_input in = rolled(50);
    damped(&policy);
    roll(&one, &in, &policy, start, NULL);
    roll(&other, &in, &policy, start, NULL);
    assert_true(one.total == other.total);
    uint32_t others = 0; /* one action in fifty is random, and may do the same */
    for (in.seed = 5; in.seed < 25; in.seed++) {
        roll(&other, &in, &policy, start, NULL);
        others += one.total != other.total;
    }
    assert_true(others > 5);
}

/* ------------------------------------------------------------------ cells */

static void test_cells(void **state) {
    (void)state;
    uint8_t bits[RLVC_CELLS_BYTES] = {0};
    const float middle[2] = {0.0f, 0.0f}, far[2] = {1e9f, -1e9f};
    assert_int_equal(rlvc_cells_mark(model, middle, bits), 1);
    assert_int_equal(rlvc_cells_mark(model, middle, bits), 0);
    assert_int_equal(rlvc_cells_mark(model, far, bits), 1);
    assert_true(bits[(11u * 12u) / 8u - 0u] != 0 || bits[11u / 8u] != 0);
    assert_int_equal(rlvc_cells_pairs(1), 1);
    assert_int_equal(rlvc_cells_pairs(2), 1);
    assert_int_equal(rlvc_cells_pairs(4), 6);
    /* a component alone is paired with itself; without a range there is one cell */
    float low = -1.0f, high = 1.0f, same = 2.0f;
    rlvc_dynamics lone = model[0];
    memset(bits, 0, sizeof bits);
    lone.basis.components = 1;
    lone.low = &low;
    lone.high = &high;
    uint32_t cells = 0;
    for (float x = -1.5f; x < 1.5f; x += 0.01f)
        cells += rlvc_cells_mark(&lone, &x, bits);
    assert_int_equal(cells, 12);
    memset(bits, 0, sizeof bits);
    lone.low = lone.high = &same;
    cells = 0;
    for (float x = -1.5f; x < 1.5f; x += 0.01f)
        cells += rlvc_cells_mark(&lone, &x, bits);
    assert_int_equal(cells, 1);
}

/* ------------------------------------------------------------------ the search */

static rlvc_search_input searched(uint32_t candidates, uint32_t patience) {
    rlvc_search_input in;
    memset(&in, 0, sizeof in);
    in.rollout = rolled(60);
    in.moves.experience = &ring;
    in.moves.scale = model->basis.scale;
    in.moves.actions = 3;
    in.moves.leaves_max = 5;
    in.start = start;
    in.starts = STARTS;
    in.candidates = candidates;
    in.patience = patience;
    in.seed = 9;
    return in;
}

static void run(const rlvc_search_input *in, uint32_t budget) {
    rlvc_small_tree tree;
    rlvc_small_tree_constant(&tree, 2);
    rlvc_search_begin(&search, in, &tree);
    while (!search.done)
        (void)rlvc_search_step(&search, budget);
}

static float mean_of(const rlvc_small_tree *tree, const rlvc_search_input *in) {
    float sum = 0.0f;
    for (uint32_t i = 0; i < STARTS; i++) {
        rlvc_rollout rollout = search.rollout;
        rlvc_rollout_begin(&rollout, &in->rollout, start + 2u * i, i);
        while (!rollout.done)
            rlvc_rollout_step(&rollout, &in->rollout, tree, NULL);
        sum += rollout.total;
    }
    return sum / (float)STARTS;
}

static void test_a_search_finds_a_good_tree(void **state) {
    (void)state;
    rlvc_search_input in = searched(2000, 2000);
    rlvc_small_tree good;
    run(&in, UINT32_MAX);
    damped(&good);
    assert_int_equal(search.tried, 2000);
    assert_true(search.tree.leaves >= 2 && search.tree.leaves <= 5);
    assert_true(search.best > 50.0f && search.best > mean_of(&good, &in) - 3.0f);
    assert_true(search.best == mean_of(&search.tree, &in)); /* and earns what it is said to */
}

static void test_a_search_without_gain_ends(void **state) {
    (void)state;
    rlvc_search_input in = searched(100000, 50);
    run(&in, UINT32_MAX);
    assert_true(search.tried < 100000 && search.tried - search.gained == 50);
}

/* A few candidates with long rollouts are as much work as many with short ones. */
static void test_a_search_takes_so_many_steps(void **state) {
    (void)state;
    rlvc_search_input in = searched(1, 1);
    rlvc_small_tree good;
    damped(&good);
    in.rollout.horizon = 1000;
    rlvc_search_begin(&search, &in, &good);
    while (!search.done)
        (void)rlvc_search_step(&search, UINT32_MAX);
    assert_true(search.tried == 0 && search.steps >= 2500);
}

/* From now on each step earns the same in the models. */
static void earn_always(float reward) {
    for (uint32_t k = 0; k < RLVC_ROLLOUT_MODELS; k++) {
        model[k].tree[2].terms = 0;
        model[k].tree[2].mean = model[k].reward_low = model[k].reward_high = reward;
    }
}

/* Where each step earns the most there is, only leaves can be saved. */
static void test_a_saturated_search_ends_sooner(void **state) {
    (void)state;
    rlvc_search_input in = searched(100000, 80);
    earn_always(1.0f);
    run(&in, UINT32_MAX);
    assert_true(search.best > 59.94f && search.tried - search.gained == 20);
    earn_always(-1.0f);
    run(&in, UINT32_MAX);
    assert_true(search.tried - search.gained == 80);
    make_model(NULL);
}

/* Where all trees earn the same, whether that is a gain or a loss, each leaf has a price. */
static void test_leaves_that_earn_nothing_go(void **state) {
    (void)state;
    rlvc_small_tree tree;
    damped(&tree);
    for (int sign = -1; sign <= 1; sign += 2) {
        rlvc_search_input in = searched(400, 400);
        const float reward = (float)sign;
        earn_always(reward);
        for (uint32_t k = 0; k < RLVC_ROLLOUT_MODELS; k++) {
            model[k].ending.node[0].component = RLVC_ENDING_LEAF;
            model[k].ending.node[0].probability = 0.0f;
        }
        rlvc_search_begin(&search, &in, &tree);
        while (!search.done)
            (void)rlvc_search_step(&search, UINT32_MAX);
        assert_true(fabsf(search.best - 60.0f * reward) < 0.01f);
        assert_int_equal(search.tree.leaves, 1);
        make_model(NULL);
    }
}

static void test_slices_change_nothing(void **state) {
    (void)state;
    const uint32_t budgets[] = {UINT32_MAX, 1, 12345};
    rlvc_search_input in = searched(300, 300);
    rlvc_small_tree found;
    for (uint32_t i = 0; i < 3; i++) {
        run(&in, budgets[i]);
        if (i == 0)
            found = search.tree;
        assert_memory_equal(search.tree.node, found.node, found.nodes * sizeof *found.node);
    }
}

/* Where novelty is sought, the tree goes where nothing was before. */
static void test_a_search_for_what_is_new(void **state) {
    (void)state;
    rlvc_search_input in = searched(400, 400);
    in.rollout.fresh = fresh;
    in.rollout.plain = 1;
    in.known = known;
    in.cells_bytes = sizeof known;
    memset(known, 0, sizeof known);
    for (uint32_t i = 0; i < ring.count; i++)
        (void)rlvc_cells_mark(model, rlvc_experience_percept(&ring, rlvc_experience_row(&ring, i)),
                              known);
    run(&in, UINT32_MAX);
    float some = search.best;
    memset(known, 0, sizeof known);
    run(&in, UINT32_MAX);
    assert_true(search.best > 2.0f && search.best > some); /* cells of a rollout */
    memset(known, 0xff, sizeof known);
    run(&in, UINT32_MAX);
    assert_true(search.best == 0.0f);
}

/* ------------------------------------------------------------------ rollouts that repeat */

/* From now on the search remembers where rollouts passed, or does not. */
static void remember(int yes) {
    memset(search.reach, 0, sizeof search.reach);
    if (yes)
        memcpy(search.reach, reach, sizeof reach);
}

/* The cursor of a search that is done, without what remembering takes. */
static void run_and_keep(const rlvc_search_input *in, uint32_t budget, rlvc_search_cursor *kept,
                         uint32_t *spent, uint32_t calls) {
    rlvc_small_tree tree;
    damped(&tree);
    rlvc_search_begin(&search, in, &tree);
    for (uint32_t i = 0; i < calls; i++)
        spent[i] = rlvc_search_step(&search, budget);
    while (!search.done)
        (void)rlvc_search_step(&search, budget);
    memcpy(kept, &search, sizeof search);
}

/* Neither what is found nor the work of any call depends on it. */
static void test_remembering_changes_nothing(void **state) {
    (void)state;
    static rlvc_search_cursor plain, remembered;
    const uint32_t units = rlvc_rollout_units(model);
    const uint32_t budgets[] = {UINT32_MAX, 1, units, 60u * units, 60u * units + 1u, 12345, 100000};
    for (uint32_t i = 0; i < sizeof budgets / sizeof *budgets; i++) {
        uint32_t spent[2][200];
        rlvc_search_input in = searched(300, 300);
        remember(0);
        run_and_keep(&in, budgets[i], &plain, spent[0], 200);
        remember(1);
        run_and_keep(&in, budgets[i], &remembered, spent[1], 200);
        assert_memory_equal(spent[0], spent[1], sizeof spent[0]);
        assert_int_equal(remembered.tried, plain.tried);
        assert_int_equal(remembered.gained, plain.gained);
        assert_int_equal(remembered.steps, plain.steps);
        assert_true(remembered.best == plain.best);
        assert_memory_equal(remembered.reference, plain.reference, sizeof plain.reference);
        assert_memory_equal(remembered.tree.node, plain.tree.node,
                            plain.tree.nodes * sizeof *plain.tree.node);
        for (uint32_t k = 0; k < plain.tree.nodes; k++)
            assert_int_equal(remembered.visits[k] > 0, plain.visits[k] > 0);
    }
    remember(0);
}

/* Of the first candidate, from how many starts the search believes what it is told of the tree in
 * hand, which is one less than it earned. */
static uint32_t believed(rlvc_search_input *in, uint32_t budget) {
    rlvc_small_tree tree;
    uint32_t count = 0;
    damped(&tree);
    rlvc_search_begin(&search, in, &tree);
    while (search.first)
        (void)rlvc_search_step(&search, 1);
    for (uint32_t i = 0; i < STARTS; i++) {
        search.reference[i] -= 1.0f;
        search.earned[i] = NAN;
    }
    (void)rlvc_search_step(&search, 1); /* the move */
    while (!search.done)
        (void)rlvc_search_step(&search, budget);
    for (uint32_t i = 0; i < STARTS; i++) {
        rlvc_rollout rollout = search.rollout;
        rlvc_rollout_begin(&rollout, &in->rollout, start + 2u * i, i);
        while (!rollout.done)
            rlvc_rollout_step(&rollout, &in->rollout, &search.candidate, NULL);
        count += fabsf(search.earned[i] - (rollout.total - 1.0f)) < 1e-4f;
    }
    return count;
}

/* Only those are not made whose 60 steps fit into the budget. */
static void test_what_repeats_is_not_made_again(void **state) {
    (void)state;
    uint32_t units = rlvc_rollout_units(model), all = 0, fitting = 0;
    rlvc_search_input in = searched(1, 40);
    for (in.seed = 0; in.seed < 50; in.seed++) {
        remember(1);
        all += believed(&in, UINT32_MAX);
        fitting += believed(&in, 59u * units + 1u);
        assert_int_equal(believed(&in, 59u * units), 0);
        remember(0);
        assert_int_equal(believed(&in, UINT32_MAX), 0);
    }
    assert_true(all > 50 && fitting > 50 && fitting <= all);
}

/* Novelty depends on the cells that all rollouts before have marked. */
static void test_what_is_new_is_looked_for_again(void **state) {
    (void)state;
    static rlvc_search_cursor plain;
    rlvc_search_input in = searched(200, 200);
    in.rollout.fresh = fresh;
    in.known = known;
    in.cells_bytes = sizeof known;
    memset(known, 0, sizeof known);
    remember(0);
    run(&in, UINT32_MAX);
    plain = search;
    remember(1);
    run(&in, UINT32_MAX);
    assert_true(search.best == plain.best && search.steps == plain.steps);
    assert_memory_equal(search.earned, plain.earned, sizeof plain.earned);
    remember(0);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_a_rollout_earns_what_the_world_gives),
        cmocka_unit_test(test_a_rollout_ends_where_episodes_do),
        cmocka_unit_test(test_kinds_of_rollouts),
        cmocka_unit_test(test_common_random_numbers),
        cmocka_unit_test(test_cells),
        cmocka_unit_test(test_a_search_finds_a_good_tree),
        cmocka_unit_test(test_a_search_without_gain_ends),
        cmocka_unit_test(test_a_saturated_search_ends_sooner),
        cmocka_unit_test(test_leaves_that_earn_nothing_go),
        cmocka_unit_test(test_a_search_takes_so_many_steps),
        cmocka_unit_test(test_slices_change_nothing),
        cmocka_unit_test(test_a_search_for_what_is_new),
        cmocka_unit_test(test_remembering_changes_nothing),
        cmocka_unit_test(test_what_repeats_is_not_made_again),
        cmocka_unit_test(test_what_is_new_is_looked_for_again),
    };
    return cmocka_run_group_tests(tests, make_model, NULL);
}
