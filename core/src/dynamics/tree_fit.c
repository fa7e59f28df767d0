/* SPDX-License-Identifier: MIT */
/* Growing a model tree: see tree_fit.h.
 *
 * Phases of a node: its Gram matrix and linear model (LINEAR, SOLVE), what that leaves (SQUARES),
 * then for each test the quartiles (CUTS), the quarters' Gram matrices (BUCKETS) and the gains
 * (GAIN). Then the best leaf is split (CHOOSE, PARTITION), and its two children are new nodes. */
#include "rlvc/float_rules.h"

#include "tree_fit.h"

#include "gram.h"
#include "../base/float_math.h"
#include <string.h>

enum { LINEAR, SOLVE, SQUARES, CUTS, BUCKETS, GAIN, CHOOSE, PARTITION, DONE };

/* Rows that splits are judged by: more are thinned to no fewer than this, and so many a term. */
#define SPLIT_ROWS 400u
#define SPLIT_ROWS_A_TERM 10u

/* Added to a mean square before its logarithm: what binary32 cannot tell from nothing. */
#define SQUARE_FLOOR 1e-6f

void rlvc_tree_fit_carve(rlvc_tree_fit_space *space, rlvc_arena *arena, uint32_t leaves_max,
                         uint32_t terms_max) {
    uint32_t floats = RLVC_GRAM_FLOATS(terms_max + 1u);
    space->node = rlvc_arena_carve(arena, 2u * leaves_max - 1u, sizeof *space->node);
    space->total = rlvc_arena_carve(arena, floats, sizeof(float));
    space->factor = rlvc_arena_carve(arena, floats, sizeof(float));
    for (uint32_t k = 0; k < RLVC_TREE_FIT_CUTS; k++)
        space->bucket[k] = rlvc_arena_carve(arena, floats, sizeof(float));
    space->x = rlvc_arena_carve(arena, rlvc_model_tree_stride(terms_max) + 1u, sizeof(float));
    space->work = rlvc_arena_carve(arena, terms_max + 1u, sizeof(float));
    space->sorted = rlvc_arena_carve(arena, RLVC_TREE_FIT_QUANTILE_ROWS, sizeof(float));
}

static void enter(rlvc_tree_fit_cursor *fit, uint8_t phase) {
    fit->phase = phase;
    fit->at = 0;
    fit->done = phase == DONE;
}

/* How many tests a node has: its components', and its actions' (of two actions one is enough). */
static uint32_t tests_of(const rlvc_basis *basis) {
    return basis->components + (basis->actions > 2u ? basis->actions : basis->actions - 1u);
}

/* A node becomes a leaf. Its cut means nothing, but is saved. */
static void make_leaf(rlvc_model_node *node, uint32_t leaf) {
    node->cut = 0.0f;
    node->test = RLVC_MODEL_LEAF;
    node->child = (uint16_t)leaf;
}

/* Begins a node, whose leaf holds the model to begin at. */
static void open_node(rlvc_tree_fit_cursor *fit, uint32_t node) {
    fit->node = node;
    fit->space->node[node].gain = 0.0f;
    rlvc_gram_clear(fit->space->total, fit->in.terms + 1u);
    enter(fit, LINEAR);
}

void rlvc_tree_fit_begin(rlvc_tree_fit_cursor *fit, const rlvc_tree_fit_input *in,
                         rlvc_tree_fit_space *space, rlvc_model_tree *tree) {
    memset(fit, 0, sizeof *fit);
    fit->in = *in;
    fit->space = space;
    fit->tree = tree;
    fit->nodes = 1;
    fit->least = in->leaf_rows > 2u * in->terms ? in->leaf_rows : 2u * in->terms;
    fit->price = 1.5f * (float)in->terms * rlvc_ln((float)in->count) +
                 2.0f * rlvc_ln((float)(3u * in->basis->components + in->basis->actions));
    tree->terms = (uint16_t)in->terms;
    tree->leaves = 1;
    make_leaf(tree->node, 0);
    for (uint32_t i = 0; i < rlvc_model_tree_stride(in->terms); i++)
        tree->coefficient[i] = space->x[i] = 0.0f;
    space->node[0].first = 0;
    space->node[0].count = in->count;
    open_node(fit, 0);
}

static uint32_t row_at(const rlvc_tree_fit_cursor *fit, uint32_t i) {
    return fit->in.row[fit->space->node[fit->node].first + i];
}

