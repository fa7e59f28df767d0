/* SPDX-License-Identifier: MIT */
/* Runs of equal targets: see runs.h. Samples are sorted by their targets, action by
 * action. */
#include "rlvc/float_rules.h"

#include "runs.h"

uint32_t rlvc_scatter(uint32_t x) {
    x = (x ^ x >> 16) * 0x45d9f3bu;
    x = (x ^ x >> 16) * 0x45d9f3bu;
    return x ^ x >> 16;
}

static int begins_run(const rlvc_samples *samples, uint32_t i) {
    return i == 0 || samples->sample[i].key != samples->sample[i - 1u].key;
}

uint32_t rlvc_run_end(const rlvc_samples *samples, uint32_t begin) {
    uint32_t at = begin + 1u;
    while (at < samples->count && !begins_run(samples, at))
        at++;
    return at;
}

uint32_t rlvc_runs_count(const rlvc_samples *samples) {
    uint32_t runs = 0;
    for (uint32_t i = 0; i < samples->count; i++)
        runs += (uint32_t)begins_run(samples, i);
    return runs;
}

void rlvc_runs_find(const rlvc_samples *samples, uint32_t runs, uint32_t i, uint32_t of,
                    uint32_t run[2]) {
    uint32_t at = 0;
    for (uint32_t left = 1u + (runs < of ? i % runs : (uint32_t)((uint64_t)i * runs / of));
         left > 0; at++)
        left -= (uint32_t)begins_run(samples, at);
    run[0] = at - 1u;
    run[1] = rlvc_run_end(samples, run[0]);
}
