/* SPDX-License-Identifier: MIT */
#ifndef RLVC_SRC_RNG_H
#define RLVC_SRC_RNG_H
#include <stdint.h>
/* PCG-XSH-RR 64/32 */
typedef struct rlvc_rng { uint64_t state; } rlvc_rng;
void rlvc_rng_seed(rlvc_rng *rng, uint32_t seed);
uint32_t rlvc_rng_next(rlvc_rng *rng);
float rlvc_rng_uniform(rlvc_rng *rng);                  /* [0, 1), 24 bits */
uint32_t rlvc_rng_below(rlvc_rng *rng, uint32_t bound); /* [0, bound), by multiply-shift: one draw */
#endif
