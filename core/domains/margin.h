/* SPDX-License-Identifier: MIT */
/* The margin rule: which radius passes through the widest gap between a class's percepts. */
#ifndef RLVC_DOMAINS_MARGIN_H
#define RLVC_DOMAINS_MARGIN_H

#include "rlvc/descriptors.h"

#include <stdint.h>

#define RLVC_MARGIN_BINS 64u

/* How the class's percepts lie about a vector, as far as they have been looked at. A row of empty
 * bins can only shrink. So bins count only from the first to the last row that is still longer than
 * what is asked for: of percepts beyond, it need not be known how far they are. */
typedef struct rlvc_crowd {
    float edge[RLVC_MARGIN_BINS + 1u]; /* squared distances between which the bins lie */
    uint8_t taken[RLVC_MARGIN_BINS];   /* is there a percept in the bin? */
    uint32_t from, to;                 /* the bins that count; none if equal */
    uint8_t nearer;                    /* is there a percept before them, */
    uint8_t farther;                   /* or behind? */
} rlvc_crowd;

/* What a vector's distances leave empty. */
typedef struct rlvc_gap {
    uint32_t width; /* bins; 0: there is none */
    float radius;   /* in it */
} rlvc_gap;

/* Nobody has been looked at. */
void rlvc_crowd_open(const rlvc_descriptors *d, rlvc_crowd *made);

/* Puts a percept to the others, by its squared distance. Rows of at most `width` empty bins are of
 * no interest. */
void rlvc_crowd_join(rlvc_crowd *all, float squared, uint32_t width);

/* The longest row of empty bins with a percept on both sides, of equals the nearest. The radius
 * leaves 1 / beyond of it beyond itself. */
rlvc_gap rlvc_crowd_gap(const rlvc_descriptors *d, const rlvc_crowd *all, uint32_t beyond);

#endif
