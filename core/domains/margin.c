/* SPDX-License-Identifier: MIT */
/* The margin rule. A feature is worth most if its radius passes between percepts, not through a
 * crowd of them: the same thing seen from elsewhere, or in other light, is a little nearer or
 * farther. So the distances of the class's percepts that lie within [tau / m, m tau] are counted in
 * RLVC_MARGIN_BINS equal intervals, and the radius is put into the longest row of empty ones which
 * has a percept on both sides. */
#include "rlvc/float_rules.h"

#include "margin.h"

#include <string.h>

#define BINS RLVC_MARGIN_BINS

static float low_of(const rlvc_descriptors *d) {
    return d->radius / d->margin;
}

static float step_of(const rlvc_descriptors *d) {
    return (d->radius * d->margin - low_of(d)) / (float)BINS;
}

void rlvc_crowd_open(const rlvc_descriptors *d, rlvc_crowd *made) {
    memset(made, 0, sizeof *made);
    for (uint32_t b = 0; b <= BINS; b++) {
        const float edge = low_of(d) + step_of(d) * (float)b;
        made->edge[b] = edge * edge;
    }
    made->to = BINS;
}

/* Leaves out the bins before and behind all rows longer than `width`. */
static void narrow(rlvc_crowd *all, uint32_t width) {
    uint32_t row = 0, from = all->to, to = all->from;
    for (uint32_t b = all->from; b < all->to; b++) {
        row = all->taken[b] ? 0 : row + 1u;
        if (row > width) {
            from = from < b + 1u - row ? from : b + 1u - row;
            to = b + 1u;
        }
    }
    for (uint32_t b = all->from; b < all->to; b++) {
        all->nearer |= (uint8_t)(all->taken[b] && b < from);
        all->farther |= (uint8_t)(all->taken[b] && b >= to);
    }
    all->from = from < to ? from : to;
    all->to = to;
}

/* Puts a percept to the others, by its squared distance. */
void rlvc_crowd_join(rlvc_crowd *all, float squared, uint32_t width) {
    uint32_t low = all->from, high = all->to;
    if (squared < all->edge[low]) {
        all->nearer = 1;
        return;
    }
    if (squared >= all->edge[high]) {
        all->farther = 1;
        return;
    }
    while (high - low > 1u) {
        const uint32_t middle = (low + high) / 2u;
        if (squared < all->edge[middle])
            high = middle;
        else
            low = middle;
    }
    if (!all->taken[low]) {
        all->taken[low] = 1;
        narrow(all, width);
    }
}

/* The longest row of empty bins with a percept on both sides, of equals the nearest. */
rlvc_gap rlvc_crowd_gap(const rlvc_descriptors *d, const rlvc_crowd *all, uint32_t beyond) {
    rlvc_gap best = {0, -1.0f};
    uint32_t row = 0, last = all->farther ? all->to : all->from;
    uint8_t nearer = all->nearer;
    for (uint32_t b = all->from; b < all->to; b++)
        last = all->taken[b] && last < b ? b : last;
    for (uint32_t b = all->from; b < last; b++) {
        row = all->taken[b] ? 0 : row + 1u;
        nearer |= all->taken[b];
        if (row > best.width && nearer) {
            best.width = row;
            best.radius = low_of(d) + step_of(d) * ((float)(b + 1u) - (float)row / (float)beyond);
        }
    }
    return best;
}
