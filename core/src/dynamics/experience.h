/* SPDX-License-Identifier: MIT */
/* What real-valued percepts were followed by: a ring of rows.
 *
 * A row is a percept and, once it was acted upon, the action, the reward and how it ended. Rows
 * stand in order of time, and the row after an interaction always holds its s', also where it
 * terminated: the dynamics model learns from it where episodes end. So an episode of T interactions
 * takes T + 1 rows, the last of which has no interaction (RLVC_ROW_LAST). The newest row is the
 * current percept while an episode is under way.
 *
 * While a model is being fitted, the rows it looks at must stay: the ring is frozen, and has room
 * for `spare` more rows until it is thawed.
 *
 * Invariant: every row with an interaction has a next row; the newest row has none. */
#ifndef RLVC_SRC_EXPERIENCE_H
#define RLVC_SRC_EXPERIENCE_H

#include "../base/arena.h"

/* Beside RLVC_GOES_ON, RLVC_TERMINATED and RLVC_TRUNCATED: no interaction. */
#define RLVC_ROW_LAST 3u

typedef struct rlvc_experience {
    float *percept; /* [rows][components] */
    float *reward;  /* [rows] */
    float *low;     /* [components] least value ever seen */
    float *high;    /* [components] greatest value ever seen */
    uint8_t *action;
    uint8_t *end;
    uint32_t components;
    uint32_t rows;
    uint32_t head;  /* the newest row */
    uint32_t count; /* rows in use */
    uint32_t total; /* interactions ever observed, at most UINT32_MAX */
    uint32_t spare; /* rows there is room for while frozen */
    uint8_t frozen;
} rlvc_experience;

void rlvc_experience_carve(rlvc_experience *experience, rlvc_arena *arena, uint32_t components,
                           uint32_t rows);

/* The i-th row in order of time, i in [0, count). O(1). */
static inline uint32_t rlvc_experience_row(const rlvc_experience *experience, uint32_t i) {
    uint32_t oldest = experience->head + experience->rows - (experience->count - 1u);
    uint32_t row = oldest >= experience->rows ? oldest - experience->rows : oldest;
    uint32_t to_end = experience->rows - row;
    return i < to_end ? row + i : i - to_end;
}

static inline uint32_t rlvc_experience_next(const rlvc_experience *experience, uint32_t row) {
    return row + 1u == experience->rows ? 0u : row + 1u;
}

static inline const float *rlvc_experience_percept(const rlvc_experience *experience,
                                                   uint32_t row) {
    return experience->percept + (size_t)row * experience->components;
}

/* Is there room for another row? O(1). */
static inline int rlvc_experience_has_room(const rlvc_experience *experience) {
    return !experience->frozen || experience->spare > 0;
}

/* Freezes the rows but the oldest eighth, which may still leave to make room.
 * @param first the first row that stays
 * @return how many rows from there on hold what was observed, the newest left out. O(1). */
uint32_t rlvc_experience_freeze(rlvc_experience *experience, uint32_t *first);

/* Starts an episode at a percept; needs room. One that is under way is cut off there.
 * O(components). */
void rlvc_experience_begin(rlvc_experience *experience, const float *percept);

/* What came of the current percept; `next` becomes the newest row; needs room. O(components). */
void rlvc_experience_append(rlvc_experience *experience, uint8_t action, float reward,
                            const float *next, uint8_t end);

#endif
