/* SPDX-License-Identifier: MIT */
/* The planner: see rlvc/planner.h. Acting and observing are here; what is learnt is in planning.c.
 */
#include "rlvc/float_rules.h"

#include "planner_state.h"

#include "cells.h"
#include "../base/solver_select.h"
#include <string.h>

/* ------------------------------------------------------------------ memory */

/* A part of the planner that holds arrays; while only counting it stands in the planner's place. */
typedef union part {
    rlvc_tree tree;
    rlvc_experience experience;
    rlvc_dynamics model;
    rlvc_dynamics_fit_cursor fit;
    rlvc_archive archive;
} part;

/* Carves the arrays that are the planner's own. Without one, only counts. */
static void carve_own(rlvc_planner *planner, rlvc_arena *arena, const rlvc_config *config,
                      uint32_t d) {
    uint32_t cells_bytes = rlvc_cells_pairs(d) * RLVC_CELLS_BYTES;
    uint8_t *action = rlvc_arena_carve(arena, RLVC_PLANNER_LEAVES_MAX, 1);
    uint32_t *row = rlvc_arena_carve(arena, config->sample, sizeof *row);
    float *start = rlvc_arena_carve(arena, RLVC_PLANNER_STARTS * d, sizeof(float));
    float *common = rlvc_arena_carve(arena, RLVC_PLANNER_STARTS * d, sizeof(float));
    float *search_start = rlvc_arena_carve(arena, RLVC_SEARCH_STARTS * d, sizeof(float));
    float *now = rlvc_arena_carve(arena, d, sizeof(float));
    float *promised = rlvc_arena_carve(arena, d, sizeof(float));
    float *searched = rlvc_arena_carve(arena, d, sizeof(float));
    uint8_t *cells = rlvc_arena_carve(arena, cells_bytes, 1);
    uint8_t *fresh = rlvc_arena_carve(arena, cells_bytes, 1);
    if (!planner)
        return;
    planner->tree_action = action;
    planner->sample.room = config->sample;
    planner->sample.row = row;
    planner->start = start;
    planner->common = common;
    planner->search_start = search_start;
    planner->now = now;
    planner->planning.rollout.s = promised;
    planner->planning.search.rollout.s = searched;
    planner->cells_bytes = cells_bytes;
    planner->cells = cells;
    planner->fresh = fresh;
}

/* Carves a planner, or only counts if that is null: to ask for its size takes no planner on the
 * stack, which would be the most that a controller's stack ever holds. */
static void carve(rlvc_planner *planner, rlvc_arena *arena, const rlvc_config *config, uint32_t d) {
    part spare;
    uint32_t actions = config->actions, leaves = config->model_leaves;
    (void)rlvc_arena_carve(arena, 1, sizeof *planner);
    rlvc_tree_carve(planner ? &planner->tree : &spare.tree, arena, RLVC_PLANNER_LEAVES_MAX,
                    RLVC_THRESHOLDS_FEATURE_BYTES);
    rlvc_experience_carve(planner ? &planner->experience : &spare.experience, arena, d,
                          config->capacity);
    for (uint32_t k = 0; k < RLVC_ROLLOUT_MODELS; k++)
        rlvc_dynamics_carve(planner ? planner->model + k : &spare.model, arena, d, actions, leaves);
    rlvc_dynamics_fit_carve(planner ? &planner->planning.fit : &spare.fit, arena, d, actions,
                            leaves);
    rlvc_archive_carve(planner ? &planner->archive : &spare.archive, arena, d);
    carve_own(planner, arena, config, d);
}

/* Carves what only saves time, behind all the rest. */
static void carve_reach(rlvc_reach *reach, rlvc_arena *arena, const rlvc_config *config,
                        uint32_t d) {
    for (uint32_t k = 0; k < 2u; k++)
        rlvc_reach_carve(reach + k, arena, RLVC_SEARCH_STARTS, config->leaves, d);
}

/* The size of a block, without what only saves time or with it. */
static rlvc_status size_of(const rlvc_config *config, const rlvc_domain *domain, int ample,
                           size_t *bytes) {
    rlvc_arena arena = {NULL, 0};
    rlvc_reach spare[2];
    if (!bytes)
        return RLVC_E_NULL;
    *bytes = 0;
    rlvc_status status = rlvc_config_status(config, domain);
    if (status != RLVC_OK)
        return status;
    carve(NULL, &arena, config, rlvc_planner_components(domain));
    if (ample)
        carve_reach(spare, &arena, config, rlvc_planner_components(domain));
    *bytes = (size_t)arena.used;
    return RLVC_OK;
}

