/* SPDX-License-Identifier: MIT */
/* Bytes, CRC, random numbers and arithmetic, of any arguments that their headers allow. */
#include "any.h"
#include "base/arena.h"
#include "base/bytes.h"
#include "base/crc.h"
#include "base/float_math.h"
#include "base/mean.h"
#include "base/popcount.h"
#include "base/rng.h"
#include "rlvc/status.h"

static unsigned char bytes[64];

int eva_base(void) {
    rlvc_rng rng;
    volatile float real;
    volatile uint32_t number;
    any_bytes(bytes, sizeof bytes);
    number = rlvc_crc(any_in(0, UINT32_MAX), bytes, any_in(0, sizeof bytes));
    number = (uint32_t)rlvc_get(bytes, any_in(1, 8));
    rlvc_put(bytes, number, any_in(1, 8));
    rlvc_rng_seed(&rng, any_in(0, UINT32_MAX));
    number = rlvc_rng_next(&rng);
    number = rlvc_rng_below(&rng, any_in(1, UINT32_MAX));
    real = rlvc_rng_uniform(&rng);
    real = rlvc_ln(any_real(1e-45f, 3e38f));
    real = rlvc_ln_1_minus(any_real(0.0f, 0.99f));
    real = rlvc_exp(any_real(-1000.0f, 80.0f));
    real = rlvc_sqrt(any_real(0.0f, 3e38f));
    number = rlvc_arena_check(bytes, any_in(0, 64), any_in(0, 64)) == RLVC_OK;
    number = (uint32_t)(rlvc_status_text((rlvc_status)(-(int)any_in(0, 100))) != 0);
    return 0;
}