static float component_of(const rlvc_tree_fit_cursor *fit, uint32_t row, uint32_t component) {
    return rlvc_experience_percept(fit->in.experience, row)[component];
}

static float *coefficients(const rlvc_tree_fit_cursor *fit) {
    return rlvc_model_tree_coefficients(fit->tree, fit->tree->node[fit->node].child);
}

/* The basis of a row, and behind it what the node's model leaves of the target, which is returned
 * itself. */
static float look_at(const rlvc_tree_fit_cursor *fit, uint32_t row) {
    float *x = fit->space->x;
    const rlvc_model_tree *tree = fit->tree;
    rlvc_basis_row(fit->in.basis, fit->in.terms, rlvc_experience_percept(fit->in.experience, row),
                   fit->in.experience->action[row], x);
    float target = rlvc_fit_target(fit->in.experience, fit->in.output, row);
    float y = (target - tree->mean) / tree->scale;
    x[fit->in.terms] = y - rlvc_model_tree_linear(tree, tree->node[fit->node].child, x);
    return y;
}

/* ------------------------------------------------------------------ a node's model */

static void add_row(rlvc_tree_fit_cursor *fit) {
    (void)look_at(fit, row_at(fit, fit->at));
    rlvc_gram_add(fit->space->total, fit->space->x, fit->in.terms + 1u);
    if (++fit->at == fit->space->node[fit->node].count)
        enter(fit, SOLVE);
}

static void factor_of(rlvc_tree_fit_cursor *fit, const float *gram, float *squares) {
    uint32_t order = fit->in.terms + 1u;
    memcpy(fit->space->factor, gram, RLVC_GRAM_FLOATS(order) * sizeof *gram);
    *squares = rlvc_gram_factor(fit->space->factor, order, fit->in.ridge * gram[0]);
}

static void solve(rlvc_tree_fit_cursor *fit) {
    uint32_t order = fit->in.terms + 1u;
    rlvc_fit_node *node = fit->space->node + fit->node;
    uint32_t rows = SPLIT_ROWS_A_TERM * fit->in.terms;
    factor_of(fit, fit->space->total, &node->squares);
    rlvc_gram_solve(fit->space->factor, order, fit->space->work, coefficients(fit));
    rlvc_gram_clear(fit->space->total, order);
    fit->thin = node->count / (rows > SPLIT_ROWS ? rows : SPLIT_ROWS);
    if (fit->thin == 0)
        fit->thin = 1;
    node->squares = 0.0f;
    enter(fit, SQUARES);
}

static void end_of_squares(rlvc_tree_fit_cursor *fit) {
    rlvc_fit_node *node = fit->space->node + fit->node;
    rlvc_model_leaf *leaf = fit->tree->leaf + fit->tree->node[fit->node].child;
    uint32_t terms = fit->in.terms;
    float free = (float)node->count - 0.5f * (float)terms;
    float mean_square = node->squares / (free > 1.0f ? free : 1.0f);
    leaf->noise = rlvc_sqrt(mean_square + 1e-30f);
    leaf->low = fit->low - fit->in.slack * (fit->high - fit->low);
    leaf->high = fit->high + fit->in.slack * (fit->high - fit->low);
    fit->test = 0;
    enter(fit, node->count >= 2u * fit->least ? CUTS : CHOOSE);
}

/* What the new model leaves; of the thinned rows also the Gram matrix, with that as its target. */
static void add_squares(rlvc_tree_fit_cursor *fit) {
    float y = look_at(fit, row_at(fit, fit->at));
    uint32_t terms = fit->in.terms;
    const float *x = fit->space->x;
    fit->space->node[fit->node].squares += x[terms] * x[terms];
    if (fit->at % fit->thin == 0)
        rlvc_gram_add(fit->space->total, x, terms + 1u);
    if (fit->at == 0 || y < fit->low)
        fit->low = y;
    if (fit->at == 0 || y > fit->high)
        fit->high = y;
    if (++fit->at == fit->space->node[fit->node].count)
        end_of_squares(fit);
}

/* ------------------------------------------------------------------ the gains of its splits */

