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
    RLVC_PHASE_FINISH,
    RLVC_PHASE_INFLUENCE /* before SUCCESSORS */
};

/* A phase that looks for splits, class by class, or (INFLUENCE) for what is influenced? */
static inline int rlvc_phase_splits(uint8_t phase) {
    return phase >= RLVC_PHASE_SEARCH && phase != RLVC_PHASE_FINISH;
}

/* Keys of the step's samples. @param kind RLVC_CRITERION_* or RLVC_TARGET_SUCCESSOR */
rlvc_target_input rlvc_learner_target_input(const rlvc_agent *agent, uint8_t kind);

/* What a search of the step looks at. */
rlvc_split_input rlvc_learner_split_input(const rlvc_agent *agent,
                                          const rlvc_target_input *criterion);

/* Takes what was found in class `at`, its feature or null, and carries the split out if it is
 * significant. The features of the tree are compared with it some at a time, and some nodes are
 * gone down to the class's leaf: the class is done once `at` is the next one.
 * @return the units used */
uint32_t rlvc_learner_decide(rlvc_agent *agent, rlvc_split *split, const void *feature);

/* Measures how far samples depend on each other by the feature that the search found in class `at`,
 * as far as the budget goes: see dependence.h.
 * @return RLVC_OK; RLVC_E_CALLBACK. */
rlvc_status rlvc_learner_weigh_dependence(rlvc_agent *agent, const void *feature, uint32_t budget,
                                          uint32_t *used);

/* Once that is measured, and not before: has the p-values take it into account. RLVC_TEST_UNITS.
 * @return 1 if it did so now. */
int rlvc_learner_discount(rlvc_agent *agent);

/* ln of the level at which a feature new to the tree splits a class in this step, or counts as
 * influenced: its share of alpha. O(1). */
float rlvc_learner_log_level(const rlvc_agent *agent);

/* Begins the search of the phase, in class `at` or, of INFLUENCE, in all. O(actions). */
void rlvc_learner_begin_search(rlvc_agent *agent);

/* What a solution of the step looks at. */
rlvc_solver_input rlvc_learner_solver_input(const rlvc_agent *agent);

#endif
