/* SPDX-License-Identifier: MIT */
/* The best cutpoint of one presence column (section 4.2.3). */
#ifndef RLVC_SRC_CUTPOINT_H
#define RLVC_SRC_CUTPOINT_H
#include <stdint.h>

typedef struct rlvc_cut {
    float score;            /* -1 if there is none */
    uint32_t below;         /* samples [0, below) are below the cutpoint */
    uint32_t present_below; /* how many of these exhibit the feature */
    uint32_t present;       /* how many of all do */
} rlvc_cut;

typedef struct rlvc_scan {
    rlvc_cut best;
    uint8_t done;
} rlvc_scan;

/* column: bit i is 1 if sample i (by ascending target) exhibits the feature; bits count and above are 0.
 * cuts: bit i (i >= 1) is 1 if samples i-1 and i have distinct targets, i.e. `below = i` is a cutpoint.
 * Finds the first (lowest `below`) cutpoint of the highest score if that is > beat; else best.score = -1. */
void rlvc_scan_begin(rlvc_scan *scan, const uint64_t *column, const uint64_t *cuts, uint32_t count,
                     uint8_t score_kind, float beat);
uint32_t rlvc_scan_step(rlvc_scan *scan, uint32_t budget);
#endif
