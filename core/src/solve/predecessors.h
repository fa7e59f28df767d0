/* SPDX-License-Identifier: MIT */
/* Who leads to a class, for prioritized sweeping (value_iteration.h): the model's transitions,
 * turned round.
 *
 * Where several interactions were counted to one transition, the sample array has room behind the
 * model's E transitions (model.h). There lie, if they fit, for C classes:
 *
 *     [E, 2E)      {key: a class c, slot: the bits of gamma n(c, a, c') / n(c, a)}, grouped by c'
 *     [2E, 2E + C) {key: begin, slot: end} of the group of each c'
 *
 * A change of V(c') by d changes Q(c, a) by that number times d. */
#ifndef RLVC_SRC_PREDECESSORS_H
#define RLVC_SRC_PREDECESSORS_H

#include "../samples/sort.h"
#include "../tree/values.h"

typedef struct rlvc_predecessors {
    uint32_t at;    /* class or transition */
    uint32_t pair;  /* of the transition */
    uint32_t place; /* entries given out so far */
    uint8_t phase;
    uint8_t done;
} rlvc_predecessors;

/* What does not change meanwhile. */
typedef struct rlvc_turning {
    const rlvc_values *values;
    rlvc_sample *sample;
    uint32_t classes;
    uint32_t transitions; /* E */
    float discount;
} rlvc_turning;

/* Is there room in an array of so many samples? O(1). */
static inline int rlvc_predecessors_fit(uint32_t transitions, uint32_t classes, uint32_t slots) {
    return 2u * (uint64_t)transitions + classes <= slots;
}

/* The group of a class: entries [key, slot) of the array. O(1). */
static inline const rlvc_sample *rlvc_predecessors_of(const rlvc_sample *sample,
                                                      uint32_t transitions, uint32_t class_id) {
    return sample + 2u * (size_t)transitions + class_id;
}

void rlvc_predecessors_begin(rlvc_predecessors *predecessors);

/* Takes one elementary step: a unit. There are two for each class and transition, and one for each
 * pair. Not to be called when done, nor unless they fit. O(1). */
void rlvc_predecessors_step(rlvc_predecessors *predecessors, const rlvc_turning *turning);

#endif
