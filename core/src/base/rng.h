/* SPDX-License-Identifier: MIT */
/* The pseudo-random numbers of exploration: PCG-XSH-RR 64/32 (O'Neill 2014).
 *
 *     state    <- state * 6364136223846793005 + 1442695040888963407   (mod 2^64)
 *     output    = the low 32 bits of ((state ^ state >> 18) >> 27), turned right by state >> 59,
 *
 * the output being that of the state before the step. The seed is spread over the 64 bits of the
 * first state by one step of SplitMix64 (Steele, Lea, Flood 2014), for neighbouring seeds to have
 * nothing in common. The same seed gives the same numbers on every target; SPEC.md relies on it. */
#ifndef RLVC_SRC_RNG_H
#define RLVC_SRC_RNG_H

#include <stdint.h>

typedef struct rlvc_rng {
    uint64_t state;
} rlvc_rng;

void rlvc_rng_seed(rlvc_rng *rng, uint32_t seed);

/* 32 random bits. */
uint32_t rlvc_rng_next(rlvc_rng *rng);

/* [0, 1), a multiple of 2^-24. */
float rlvc_rng_uniform(rlvc_rng *rng);

/* [0, bound), bound >= 1: the high half of bound * next. One draw always, at the price of a bias of
 * at most bound / 2^32 of a number's probability. */
uint32_t rlvc_rng_below(rlvc_rng *rng, uint32_t bound);

#endif
