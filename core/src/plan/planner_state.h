/* SPDX-License-Identifier: MIT */
/* What a planner's block holds. */
#ifndef RLVC_SRC_PLANNER_STATE_H
#define RLVC_SRC_PLANNER_STATE_H

#include "../base/method.h"
#include "../tree/tree.h"
#include "archive.h"
#include "search.h"
#include "rlvc/planner.h"
#include "rlvc/thresholds.h"

#define RLVC_PLANNER_STARTS 128u /* first percepts that are remembered */

typedef struct rlvc_acting {
    rlvc_small_tree tree;
    uint32_t trial;  /* the archive's, where it is one, */
    uint32_t serial; /* and still is the same */
    uint8_t why;     /* RLVC_PLANNER_RANDOM, ... */
} rlvc_acting;

/* One step of learning: which policy acts in the next episode. */
typedef struct rlvc_planning_cursor {
    rlvc_dynamics_fit_cursor fit;
    rlvc_search_cursor search;
    rlvc_rollout rollout;
    rlvc_small_tree candidate; /* the best of this step's searches */
    float candidate_value;
    float value_sum;
    uint32_t policy; /* whose promises are being made */
    uint32_t episode;
    uint32_t at;
    uint32_t tries;  /* searches from nothing to come */
    uint32_t model;  /* that is being fitted */
    uint8_t derives; /* the search began at the best policy */
    uint8_t derived; /* so did the one that made the candidate */
    uint8_t rolling;
    uint8_t rolled; /* models that the episode was rolled out in */
    uint8_t phase;
} rlvc_planning_cursor;

typedef struct rlvc_planner {
    rlvc_config config; /* first: see ../base/method.h */
    rlvc_domain domain;
    rlvc_tree tree;       /* the learnt policy where it was last asked for, */
    uint8_t *tree_action; /* [RLVC_PLANNER_LEAVES_MAX] and the actions of its classes */
    uint32_t components;
    rlvc_experience experience;
    rlvc_row_sample sample;
    rlvc_dynamics model[RLVC_ROLLOUT_MODELS];
    rlvc_archive archive;
    rlvc_planning_cursor planning;
    rlvc_acting acting;
    rlvc_acting next; /* from the next episode on */
    rlvc_rng rng;     /* of acting */
    float *start;     /* [RLVC_PLANNER_STARTS][components] */
    float *
        common; /* [RLVC_PLANNER_STARTS][components] of the last fit: where promises are compared */
    float *search_start; /* [RLVC_SEARCH_STARTS][components] */
    float *now;          /* [components] the episode's first percept */
    uint8_t *cells;      /* visited */
    uint8_t *fresh;      /* and in the rollouts of a candidate */
    uint32_t cells_bytes;
    uint32_t starts; /* ever; from RLVC_PLANNER_STARTS on, that and the remainder */
    uint32_t commons;
    uint32_t steps; /* of the episode */
    float earned;   /* in the episode */
    float least;    /* returns so far */
    float most;
    uint32_t episodes;  /* that ended */
    uint32_t longest;   /* truncated episode */
    uint32_t fitted;    /* interactions at the last fit; 0: none. With those at UINT32_MAX, this and
                           searched go down instead */
    uint32_t explored;  /* interactions spent on exploring */
    uint32_t new_cells; /* in the episode that explores */
    uint32_t counter;   /* steps of learning, modulo 2^32: each has seeds of its own */
    uint32_t searched;  /* interactions at the last search */
    uint32_t failures;  /* searches without gain in a row */
    uint32_t fits;
    uint32_t searches;
    uint32_t candidates;
    uint8_t gainful;  /* exploring still finds something */
    uint8_t open;     /* an episode is under way */
    uint8_t due;      /* an episode ended since the last step of learning */
    uint8_t learning; /* a step is under way */
    uint8_t busy;     /* a callback is being called */
} rlvc_planner;

/* Counts what may go on for years: at most UINT32_MAX of it. */
static inline void rlvc_planner_count(uint32_t *counter, uint32_t more) {
    *counter += more < UINT32_MAX - *counter ? more : UINT32_MAX - *counter;
}

static inline uint32_t rlvc_planner_components(const rlvc_domain *domain) {
    return domain->percept_bytes / RLVC_THRESHOLDS_PERCEPT_BYTES(1);
}

/* The planner that an agent is.
 * @return RLVC_OK; RLVC_E_NULL; RLVC_E_MISMATCH: it is none; RLVC_E_REENTERED. O(1). */
static inline rlvc_status rlvc_planner_of(rlvc_agent *agent, rlvc_planner **planner) {
    if (!agent)
        return RLVC_E_NULL;
    if (!rlvc_agent_plans(agent))
        return RLVC_E_MISMATCH;
    *planner = (rlvc_planner *)(void *)agent;
    return (*planner)->busy ? RLVC_E_REENTERED : RLVC_OK;
}

uint32_t rlvc_planner_horizon(const rlvc_planner *planner);

/* The most multiplications of an elementary step of learning. */
uint32_t rlvc_planning_grain(const rlvc_planner *planner);

/* Begins a step of learning; works on for at least `budget` multiplications, and one elementary
 * step more at most. @return the multiplications done. */
void rlvc_planning_begin(rlvc_planner *planner);
uint32_t rlvc_planning_step(rlvc_planner *planner, uint32_t budget);

/* The policy that was learnt; null if there is none yet. O(policies). */
static inline const rlvc_trial *rlvc_planner_best(const rlvc_planner *planner) {
    const rlvc_archive *archive = &planner->archive;
    return archive->count > 0 ? archive->trial + rlvc_archive_best(archive, 0.5f) : NULL;
}

#endif
