/* SPDX-License-Identifier: MIT */
/* Where episodes terminate: see ending.h. Phases of a node: what it holds (WEIGH), the bins
 * (COUNT), and then the best leaf's split (CHOOSE, PARTITION). */
#include "rlvc/float_rules.h"

#include "ending.h"

#include "../base/assert.h"
#include "../base/float_math.h"
#include <string.h>

enum { WEIGH, COUNT, CHOOSE, PARTITION, DONE };

static void enter(rlvc_ending_fit_cursor *fit, uint8_t phase) {
    fit->phase = phase;
    fit->at = 0;
    fit->done = phase == DONE;
}

static void open_node(rlvc_ending_fit_cursor *fit, uint32_t node) {
    fit->node = node;
    fit->gain[node] = 0.0f;
    memset(&fit->all, 0, sizeof fit->all);
    fit->reward = fit->error = 0.0f;
    memset(fit->ending->node + node, 0, sizeof *fit->ending->node);
    fit->ending->node[node].component = RLVC_ENDING_LEAF;
    enter(fit, WEIGH);
}

void rlvc_ending_fit_begin(rlvc_ending_fit_cursor *fit, const rlvc_experience *experience,
                           const rlvc_row_sample *sample, rlvc_ending *ending,
                           rlvc_ending_window *window) {
    memset(fit, 0, sizeof *fit);
    fit->experience = experience;
    fit->sample = sample;
    fit->ending = ending;
    fit->window = window;
    fit->nodes = fit->leaves = 1;
    fit->count[0] = sample->count;
    open_node(fit, 0);
}

static uint32_t row_at(const rlvc_ending_fit_cursor *fit, uint32_t i) {
    return fit->sample->row[fit->first[fit->node] + i];
}

static const float *successor(const rlvc_ending_fit_cursor *fit, uint32_t row) {
    return rlvc_experience_percept(fit->experience, rlvc_experience_next(fit->experience, row));
}

static int ended(const rlvc_ending_fit_cursor *fit, uint32_t row) {
    return fit->experience->end[row] == RLVC_TERMINATED;
}

static void tally_row(const rlvc_ending_fit_cursor *fit, rlvc_ending_tally *rows, uint32_t row) {
    if (ended(fit, row)) {
        float reward = fit->experience->reward[row] - fit->ending->node[fit->node].reward;
        rows->ended += fit->sample->weight_ended;
        rows->reward += fit->sample->weight_ended * reward;
    } else {
        rows->going += fit->sample->weight_going;
    }
}

static float weight_of(const rlvc_ending_tally *rows) {
    return rows->going + rows->ended;
}

static int rewards_differ(const rlvc_ending_fit_cursor *fit) {
    return fit->reward_low < fit->reward_high;
}

/* Opens the windows: from least to greatest value, which were put into low and width. */
static void open_windows(rlvc_ending_fit_cursor *fit) {
    for (uint32_t i = 0; i < fit->experience->components; i++) {
        rlvc_ending_window *window = fit->window + i;
        window->width = (window->width - window->low) / (float)RLVC_ENDING_BINS;
        window->gain = 0.0f;
        memset(&window->below, 0, sizeof window->below);
        memset(window->bin, 0, sizeof window->bin);
    }
    fit->pass = 0;
}

static void end_of_weighing(rlvc_ending_fit_cursor *fit) {
    rlvc_ending_node *node = fit->ending->node + fit->node;
    node->probability = fit->all.ended / weight_of(&fit->all);
    node->reward = fit->all.ended > 0.0f ? fit->reward / fit->all.ended : 0.0f;
    if (fit->all.ended > 0.0f && (fit->all.going > 0.0f || rewards_differ(fit))) {
        open_windows(fit);
        enter(fit, COUNT);
    } else {
        enter(fit, CHOOSE);
    }
}

static void weigh_reward(rlvc_ending_fit_cursor *fit, float reward) {
    if (fit->node == 0 && (!(fit->all.ended > 0.0f) || reward < fit->reward_low))
        fit->reward_low = reward;
    if (fit->node == 0 && (!(fit->all.ended > 0.0f) || reward > fit->reward_high))
        fit->reward_high = reward;
    fit->all.ended += fit->sample->weight_ended;
    fit->reward += fit->sample->weight_ended * reward;
}

