/* SPDX-License-Identifier: MIT */
/* A learning step's phases, and their inputs: see learn.c. */
#ifndef RLVC_SRC_LEARN_H
#define RLVC_SRC_LEARN_H

#include "state.h"

/* learner.phase. A snapshot holds these numbers (SPEC.md). */
enum {
    RLVC_PHASE_IDLE,
    RLVC_PHASE_LABEL,
    RLVC_PHASE_COPY_VALUES,
    RLVC_PHASE_MODEL,
    RLVC_PHASE_SOLVE,
    RLVC_PHASE_NOVELTY,
    RLVC_PHASE_GROUP,
    RLVC_PHASE_SEARCH,
    RLVC_PHASE_SUCCESSORS,
    RLVC_PHASE_FINISH
};

/* A phase that looks for splits, class by class? */
static inline int rlvc_phase_splits(uint8_t phase) {
    return phase == RLVC_PHASE_SEARCH || phase == RLVC_PHASE_SUCCESSORS;
}

/* Keys of the step's samples. @param kind RLVC_CRITERION_* or RLVC_TARGET_SUCCESSOR */
rlvc_target_input rlvc_learner_target_input(const rlvc_agent *agent, uint8_t kind);

/* What a search of the step looks at. */
rlvc_split_input rlvc_learner_split_input(const rlvc_agent *agent,
                                          const rlvc_target_input *criterion);

/* Takes what was found in class `at`, its feature or null, and carries the split out if it is
 * significant. The features of the tree are compared with it some at a time: the class is done once
 * `at` is the next one.
 * @return the units used */
uint32_t rlvc_learner_decide(rlvc_agent *agent, rlvc_split *split, const void *feature);

/* What a solution of the step looks at. */
rlvc_solver_input rlvc_learner_solver_input(const rlvc_agent *agent);

#endif
