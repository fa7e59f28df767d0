/* SPDX-License-Identifier: MIT */
/* The truncated discounted return (definition 1): R_t^H = sum over i = 0..H of gamma^i
 * r_{t+i+1}. */
#ifndef RLVC_SRC_RETURNS_H
#define RLVC_SRC_RETURNS_H

#include "replay.h"

/* Works out the return at one position t for a horizon H, in slices: first forward over the window
 * t..t+H, to see that it is whole; then backward, R := r + gamma R, which gives the same bits for
 * the same rewards wherever they stand. */
typedef struct rlvc_return_cursor {
    uint32_t position; /* t */
    uint32_t offset;   /* i, the next interaction to look at */
    uint8_t summing;   /* 0: forward; 1: backward */
    uint8_t defined;   /* the result: R_t^H exists ... */
    uint8_t done;
    float value; /* ... and is this */
} rlvc_return_cursor;

/* What the windows of one step have in common. */
typedef struct rlvc_return_input {
    const rlvc_replay *replay;
    uint32_t end;       /* N: interactions at positions [0, end) are in the database */
    uint32_t horizon;   /* H = k */
    float discount;     /* gamma */
    uint8_t continuing; /* the window runs on through a terminated interaction */
} rlvc_return_input;

void rlvc_return_begin(rlvc_return_cursor *window, uint32_t position);

/* R_t^H is undefined if the window leaves the database, holds an action that was not exploitation
 * (section 4.2.1), or crosses the end of an episode: a truncated or interrupted one always, a
 * terminated one unless the task is continuing.
 * @return the work, at most budget (>= 1): one unit for each interaction looked at, 2 (H + 1) in
 * all. */
uint32_t rlvc_return_step(rlvc_return_cursor *window, const rlvc_return_input *input,
                          uint32_t budget);

#endif
