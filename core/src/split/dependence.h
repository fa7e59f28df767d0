/* SPDX-License-Identifier: MIT */
/* Dependence: whether the samples of a class are worth as many independent ones.
 *
 * What a feature and the targets have in common is the sum over the samples, in order of time, of
 *
 *     u = (x - mean of x after the action) (z - mean of z after the action where x is the same),
 *
 * x being the presence of the feature and z the target. A real difference of the targets is in the
 * means. What is left has a mean of 0, and if feature and targets have nothing to do with each
 * other, the variance of its sum is that of as many independent terms times the design effect
 *
 *     1 + 2 (r1 + r2 + ...),
 *
 * rk being the correlation of two terms k visits of the class apart (Bartlett 1935): a statistic is
 * worth that many times less (Rao and Scott 1981). It is above 1 only where both stay for a while.
 * A feature drawn anew at each percept has an effect of 1, whatever the targets do, and so has
 * any feature where the targets are drawn anew, or where it explains them.
 *
 * r1 and r2 are measured. What follows is assumed to fall off by the factor f: r2 / r1 if r1 is
 * above 0 by three standard errors, else r1. Two of them tell a slow drift beneath much noise from
 * a quick one: 1 + 2 r1 / (1 - f). */
#ifndef RLVC_SRC_DEPENDENCE_H
#define RLVC_SRC_DEPENDENCE_H

#include "split_search.h"

typedef struct rlvc_dependence {
    uint32_t at;     /* position in the ring */
    uint32_t count;  /* samples so far of the second time */
    float before[2]; /* u of the last two */
    float sum[3];    /* of u times itself, the one before, and the one before that */
    uint8_t wanted;  /* whether a split depends on it */
    uint8_t again;   /* the second time, for u; the first is for the means */
} rlvc_dependence;

/* Begins. O(1). */
void rlvc_dependence_begin(rlvc_dependence *dependence);

/* Whether it has been through the ring's positions below `end` twice. O(1). */
static inline int rlvc_dependence_done(const rlvc_dependence *dependence, uint32_t end) {
    return dependence->again && dependence->at == end;
}

/* What a position of the ring is charged: two divisions and more arithmetic, where other units but
 * look. */
#define RLVC_DEPENDENCE_UNITS 8u

/* Goes through the ring's positions below `end`, twice, as far as the budget goes; *used becomes
 * the work. What the search of the class had in the workspace is lost but for its
 * result.
 * @return RLVC_OK; RLVC_E_CALLBACK: try that callback again by calling again. */
rlvc_status rlvc_dependence_step(rlvc_dependence *dependence, const rlvc_split_input *input,
                                 uint32_t class_id, const void *feature, uint32_t budget,
                                 uint32_t *used);

/* Once done: the design effect, at least 1. O(1). */
float rlvc_dependence_effect(const rlvc_dependence *dependence);

#endif
