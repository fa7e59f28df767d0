/* SPDX-License-Identifier: MIT */
/* The learnt model of the world: see dynamics.h.
 *
 * Phases of a fit: the sample (SAMPLE), its means and deviations (MEAN, DEVIATION); then for each
 * output, the reward first as its rows are [0, going), the target's (TARGET_MEAN, TARGET_DEVIATION)
 * and the trees (SHORT, FULL); then the endings (ENDING). */
#include "rlvc/float_rules.h"

#include "dynamics.h"

#include "../base/float_math.h"
#include <string.h>

enum { SAMPLE, MEAN, DEVIATION, TARGET_MEAN, TARGET_DEVIATION, SHORT, FULL, ENDING, DONE };

#define RIDGE 1e-5f
#define LEAF_ROWS 15u
#define SLACK 0.5f
#define DEVIATION_LEAST 1e-6f
/* Noise below this share of a target's deviation is not drawn. */
#define NOISE_LEAST 0.01f

void rlvc_dynamics_carve(rlvc_dynamics *dynamics, rlvc_arena *arena, uint32_t components,
                         uint32_t actions, uint32_t leaves_max) {
    memset(dynamics, 0, sizeof *dynamics);
    uint32_t terms = rlvc_basis_full(components, actions);
    dynamics->terms_max = terms;
    dynamics->leaves_max = leaves_max;
    dynamics->basis.components = components;
    dynamics->basis.actions = actions;
    dynamics->basis.mean = rlvc_arena_carve(arena, components, sizeof(float));
    dynamics->basis.scale = rlvc_arena_carve(arena, components, sizeof(float));
    dynamics->low = rlvc_arena_carve(arena, components, sizeof(float));
    dynamics->high = rlvc_arena_carve(arena, components, sizeof(float));
    dynamics->x = rlvc_arena_carve(arena, rlvc_model_tree_stride(terms), sizeof(float));
    if (arena->base)
        memset(dynamics->x, 0, rlvc_model_tree_stride(terms) * sizeof(float));
    dynamics->tree = rlvc_arena_carve(arena, components + 1u, sizeof *dynamics->tree);
    for (uint32_t k = 0; k <= components; k++) {
        rlvc_model_tree tree;
        rlvc_model_tree_carve(&tree, arena, leaves_max, terms);
        if (arena->base)
            dynamics->tree[k] = tree;
    }
}

void rlvc_dynamics_fit_carve(rlvc_dynamics_fit_cursor *fit, rlvc_arena *arena, uint32_t components,
                             uint32_t actions, uint32_t leaves_max) {
    uint32_t terms = rlvc_basis_full(components, actions);
    memset(fit, 0, sizeof *fit);
    rlvc_model_tree_carve(&fit->spare, arena, leaves_max, terms);
    rlvc_tree_fit_carve(&fit->space, arena, leaves_max, terms);
    fit->window = rlvc_arena_carve(arena, components, sizeof *fit->window);
    fit->sum = rlvc_arena_carve(arena, components, sizeof(float));
}

static void enter(rlvc_dynamics_fit_cursor *fit, uint8_t phase) {
    fit->phase = phase;
    fit->at = 0;
    fit->moment = 0.0f;
    fit->done = phase == DONE;
    if (fit->done)
        fit->experience->frozen = 0;
}

void rlvc_dynamics_fit_begin(rlvc_dynamics_fit_cursor *fit, rlvc_dynamics *dynamics,
                             rlvc_experience *experience, rlvc_row_sample *sample, uint32_t seed) {
    uint32_t first, rows = rlvc_experience_freeze(experience, &first);
    fit->dynamics = dynamics;
    fit->experience = experience;
    fit->sample = sample;
    rlvc_sampling_begin(&fit->sampling, first, rows, seed);
    enter(fit, SAMPLE);
}

/* ------------------------------------------------------------------ moments of the percepts */

static void clear_sums(rlvc_dynamics_fit_cursor *fit) {
    for (uint32_t i = 0; i < fit->experience->components; i++)
        fit->sum[i] = 0.0f;
}

static void set_bounds(rlvc_dynamics_fit_cursor *fit) {
    const rlvc_experience *experience = fit->experience;
    for (uint32_t i = 0; i < experience->components; i++) {
        float more = SLACK * (experience->high[i] - experience->low[i]);
        fit->dynamics->low[i] = experience->low[i] - more;
        fit->dynamics->high[i] = experience->high[i] + more;
    }
}