rlvc_status rlvc_planner_size(const rlvc_config *config, const rlvc_domain *domain, size_t *bytes) {
    return size_of(config, domain, 0, bytes);
}

rlvc_status rlvc_planner_ample_size(const rlvc_config *config, const rlvc_domain *domain,
                                    size_t *bytes) {
    return size_of(config, domain, 1, bytes);
}

rlvc_status rlvc_planner_init(const rlvc_config *config, const rlvc_domain *domain, void *memory,
                              size_t bytes, rlvc_agent **agent) {
    size_t needed, ample;
    if (!agent)
        return RLVC_E_NULL;
    *agent = NULL;
    rlvc_status status = rlvc_planner_size(config, domain, &needed);
    if (status == RLVC_OK)
        status = rlvc_arena_check(memory, bytes, needed);
    if (status != RLVC_OK)
        return status;
    (void)size_of(config, domain, 1, &ample);
    const int roomy = RLVC_AT_ONCE && bytes >= ample;
    const rlvc_config copied_config = *config; /* they may lie in the block */
    const rlvc_domain copied_domain = *domain;
    rlvc_arena arena = {(unsigned char *)memory, 0};
    rlvc_planner *made = memory;
    RLVC_UNPOISON(memory, roomy ? ample : needed);
    memset(memory, 0, needed);
    made->config = copied_config;
    made->domain = copied_domain;
    made->components = rlvc_planner_components(&copied_domain);
    carve(made, &arena, &copied_config, made->components);
    if (roomy)
        carve_reach(made->planning.search.reach, &arena, &copied_config, made->components);
    made->gainful = 1;
    rlvc_rng_seed(&made->rng, copied_config.seed);
    *agent = memory;
    return RLVC_OK;
}

/* ------------------------------------------------------------------ acting and observing */

static int is_number(float x, float most) {
    return x >= -most && x <= most; /* false for a NaN */
}

static int is_percept(const rlvc_planner *planner, const float *percept) {
    for (uint32_t i = 0; i < planner->components; i++)
        if (!is_number(percept[i], RLVC_PLANNER_NUMBER_MAX))
            return 0;
    return 1;
}

/* Which policy acts in the next episode: the one that was chosen last, or the best while that is
 * being chosen; while there is none, the one that acts now. */
static void choose_acting(const rlvc_planner *planner, rlvc_acting *acting) {
    *acting = planner->learning ? planner->acting : planner->next;
    if (planner->learning && planner->archive.count > 0) {
        acting->trial = rlvc_archive_best(&planner->archive, 0.5f);
        acting->tree = planner->archive.trial[acting->trial].tree;
        acting->serial = planner->archive.trial[acting->trial].serial;
        acting->why = RLVC_PLANNER_AGAIN;
    }
}

static uint32_t action_of(rlvc_planner *planner, const rlvc_acting *acting, const float *percept) {
    return acting->why == RLVC_PLANNER_RANDOM
               ? rlvc_rng_below(&planner->rng, planner->config.actions)
               : rlvc_small_tree_act(&acting->tree, percept);
}

/* Begins to count an episode. */
static void open_episode(rlvc_planner *planner, const float *percept) {
    memcpy(planner->now, percept, planner->components * sizeof(float));
    planner->steps = 0;
    planner->earned = 0.0f;
    planner->new_cells = 0;
    rlvc_acting acting;
    choose_acting(planner, &acting);
    planner->acting = acting;
}

/* The planner that an agent is, if the percept is one of its.
 * @return RLVC_OK; as of rlvc_planner_of; RLVC_E_NULL; RLVC_E_PERCEPT. */
static rlvc_status available(rlvc_agent *agent, const float *percept, rlvc_planner **planner) {
    const rlvc_status status = rlvc_planner_of(agent, planner);
    if (status != RLVC_OK)
        return status;
    if (!percept)
        return RLVC_E_NULL;
    return is_percept(*planner, percept) ? RLVC_OK : RLVC_E_PERCEPT;
}

/* Counts a first percept. Beyond those that are remembered only where the next one goes matters,
 * and that there were some: after 2^32 it would be 0 again. */
