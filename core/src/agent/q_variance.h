/* SPDX-License-Identifier: MIT */
/* The variance of Q(c, a), the mean of a class-action pair's targets: from the spread of the
 * targets r + gamma V(C(s')) in the ring. Interactions that no learning step has labelled yet are
 * left out.
 *
 * The samples of one trajectory are not independent, and V is common to them: the
 * standard errors assume that they are, and so are rather too small. */
#ifndef RLVC_SRC_Q_VARIANCE_H
#define RLVC_SRC_Q_VARIANCE_H

#include "../samples/replay.h"
#include "../tree/values.h"

typedef struct rlvc_q_variance {
    float *squares;  /* [classes * actions] the sum of (target - Q)^2 */
    uint32_t *count; /* [classes * actions] targets in it */
} rlvc_q_variance;

/* Fills both tables. O(slots + classes * actions). */
void rlvc_q_variance_measure(const rlvc_q_variance *variance, const rlvc_replay *replay,
                             const rlvc_values *values, float discount, uint32_t classes);

/* The square of the standard error of Q of a pair with samples: sum of squares / n^2. O(1). */
static inline float rlvc_q_variance_of(const rlvc_q_variance *variance, size_t pair) {
    const float n = (float)variance->count[pair];
    return variance->squares[pair] / n / n;
}

#endif
