/* SPDX-License-Identifier: MIT */
/* Carving the caller's block: see arena.h. */
#include "rlvc/float_rules.h"

#include "arena.h"

void *rlvc_arena_carve_bytes(rlvc_arena *arena, uint64_t bytes) {
    uint64_t begin = arena->used, mask = RLVC_ALIGNMENT - 1u;
    arena->used += ((bytes + mask) & ~mask) + RLVC_RED_ZONE_BYTES;
    if (!arena->base)
        return NULL;
    RLVC_UNPOISON(arena->base + (size_t)begin, (size_t)bytes);
    RLVC_POISON(arena->base + (size_t)(begin + bytes), (size_t)(arena->used - begin - bytes));
    return arena->base + (size_t)begin;
}

void *rlvc_arena_carve(rlvc_arena *arena, uint32_t count, uint32_t size) {
    return rlvc_arena_carve_bytes(arena, (uint64_t)count * size);
}
