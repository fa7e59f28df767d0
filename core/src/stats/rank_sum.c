/* SPDX-License-Identifier: MIT */
/* The rank-sum test: see rank_sum.h. The sums are exact integers; floats only put the statistic
 * together. So columns that differ by exchanged samples of one cluster, or that are each other's
 * complement, have the same statistic to the last bit. */
#include "rlvc/float_rules.h"

#include "rank_sum.h"

#include "../base/assert.h"
#include "../base/popcount.h"
#include "../base/float_math.h"
#include "score.h"

static uint64_t cube(uint32_t t) {
    return (uint64_t)t * t * t;
}

void rlvc_rank_sum_add(rlvc_rank_sum *ranks, uint32_t at, uint32_t column, uint32_t cuts) {
    uint32_t inside = ranks->inside;
    while (cuts != 0) {
        if (cuts & 1u) {
            ranks->sum += (uint64_t)inside * (ranks->begin + at);
            ranks->cubes += cube(at - ranks->begin);
            ranks->begin = at;
            inside = 0;
        }
        inside += column & 1u;
        column >>= 1;
        cuts >>= 1;
        at++;
    }
    const uint64_t rest = column;
    ranks->inside = inside + rlvc_popcount(&rest, 1);
}

float rlvc_rank_sum_statistic(rlvc_rank_sum *ranks, uint32_t present, uint32_t count) {
    RLVC_ASSERT(present > 0 && present < count && count <= RLVC_RANK_SUM_MAX);
    rlvc_rank_sum_add(ranks, count, 0, 1); /* the last cluster ends */
    const uint32_t absent = count - present;
    const int32_t more = (int32_t)(present - absent);
    const uint64_t all = cube(count);
    float v = (float)((uint64_t)present * absent) * (float)(all - ranks->cubes) /
              (float)(3u * (uint64_t)count * (count - 1u));
    float tau = (float)ranks->cubes / (float)all;
    float square = (float)((int64_t)more * more + 1) * tau;
    float deviation = (float)(int64_t)(ranks->sum - (uint64_t)present * count);
    float x = rlvc_sqrt(square) * rlvc_float_of(rlvc_bits_of(deviation) & 0x7fffffffu);
    return 2.0f * rlvc_excess(v + x, v, x, v + x + v) / square;
}
