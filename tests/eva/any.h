/* SPDX-License-Identifier: MIT */
/* Values of which the analyser knows nothing, for the drivers of Frama-C's Eva. */
#ifndef RLVC_TESTS_EVA_ANY_H
#define RLVC_TESTS_EVA_ANY_H

#include "__fc_builtin.h"

#include <stdint.h>

static inline uint32_t any_in(uint32_t low, uint32_t high) {
    return Frama_C_unsigned_int_interval(low, high);
}

/* The same, each number by itself: what depends on it is known exactly. (A function would join them
 * again when it returns.) */
#define each_in(low, high) ((uint32_t)Frama_C_interval_split((int)(low), (int)(high)))

static inline float any_real(float low, float high) {
    return Frama_C_float_interval(low, high);
}

static inline void any_bytes(void *bytes, uint32_t count) {
    if (count > 0)
        Frama_C_make_unknown((char *)bytes, count);
}

#endif
