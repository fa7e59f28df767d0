/* SPDX-License-Identifier: MIT */
/* How a maze is learnt unless one says otherwise: by run_gridworld, and in the playground's page.
 * No default depends on the maze. */
#ifndef GRIDWORLD_MAZE_DEFAULTS_H
#define GRIDWORLD_MAZE_DEFAULTS_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* What they depend on. */
typedef struct gridworld_learner {
    int returns;           /* RLVC_CRITERION_RETURNS, as published; else RLVC_CRITERION_RESIDUAL */
    int incremental;       /* RLVC_SOLVER_Q_LEARNING or RLVC_SOLVER_SARSA; else a batch solver */
    uint32_t interactions; /* as one says; 0: the default */
} gridworld_learner;

typedef struct gridworld_defaults {
    uint32_t interactions; /* returns: of each step; residual: of the whole run */
    uint32_t steps;        /* of learning; residual: spread evenly over the interactions */
    uint32_t classes;
    float epsilon, alpha, alpha_known;
    int successors;
} gridworld_defaults;

/* The defaults for a learner. The ring holds all interactions (of a step). O(1). */
gridworld_defaults gridworld_defaults_for(const gridworld_learner *learner);

#ifdef __cplusplus
}
#endif

#endif
