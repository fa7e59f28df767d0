/* SPDX-License-Identifier: MIT */
/* The model of the world: the sample it is fitted to, model trees, endings, and all of them
 * together on worlds whose laws are known. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "block.h"
#include "dynamics/dynamics.h"
#include "slider.h"
#include <math.h>
#include <string.h>

#define ROWS 3000u
#define LEAVES 8u

static uint64_t block[200000];
static rlvc_experience ring;
static rlvc_dynamics model;
static rlvc_dynamics_fit_cursor fit;
static rlvc_row_sample sample;

static void carve_all(rlvc_arena *arena, uint32_t components, uint32_t actions, uint32_t room) {
    rlvc_experience_carve(&ring, arena, components, ROWS);
    rlvc_dynamics_carve(&model, arena, components, actions, LEAVES);
    rlvc_dynamics_fit_carve(&fit, arena, components, actions, LEAVES);
    sample.room = room;
    sample.row = rlvc_arena_carve(arena, room, sizeof *sample.row);
}

/* In memory that held so many bytes of one kind. */
static void make_in(int byte, uint32_t components, uint32_t actions, uint32_t room) {
    rlvc_arena arena = {NULL, 0};
    memset(&sample, 0, sizeof sample);
    carve_all(&arena, components, actions, room);
    assert_true(arena.used <= sizeof block);
    block_fill(block, byte, sizeof block);
    arena.base = (unsigned char *)block;
    arena.used = 0;
    carve_all(&arena, components, actions, room);
    memset(&model.ending, byte, sizeof model.ending);
}

static void make(uint32_t components, uint32_t actions, uint32_t room) {
    make_in(0, components, actions, room);
}

static uint64_t fit_model(uint32_t seed, uint32_t budget) {
    uint64_t work = 0;
    rlvc_dynamics_fit_begin(&fit, &model, &ring, &sample, seed);
    assert_true(ring.frozen);
    while (!fit.done)
        work += rlvc_dynamics_fit_step(&fit, budget);
    assert_false(ring.frozen);
    return work;
}

/* ------------------------------------------------------------------ the sample */

/* Rows 0, 1, ... of one component, each of which but every `ending`-th goes on. */
static void count_up(uint32_t rows, uint32_t ending) {
    for (uint32_t i = 0; i < rows; i++) {
        float s = (float)i;
        if (i == 0 || i % ending == 0)
            rlvc_experience_begin(&ring, &s);
        s += 0.5f;
        rlvc_experience_append(&ring, 0, s, &s,
                               i % ending == ending - 1u ? RLVC_TERMINATED : RLVC_GOES_ON);
    }
}

static void draw_sample(uint32_t seed, uint32_t budget) {
    rlvc_sampling_cursor sampling;
    uint32_t first, rows = rlvc_experience_freeze(&ring, &first);
    rlvc_sampling_begin(&sampling, first, rows, seed);
    while (!sampling.done)
        assert_true(rlvc_sampling_step(&sampling, &ring, &sample, budget) <= budget);
    ring.frozen = 0;
}

static void check_sample(uint32_t going, uint32_t ended) {
    uint8_t seen[ROWS] = {0};
    assert_int_equal(sample.going, going);
    assert_int_equal(sample.count, going + ended);
    for (uint32_t i = 0; i < sample.count; i++) {
        uint32_t row = sample.row[i];
        assert_int_equal(seen[row]++, 0);
        assert_int_equal(ring.end[row], i < going ? RLVC_GOES_ON : RLVC_TERMINATED);
    }
}

static void test_a_small_sample_is_seven_in_ten(void **state) {
    (void)state;
    make(1, 2, 500);
    count_up(200, 10);
    draw_sample(1, UINT32_MAX);
    check_sample(126, 14);
    assert_true(fabsf(sample.weight_going * 126.0f - 180.0f) < 0.01f);
    assert_true(fabsf(sample.weight_ended * 14.0f - 20.0f) < 0.01f);
    for (uint32_t rows = 1; rows < 40; rows++) {
        make(1, 2, 500);
        count_up(rows, 1000);
        draw_sample(1, UINT32_MAX);
        check_sample((7u * rows + 9u) / 10u, 0);
    }
}

