/* SPDX-License-Identifier: MIT */
/* How many samples a cell of a table counts, and products of two such counts, exactly.
 *
 * What one agent has seen fits into 31 bits, and a product into 63. What many machines have seen
 * together (rlvc/counts.h) needs more, and products 128 bits. So a host counts by 64 bits, and a
 * microcontroller by 32. Floats are made of exact integers by rounding once. So both give the same
 * bits where both have room. */
#ifndef RLVC_SRC_COUNT_H
#define RLVC_SRC_COUNT_H

#include <stdint.h>

#ifndef RLVC_COUNT_BITS
#if UINTPTR_MAX > 0xffffffffu
#define RLVC_COUNT_BITS 64
#else
#define RLVC_COUNT_BITS 32
#endif
#endif

#if RLVC_COUNT_BITS == 64

#define RLVC_COUNT_MAX ((UINT64_C(1) << 48) - 1u) /* of all samples together */
typedef uint64_t rlvc_count;

/* A product, or a sum of two: below 2^98. */
typedef struct rlvc_product {
    uint64_t high, low;
} rlvc_product;

static inline rlvc_product rlvc_product_of(rlvc_count x, rlvc_count y) {
    const uint64_t half = 0xffffffffu;
    uint64_t low = (x & half) * (y & half);
    uint64_t middle = (x >> 32) * (y & half) + (low >> 32);
    uint64_t other = (x & half) * (y >> 32) + (middle & half);
    rlvc_product made;
    made.low = other << 32 | (low & half);
    made.high = (x >> 32) * (y >> 32) + (middle >> 32) + (other >> 32);
    return made;
}

/* Is p below q? */
static inline int rlvc_product_below(rlvc_product p, rlvc_product q) {
    return p.high < q.high || (p.high == q.high && p.low < q.low);
}

static inline rlvc_product rlvc_product_sum(rlvc_product p, rlvc_product q) {
    rlvc_product made;
    made.low = p.low + q.low;
    made.high = p.high + q.high + (made.low < p.low);
    return made;
}

/* The nearest float. Of what is beyond 64 bits only whether it is 0 can matter, as the upper 64
 * have more than twice the digits of a float. */
static inline float rlvc_product_float(rlvc_product p) {
    float scale = 1.0f;
    while (p.high != 0) {
        p.low = p.low >> 16 | p.high << 48 | (uint64_t)((p.low & 0xffffu) != 0);
        p.high >>= 16;
        scale *= 65536.0f;
    }
    return (float)p.low * scale;
}

/* p - q, rounded once. */
static inline float rlvc_product_difference(rlvc_product p, rlvc_product q) {
    int negative = rlvc_product_below(p, q);
    rlvc_product more = negative ? q : p, less = negative ? p : q, left;
    left.low = more.low - less.low;
    left.high = more.high - less.high - (more.low < less.low);
    return negative ? -rlvc_product_float(left) : rlvc_product_float(left);
}

#else

#define RLVC_COUNT_MAX INT32_MAX
typedef uint32_t rlvc_count;
typedef uint64_t rlvc_product;

static inline rlvc_product rlvc_product_of(rlvc_count x, rlvc_count y) {
    return (uint64_t)x * y;
}

static inline int rlvc_product_below(rlvc_product p, rlvc_product q) {
    return p < q;
}

#endif

#endif