static void add_percept(rlvc_dynamics_fit_cursor *fit) {
    const rlvc_basis *basis = &fit->dynamics->basis;
    uint32_t row = fit->sample->row[fit->at];
    const float *s = rlvc_experience_percept(fit->experience, row);
    for (uint32_t i = 0; i < basis->components; i++) {
        float off = fit->phase == MEAN ? s[i] : (s[i] - basis->mean[i]) * (s[i] - basis->mean[i]);
        fit->sum[i] += off;
    }
    if (++fit->at < fit->sample->count)
        return;
    float rows = (float)fit->sample->count;
    for (uint32_t i = 0; i < basis->components; i++) {
        float mean = fit->sum[i] / rows;
        if (fit->phase == MEAN) {
            basis->mean[i] = mean;
        } else {
            float least = DEVIATION_LEAST * DEVIATION_LEAST;
            basis->scale[i] = mean > least ? rlvc_sqrt(mean) : 1.0f;
        }
    }
    clear_sums(fit);
    fit->output = basis->components;
    enter(fit, fit->phase == MEAN ? DEVIATION : TARGET_MEAN);
}

/* ------------------------------------------------------------------ the tree of one output */

static uint32_t rows_of_output(const rlvc_dynamics_fit_cursor *fit) {
    return fit->output == fit->experience->components ? fit->sample->going : fit->sample->count;
}

static void begin_tree(rlvc_dynamics_fit_cursor *fit, uint32_t terms, rlvc_model_tree *tree) {
    rlvc_tree_fit_input in;
    memset(&in, 0, sizeof in);
    in.experience = fit->experience;
    in.basis = &fit->dynamics->basis;
    in.row = fit->sample->row;
    in.count = rows_of_output(fit);
    in.output = fit->output;
    in.terms = terms;
    in.leaves_max = fit->dynamics->leaves_max;
    in.leaf_rows = LEAF_ROWS;
    in.ridge = RIDGE;
    in.slack = fit->output == fit->experience->components ? 0.0f : SLACK;
    rlvc_tree_fit_begin(&fit->tree, &in, &fit->space, tree);
}

static void next_output(rlvc_dynamics_fit_cursor *fit) {
    uint32_t components = fit->experience->components;
    fit->output = fit->output == components ? 0u : fit->output + 1u;
    if (fit->output < components) {
        enter(fit, TARGET_MEAN);
        return;
    }
    rlvc_ending_fit_begin(&fit->ending, fit->experience, fit->sample, &fit->dynamics->ending,
                          fit->window);
    enter(fit, ENDING);
}

/* A target that does not differ has no tree: terms 0 and one leaf. */
static void make_constant(rlvc_dynamics_fit_cursor *fit, rlvc_model_tree *tree) {
    tree->scale = 0.0f;
    tree->terms = 0;
    tree->leaves = 1;
    memset(tree->node, 0, sizeof *tree->node);
    tree->node[0].test = RLVC_MODEL_LEAF;
    memset(tree->leaf, 0, sizeof *tree->leaf);
    next_output(fit);
}

static void end_of_targets(rlvc_dynamics_fit_cursor *fit) {
    rlvc_model_tree *tree = fit->dynamics->tree + fit->output;
    uint32_t rows = rows_of_output(fit);
    float mean = rows > 0 ? fit->moment / (float)rows : 0.0f;
    if (fit->phase == TARGET_MEAN) {
        tree->mean = mean;
        enter(fit, TARGET_DEVIATION);
        return;
    }
    if (mean <= 1e-18f) {
        make_constant(fit, tree);
        return;
    }
    tree->scale = rlvc_sqrt(mean);
    enter(fit, SHORT);
    begin_tree(fit, rlvc_basis_short(fit->experience->components, fit->dynamics->basis.actions),
               tree);
}

static void add_target(rlvc_dynamics_fit_cursor *fit) {
    if (fit->at < rows_of_output(fit)) {
        const rlvc_model_tree *tree = fit->dynamics->tree + fit->output;
        float y = rlvc_fit_target(fit->experience, fit->output, fit->sample->row[fit->at]);
        int first = fit->at == 0 && fit->phase == TARGET_MEAN;
        if (fit->output == fit->experience->components) {
            rlvc_dynamics *dynamics = fit->dynamics;
            if (first || y < dynamics->reward_low)
                dynamics->reward_low = y;
            if (first || y > dynamics->reward_high)
                dynamics->reward_high = y;
        }
        fit->moment += fit->phase == TARGET_MEAN ? y : (y - tree->mean) * (y - tree->mean);
        fit->at++;
    }
    if (fit->at >= rows_of_output(fit))
        end_of_targets(fit);
}