static void test_a_bounded_sample_is_stratified(void **state) {
    (void)state;
    make(1, 2, 100);
    count_up(1000, 2);
    draw_sample(1, UINT32_MAX);
    check_sample(75, 25); /* a quarter of the room at most, as both are many */
    assert_true(fabsf(sample.weight_going * 75.0f - 500.0f) < 0.01f);
    assert_true(fabsf(sample.weight_ended * 25.0f - 500.0f) < 0.01f);
    make(1, 2, 100);
    count_up(1000, 200);
    draw_sample(1, UINT32_MAX);
    check_sample(96, 4); /* seven in ten of few endings */
    make(1, 2, 100);
    count_up(200, 1);
    draw_sample(1, UINT32_MAX);
    check_sample(0, 100);
    assert_true(sample.weight_going == 1.0f && sample.weight_ended == 2.0f);
}

static void test_a_sample_depends_on_the_seed_alone(void **state) {
    (void)state;
    uint32_t drawn[3][100];
    for (uint32_t i = 0; i < 3; i++) {
        make(1, 2, 100);
        count_up(1000, 10);
        draw_sample(i == 2 ? 5 : 4, i == 1 ? 7 : UINT32_MAX);
        memcpy(drawn[i], sample.row, sizeof drawn[i]);
    }
    assert_memory_equal(drawn[0], drawn[1], sizeof drawn[0]);
    assert_memory_not_equal(drawn[0], drawn[2], sizeof drawn[0]);
}

/* ------------------------------------------------------------------ model trees */

/* Two components and three actions drawn at random; what follows is `law`. */
static void draw_world(uint32_t rows, uint32_t seed, uint32_t levels,
                       void (*law)(const float *s, uint32_t a, float *next, float *reward)) {
    rlvc_rng rng;
    rlvc_rng_seed(&rng, seed);
    for (uint32_t i = 0; i < rows; i++) {
        float s[2], next[2], reward;
        for (uint32_t k = 0; k < 2; k++)
            s[k] =
                levels ? (float)rlvc_rng_below(&rng, levels) : 2.0f * rlvc_rng_uniform(&rng) - 1.0f;
        uint32_t a = rlvc_rng_below(&rng, 3);
        law(s, a, next, &reward);
        rlvc_experience_begin(&ring, s);
        rlvc_experience_append(&ring, (uint8_t)a, reward, next, RLVC_TRUNCATED);
    }
}

static void bent(const float *s, uint32_t a, float *next, float *reward) {
    next[0] = s[0] + (s[0] > 0.3f ? 0.5f - s[0] : 0.2f * s[0]); /* a test of a component */
    next[1] = s[1] + (a == 1u ? 0.4f * s[0] : -0.3f * s[1]);    /* a test of an action */
    *reward = 2.0f;
}

static void smooth(const float *s, uint32_t a, float *next, float *reward) {
    next[0] = s[0] + 0.1f * s[1];
    next[1] = s[1] + 0.2f * ((float)a - 1.0f) - 0.1f * s[0];
    *reward = s[0] * s[1] - s[0] * s[0];
}

static void waves(const float *s, uint32_t a, float *next, float *reward) {
    next[0] = s[0] + sinf(6.0f * s[0]) + (float)a;
    next[1] = s[1];
    *reward = sinf(9.0f * s[0]) + cosf(7.0f * s[1]);
}

static void stepped(const float *s, uint32_t a, float *next, float *reward) {
    next[0] = s[0] + (s[0] > 0.5f ? 1.0f : s[1] > 0.5f ? -1.0f : 0.25f);
    next[1] = s[1] + (float)a;
    *reward = s[1] > 0.5f ? 3.0f : 0.0f;
}