/* A cut between the value of a rank and its neighbour that differs. */
static float cut_at(const float *sorted, uint32_t count, uint32_t rank) {
    uint32_t above = rank, below = rank;
    while (above + 1u < count && sorted[above] == sorted[rank])
        above++;
    if (sorted[above] != sorted[rank])
        return 0.5f * (sorted[rank] + sorted[above]);
    while (below > 0 && sorted[below] == sorted[rank])
        below--;
    return 0.5f * (sorted[rank] + sorted[below]);
}

/* The node's values of a component, or 63 of them, sorted; the cuts are at their quartiles. */
static uint32_t find_cuts(rlvc_tree_fit_cursor *fit) {
    uint32_t rows = fit->space->node[fit->node].count, count = rows;
    float *sorted = fit->space->sorted;
    if (count > RLVC_TREE_FIT_QUANTILE_ROWS)
        count = RLVC_TREE_FIT_QUANTILE_ROWS;
    for (uint32_t i = 0; i < count; i++) {
        uint32_t at = (uint32_t)((uint64_t)i * rows / count), j = i;
        float value = component_of(fit, row_at(fit, at), fit->test);
        for (; j > 0 && sorted[j - 1u] > value; j--)
            sorted[j] = sorted[j - 1u];
        sorted[j] = value;
    }
    uint32_t cuts = 0;
    for (uint32_t k = 1; k <= RLVC_TREE_FIT_CUTS; k++) {
        float cut = cut_at(sorted, count, k * count / 4u);
        if (cuts == 0 || cut > fit->cut[cuts - 1u])
            fit->cut[cuts++] = cut;
    }
    fit->cuts = cuts;
    return count * (count + 8u) / 4u;
}

static uint32_t next_test(rlvc_tree_fit_cursor *fit) {
    uint32_t units = 1, order = fit->in.terms + 1u;
    if (fit->test < fit->in.basis->components) {
        units = find_cuts(fit);
    } else {
        fit->cuts = 1;
    }
    for (uint32_t k = 0; k < fit->cuts; k++)
        rlvc_gram_clear(fit->space->bucket[k], order);
    fit->gained = 0;
    enter(fit, BUCKETS);
    return units;
}

/* The bucket of a row: of a component the first cut that it does not exceed; of an action 0 if it
 * is another one. `cuts` for what is in no bucket. */
static uint32_t bucket_of(const rlvc_tree_fit_cursor *fit, uint32_t row) {
    uint32_t components = fit->in.basis->components, k = 0;
    if (fit->test >= components)
        return fit->in.experience->action[row] == fit->test - components;
    float value = component_of(fit, row, fit->test);
    while (k < fit->cuts && value > fit->cut[k])
        k++;
    return k;
}

static void add_to_bucket(rlvc_tree_fit_cursor *fit) {
    uint32_t row = row_at(fit, fit->at), k = bucket_of(fit, row);
    if (k < fit->cuts) {
        (void)look_at(fit, row);
        rlvc_gram_add(fit->space->bucket[k], fit->space->x, fit->in.terms + 1u);
    }
    fit->at += fit->thin;
    if (fit->at >= fit->space->node[fit->node].count)
        enter(fit, GAIN);
}

static float length_of(float squares, float rows) {
    return rows * rlvc_ln(squares / rows + SQUARE_FLOOR);
}

/* The gain of the split at the next cut. */
static void gain_of_cut(rlvc_tree_fit_cursor *fit) {
    uint32_t order = fit->in.terms + 1u, k = fit->gained++;
    rlvc_fit_node *node = fit->space->node + fit->node;
    float *left = fit->space->bucket[k], *right = fit->space->factor, squares[2];
    if (k > 0)
        rlvc_gram_sum(left, fit->space->bucket[k - 1u], order);
    float rows = fit->space->total[0], least = (float)fit->least;
    if (left[0] >= least && rows - left[0] >= least) {
        float gain = length_of(fit->space->total[RLVC_GRAM_FLOATS(order) - 1u], rows);
        factor_of(fit, left, squares);
        rlvc_gram_difference(right, fit->space->total, left, order);
        squares[1] = rlvc_gram_factor(right, order, fit->in.ridge * (rows - left[0]));
        gain -= length_of(squares[0], left[0]) + length_of(squares[1], rows - left[0]);
        gain = gain * ((float)node->count / rows) - fit->price;
        if (gain > node->gain) {
            node->gain = gain;
            node->test = (uint16_t)fit->test;
            node->cut = fit->test < fit->in.basis->components ? fit->cut[k] : 0.0f;
        }
    }
    if (fit->gained < fit->cuts)
        return;
    fit->test++;
    enter(fit, fit->test < tests_of(fit->in.basis) ? CUTS : CHOOSE);
}

