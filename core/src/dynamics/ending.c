/* SPDX-License-Identifier: MIT */
/* Where episodes terminate: see ending.h. Phases of a node: what it holds (WEIGH), the bins
 * (COUNT), and then the best leaf's split (CHOOSE, PARTITION). */
#include "rlvc/float_rules.h"

#include "ending.h"

#include "../base/assert.h"
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
    fit->weight[0] = fit->weight[1] = fit->reward = 0.0f;
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

static float weight_of(const rlvc_ending_fit_cursor *fit, int end) {
    return end ? fit->sample->weight_ended : fit->sample->weight_going;
}

/* Opens the windows: from least to greatest value, which were put into low and width. */
static void open_windows(rlvc_ending_fit_cursor *fit) {
    for (uint32_t i = 0; i < fit->experience->components; i++) {
        rlvc_ending_window *window = fit->window + i;
        window->width = (window->width - window->low) / (float)RLVC_ENDING_BINS;
        window->gain = 0.0f;
        window->below[0] = window->below[1] = 0.0f;
        memset(window->bin, 0, sizeof window->bin);
    }
    fit->pass = 0;
}

static void end_of_weighing(rlvc_ending_fit_cursor *fit) {
    rlvc_ending_node *node = fit->ending->node + fit->node;
    float ending = fit->weight[1], all = fit->weight[0] + fit->weight[1];
    node->probability = ending / all;
    node->reward = ending > 0.0f ? fit->reward / ending : 0.0f;
    if (ending > 0.0f && fit->weight[0] > 0.0f) {
        open_windows(fit);
        enter(fit, COUNT);
    } else {
        enter(fit, CHOOSE);
    }
}

static void weigh_row(rlvc_ending_fit_cursor *fit) {
    uint32_t row = row_at(fit, fit->at);
    const float *value = successor(fit, row);
    int end = ended(fit, row);
    fit->weight[end] += weight_of(fit, end);
    if (end)
        fit->reward += weight_of(fit, end) * fit->experience->reward[row];
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

static float gini(const float *weight) {
    float all = weight[0] + weight[1];
    return all > 0.0f ? 2.0f * weight[0] * weight[1] / all : 0.0f;
}

/* The best boundary of two bins; the window then closes upon the bins on its two sides that hold
 * anything. */
static void close_window(rlvc_ending_fit_cursor *fit, rlvc_ending_window *window) {
    float below[2] = {window->below[0], window->below[1]}, best = -1.0f;
    uint32_t from = 0, to = 0, open = 0;
    for (uint32_t b = 0; b < RLVC_ENDING_BINS; b++) {
        const float *bin = window->bin[b];
        if (open && bin[0] + bin[1] > 0.0f) {
            to = b;
            open = 0;
        }
        below[0] += bin[0];
        below[1] += bin[1];
        float above[2] = {fit->weight[0] - below[0], fit->weight[1] - below[1]};
        float gain = gini(fit->weight) - gini(below) - gini(above);
        if (bin[0] + bin[1] > 0.0f && above[0] + above[1] > 0.5f && gain > best) {
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
    window->below[0] = window->below[1] = 0.0f;
    memset(window->bin, 0, sizeof window->bin);
}

static void end_of_pass(rlvc_ending_fit_cursor *fit) {
    rlvc_ending_node *node = fit->ending->node + fit->node;
    for (uint32_t i = 0; i < fit->experience->components; i++)
        if (fit->window[i].width > 0.0f)
            close_window(fit, fit->window + i);
    enter(fit, COUNT);
    if (++fit->pass < RLVC_ENDING_PASSES)
        return;
    for (uint32_t i = 0; i < fit->experience->components; i++) {
        if (fit->window[i].gain > fit->gain[fit->node] + 1e-6f * fit->weight[1]) {
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
    int end = ended(fit, row);
    float weight = weight_of(fit, end);
    for (uint32_t i = 0; i < fit->experience->components; i++) {
        rlvc_ending_window *window = fit->window + i;
        float offset = value[i] - window->low;
        if (offset < 0.0f) {
            window->below[end] += weight;
        } else if (offset <= window->width * (float)RLVC_ENDING_BINS && window->width > 0.0f) {
            uint32_t b = (uint32_t)(offset / window->width);
            window->bin[b < RLVC_ENDING_BINS ? b : RLVC_ENDING_BINS - 1u][end] += weight;
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