/* The greatest error of what the model says, on a grid. */
static float worst_error(void (*law)(const float *s, uint32_t a, float *next, float *reward),
                         float margin) {
    float worst = 0.0f;
    for (int32_t i = -9; i <= 9; i++) {
        for (int32_t j = -9; j <= 9; j++) {
            for (uint32_t a = 0; a < 3; a++) {
                float s[2] = {0.1f * (float)i, 0.1f * (float)j}, next[2], reward;
                rlvc_outcome outcome;
                if (fabsf(s[0] - 0.3f) < margin)
                    continue;
                law(s, a, next, &reward);
                rlvc_dynamics_step(&model, s, a, NULL, &outcome);
                worst = fmaxf(worst, fabsf(s[0] - next[0]));
                worst = fmaxf(worst, fabsf(s[1] - next[1]));
                worst = fmaxf(worst, fabsf(outcome.reward - reward));
                assert_true(outcome.end == 0.0f);
            }
        }
    }
    return worst;
}

static void test_smooth_laws_need_no_split(void **state) {
    (void)state;
    make(2, 3, 1000);
    draw_world(800, 1, 0, smooth);
    fit_model(1, UINT32_MAX);
    for (uint32_t k = 0; k <= 2; k++)
        assert_int_equal(model.tree[k].leaves, 1);
    assert_int_equal(model.tree[0].terms, 5); /* the short basis is enough */
    assert_int_equal(model.tree[2].terms, 8); /* the reward has products */
    assert_true(worst_error(smooth, 0.0f) < 0.01f);
    assert_true(model.tree[0].leaf[0].noise < 0.005f);
    rlvc_rng rng = {3}, same = rng;
    float s[2] = {0.2f, 0.4f}, plain[2] = {0.2f, 0.4f};
    rlvc_outcome outcome;
    rlvc_dynamics_step(&model, s, 1, &rng, &outcome); /* so little noise is not drawn */
    rlvc_dynamics_step(&model, plain, 1, NULL, &outcome);
    assert_memory_equal(s, plain, sizeof s);
    assert_true(rng.state == same.state);
}

static void test_bent_laws_are_split_where_they_bend(void **state) {
    (void)state;
    make(2, 3, 2000);
    draw_world(1400, 2, 0, bent);
    fit_model(1, UINT32_MAX);
    assert_true(model.tree[0].leaves >= 2 && model.tree[1].leaves == 2);
    assert_int_equal(model.tree[0].node[0].test, 0);
    assert_int_equal(model.tree[1].node[0].test, 2 + 1); /* action 1 */
    assert_int_equal(model.tree[2].terms, 0);            /* the reward is constant: */
    const rlvc_model_leaf nothing = {0.0f, 0.0f, 0.0f};  /* it differs by nothing */
    assert_memory_equal(model.tree[2].leaf, &nothing, sizeof nothing);
    assert_true(worst_error(bent, 0.15f) < 0.08f);
}

/* Splits are judged by one row in some where there are many; and leaves end. */
static void test_many_rows_and_many_leaves(void **state) {
    (void)state;
    make(2, 3, 2900);
    draw_world(1490, 3, 0, waves);
    fit_model(1, UINT32_MAX);
    assert_int_equal(model.tree[2].leaves, LEAVES);
    assert_int_equal(model.tree[1].terms, 0);
}

/* Components of few values have few cuts, and none beyond their values. */
static void test_few_values(void **state) {
    (void)state;
    for (uint32_t levels = 1; levels <= 3; levels++) {
        make(2, 3, 1000);
        draw_world(900, 4, levels, stepped);
        fit_model(1, UINT32_MAX);
        for (uint32_t i = 0; i < levels; i++) {
            for (uint32_t j = 0; j < levels; j++) {
                float s[2] = {(float)i, (float)j}, next[2], reward;
                rlvc_outcome outcome;
                stepped(s, 1, next, &reward);
                rlvc_dynamics_step(&model, s, 1, NULL, &outcome);
                assert_true(fabsf(s[0] - next[0]) < 0.1f && fabsf(s[1] - next[1]) < 0.1f);
                assert_true(fabsf(outcome.reward - reward) < 0.1f);
            }
        }
    }
}

