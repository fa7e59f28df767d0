/* SPDX-License-Identifier: MIT */
/* The rows of the ring that a model is fitted to: a bounded sample of the interactions, stratified.
 *
 * A fit looks at `room` interactions at most, so its cost is bounded. It looks at seven in ten at
 * most, so that two samples differ even if there are few interactions. Interactions that terminated
 * are few and show where episodes end. They are drawn apart and get up to a quarter of the room.
 * Each of a stratum's interactions is as likely to be drawn as any other (selection sampling, Knuth
 * volume 2, 3.4.2, algorithm S), and stands for `weight` of them.
 *
 * Rows [0, going) did not terminate, rows [going, count) did. */
#ifndef RLVC_SRC_SAMPLE_H
#define RLVC_SRC_SAMPLE_H

#include "experience.h"
#include "../base/rng.h"

typedef struct rlvc_row_sample {
    uint32_t *row; /* [room] */
    uint32_t room;
    uint32_t count;
    uint32_t going;
    float weight_going;
    float weight_ended;
} rlvc_row_sample;

/* The drawing of a sample, in two passes over the ring. */
typedef struct rlvc_sampling_cursor {
    rlvc_rng rng;
    uint32_t first; /* of the rows to draw from */
    uint32_t rows;
    uint32_t row;       /* the next to be looked at */
    uint32_t at;        /* how many were, in this pass */
    uint32_t seen[2];   /* interactions left to look at: that go on, that terminated */
    uint32_t needed[2]; /* of these, to draw */
    uint32_t placed[2];
    uint8_t drawing; /* 0: counting; 1: drawing */
    uint8_t done;
} rlvc_sampling_cursor;

/* Draws from `rows` rows from `first` on, at least one. O(1). */
void rlvc_sampling_begin(rlvc_sampling_cursor *sampling, uint32_t first, uint32_t rows,
                         uint32_t seed);

/* Looks at up to `budget` rows. @return how many. */
uint32_t rlvc_sampling_step(rlvc_sampling_cursor *sampling, const rlvc_experience *experience,
                            rlvc_row_sample *sample, uint32_t budget);

#endif
