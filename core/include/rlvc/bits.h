/* SPDX-License-Identifier: MIT */
/* The ready-made domain of bits (section 6.1): a percept is a string of bits, a feature is the
 * number of a bit, and a percept exhibits the feature if that bit is 1. */
#ifndef RLVC_BITS_H
#define RLVC_BITS_H

#include "rlvc/domain.h"
#include "rlvc/status.h"

#ifdef __cplusplus
extern "C" {
#endif

#define RLVC_BITS_MAX 1024u

/* Bytes of a percept of that many bits. Bit i is bit i % 8 (0 the lowest) of byte i / 8. */
#define RLVC_BITS_PERCEPT_BYTES(bits) (((uint32_t)(bits) + 7u) / 8u)

/* Bytes of a feature: the bit's number as a uint16_t, low byte first. */
#define RLVC_BITS_FEATURE_BYTES 2u

/* Makes *domain the domain of percepts of `bits` bits, 1 to RLVC_BITS_MAX. Unused high bits of a
 * percept's last byte are never looked at. The domain holds no pointer (ctx carries the number).
 * Its callbacks never fail; detecting 64 features in 64 samples costs O(64 log 64) word operations.
 *
 * @return RLVC_OK; RLVC_E_NULL; RLVC_E_RANGE (bits), *domain unchanged. O(1). */
RLVC_API rlvc_status rlvc_bits_domain(uint32_t bits, rlvc_domain *domain);

/* The bit's number in a feature's record. O(1). */
static inline uint32_t rlvc_bits_feature(const void *feature) {
    const unsigned char *byte = (const unsigned char *)feature;
    return (uint32_t)byte[0] | (uint32_t)byte[1] << 8;
}

#ifdef __cplusplus
}
#endif

#endif