static void test_slices_change_nothing(void **state) {
    (void)state;
    static rlvc_model_node nodes[3][2 * LEAVES - 1];
    static float coefficients[3][LEAVES * 8u];
    const uint32_t budgets[] = {UINT32_MAX, 1, 777};
    uint64_t work[3];
    for (uint32_t i = 0; i < 3; i++) {
        make(2, 3, 700);
        draw_world(1000, 5, 0, waves);
        work[i] = fit_model(9, budgets[i]);
        memcpy(nodes[i], model.tree[2].node, sizeof nodes[i]);
        memcpy(coefficients[i], model.tree[2].coefficient, sizeof coefficients[i]);
        assert_memory_equal(nodes[i], nodes[0], sizeof nodes[0]);
        assert_memory_equal(coefficients[i], coefficients[0], sizeof coefficients[0]);
        assert_true(work[i] == work[0]);
    }
}

/* Nor does what the memory held before: also the places of a model that mean nothing are saved. */
static void test_memory_changes_nothing(void **state) {
    (void)state;
    static rlvc_dynamics first;
    static uint64_t other[sizeof block / sizeof *block];
    make(2, 3, 700);
    draw_world(1000, 5, 0, bent); /* its reward is constant */
    fit_model(9, UINT32_MAX);
    first = model;
    block_copy(other, block, sizeof block);
    make_in(0xa5, 2, 3, 700);
    draw_world(1000, 5, 0, bent);
    fit_model(9, UINT32_MAX);
    for (uint32_t k = 0; k <= 2; k++) {
        const rlvc_model_tree *tree = &model.tree[k];
        const ptrdiff_t node = (unsigned char *)tree->node - (unsigned char *)block;
        const ptrdiff_t leaf = (unsigned char *)tree->leaf - (unsigned char *)block;
        assert_true(block_equal(tree->node, (unsigned char *)other + node,
                                (2u * tree->leaves - 1u) * sizeof *tree->node));
        assert_true(block_equal(tree->leaf, (unsigned char *)other + leaf,
                                tree->leaves * sizeof *tree->leaf));
    }
    assert_memory_equal(&model.ending.node[0], &first.ending.node[0], sizeof model.ending.node[0]);
}

/* A leaf's range is that of its rows, whichever row is the least: a reward's as it is, that of a
 * component widened by half. In units of the target's deviation, about its mean. */
static void test_ranges_of_leaves(void **state) {
    (void)state;
    for (uint32_t seed = 1; seed <= 30; seed++) {
        make(2, 3, 100);
        draw_world(20, seed, 0, smooth);
        fit_model(seed, UINT32_MAX);
        for (uint32_t k = 0; k <= 2; k++) {
            const rlvc_model_tree *tree = &model.tree[k];
            const float slack = k < 2 ? 0.5f : 0.0f;
            float least = INFINITY, most = -INFINITY;
            for (uint32_t i = 0; i < sample.going; i++) {
                const float y = rlvc_fit_target(&ring, k, sample.row[i]);
                least = fminf(least, y);
                most = fmaxf(most, y);
            }
            assert_int_equal(tree->leaves, 1);
            assert_true(fabsf(tree->mean + tree->scale * tree->leaf[0].low -
                              (least - slack * (most - least))) < 1e-4f);
            assert_true(fabsf(tree->mean + tree->scale * tree->leaf[0].high -
                              (most + slack * (most - least))) < 1e-4f);
        }
    }
}

