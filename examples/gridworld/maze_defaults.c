/* SPDX-License-Identifier: MIT */
/* Defaults found by trial.
 *
 * The published criterion asks for the same evidence from every feature. By residuals the defaults
 * are the library's, for a maze of any size, with or without slip. A learning step after every 100
 * interactions is soon enough; of many interactions, after every hundredth part of them. A class
 * needs eight interactions, so that no more classes than that can come up. An incremental solver
 * forgets at its learning rate, so it needs more interactions, and more of them along its
 * policy. */
#include "maze_defaults.h"

#define STEP_INTERACTIONS 100u
#define STEPS_MAX 100u
#define CLASS_INTERACTIONS 8u
#define CLASSES_MIN 64u
#define CLASSES_MAX 65535u

static const gridworld_defaults published = {10000, 20, 0, 0.8f, 0.05f, 0.0001f, 0};
static const gridworld_defaults by_residuals = {5000, 0, 0, 0.9f, 0.01f, 0.1f, 1};
static const gridworld_defaults incremental = {20000, 0, 0, 0.3f, 0.01f, 0.1f, 1};

static uint32_t within(uint32_t low, uint32_t x, uint32_t high) {
    const uint32_t least = x < low ? low : x;
    return least > high ? high : least;
}

gridworld_defaults gridworld_defaults_for(const gridworld_learner *learner) {
    gridworld_defaults defaults = learner->returns       ? published
                                  : learner->incremental ? incremental
                                                         : by_residuals;
    if (learner->interactions > 0) {
        defaults.interactions = learner->interactions;
    }
    if (!learner->returns) {
        defaults.steps = within(1, defaults.interactions / STEP_INTERACTIONS, STEPS_MAX);
    }
    defaults.classes = within(CLASSES_MIN, defaults.interactions / CLASS_INTERACTIONS, CLASSES_MAX);
    return defaults;
}
