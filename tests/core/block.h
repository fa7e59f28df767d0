/* SPDX-License-Identifier: MIT */
/* Filling, copying and comparing whole blocks, also where the build keeps the arrays in them apart
 * by zones that must not be touched (base/arena.h): these functions may. Sizes are in bytes and
 * need be no multiple of anything. */
#ifndef RLVC_TESTS_BLOCK_H
#define RLVC_TESTS_BLOCK_H

#include "base/arena.h"

#include <stddef.h>
#include <string.h>

#ifdef RLVC_RED_ZONES

/* Volatile, for compilers not to make calls of memcpy, which looks at zones. */
__attribute__((no_sanitize_address)) static inline void block_copy(void *to, const void *from,
                                                                   size_t bytes) {
    volatile unsigned char *written = (volatile unsigned char *)to;
    const volatile unsigned char *read = (const volatile unsigned char *)from;
    for (size_t i = 0; i < bytes; i++)
        written[i] = read[i];
}

/* Where the first byte is that differs; `bytes` if none does. */
__attribute__((no_sanitize_address)) static inline size_t
block_difference(const void *a, const void *b, size_t bytes) {
    const volatile unsigned char *one = (const volatile unsigned char *)a;
    const volatile unsigned char *other = (const volatile unsigned char *)b;
    size_t i = 0;
    while (i < bytes && one[i] == other[i])
        i++;
    return i;
}

#else

static inline void block_copy(void *to, const void *from, size_t bytes) {
    memcpy(to, from, bytes);
}

static inline size_t block_difference(const void *a, const void *b, size_t bytes) {
    const unsigned char *one = (const unsigned char *)a, *other = (const unsigned char *)b;
    size_t i = 0;
    while (i < bytes && one[i] == other[i])
        i++;
    return i;
}

#endif

static inline int block_equal(const void *a, const void *b, size_t bytes) {
    return block_difference(a, b, bytes) == bytes;
}

/* Takes a block back and fills it. */
static inline void block_fill(void *block, int byte, size_t bytes) {
    RLVC_UNPOISON(block, bytes);
    memset(block, byte, bytes);
}

#endif