/* The deviation of a component is that of the rows fitted to, however far from 0 these are. */
static void test_deviations_are_about_the_mean(void **state) {
    (void)state;
    const float middle[] = {0.0f, 30.0f, -1000.0f};
    for (uint32_t k = 0; k < 3; k++) {
        rlvc_rng rng;
        double sum = 0.0, squares = 0.0;
        rlvc_rng_seed(&rng, 6);
        make(1, 3, 500);
        for (uint32_t i = 0; i < 600; i++) {
            float s = middle[k] + 0.1f * rlvc_rng_uniform(&rng);
            rlvc_experience_begin(&ring, &s);
            rlvc_experience_append(&ring, 0, 0.0f, &s, RLVC_TRUNCATED);
        }
        fit_model(1, UINT32_MAX);
        for (uint32_t i = 0; i < sample.count; i++)
            sum += (double)*rlvc_experience_percept(&ring, sample.row[i]);
        for (uint32_t i = 0; i < sample.count; i++) {
            double s = (double)*rlvc_experience_percept(&ring, sample.row[i]);
            squares += pow(s - sum / sample.count, 2.0);
        }
        double deviation = sqrt(squares / sample.count);
        assert_true(fabs((double)model.basis.scale[0] - deviation) < 0.01 * deviation);
    }
}

/* With more terms than there is room for, there are no products; with two actions one test. */
static void test_long_bases(void **state) {
    (void)state;
    assert_int_equal(rlvc_basis_full(9, 4), 9 + 4 + 45);
    assert_int_equal(rlvc_basis_full(10, 4), 14);
    make(10, 2, 400);
    rlvc_rng rng;
    rlvc_rng_seed(&rng, 3);
    float s[10] = {0};
    for (uint32_t i = 0; i < 300; i++) {
        if (i % 100 == 0)
            rlvc_experience_begin(&ring, s);
        uint32_t a = rlvc_rng_below(&rng, 2);
        for (uint32_t k = 0; k < 10; k++)
            s[k] = a ? -0.5f * s[k] + 0.1f : 0.9f * s[k] - 0.1f + 0.2f * rlvc_rng_uniform(&rng);
        rlvc_experience_append(&ring, (uint8_t)a, s[0], s, i % 100 == 99 ? RLVC_TRUNCATED : 0);
    }
    fit_model(1, UINT32_MAX);
    assert_int_equal(model.tree[3].terms, 12);
    assert_int_equal(model.tree[3].node[0].test, 10);
    rlvc_outcome outcome;
    float before = s[0];
    rlvc_dynamics_step(&model, s, 1, NULL, &outcome);
    assert_true(fabsf(s[0] - (0.1f - 0.5f * before)) < 0.02f);
}

/* ------------------------------------------------------------------ endings */

/* A walk of `rows` steps over [0, 1] x [0, 1], each of which ends as the law says. */
static void walk_to_endings(uint32_t rows, uint32_t seed, int (*ends)(const float *s)) {
    rlvc_rng rng;
    rlvc_rng_seed(&rng, seed);
    for (uint32_t i = 0; i < rows; i++) {
        float s[2] = {rlvc_rng_uniform(&rng), rlvc_rng_uniform(&rng)};
        float next[2] = {rlvc_rng_uniform(&rng), rlvc_rng_uniform(&rng)};
        int end = ends(next);
        rlvc_experience_begin(&ring, s);
        rlvc_experience_append(&ring, 0, end ? -5.0f : 1.0f, next,
                               end ? RLVC_TERMINATED : RLVC_GOES_ON);
    }
}

static int beyond(const float *s) {
    return s[0] > 0.8f || s[1] < 0.1f;
}

static int never(const float *s) {
    return s[0] > 2.0f;
}

static int always(const float *s) {
    return s[0] < 2.0f;
}

static int chequered(const float *s) {
    return ((uint32_t)(s[0] * 8.0f) + (uint32_t)(s[1] * 8.0f)) % 2u == 0;
}