static uint32_t next_count(uint32_t starts) {
    return starts < RLVC_PLANNER_STARTS ? starts + 1u
                                        : RLVC_PLANNER_STARTS + (starts + 1u) % RLVC_PLANNER_STARTS;
}

rlvc_status rlvc_planner_begin(rlvc_agent *agent, const void *first) {
    rlvc_planner *planner;
    const float *percept = first;
    const rlvc_status status = available(agent, percept, &planner);
    if (status != RLVC_OK)
        return status;
    if (!rlvc_experience_has_room(&planner->experience))
        return RLVC_E_BUSY;
    uint32_t d = planner->components;
    rlvc_experience_begin(&planner->experience, percept);
    memcpy(planner->start + (size_t)(planner->starts % RLVC_PLANNER_STARTS) * d, percept,
           d * sizeof(float));
    planner->starts = next_count(planner->starts);
    open_episode(planner, percept);
    planner->open = 1;
    return RLVC_OK;
}

rlvc_status rlvc_planner_act(rlvc_agent *agent, rlvc_choice *choice) {
    rlvc_planner *planner;
    const rlvc_status status = rlvc_planner_of(agent, &planner);
    if (status != RLVC_OK)
        return status;
    if (!choice)
        return RLVC_E_NULL;
    if (!planner->open)
        return RLVC_E_ORDER;
    const float *s = rlvc_experience_percept(&planner->experience, planner->experience.head);
    choice->action = (uint8_t)action_of(planner, &planner->acting, s);
    choice->exploited = planner->acting.why >= RLVC_PLANNER_NEW;
    return RLVC_OK;
}

rlvc_status rlvc_planner_act_at(rlvc_agent *agent, const float *percept, uint32_t *action) {
    rlvc_planner *planner;
    rlvc_acting acting;
    const rlvc_status status = available(agent, percept, &planner);
    if (status != RLVC_OK)
        return status;
    if (!action)
        return RLVC_E_NULL;
    choose_acting(planner, &acting);
    *action = action_of(planner, &acting, percept);
    return RLVC_OK;
}

/* An episode by a policy of the archive, which may have left it since. */
static void note_return(rlvc_planner *planner) {
    const rlvc_acting *acting = &planner->acting;
    rlvc_archive *archive = &planner->archive;
    if (acting->why < RLVC_PLANNER_NEW || archive->trial[acting->trial].serial != acting->serial)
        return;
    rlvc_archive_note(archive, acting->trial, planner->now, planner->earned);
    /* what was being rolled out may be another episode now */
    planner->planning.rolling = planner->planning.rolled = 0;
}

/* Is exploring still worth it? Of the cells that the episode might have been the first in, it was
 * in one in fifty. */
static void note_exploration(rlvc_planner *planner) {
    uint32_t cells = RLVC_CELLS_SIDE * RLVC_CELLS_SIDE;
    uint32_t most = planner->steps < cells ? planner->steps : cells;
    most *= rlvc_cells_pairs(planner->components);
    planner->gainful = planner->new_cells * 50u >= most;
}

/* A tree that explored, and earned more than the best policy is held to, is one as well. It takes
 * no other's place: what a step of learning looks at stays. */
static void note_discovery(rlvc_planner *planner) {
    rlvc_archive *archive = &planner->archive;
    float bar = planner->least;
    if (archive->count == RLVC_ARCHIVE_POLICIES)
        return;
    if (archive->count > 0)
        bar = archive->trial[rlvc_archive_best(archive, 0.0f)].score;
    if (planner->earned <= bar)
        return;
    uint32_t added = rlvc_archive_add(archive, &planner->acting.tree, planner->earned);
    archive->trial[added].promise_known = 0;
    archive->trial[added].score = planner->earned;
    rlvc_archive_note(archive, added, planner->now, planner->earned);
}

static void close_episode(rlvc_planner *planner, uint8_t end) {
    if (planner->episodes == 0 || planner->earned < planner->least)
        planner->least = planner->earned;
    if (planner->episodes == 0 || planner->earned > planner->most)
        planner->most = planner->earned;
    rlvc_planner_count(&planner->episodes, 1);
    if (end != RLVC_TERMINATED && planner->steps > planner->longest)
        planner->longest = planner->steps;
    if (planner->acting.why == RLVC_PLANNER_EXPLORE) {
        note_exploration(planner);
        note_discovery(planner);
    }
    note_return(planner);
    planner->due = 1;
}

