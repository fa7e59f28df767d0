/* SPDX-License-Identifier: MIT */
/* Grouping the database by class and action, with a key for each sample.
 *
 * A counting sort from the ring: afterwards the samples of the pair (c, a) are sample[first[p]] to
 * sample[first[p + 1] - 1] with p = c * actions + a, in order of time. */
#ifndef RLVC_SRC_GROUPING_H
#define RLVC_SRC_GROUPING_H

#include "targets.h"

typedef struct rlvc_grouping_cursor {
    rlvc_target_cursor target;
    uint32_t at; /* position in the ring, or pair */
    uint32_t pairs;
    uint8_t phase;
    uint8_t done;
} rlvc_grouping_cursor;

void rlvc_grouping_begin(rlvc_grouping_cursor *grouping, uint32_t pairs);

/* @param sample [capacity + 1]
 * @param first  [pairs + 1]
 * @return the work, at most budget (>= 1): a unit for each pair three times over, and two for each
 *         interaction (for returns twice rlvc_return_step). */
uint32_t rlvc_grouping_step(rlvc_grouping_cursor *grouping, const rlvc_target_input *input,
                            rlvc_sample *sample, uint32_t *first, uint32_t budget);

/* How far the cursor has come, for a snapshot: the same only for the same state on the same
 * input. */
void rlvc_grouping_mark(const rlvc_grouping_cursor *grouping, uint32_t word[4]);

#endif