static void test_endings_are_found(void **state) {
    (void)state;
    make(2, 3, 1000);
    walk_to_endings(2000, 1, beyond);
    fit_model(1, UINT32_MAX);
    uint32_t wrong = 0;
    for (uint32_t i = 0; i <= 40; i++) {
        for (uint32_t j = 0; j <= 40; j++) {
            float s[2] = {0.025f * (float)i, 0.025f * (float)j};
            const rlvc_ending_node *leaf = rlvc_ending_at(&model.ending, s);
            wrong += (leaf->probability > 0.5f) != beyond(s);
            if (leaf->probability > 0.0f)
                assert_true(fabsf(leaf->reward + 5.0f) < 0.01f);
        }
    }
    assert_true(wrong < 40);
    assert_true(model.reward_low == 1.0f); /* those that ended are apart */
}

static void test_no_ending_and_nothing_else(void **state) {
    (void)state;
    make(2, 3, 500);
    walk_to_endings(300, 1, never);
    fit_model(1, UINT32_MAX);
    assert_true(model.ending.node[0].component == RLVC_ENDING_LEAF);
    assert_true(model.ending.node[0].probability == 0.0f);
    make(2, 3, 500);
    walk_to_endings(300, 1, always);
    fit_model(1, UINT32_MAX);
    assert_true(model.ending.node[0].probability == 1.0f);
    assert_true(model.tree[2].terms == 0 && model.tree[2].mean == 0.0f); /* no reward to fit to */
}

static void test_endings_have_sixteen_leaves_at_most(void **state) {
    (void)state;
    make(2, 3, 1400);
    walk_to_endings(1400, 2, chequered);
    fit_model(1, UINT32_MAX);
    uint32_t leaves = 0;
    for (uint32_t k = 0; k < fit.ending.nodes; k++)
        leaves += model.ending.node[k].component == RLVC_ENDING_LEAF;
    assert_int_equal(leaves, RLVC_ENDING_LEAVES);
}

/* Episodes of one step, each of which terminates with the law's reward of s'. */
static void end_at_once(uint32_t rows, uint32_t seed, float (*reward)(const float *, rlvc_rng *)) {
    rlvc_rng rng;
    rlvc_rng_seed(&rng, seed);
    for (uint32_t i = 0; i < rows; i++) {
        float next[2] = {rlvc_rng_uniform(&rng), rlvc_rng_uniform(&rng)};
        rlvc_experience_begin(&ring, next);
        rlvc_experience_append(&ring, 0, reward(next, &rng), next, RLVC_TERMINATED);
    }
}

static float by_band(const float *s, rlvc_rng *rng) {
    (void)rng;
    return s[1] < 0.3f ? -100.0f : s[1] < 0.6f ? 100.0f : -10.0f;
}

static float by_coin(const float *s, rlvc_rng *rng) {
    (void)s;
    return rlvc_rng_uniform(rng) < 0.5f ? -1.0f : 1.0f;
}

static float by_rare_coin(const float *s, rlvc_rng *rng) {
    (void)s;
    return rlvc_rng_uniform(rng) < 0.05f ? 1.0f : 0.0f;
}

static float by_sum(const float *s, rlvc_rng *rng) {
    (void)s;
    float sum = -6.0f;
    for (int i = 0; i < 12; i++)
        sum += rlvc_rng_uniform(rng);
    return 1000.0f + sum;
}

/* What is won and lost at the same kind of end is told apart by where it is. */
static void test_rewards_of_endings_are_found(void **state) {
    (void)state;
    make(2, 3, 400);
    end_at_once(400, 3, by_band);
    fit_model(1, UINT32_MAX);
    for (uint32_t j = 0; j <= 40; j++) {
        float s[2] = {0.5f, 0.025f * (float)j};
        if (fabsf(s[1] - 0.3f) < 0.02f || fabsf(s[1] - 0.6f) < 0.02f)
            continue;
        const rlvc_ending_node *leaf = rlvc_ending_at(&model.ending, s);
        assert_true(leaf->probability == 1.0f);
        assert_true(fabsf(leaf->reward - by_band(s, NULL)) < 0.01f);
    }
    assert_int_equal(fit.ending.leaves, 3); /* and no more */
}

