/* SPDX-License-Identifier: MIT */
/* A candidate is the best of a few patterns by the margin rule.
 *
 * The radius of a vector is put near the far end of its gap: what was never seen of a thing tends
 * to be farther off than what was. That of a pair is put into the middle, since the same things in
 * another place, which a pair is to tell from it, vary as much.
 *
 * A pair is of two points of one percept, APART_MIN pixels or more from each other, as the same
 * corner often makes two points. How much the displacement may err grows with it, as with a thing's
 * size: a share of its length, but a few pixels in any case. */
#include "rlvc/float_rules.h"

#include "draws.h"

#include "margin.h"
#include "nearest.h"
#include "runs.h"

#include <string.h>

#define GAP_MIN 7u    /* bins; narrower gaps are refused */
#define MEASURED 512u /* percepts */
#define STRIDE 1733u  /* between them: a prime, so that the first come from many targets */
#define REFUSED (-1.0f)
#define VECTOR_BEYOND 5u
#define PAIR_BEYOND 2u
#define APART_MIN 6.0f /* pixels */
#define ERROR_MIN 4.0f /* pixels, at the radius tau */
#define ERROR_SHARE 0.35f

/* Makes a pair of point `from` and the first that is far enough from it, from point `to` on,
 * counted round. 0: there is none. */
static int pair_up(const rlvc_layout *layout, const void *percept, uint32_t from, uint32_t to,
                   rlvc_pattern *made) {
    const uint32_t count = rlvc_vectors_count(percept);
    for (uint32_t k = 0; k < count; k++) {
        const uint32_t j = (to + k) % count;
        rlvc_vectors_displacement(layout, percept, from, j, made->displacement);
        const float x = made->displacement[0], y = made->displacement[1];
        const float squared = x * x + y * y;
        if (squared > APART_MIN * APART_MIN) {
            const float share = ERROR_SHARE * ERROR_SHARE * squared;
            const float error = share < ERROR_MIN * ERROR_MIN ? ERROR_MIN * ERROR_MIN : share;
            made->scale = layout->d->radius * layout->d->radius / error;
            made->vector[1] = rlvc_vectors_at(layout->d, percept, j);
            return 1;
        }
    }
    return 0;
}

/* A pattern of a percept: vector `chance`, counted round, alone or with another. 0: it is not to be
 * had. */
static int pick(const rlvc_layout *layout, const void *percept, uint32_t chance, int as_pair,
                rlvc_pattern *made) {
    const uint32_t count = rlvc_vectors_count(percept);
    if (count == 0)
        return 0;
    const uint32_t from = chance % count;
    made->vector[0] = rlvc_vectors_at(layout->d, percept, from);
    made->scale = 0.0f;
    return !as_pair || pair_up(layout, percept, from, rlvc_scatter(chance) % count, made);
}

static int is_among(const rlvc_layout *layout, const unsigned char *features, uint32_t count,
                    const rlvc_pattern *pattern) {
    for (uint32_t j = 0; j < count; j++) {
        rlvc_pattern other;
        rlvc_vectors_read(layout, features + (size_t)j * layout->feature_bytes, &other);
        if (rlvc_vectors_equal(layout, pattern, &other))
            return 1;
    }
    return 0;
}

/* Measures a pattern against the class: finds its gap, if that is wider than *found. */
static int measure(const rlvc_layout *layout, const rlvc_samples *samples,
                   const rlvc_pattern *pattern, rlvc_gap *found) {
    const uint32_t measured = samples->count < MEASURED ? samples->count : MEASURED;
    uint32_t at = 0, point[2];
    rlvc_crowd all;
    rlvc_probe wanted;
    rlvc_crowd_open(layout->d, &all);
    rlvc_probe_open(layout, pattern, &wanted);
    for (uint32_t i = 0; i < measured && all.from < all.to; i++) {
        const void *percept =
            rlvc_samples_percept(samples, (uint32_t)((uint64_t)at * samples->count / measured));
        if (rlvc_vectors_count(percept) > layout->d->points)
            return -1;
        rlvc_crowd_join(
            &all, rlvc_probe_nearest(&wanted, percept, all.edge[all.from], all.edge[all.to], point),
            found->width);
        at = (at + STRIDE) % measured;
    }
    const rlvc_gap made =
        rlvc_crowd_gap(layout->d, &all, pattern->scale > 0.0f ? PAIR_BEYOND : VECTOR_BEYOND);
    if (made.width > found->width)
        *found = made;
    return 0;
}

/* Draws patterns for candidate number `number` from samples [run[0], run[1]), and keeps the best
 * behind the `written` features. */
static int draw(const rlvc_layout *layout, const rlvc_samples *samples, uint32_t number,
                const uint32_t run[2], unsigned char *features, uint32_t written) {
    const rlvc_descriptors *d = layout->d;
    unsigned char *out = features + (size_t)written * layout->feature_bytes;
    const uint32_t draws = d->margin > 1.0f ? d->draws : 1u;
    const rlvc_gap fixed = {RLVC_MARGIN_BINS, d->radius};
    rlvc_gap best = {GAP_MIN - 1u, REFUSED};
    memset(out, 0, layout->feature_bytes);
    memcpy(out, &best.radius, sizeof best.radius);
    for (uint32_t t = 0; t < draws; t++) {
        const uint32_t chance = rlvc_scatter(number * RLVC_DESCRIPTORS_DRAWS_MAX + t + 1u);
        const void *percept = rlvc_samples_percept(samples, run[0] + chance % (run[1] - run[0]));
        rlvc_gap found = best;
        rlvc_pattern pattern;
        if (rlvc_vectors_count(percept) > d->points)
            return -1;
        if (!pick(layout, percept, rlvc_scatter(chance), number >= d->candidates, &pattern) ||
            is_among(layout, features, written, &pattern))
            continue;
        if (!(d->margin > 1.0f))
            found = fixed;
        else if (measure(layout, samples, &pattern, &found) != 0)
            return -1;
        if (found.width > best.width) {
            best = found;
            rlvc_vectors_write(layout, &pattern, best.radius, out);
        }
    }
    return 0;
}

int rlvc_draw_candidates(const rlvc_layout *layout, const rlvc_samples *samples, uint32_t first,
                         uint32_t room, void *features, uint32_t *written) {
    const uint32_t runs = rlvc_runs_count(samples), vectors = layout->d->candidates;
    uint32_t n = 0;
    for (; n < room && first + n < vectors + layout->pairs; n++) {
        const uint32_t number = first + n;
        const uint32_t i = number < vectors ? number : number - vectors;
        const uint32_t of = number < vectors ? vectors : layout->pairs;
        uint32_t run[2];
        rlvc_runs_find(samples, runs, i, of, run);
        if (draw(layout, samples, number, run, (unsigned char *)features, n) != 0)
            return -1;
    }
    *written = n;
    return 0;
}