/* ------------------------------------------------------------------ splitting */

/* The second child is opened once the first is done; then the best leaf of all is split. */
static void choose(rlvc_tree_fit_cursor *fit) {
    if (fit->node + 2u == fit->nodes) {
        open_node(fit, fit->node + 1u);
        return;
    }
    const rlvc_model_node *nodes = fit->tree->node;
    const rlvc_fit_node *known = fit->space->node;
    float best = 0.0f;
    for (uint32_t k = 0; k < fit->nodes; k++) {
        if (nodes[k].test == RLVC_MODEL_LEAF && known[k].gain > best) {
            best = known[k].gain;
            fit->node = k;
        }
    }
    if (!(best > 0.0f) || fit->tree->leaves == fit->in.leaves_max) {
        enter(fit, DONE);
        return;
    }
    enter(fit, PARTITION);
    fit->end = known[fit->node].count;
}

/* The two children of the node: the first keeps its leaf, the second begins at a copy. */
static void make_children(rlvc_tree_fit_cursor *fit) {
    rlvc_model_tree *tree = fit->tree;
    rlvc_model_node *node = tree->node + fit->node;
    rlvc_fit_node *known = fit->space->node + fit->node, *child = fit->space->node + fit->nodes;
    uint32_t leaf = node->child, fresh = tree->leaves++;
    memcpy(rlvc_model_tree_coefficients(tree, fresh), rlvc_model_tree_coefficients(tree, leaf),
           rlvc_model_tree_stride(fit->in.terms) * sizeof(float));
    make_leaf(tree->node + fit->nodes, leaf);
    make_leaf(tree->node + fit->nodes + 1u, fresh);
    node->test = known->test;
    node->cut = known->cut;
    node->child = (uint16_t)fit->nodes;
    child[0].first = known->first;
    child[0].count = fit->end;
    child[1].first = known->first + fit->end;
    child[1].count = known->count - fit->end;
    fit->nodes += 2u;
    open_node(fit, fit->nodes - 2u);
}

/* Rows that pass the test change places with rows from the end. */
static void partition_row(rlvc_tree_fit_cursor *fit) {
    const rlvc_fit_node *known = fit->space->node + fit->node;
    uint32_t *row = fit->in.row + known->first, components = fit->in.basis->components;
    uint32_t here = row[fit->at];
    int holds = known->test < components
                    ? component_of(fit, here, known->test) > known->cut
                    : fit->in.experience->action[here] == known->test - components;
    if (holds) {
        fit->end--;
        row[fit->at] = row[fit->end];
        row[fit->end] = here;
    } else {
        fit->at++;
    }
    if (fit->at == fit->end)
        make_children(fit);
}

/* One elementary step. @return the multiplications it took. */
static uint32_t advance(rlvc_tree_fit_cursor *fit) {
    uint32_t terms = fit->in.terms, row = terms * (terms + 5u) / 2u, cube = terms * terms * terms;
    switch (fit->phase) {
    case LINEAR:
        add_row(fit);
        return row;
    case SOLVE:
        solve(fit);
        return cube / 6u + row;
    case SQUARES:
        add_squares(fit);
        return row;
    case CUTS:
        return next_test(fit);
    case BUCKETS:
        add_to_bucket(fit);
        return row;
    case GAIN:
        gain_of_cut(fit);
        return cube / 3u + row;
    case CHOOSE:
        choose(fit);
        return fit->nodes;
    default:
        partition_row(fit);
        return 2u;
    }
}

uint32_t rlvc_tree_fit_step(rlvc_tree_fit_cursor *fit, uint32_t budget) {
    uint32_t spent = 0;
    while (spent < budget && !fit->done)
        spent += advance(fit);
    return spent;
}

float rlvc_tree_fit_length(const rlvc_tree_fit_cursor *fit) {
    float length = fit->price * (float)fit->tree->leaves;
    for (uint32_t k = 0; k < fit->nodes; k++) {
        const rlvc_fit_node *known = fit->space->node + k;
        if (fit->tree->node[k].test == RLVC_MODEL_LEAF)
            length += length_of(known->squares, (float)known->count);
    }
    return length;
}