/* Rewards that are drawn seldom make a tree larger. Few rows do, and rare rewards: two wins of five
 * next to each other are far from the mean of a hundred. */
static void test_endings_with_random_rewards(void **state) {
    float (*const law[])(const float *, rlvc_rng *) = {by_coin, by_sum, by_rare_coin};
    const uint32_t rows[] = {20, 100, 400}, most[][3] = {{10, 5, 5}, {20, 5, 5}, {15, 30, 15}};
    (void)state;
    for (uint32_t k = 0; k < 3; k++) {
        for (uint32_t n = 0; n < 3; n++) {
            uint32_t grown = 0;
            for (uint32_t seed = 1; seed <= 100; seed++) {
                make(2, 3, 400);
                end_at_once(rows[n], seed, law[k]);
                fit_model(seed, UINT32_MAX);
                grown += fit.ending.leaves > 1;
            }
            if (grown > most[k][n])
                fail_msg("law %u: %u of 100 trees of %u rows grew", k, grown, rows[n]);
        }
    }
}

/* Two values next to each other: the cut between them is one of them. */
static void test_endings_apart_by_a_bit(void **state) {
    (void)state;
    for (uint32_t k = 0; k < 2; k++) {
        float value[2] = {k ? 1.0f : 1.0000001f, k ? 1.0000001f : 1.0000002f};
        make(1, 3, 100);
        for (uint32_t i = 0; i < 60; i++) {
            rlvc_experience_begin(&ring, value);
            rlvc_experience_append(&ring, 0, 0.0f, &value[i % 2u],
                                   i % 2u ? RLVC_TERMINATED : RLVC_GOES_ON);
        }
        fit_model(1, UINT32_MAX);
        /* half-way between them rounds to the even one: at first to the greater, which splits
         * nothing */
        float found = rlvc_ending_at(&model.ending, value)->probability;
        assert_true(found == (k ? 0.0f : 0.5f));
    }
}

/* A component that is always the same has no cut. */
static void test_endings_of_a_constant(void **state) {
    (void)state;
    make(2, 3, 200);
    for (uint32_t i = 0; i < 150; i++) {
        float s[2] = {7.0f, (float)(i % 10u)};
        rlvc_experience_begin(&ring, s);
        rlvc_experience_append(&ring, 0, 0.0f, s, i % 10u > 6u ? RLVC_TERMINATED : RLVC_GOES_ON);
    }
    fit_model(1, UINT32_MAX);
    assert_int_equal(model.ending.node[0].component, 1);
    assert_true(model.ending.node[0].cut > 6.0f && model.ending.node[0].cut < 7.0f);
}

/* Three rows: a model all the same, which says what is nearly their mean. */
static void test_few_rows(void **state) {
    (void)state;
    make(2, 3, 100);
    draw_world(3, 8, 0, smooth);
    fit_model(1, UINT32_MAX);
    float s[2] = {0.0f, 0.0f};
    rlvc_outcome outcome;
    rlvc_dynamics_step(&model, s, 0, NULL, &outcome);
    assert_true(fabsf(s[0]) < 3.0f && fabsf(s[1]) < 3.0f && outcome.end == 0.0f);
}

/* ------------------------------------------------------------------ all together */

static void play_slider(uint32_t rows) {
    rlvc_rng rng;
    slider world;
    rlvc_rng_seed(&rng, 11);
    slider_reset(&world, &rng);
    rlvc_experience_begin(&ring, world.s);
    for (uint32_t i = 0; i < rows; i++) {
        uint32_t action = rlvc_rng_below(&rng, SLIDER_ACTIONS);
        float reward;
        uint8_t end = slider_step(&world, action, &reward);
        rlvc_experience_append(&ring, (uint8_t)action, reward, world.s, end);
        if (end != RLVC_GOES_ON) {
            slider_reset(&world, &rng);
            rlvc_experience_begin(&ring, world.s);
        }
    }
}

