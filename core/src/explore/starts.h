/* SPDX-License-Identifier: MIT */
/* How likely it is that the next episode begins where none has begun yet. By Good and Turing (Good,
 * 1953) the chance that a draw shows something new is
 *
 *     N1 / N,    N: episodes that have begun, N1: classes in which exactly one of these began.
 *
 * Where all begin in one class that is 0 as soon as two were counted. Where each begins in a class
 * of its own it is 1. */
#ifndef RLVC_SRC_STARTS_H
#define RLVC_SRC_STARTS_H

#include "../samples/replay.h"

typedef struct rlvc_starts_cursor {
    uint32_t position; /* in the ring, the next to look at */
    uint32_t end;
    uint32_t episodes; /* N so far */
    uint32_t once;     /* N1 so far */
} rlvc_starts_cursor;

/* Begins to look at positions [0, end). O(1). */
void rlvc_starts_begin(rlvc_starts_cursor *starts, uint32_t end);

/* Looks at some, which have labels.
 * @param begun by class, the episodes that began there so far; 0 before the first look
 * @return the work, at most budget (>= 1): a unit for each; 0: there is none left. */
uint32_t rlvc_starts_step(rlvc_starts_cursor *starts, const rlvc_replay *replay, uint32_t *begun,
                          uint32_t budget);

/* N1 / N; 0 where no episode was seen to begin. O(1). */
float rlvc_starts_chance(const rlvc_starts_cursor *starts);

#endif