static void weigh_row(rlvc_ending_fit_cursor *fit) {
    uint32_t row = row_at(fit, fit->at);
    const float *value = successor(fit, row);
    if (ended(fit, row))
        weigh_reward(fit, fit->experience->reward[row]);
    else
        fit->all.going += fit->sample->weight_going;
    for (uint32_t i = 0; i < fit->experience->components; i++) {
        rlvc_ending_window *window = fit->window + i;
        if (fit->at == 0 || value[i] < window->low)
            window->low = value[i];
        if (fit->at == 0 || value[i] > window->width)
            window->width = value[i];
    }
    if (++fit->at == fit->count[fit->node])
        end_of_weighing(fit);
}

/* ------------------------------------------------------------------ the windows */

static float gini(const rlvc_ending_tally *rows) {
    float all = weight_of(rows);
    return all > 0.0f ? 2.0f * rows->going * rows->ended / all : 0.0f;
}

/* What the mean of a part of the rows takes away from the squared error of their rewards. */
static float explained(const rlvc_ending_tally *rows) {
    return rows->ended > 0.0f ? rows->reward * rows->reward / rows->ended : 0.0f;
}

static float gain_of(const rlvc_ending_fit_cursor *fit, const rlvc_ending_tally *below,
                     const rlvc_ending_tally *above) {
    float gain = gini(&fit->all) - gini(below) - gini(above);
    float error = explained(below) + explained(above) - fit->chance;
    float range = fit->reward_high - fit->reward_low;
    return rewards_differ(fit) && error > 0.0f ? gain + 2.0f * error / (range * range) : gain;
}

/* The best boundary of two bins; the window then closes upon the bins on its two sides that hold
 * anything. */
static void close_window(rlvc_ending_fit_cursor *fit, rlvc_ending_window *window) {
    rlvc_ending_tally below = window->below;
    float best = -1.0f;
    uint32_t from = 0, to = 0, open = 0;
    for (uint32_t b = 0; b < RLVC_ENDING_BINS; b++) {
        const rlvc_ending_tally *bin = window->bin + b;
        if (open && weight_of(bin) > 0.0f) {
            to = b;
            open = 0;
        }
        below.going += bin->going;
        below.ended += bin->ended;
        below.reward += bin->reward;
        rlvc_ending_tally above = {fit->all.going - below.going, fit->all.ended - below.ended,
                                   fit->all.reward - below.reward};
        float gain = gain_of(fit, &below, &above);
        if (weight_of(bin) > 0.0f && weight_of(&above) > 0.5f && gain > best) {
            best = gain;
            from = b;
            open = 1;
        }
    }
    if (to <= from)
        to = from + 1u;
    window->gain = best;
    window->cut = window->low + window->width * 0.5f * (float)(from + to + 1u);
    window->low += window->width * (float)from;
    window->width *= (float)(to + 1u - from) / (float)RLVC_ENDING_BINS;
    memset(&window->below, 0, sizeof window->below);
    memset(window->bin, 0, sizeof window->bin);
}

/* Of n squares of normal numbers the greatest is about 2 ln n. As many cuts are looked at as rows
 * ended, of each component. */
static float error_by_chance(const rlvc_ending_fit_cursor *fit) {
    float rows = fit->all.ended / fit->sample->weight_ended;
    return 2.0f * rlvc_ln(1.0f + rows * (float)fit->experience->components) * fit->error / rows;
}

static void end_of_pass(rlvc_ending_fit_cursor *fit) {
    rlvc_ending_node *node = fit->ending->node + fit->node;
    if (fit->pass == 0)
        fit->chance = error_by_chance(fit);
    for (uint32_t i = 0; i < fit->experience->components; i++)
        if (fit->window[i].width > 0.0f)
            close_window(fit, fit->window + i);
    enter(fit, COUNT);
    if (++fit->pass < RLVC_ENDING_PASSES)
        return;
    for (uint32_t i = 0; i < fit->experience->components; i++) {
        if (fit->window[i].gain > fit->gain[fit->node] + 1e-6f * fit->all.ended) {
            fit->gain[fit->node] = fit->window[i].gain;
            node->cut = fit->window[i].cut;
            node->child = (uint16_t)i; /* until it is split */
        }
    }
    enter(fit, CHOOSE);
}

