/* SPDX-License-Identifier: MIT */
/* The value gate: would a split raise the estimated return, and not only the likelihood of the
 * targets?
 *
 * A feature parts the samples of a class into two sides, s = 0 without and s = 1 with it. Of the n
 * targets after action a on side s let m(a, s) be the mean, and e(a, s) its standard error, the
 * square of which is
 *
 *     e^2 = (sum of (target - m)^2 / n) / n.
 *
 * g is the action with the greatest mean over both sides, the greedy one of the class as it is. A
 * split raises the return by what another action is worth more than g on one side. As that action
 * is chosen for it, and means vary, there always seems to be one, even where all actions are worth
 * the same. So not means are compared but what they are sure to be, RLVC_GATE_DEVIATIONS standard
 * errors off: the split passes if on some side s
 *
 *     max over a of (m(a, s) - 2 e(a, s))  >  m(g, s) + 2 e(g, s) + gap,
 *
 * where the gap is what the solver's values are sure to. An action with fewer than min_samples on a
 * side does not count there: its spread is not known. */
#ifndef RLVC_SRC_GATE_H
#define RLVC_SRC_GATE_H

#include "../base/mean.h"

#define RLVC_GATE_DEVIATIONS 2.0f

/* The targets of one action on one side, as differences from the first of them, so that a mean far
 * from 0 costs no digits of the spread. */
typedef struct rlvc_side {
    rlvc_sum off;
    float squares;
    float first;
} rlvc_side;

typedef struct rlvc_gate {
    const void *feature;
    rlvc_side side[2]; /* of the action at work */
    float most[2];     /* the greatest m - 2 e so far */
    float enough[2];   /* m(g, s) + 2 e(g, s) */
    float highest;     /* the mean of g over both sides */
} rlvc_gate;

/* Begins with the first action. O(1). */
void rlvc_gate_begin(rlvc_gate *gate, const void *feature);

/* Adds a sample of the action at work. O(1).
 * @param present 1 if it exhibits the feature, else 0 */
void rlvc_gate_add(rlvc_gate *gate, float target, uint32_t present);

/* Ends the action at work and begins with the next. O(1).
 * @return 1 if the split passes, as far as the actions so far tell; else 0. */
int rlvc_gate_close(rlvc_gate *gate, uint32_t min_samples, float gap);

#endif
