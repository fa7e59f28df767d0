/* SPDX-License-Identifier: MIT */
/* PCG-XSH-RR 64/32. See rng.h. */
#include "rlvc/float_rules.h"

#include "rng.h"

#include "assert.h"

void rlvc_rng_seed(rlvc_rng *rng, uint32_t seed) {
    uint64_t z = seed + UINT64_C(0x9e3779b97f4a7c15);
    z = (z ^ (z >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
    z = (z ^ (z >> 27)) * UINT64_C(0x94d049bb133111eb);
    rng->state = z ^ (z >> 31);
}

uint32_t rlvc_rng_next(rlvc_rng *rng) {
    uint64_t state = rng->state;
    rng->state = state * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    uint32_t word = (uint32_t)(((state >> 18) ^ state) >> 27);
    uint32_t turn = (uint32_t)(state >> 59);
    return (word >> turn) | (word << ((32u - turn) & 31u));
}

float rlvc_rng_uniform(rlvc_rng *rng) {
    return (float)(rlvc_rng_next(rng) >> 8) * (1.0f / 16777216.0f);
}

uint32_t rlvc_rng_below(rlvc_rng *rng, uint32_t bound) {
    RLVC_ASSERT(bound >= 1u);
    return (uint32_t)(((uint64_t)rlvc_rng_next(rng) * bound) >> 32);
}
