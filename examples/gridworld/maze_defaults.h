/* SPDX-License-Identifier: MIT */
/* How a maze is learnt unless one says otherwise: by run_gridworld, and in the playground's page.
 */
#ifndef GRIDWORLD_MAZE_DEFAULTS_H
#define GRIDWORLD_MAZE_DEFAULTS_H

#include "gridworld.h"

#ifdef __cplusplus
extern "C" {
#endif

/* What they depend on, beside the maze. */
typedef struct gridworld_learner {
    int returns;     /* RLVC_CRITERION_RETURNS, as published; else RLVC_CRITERION_RESIDUAL */
    int incremental; /* RLVC_SOLVER_Q_LEARNING or RLVC_SOLVER_SARSA; else a batch solver */
    uint32_t distractors;
    float slip;
} gridworld_learner;

typedef struct gridworld_defaults {
    uint32_t interactions; /* returns: of each step; residual: of the whole run */
    uint32_t steps;        /* of learning; residual: spread evenly over the interactions */
    uint32_t capacity;     /* of the ring at most; 0: all interactions */
    uint32_t classes;
    float epsilon, alpha, alpha_known;
    int successors;
} gridworld_defaults;

/* The defaults for a maze. O(1). */
gridworld_defaults gridworld_defaults_for(const gridworld_maze *maze,
                                          const gridworld_learner *learner);

#ifdef __cplusplus
}
#endif

#endif
