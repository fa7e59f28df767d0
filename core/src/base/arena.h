/* SPDX-License-Identifier: MIT */
/* Carving the caller's block into arrays.
 *
 * The same carving code runs twice: without a block, it only counts (rlvc_agent_size); with one, it
 * places. So the size that is asked for and the size that is used cannot differ. */
#ifndef RLVC_SRC_ARENA_H
#define RLVC_SRC_ARENA_H

#include "rlvc/agent.h"

typedef struct rlvc_arena {
    unsigned char *base; /* the block, aligned to RLVC_ALIGNMENT; null to count only */
    uint64_t used;       /* bytes carved so far: 64 bits, so that no sum of sizes can wrap */
} rlvc_arena;

/* The next `count` items of `size` bytes, the whole rounded up to RLVC_ALIGNMENT; null when only
 * counting. O(1). */
static inline void *rlvc_arena_carve(rlvc_arena *arena, uint64_t count, uint64_t size) {
    void *place = arena->base ? arena->base + (size_t)arena->used : NULL;
    uint64_t mask = RLVC_ALIGNMENT - 1u;
    arena->used += (count * size + mask) & ~mask;
    return place;
}

#endif
