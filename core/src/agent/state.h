/* SPDX-License-Identifier: MIT */
/* The state of an agent of classes: everything that lies in the caller's block. */
#ifndef RLVC_SRC_STATE_H
#define RLVC_SRC_STATE_H

#include "../solve/model.h"
#include "../base/method.h"
#include "../base/rng.h"
#include "../explore/novelty.h"
#include "../solve/value_iteration.h"
#include "../base/solver_select.h"
#include "../split/split_search.h"
#include "../split/dependence.h"
#include "../split/successor_search.h"
#include "../tree/tree.h"

/* learner.searching, as snapshots have it. */
#define RLVC_SEARCHING 1u
#define RLVC_GROWING 5u /* the split that was found is being made */

/* A learning step under way: see learn.c. */
typedef struct rlvc_learner {
    union {
        rlvc_grouping_cursor grouping;
        rlvc_split_cursor split;
        rlvc_successor_cursor successors;
        rlvc_model_cursor model;
        rlvc_solver_cursor solver;
        rlvc_novelty_cursor novelty;
    } work;       /* of the phase */
    uint32_t end; /* N: interactions at positions [0, end) are the database */
    uint32_t at;  /* position, pair or class, by phase */
    union {
        uint32_t node; /* LABEL: where the walk of the percept at position `at` is; RLVC_GROWING:
                          where that to the leaf of class `at` is */
        uint32_t
            compared; /* a search: how many of the tree's features the new one was compared with */
    } walk;
    rlvc_dependence dependence; /* SEARCH: of what was found in class `at` */
    uint32_t classes;           /* when this phase began */
    uint32_t rounds;            /* begun in this step */
    uint32_t splits;            /* made in this step */
    uint32_t made;              /* made in this round */
    uint32_t influenced;        /* SUCCESSORS: features in the workspace's block */
    uint8_t phase;
    uint8_t searching; /* RLVC_SEARCHING, RLVC_GROWING, or 0: class `at` was not begun */
    uint8_t failed;    /* the last call of rlvc_learn did */
} rlvc_learner;

struct rlvc_agent { /* first what is used most: Thumb's short instructions reach 128 bytes */
    rlvc_config config;
    rlvc_tree tree;
    rlvc_domain domain;
    rlvc_replay replay;
    rlvc_values values;
    rlvc_explorer explorer;
    rlvc_workspace space;
    rlvc_learner learner;
    rlvc_rng rng;
    uint64_t interactions;
    uint16_t *pending;   /* [classes] the class that a split of this round made from one, or 0 */
    uint32_t step;       /* k */
    uint32_t run;        /* greedy actions that the present run of exploitation still has to take */
    uint32_t last_split; /* the step of the newest split */
    uint32_t refused;
    uint32_t sweeps; /* of the last solution */
    float residual;
    uint8_t busy; /* a callback is being called */
};

static inline int rlvc_is_incremental(const rlvc_config *config) {
    return (RLVC_HAS_SOLVER(RLVC_SOLVER_Q_LEARNING) && config->solver == RLVC_SOLVER_Q_LEARNING) ||
           (RLVC_HAS_SOLVER(RLVC_SOLVER_SARSA) && config->solver == RLVC_SOLVER_SARSA);
}

#endif
