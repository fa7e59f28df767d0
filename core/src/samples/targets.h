/* SPDX-License-Identifier: MIT */
/* The aliasing criterion (section 4.2.2): the target of each sample.
 *
 * A class is aliased if, after the same action, its percepts have different targets. The target of
 * the interaction at time t is
 *   returns    R_t^k, where it is defined (definitions 1 and 2);
 *   residual   r_{t+1} + gamma V(C(s_{t+1})), and r_{t+1} alone where the episode terminated: the
 *              right-hand side of Bellman's equation (2) for the sample.
 * For returns, targets are compared exactly. Under the residual criterion V is only known within
 * the solver's tolerance, so that targets closer than twice the tolerance count as equal. */
#ifndef RLVC_SRC_TARGETS_H
#define RLVC_SRC_TARGETS_H

#include "returns.h"
#include "../tree/values.h"

/* A third kind of key besides the two criteria: the class of s', by which the model counts
 * transitions. RLVC_NO_CLASS where the episode terminated. */
#define RLVC_TARGET_SUCCESSOR 2u

typedef struct rlvc_target_input {
    rlvc_return_input returns; /* the database, and the window for RLVC_CRITERION_RETURNS */
    const rlvc_values *values;
    float gap;    /* targets of one cluster are within this: 0 for returns, else 2 * tolerance */
    uint8_t kind; /* RLVC_CRITERION_* or RLVC_TARGET_SUCCESSOR */
} rlvc_target_input;

/* The key of one sample, in slices. */
typedef struct rlvc_target_cursor {
    rlvc_return_cursor window;
    uint32_t key; /* the result ... */
    uint8_t defined;
    uint8_t done;
} rlvc_target_cursor;

void rlvc_target_begin(rlvc_target_cursor *target, uint32_t position);

/* Works out whether the slot at window.position is a sample, and its key.
 * @return the work, at most budget (>= 1): one unit, or that of rlvc_return_step for returns. */
uint32_t rlvc_target_step(rlvc_target_cursor *target, const rlvc_target_input *input,
                          uint32_t budget);

/* The key of the interaction in a slot, where that needs no window: not for RLVC_CRITERION_RETURNS.
 * O(1). */
uint32_t rlvc_target_key_at(const rlvc_target_input *input, uint32_t slot);

/* Keys order as targets do. -0 and +0 have the same. O(1). */
uint32_t rlvc_target_key(float target);
float rlvc_target_of(uint32_t key);

/* Do two keys, the lower of which is the lowest of its cluster, stand for distinct targets? O(1).
 */
int rlvc_target_distinct(const rlvc_target_input *input, uint32_t lowest, uint32_t key);

#endif