static void count_row(rlvc_ending_fit_cursor *fit) {
    uint32_t row = row_at(fit, fit->at);
    const float *value = successor(fit, row);
    if (fit->pass == 0 && ended(fit, row)) {
        float error = fit->experience->reward[row] - fit->ending->node[fit->node].reward;
        fit->error += fit->sample->weight_ended * error * error;
    }
    for (uint32_t i = 0; i < fit->experience->components; i++) {
        rlvc_ending_window *window = fit->window + i;
        float offset = value[i] - window->low;
        if (offset < 0.0f) {
            tally_row(fit, &window->below, row);
        } else if (offset <= window->width * (float)RLVC_ENDING_BINS && window->width > 0.0f) {
            uint32_t b = (uint32_t)(offset / window->width);
            tally_row(fit, window->bin + (b < RLVC_ENDING_BINS ? b : RLVC_ENDING_BINS - 1u), row);
        }
    }
    if (++fit->at == fit->count[fit->node])
        end_of_pass(fit);
}

/* ------------------------------------------------------------------ splitting */

static void choose(rlvc_ending_fit_cursor *fit) {
    if (fit->node + 2u == fit->nodes) {
        open_node(fit, fit->node + 1u);
        return;
    }
    float best = 0.0f;
    for (uint32_t k = 0; k < fit->nodes; k++) {
        if (fit->ending->node[k].component == RLVC_ENDING_LEAF && fit->gain[k] > best) {
            best = fit->gain[k];
            fit->node = k;
        }
    }
    if (!(best > 0.0f) || fit->leaves == RLVC_ENDING_LEAVES) {
        enter(fit, DONE);
        return;
    }
    enter(fit, PARTITION);
    fit->end = fit->count[fit->node];
}

static void make_children(rlvc_ending_fit_cursor *fit) {
    rlvc_ending_node *node = fit->ending->node + fit->node;
    uint32_t child = fit->nodes;
    RLVC_ASSERT(fit->end > 0);
    if (fit->end == fit->count[fit->node]) { /* the cut was rounded up to the greatest value */
        fit->gain[fit->node] = 0.0f;
        fit->node = fit->nodes; /* no first child */
        enter(fit, CHOOSE);
        return;
    }
    node->component = node->child;
    node->child = (uint16_t)child;
    fit->first[child] = fit->first[fit->node];
    fit->count[child] = fit->end;
    fit->first[child + 1u] = fit->first[fit->node] + fit->end;
    fit->count[child + 1u] = fit->count[fit->node] - fit->end;
    fit->nodes += 2u;
    fit->leaves++;
    open_node(fit, child);
}

static void partition_row(rlvc_ending_fit_cursor *fit) {
    const rlvc_ending_node *node = fit->ending->node + fit->node;
    uint32_t *row = fit->sample->row + fit->first[fit->node], here = row[fit->at];
    if (successor(fit, here)[node->child] > node->cut) {
        fit->end--;
        row[fit->at] = row[fit->end];
        row[fit->end] = here;
    } else {
        fit->at++;
    }
    if (fit->at == fit->end)
        make_children(fit);
}

uint32_t rlvc_ending_fit_step(rlvc_ending_fit_cursor *fit, uint32_t budget) {
    uint32_t spent = 0, row = 2u * fit->experience->components;
    while (spent < budget && !fit->done) {
        switch (fit->phase) {
        case WEIGH:
            weigh_row(fit);
            break;
        case COUNT:
            count_row(fit);
            break;
        case CHOOSE:
            choose(fit);
            break;
        default:
            partition_row(fit);
            break;
        }
        spent += row;
    }
    return spent;
}
