/* SPDX-License-Identifier: MIT */
/* The value gate: see gate.h. */
#include "gate.h"

#include "../base/float_math.h"
#include <string.h>

/* What is not known may be as far off as this. */
#define UNKNOWN 3e38f
/* Variances below are rounding. */
#define NO_VARIANCE 1e-30f

void rlvc_gate_begin(rlvc_gate *gate, const void *feature) {
    memset(gate, 0, sizeof *gate);
    gate->feature = feature;
    gate->most[0] = -UNKNOWN;
    gate->most[1] = -UNKNOWN;
    gate->highest = -UNKNOWN;
}

void rlvc_gate_add(rlvc_gate *gate, float target, uint32_t present) {
    rlvc_side *side = &gate->side[present];
    if (side->off.weight == 0)
        side->first = target;
    float off = target - side->first;
    rlvc_sum_add(&side->off, off, 1);
    side->squares += off * off;
}

int rlvc_gate_close(rlvc_gate *gate, uint32_t min_samples, float gap) {
    float upper[2], sum = 0.0f, all = 0.0f;
    for (uint32_t s = 0; s < 2u; s++) {
        const rlvc_side *side = &gate->side[s];
        float n = (float)side->off.weight, off = rlvc_sum_mean(&side->off);
        float mean = side->first + off, reach = UNKNOWN;
        if (side->off.weight >= min_samples) {
            float variance = (side->squares / n - off * off) / n;
            reach = variance < NO_VARIANCE ? 0.0f : RLVC_GATE_DEVIATIONS * rlvc_sqrt(variance);
        }
        if (mean - reach > gate->most[s])
            gate->most[s] = mean - reach;
        upper[s] = mean + reach;
        sum += mean * n;
        all += n;
    }
    if (sum / all > gate->highest) { /* not of an action never taken, which is 0 / 0 */
        gate->highest = sum / all;
        memcpy(gate->enough, upper, sizeof upper);
    }
    memset(gate->side, 0, sizeof gate->side);
    return gate->most[0] - gate->enough[0] > gap || gate->most[1] - gate->enough[1] > gap;
}