/* May this be stored? */
static rlvc_status check_interaction(const rlvc_planner *planner, rlvc_choice choice, float reward,
                                     uint8_t end) {
    if (!planner->open)
        return RLVC_E_ORDER;
    if (choice.action >= planner->config.actions || choice.exploited > 1 || end > RLVC_TRUNCATED)
        return RLVC_E_RANGE;
    if (!is_number(reward, RLVC_REWARD_MAX))
        return RLVC_E_REWARD;
    return rlvc_experience_has_room(&planner->experience) ? RLVC_OK : RLVC_E_BUSY;
}

/* Once interactions are no longer counted, what they were at the last fit and search goes down: so
 * the number of those since grows on, and learning does not stop. */
static void keep_distance(rlvc_planner *planner) {
    if (planner->experience.total < UINT32_MAX)
        return;
    if (planner->fitted > 1u) /* 0 is none */
        planner->fitted--;
    if (planner->searched > 0)
        planner->searched--;
}

rlvc_status rlvc_planner_observe(rlvc_agent *agent, rlvc_choice choice, float reward,
                                 const void *reached, uint8_t end) {
    rlvc_planner *planner;
    const float *next = reached;
    rlvc_status status = available(agent, next, &planner);
    if (status == RLVC_OK)
        status = check_interaction(planner, choice, reward, end);
    if (status != RLVC_OK)
        return status;
    keep_distance(planner);
    rlvc_experience_append(&planner->experience, choice.action, reward, next, end);
    planner->earned += reward;
    planner->steps++;
    if (planner->acting.why == RLVC_PLANNER_EXPLORE) {
        rlvc_planner_count(&planner->explored, 1);
        planner->new_cells += rlvc_cells_mark(planner->model, next, planner->cells);
    }
    planner->open = end == RLVC_GOES_ON;
    if (!planner->open || planner->steps == planner->config.horizon)
        close_episode(planner, end);
    if (planner->open && planner->steps == planner->config.horizon)
        open_episode(planner, next);
    return RLVC_OK;
}

/* ------------------------------------------------------------------ learning and asking */

rlvc_status rlvc_planner_learn(rlvc_agent *agent, uint32_t budget, rlvc_progress *progress) {
    rlvc_planner *planner;
    const rlvc_status status = rlvc_planner_of(agent, &planner);
    if (status != RLVC_OK)
        return status;
    if (!progress)
        return RLVC_E_NULL;
    uint32_t grain = rlvc_planning_grain(planner);
    if (budget < grain)
        return RLVC_E_RANGE;
    memset(progress, 0, sizeof *progress);
    if (!planner->learning && planner->due)
        rlvc_planning_begin(planner);
    progress->work = rlvc_planning_step(planner, budget - grain + 1u);
    progress->done = !planner->learning;
    return RLVC_OK;
}

rlvc_status rlvc_planner_budget_min(const rlvc_agent *agent, uint32_t *budget) {
    if (!agent || !budget)
        return RLVC_E_NULL;
    *budget = rlvc_planning_grain((const rlvc_planner *)(const void *)agent);
    return RLVC_OK;
}

rlvc_status rlvc_planner_predict(rlvc_agent *agent, const void *percept, uint32_t *class_id,
                                 uint32_t *action) {
    rlvc_planner *planner;
    uint32_t node = 0;
    const rlvc_status status = available(agent, percept, &planner);
    if (status != RLVC_OK)
        return status;
    const rlvc_trial *best = rlvc_planner_best(planner);
    if (best)
        node = rlvc_small_tree_leaf(&best->tree, percept);
    if (class_id)
        *class_id = best ? rlvc_small_tree_class(&best->tree, node) : 0;
    if (action)
        *action = best ? best->tree.node[node].action : 0;
    return RLVC_OK;
}

void rlvc_planner_view(rlvc_agent *agent, rlvc_learnt *learnt) {
    rlvc_planner *planner = (rlvc_planner *)(void *)agent;
    rlvc_small_tree nothing;
    const rlvc_trial *best = rlvc_planner_best(planner);
    rlvc_small_tree_constant(&nothing, 0);
    if (!planner->busy)
        rlvc_small_tree_grow(best ? &best->tree : &nothing, &planner->tree, planner->tree_action);
    memset(learnt, 0, sizeof *learnt);
    learnt->domain = &planner->domain;
    learnt->tree = &planner->tree;
    learnt->policy = planner->tree_action;
    learnt->busy = &planner->busy;
    learnt->actions = planner->config.actions;
}