static void test_the_slider_is_learnt(void **state) {
    (void)state;
    make(2, 3, 1000);
    play_slider(1000);
    fit_model(3, UINT32_MAX);
    float s[2] = {0.2f, -0.3f};
    slider world = {{0.2f, -0.3f}, 0};
    rlvc_outcome outcome;
    for (uint32_t i = 0; i < 20; i++) {
        float reward;
        assert_int_equal(slider_step(&world, i % 2u * 2u, &reward), RLVC_GOES_ON);
        rlvc_dynamics_step(&model, s, i % 2u * 2u, NULL, &outcome);
        assert_true(fabsf(s[0] - world.s[0]) < 0.02f && fabsf(s[1] - world.s[1]) < 0.02f);
        assert_true(fabsf(outcome.reward - reward) < 0.02f && outcome.end < 0.05f);
    }
    float out[2] = {0.99f, 1.0f}, far[2] = {1e6f, -1e6f};
    rlvc_dynamics_step(&model, out, 2, NULL, &outcome);
    assert_true(outcome.end > 0.9f);
    rlvc_dynamics_step(&model, far, 0, NULL, &outcome);
    assert_true(far[0] <= model.high[0] && far[1] >= model.low[1]); /* held within what was seen */
    assert_true(outcome.reward >= model.reward_low && outcome.reward <= model.reward_high);
}

/* What is not explained comes back as noise of the same deviation. */
static void test_noise_is_drawn(void **state) {
    (void)state;
    rlvc_rng rng;
    rlvc_rng_seed(&rng, 5);
    make(1, 2, 1000);
    for (uint32_t i = 0; i < 1000; i++) {
        float s = rlvc_rng_uniform(&rng), next = 0.5f + 0.2f * rlvc_rng_uniform(&rng);
        rlvc_experience_begin(&ring, &s);
        rlvc_experience_append(&ring, 0, 0.0f, &next, RLVC_TRUNCATED);
    }
    fit_model(1, UINT32_MAX);
    double sum = 0.0, squares = 0.0;
    for (uint32_t i = 0; i < 4000; i++) {
        float s = 0.5f;
        rlvc_outcome outcome;
        rlvc_dynamics_step(&model, &s, 0, &rng, &outcome);
        sum += (double)s;
        squares += (double)s * (double)s;
    }
    double mean = sum / 4000.0, deviation = sqrt(squares / 4000.0 - mean * mean);
    assert_true(fabs(mean - 0.6) < 0.01);
    assert_true(fabs(deviation - 0.2 / sqrt(12.0)) < 0.005);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_a_small_sample_is_seven_in_ten),
        cmocka_unit_test(test_a_bounded_sample_is_stratified),
        cmocka_unit_test(test_a_sample_depends_on_the_seed_alone),
        cmocka_unit_test(test_smooth_laws_need_no_split),
        cmocka_unit_test(test_bent_laws_are_split_where_they_bend),
        cmocka_unit_test(test_many_rows_and_many_leaves),
        cmocka_unit_test(test_few_values),
        cmocka_unit_test(test_slices_change_nothing),
        cmocka_unit_test(test_memory_changes_nothing),
        cmocka_unit_test(test_ranges_of_leaves),
        cmocka_unit_test(test_deviations_are_about_the_mean),
        cmocka_unit_test(test_long_bases),
        cmocka_unit_test(test_endings_are_found),
        cmocka_unit_test(test_no_ending_and_nothing_else),
        cmocka_unit_test(test_endings_have_sixteen_leaves_at_most),
        cmocka_unit_test(test_rewards_of_endings_are_found),
        cmocka_unit_test(test_endings_with_random_rewards),
        cmocka_unit_test(test_endings_apart_by_a_bit),
        cmocka_unit_test(test_endings_of_a_constant),
        cmocka_unit_test(test_few_rows),
        cmocka_unit_test(test_the_slider_is_learnt),
        cmocka_unit_test(test_noise_is_drawn),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
