/* SPDX-License-Identifier: MIT */
/* Carving the caller's block into arrays.
 *
 * The same carving code runs twice: without a block, it only counts (rlvc_agent_size); with one, it
 * places. So the size that is asked for and the size that is used cannot differ.
 *
 * Within one block an overflow from one array into the next is memory that AddressSanitizer knows
 * nothing of. So tests are built with RLVC_RED_ZONES: then a zone that must not be touched follows
 * each array, and the padding before it is part of it. */
#ifndef RLVC_SRC_ARENA_H
#define RLVC_SRC_ARENA_H

#include "rlvc/agent.h"

#ifdef RLVC_RED_ZONES
#include <sanitizer/asan_interface.h>
#define RLVC_RED_ZONE_BYTES 64u
#define RLVC_POISON(memory, bytes) ASAN_POISON_MEMORY_REGION(memory, bytes)
#define RLVC_UNPOISON(memory, bytes) ASAN_UNPOISON_MEMORY_REGION(memory, bytes)
#else
#define RLVC_RED_ZONE_BYTES 0u
#define RLVC_POISON(memory, bytes) ((void)0)
#define RLVC_UNPOISON(memory, bytes) ((void)0)
#endif

typedef struct rlvc_arena {
    unsigned char *base; /* the block, aligned to RLVC_ALIGNMENT; null to count only */
    uint64_t used;       /* bytes carved so far: 64 bits, so that no sum of sizes can wrap */
} rlvc_arena;

/* Can a caller's block hold `needed` bytes?
 * @return RLVC_OK; RLVC_E_NULL: there is no block; RLVC_E_MEMORY: too small, or not aligned. O(1).
 */
static inline rlvc_status rlvc_arena_check(const void *memory, size_t bytes, size_t needed) {
    if (!memory)
        return RLVC_E_NULL;
    return (uintptr_t)memory % RLVC_ALIGNMENT != 0 || bytes < needed ? RLVC_E_MEMORY : RLVC_OK;
}

/* The next `count` items of `size` bytes, the whole rounded up to RLVC_ALIGNMENT; null when only
 * counting. O(1). */
void *rlvc_arena_carve(rlvc_arena *arena, uint32_t count, uint32_t size);

/* The next `bytes` bytes, likewise. O(1). */
void *rlvc_arena_carve_bytes(rlvc_arena *arena, uint64_t bytes);

#endif
