/* SPDX-License-Identifier: MIT */
/* Numbers as bytes, the lowest first, on every target. */
#ifndef RLVC_SRC_BYTES_H
#define RLVC_SRC_BYTES_H

#include <stdint.h>

/* The `bytes` (at most 8) lowest bytes of a number. */
static inline void rlvc_put(unsigned char *to, uint64_t number, uint32_t bytes) {
    for (uint32_t i = 0; i < bytes; i++)
        to[i] = (unsigned char)(number >> (8u * i));
}

static inline uint64_t rlvc_get(const unsigned char *from, uint32_t bytes) {
    uint64_t number = 0;
    for (uint32_t i = 0; i < bytes; i++)
        number |= (uint64_t)from[i] << (8u * i);
    return number;
}

#endif
