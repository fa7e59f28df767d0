/* SPDX-License-Identifier: MIT */
/* Persistence: how long a feature stays as it is, from one visit to a class to the next.
 *
 * If its presence is a Markov chain that changes with the probability p when absent and q when
 * present, two visits that follow each other have the correlation r = 1 - p - q, and k visits apart
 * r^k. If presence and targets have nothing to do with each other, but both stay for a while, then
 * what they seem to have in common varies as if there were fewer samples: if r > 0, and the
 * correlations of the targets are at most 1, by at most the factor (Bartlett 1935)
 *
 *     1 + 2 (r + r^2 + ...)  =  (1 + r) / (1 - r)  =  (2 - p - q) / (p + q),
 *
 * the design effect, by which a statistic is divided (Rao and Scott 1981). A feature drawn anew at
 * each percept has r = 0 and an effect of 1, whatever the targets do. */
#ifndef RLVC_SRC_PERSISTENCE_H
#define RLVC_SRC_PERSISTENCE_H

#include "../samples/replay.h"

typedef struct rlvc_persistence {
    uint32_t at;          /* position in the ring */
    uint32_t count[2][2]; /* pairs of samples: absent or present, then absent or present */
    uint8_t wanted;       /* whether a split depends on it */
    uint8_t any;          /* there was a sample */
    uint8_t last;         /* that exhibited the feature */
} rlvc_persistence;

/* Begins. O(1). */
void rlvc_persistence_begin(rlvc_persistence *persistence);

/* Counts in positions [at, end) of the ring, as far as the budget goes, a unit each; *used becomes
 * the work.
 * @return RLVC_OK; RLVC_E_CALLBACK: try that callback again by calling again. */
rlvc_status rlvc_persistence_step(rlvc_persistence *persistence, const rlvc_replay *replay,
                                  const rlvc_domain *domain, uint32_t end, uint32_t class_id,
                                  const void *feature, uint32_t budget, uint32_t *used);

/* The design effect, at least 1. O(1). */
float rlvc_persistence_effect(const rlvc_persistence *persistence);

#endif