/* Of two trees the one with the shorter description stays. */
static void end_of_tree(rlvc_dynamics_fit_cursor *fit) {
    rlvc_model_tree *tree = fit->dynamics->tree + fit->output;
    float length = rlvc_tree_fit_length(&fit->tree);
    if (fit->phase == SHORT && fit->dynamics->terms_max > tree->terms) {
        fit->length = length;
        fit->spare.mean = tree->mean;
        fit->spare.scale = tree->scale;
        begin_tree(fit, fit->dynamics->terms_max, &fit->spare);
        enter(fit, FULL);
        return;
    }
    if (fit->phase == FULL && length < fit->length) {
        rlvc_model_tree other = *tree;
        *tree = fit->spare;
        fit->spare = other;
    }
    next_output(fit);
}

/* ------------------------------------------------------------------ the steps */

static uint32_t advance(rlvc_dynamics_fit_cursor *fit, uint32_t budget) {
    uint32_t spent;
    switch (fit->phase) {
    case SAMPLE:
        spent = rlvc_sampling_step(&fit->sampling, fit->experience, fit->sample, budget);
        if (fit->sampling.done) {
            clear_sums(fit);
            set_bounds(fit);
            enter(fit, MEAN);
        }
        return spent;
    case MEAN:
    case DEVIATION:
        add_percept(fit);
        return fit->experience->components;
    case TARGET_MEAN:
    case TARGET_DEVIATION:
        add_target(fit);
        return 1u;
    case SHORT:
    case FULL:
        spent = rlvc_tree_fit_step(&fit->tree, budget);
        if (fit->tree.done)
            end_of_tree(fit);
        return spent;
    default:
        spent = rlvc_ending_fit_step(&fit->ending, budget);
        if (fit->ending.done)
            enter(fit, DONE);
        return spent;
    }
}

uint32_t rlvc_dynamics_fit_step(rlvc_dynamics_fit_cursor *fit, uint32_t budget) {
    uint32_t spent = 0;
    while (spent < budget && !fit->done)
        spent += advance(fit, budget - spent);
    return spent;
}

/* ------------------------------------------------------------------ the model's answer */

/* Also of a forged model's x that is no number. */
static float clamp(float x, float low, float high) {
    return !(x >= low) ? low : x > high ? high : x;
}

/* Nearly normal: the sum of four uniform numbers, of deviation 1. */
static float draw_noise(rlvc_rng *rng) {
    uint32_t sum = 0;
    for (int i = 0; i < 2; i++) {
        uint32_t word = rlvc_rng_next(rng);
        sum += (word & 0xffffu) + (word >> 16);
    }
    return ((float)sum * (1.0f / 65536.0f) - 2.0f) * 1.7320508f;
}

/* What a leaf of a tree says to the row x of the basis. */
static float predict(const rlvc_dynamics *dynamics, const rlvc_model_tree *tree, uint32_t index,
                     rlvc_rng *rng) {
    if (tree->terms == 0)
        return tree->mean;
    const rlvc_model_leaf *leaf = tree->leaf + index;
    float y = clamp(rlvc_model_tree_linear(tree, index, dynamics->x), leaf->low, leaf->high);
    if (rng && leaf->noise > NOISE_LEAST)
        y += leaf->noise * draw_noise(rng);
    return tree->mean + tree->scale * y;
}

void rlvc_dynamics_step(const rlvc_dynamics *dynamics, float *s, uint32_t action, rlvc_rng *rng,
                        rlvc_outcome *outcome) {
    const rlvc_basis *basis = &dynamics->basis;
    uint32_t leaf_of[RLVC_COMPONENTS_MAX + 1u], d = basis->components;
    rlvc_basis_row(basis, dynamics->terms_max, s, action, dynamics->x);
    for (uint32_t k = 0; k <= d; k++)
        leaf_of[k] = rlvc_model_tree_leaf(dynamics->tree + k, d, s, action);
    for (uint32_t k = 0; k < d; k++) {
        float change = predict(dynamics, dynamics->tree + k, leaf_of[k], rng);
        s[k] = clamp(s[k] + change, dynamics->low[k], dynamics->high[k]);
    }
    float reward = predict(dynamics, dynamics->tree + d, leaf_of[d], rng);
    outcome->reward = clamp(reward, dynamics->reward_low, dynamics->reward_high);
    const rlvc_ending_node *leaf = rlvc_ending_at(&dynamics->ending, s);
    outcome->end = leaf->probability;
    outcome->end_reward = leaf->reward;
}