/* Was anything learnt? Where all policies of late are equally good there is nothing to predict
 * about them, and beta is small: then the best must earn clearly more than the worst episode did.
 */
static uint8_t verdict_of(const rlvc_planner *planner, const rlvc_trial *best) {
    if (planner->episodes == 0)
        return RLVC_PLANNER_NO_EPISODE;
    if (planner->least == planner->most)
        return RLVC_PLANNER_NO_DIFFERENCE;
    float clearly = planner->least + 4.0f * planner->archive.deviation;
    int known = best && (planner->archive.beta >= 0.1f || best->score > clearly);
    return known ? RLVC_PLANNER_LEARNT : RLVC_PLANNER_NO_MODEL;
}

/* The same of an agent that is only looked at. */
static rlvc_status constant_of(const rlvc_agent *agent, const rlvc_planner **planner) {
    if (!agent)
        return RLVC_E_NULL;
    if (!rlvc_agent_plans(agent))
        return RLVC_E_MISMATCH;
    *planner = (const rlvc_planner *)(const void *)agent;
    return (*planner)->busy ? RLVC_E_REENTERED : RLVC_OK;
}

rlvc_status rlvc_planner_stats(const rlvc_agent *agent, rlvc_planner_statistics *statistics) {
    const rlvc_planner *planner;
    const rlvc_status status = constant_of(agent, &planner);
    if (status != RLVC_OK)
        return status;
    if (!statistics)
        return RLVC_E_NULL;
    const rlvc_trial *best = rlvc_planner_best(planner);
    memset(statistics, 0, sizeof *statistics);
    statistics->interactions = planner->experience.total;
    statistics->episodes = planner->episodes;
    statistics->explored = planner->explored;
    statistics->fits = planner->fits;
    statistics->searches = planner->searches;
    statistics->candidates = planner->candidates;
    statistics->beta = planner->archive.beta;
    statistics->deviation = planner->archive.deviation;
    statistics->acting = planner->acting.why;
    statistics->leaves = 1;
    if (best) {
        statistics->leaves = best->tree.leaves;
        statistics->tried = best->episodes;
        statistics->score = best->score;
    }
    statistics->verdict = verdict_of(planner, best);
    return RLVC_OK;
}

rlvc_status rlvc_planner_summary(const rlvc_agent *agent, rlvc_statistics *statistics) {
    const rlvc_planner *planner;
    const rlvc_status status = constant_of(agent, &planner);
    if (status != RLVC_OK)
        return status;
    if (!statistics)
        return RLVC_E_NULL;
    const rlvc_trial *best = rlvc_planner_best(planner);
    memset(statistics, 0, sizeof *statistics);
    statistics->interactions = planner->experience.total;
    for (uint32_t i = 0; i < planner->experience.count; i++)
        statistics->stored +=
            planner->experience.end[rlvc_experience_row(&planner->experience, i)] != RLVC_ROW_LAST;
    statistics->step = planner->counter - planner->learning;
    statistics->classes = best ? best->tree.leaves : 1u;
    statistics->depth = best ? rlvc_small_tree_depth(&best->tree) : 0;
    return RLVC_OK;
}

rlvc_status rlvc_planner_node(const rlvc_agent *agent, uint32_t index, rlvc_planner_test *node) {
    const rlvc_planner *planner;
    const rlvc_status status = constant_of(agent, &planner);
    if (status != RLVC_OK)
        return status;
    if (!node)
        return RLVC_E_NULL;
    const rlvc_trial *best = rlvc_planner_best(planner);
    if (index >= (best ? best->tree.nodes : 1u))
        return RLVC_E_RANGE;
    memset(node, 0, sizeof *node);
    node->component = RLVC_PLANNER_LEAF;
    if (!best)
        return RLVC_OK;
    const rlvc_small_node *from = best->tree.node + index;
    node->cutpoint = from->cut;
    node->component = from->component;
    node->child = from->child;
    node->action = from->action;
    return RLVC_OK;
}
