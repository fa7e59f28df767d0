/* SPDX-License-Identifier: MIT */
/* One step of learning: which policy acts in the next episode.
 *
 * The model is fitted anew if the data have grown (FIT), the promises that are missing are made
 * (PROMISE), and then it is decided (DECIDE): explore (CELLS, EXPLORE), search (SEARCH, and now and
 * then from nothing), or try again what is known. What a search found is promised for (CANDIDATE)
 * and tried if that beats the best score. */
#include "rlvc/float_rules.h"

#include "planner_state.h"

#include "cells.h"
#include <string.h>

enum { FIT, PROMISE, DECIDE, CELLS, EXPLORE, SEARCH, CANDIDATE, DONE };

#define SEARCH_STARTS_FIRST 48u /* first percepts, */
#define SEARCH_STARTS_RING 16u  /* and percepts of the ring */
#define EXPLORE_STARTS 4u
#define EXPLORE_SHARE 0.15f
#define GROWTH 10u /* a tenth */
#define SCRATCH_EVERY 8u
#define SCRATCH_TRIES 2u
#define FAILURES_MAX 3u
#define SEARCH_PAUSE 250u /* interactions, more with each search without gain */

uint32_t rlvc_planner_horizon(const rlvc_planner *planner) {
    uint32_t most = planner->config.horizon;
    return planner->longest > 0 && planner->longest < most ? planner->longest : most;
}

/* Multiplications that an elementary step takes at most, but for two factorisations of a large
 * basis. A step of the model takes (components + 1) * (terms + 8): fewer. */
#define STEP_UNITS 2048u

uint32_t rlvc_planning_grain(const rlvc_planner *planner) {
    uint32_t order = planner->model->terms_max + 1u;
    uint32_t factors = order * order * order / 3u + order * (order + 4u) / 2u;
    return factors > STEP_UNITS ? factors : STEP_UNITS;
}

static void enter(rlvc_planner *planner, uint8_t phase) {
    planner->planning.phase = phase;
    planner->planning.at = 0;
    planner->planning.rolling = planner->planning.rolled = 0;
    planner->planning.value_sum = 0.0f;
    if (phase == DONE)
        planner->learning = 0;
}

static void choose(rlvc_planner *planner, const rlvc_small_tree *tree, uint32_t trial,
                   uint8_t why) {
    planner->next.tree = *tree;
    planner->next.trial = trial;
    planner->next.serial = planner->archive.trial[trial].serial;
    planner->next.why = why;
    enter(planner, DONE);
}

/* Begins to fit the next of the models, to a sample of its own. */
static void begin_fit(rlvc_planner *planner) {
    uint32_t k = planner->planning.model;
    uint32_t seed = planner->config.seed + planner->counter + k * UINT32_C(0x9e3779b9);
    rlvc_dynamics_fit_begin(&planner->planning.fit, planner->model + k, &planner->experience,
                            &planner->sample, seed);
}

void rlvc_planning_begin(rlvc_planner *planner) {
    uint32_t total = planner->experience.total, grown = total - planner->fitted;
    uint32_t room = planner->config.capacity;
    planner->due = 0;
    planner->learning = 1;
    planner->counter++;
    planner->planning.policy = planner->planning.episode = 0;
    if (total < planner->config.random) {
        enter(planner, DONE);
        return;
    }
    uint32_t stored = total < room ? total : room;
    if (planner->fitted == 0 || grown > stored / GROWTH) {
        enter(planner, FIT);
        planner->planning.model = 0;
        begin_fit(planner);
    } else {
        enter(planner, PROMISE);
    }
}

/* ------------------------------------------------------------------ the model */

/* How many first percepts are remembered. */
static uint32_t starts_known(const rlvc_planner *planner) {
    return planner->starts < RLVC_PLANNER_STARTS ? planner->starts : RLVC_PLANNER_STARTS;
}

/* The first percepts as they are become those that promises are compared at. */
static void renew_commons(rlvc_planner *planner) {
    planner->commons = starts_known(planner);
    memcpy(planner->common, planner->start,
           (size_t)planner->commons * planner->components * sizeof(float));
}

static uint32_t fit_model(rlvc_planner *planner, uint32_t budget) {
    rlvc_dynamics_fit_cursor *fit = &planner->planning.fit;
    uint32_t spent = rlvc_dynamics_fit_step(fit, budget);
    if (!fit->done)
        return spent;
    if (++planner->planning.model < RLVC_ROLLOUT_MODELS) {
        begin_fit(planner);
        return spent;
    }
    planner->fitted = planner->experience.total;
    rlvc_planner_count(&planner->fits, 1);
    if (planner->failures >= FAILURES_MAX)
        planner->failures = FAILURES_MAX - 1u;
    renew_commons(planner);
    rlvc_archive_forget(&planner->archive);
    enter(planner, PROMISE);
    return spent;
}

/* ------------------------------------------------------------------ promises */

static rlvc_rollout_input rollout_input(const rlvc_planner *planner, uint32_t seed, uint8_t plain) {
    rlvc_rollout_input in;
    memset(&in, 0, sizeof in);
    in.plain = plain;
    in.model = planner->model;
    in.horizon = rlvc_planner_horizon(planner);
    in.seed = planner->config.seed * 31u + seed;
    return in;
}

/* One step of the mean over the common starts. @return 1 once it is made, in value_sum. */
static int mean_step(rlvc_planner *planner, const rlvc_small_tree *tree) {
    rlvc_planning_cursor *planning = &planner->planning;
    rlvc_rollout_input in = rollout_input(planner, 1u, 1);
    if (!planning->rolling) {
        const float *start = planner->common + (size_t)planning->at * planner->components;
        rlvc_rollout_begin(&planning->rollout, &in, start, planning->at);
        planning->rolling = 1;
    }
    rlvc_rollout_step(&planning->rollout, &in, tree, NULL);
    if (!planning->rollout.done)
        return 0;
    planning->rolling = 0;
    planning->value_sum += planning->rollout.total;
    if (++planning->at < planner->commons)
        return 0;
    planning->value_sum /= (float)planner->commons;
    planning->at = 0;
    return 1;
}

/* One step of what is promised from the start of an episode: the mean over the models. What one
 * rollout earns is mostly luck, and beta would be small for that. */
static void episode_step(rlvc_planner *planner, rlvc_trial *trial) {
    rlvc_planning_cursor *planning = &planner->planning;
    rlvc_rollout_input in = rollout_input(planner, 1u, 1);
    if (!planning->rolling) {
        const float *start = rlvc_archive_start(&planner->archive, planning->policy, trial->valued);
        rlvc_rollout_begin(&planning->rollout, &in, start, trial->valued);
        planning->rollout.model = planning->rolled;
        planning->rolling = 1;
    }
    rlvc_rollout_step(&planning->rollout, &in, &trial->tree, NULL);
    if (!planning->rollout.done)
        return;
    planning->rolling = 0;
    float sum = planning->rollout.total + (planning->rolled > 0 ? planning->value_sum : 0.0f);
    planning->value_sum = sum;
    if (++planning->rolled < RLVC_ROLLOUT_MODELS)
        return;
    planning->rolled = 0;
    planning->value_sum = 0.0f;
    trial->promised[trial->valued++] = sum / (float)RLVC_ROLLOUT_MODELS;
}

/* One step of a promise that is missing: of a policy at the common starts, or of one of its
 * episodes. */
static uint32_t promise(rlvc_planner *planner) {
    rlvc_planning_cursor *planning = &planner->planning;
    rlvc_archive *archive = &planner->archive;
    if (planning->policy == archive->count) {
        rlvc_archive_score(archive, planner->most - planner->least);
        enter(planner, DECIDE);
        return 1u;
    }
    rlvc_trial *trial = archive->trial + planning->policy;
    if (!trial->promise_known) {
        if (mean_step(planner, &trial->tree)) {
            trial->promise = planning->value_sum;
            trial->promise_known = 1;
            planning->value_sum = 0.0f;
        }
    } else if (trial->valued < rlvc_trial_kept(trial)) {
        episode_step(planner, trial);
    } else {
        planning->policy++;
        return 1u;
    }
    return rlvc_rollout_units(planner->model);
}

/* ------------------------------------------------------------------ searches */

/* Puts up to `most` first percepts, from a random one on, into the starts of the search. */
static uint32_t first_starts(rlvc_planner *planner, rlvc_rng *rng, uint32_t most) {
    uint32_t d = planner->components, known = starts_known(planner);
    uint32_t count = known < most ? known : most, from = rlvc_rng_below(rng, known);
    for (uint32_t i = 0; i < count; i++)
        memcpy(planner->search_start + (size_t)i * d,
               planner->start + (size_t)((from + i) % known) * d, d * sizeof(float));
    return count;
}

static uint32_t ring_starts(rlvc_planner *planner, rlvc_rng *rng, uint32_t from) {
    const rlvc_experience *experience = &planner->experience;
    uint32_t d = planner->components, most = from + SEARCH_STARTS_RING;
    for (; from < most; from++) {
        uint32_t row = rlvc_experience_row(experience, rlvc_rng_below(rng, experience->count));
        memcpy(planner->search_start + (size_t)from * d, rlvc_experience_percept(experience, row),
               d * sizeof(float));
    }
    return from;
}

static void begin_search(rlvc_planner *planner, const rlvc_small_tree *tree, uint32_t stream) {
    const rlvc_config *config = &planner->config;
    rlvc_search_input in;
    rlvc_rng rng;
    int explore = planner->planning.phase == EXPLORE;
    memset(&in, 0, sizeof in);
    rlvc_rng_seed(&rng, config->seed * 101u + planner->counter);
    in.rollout = rollout_input(planner, planner->counter, (uint8_t)explore);
    in.moves.experience = &planner->experience;
    in.moves.scale = planner->model->basis.scale;
    in.moves.actions = config->actions;
    in.moves.leaves_max = config->leaves;
    in.start = planner->search_start;
    in.starts = first_starts(planner, &rng, explore ? EXPLORE_STARTS : SEARCH_STARTS_FIRST);
    if (explore) {
        in.rollout.fresh = planner->fresh;
        in.known = planner->cells;
        in.cells_bytes = planner->cells_bytes;
    } else {
        in.starts = ring_starts(planner, &rng, in.starts);
    }
    in.candidates = config->candidates;
    in.patience = config->patience;
    in.seed = config->seed * 7919u + planner->counter * 64u + stream;
    rlvc_search_begin(&planner->planning.search, &in, tree);
}

static void search_from_nothing(rlvc_planner *planner, uint32_t stream) {
    rlvc_small_tree tree;
    rlvc_rng rng;
    rlvc_rng_seed(&rng, planner->config.seed * 977u + planner->counter * 8u + stream);
    rlvc_small_tree_constant(&tree, rlvc_rng_below(&rng, planner->config.actions));
    begin_search(planner, &tree, stream);
}

/* ------------------------------------------------------------------ deciding */

/* Did all episodes earn the same, so that there is nothing to search for yet? */
static int all_alike(const rlvc_planner *planner) {
    return planner->least == planner->most && (planner->longest > 0 || planner->episodes > 5u);
}

/* Searches have gained nothing of late: the next one waits the longer, the more did not. */
static int pauses(const rlvc_planner *planner) {
    uint32_t failures = planner->failures;
    return failures >= FAILURES_MAX && planner->experience.total - planner->searched <
                                           SEARCH_PAUSE * (failures - FAILURES_MAX + 1u);
}

static void try_again(rlvc_planner *planner) {
    uint32_t again = rlvc_archive_race(&planner->archive);
    choose(planner, &planner->archive.trial[again].tree, again, RLVC_PLANNER_AGAIN);
}

static void decide(rlvc_planner *planner) {
    rlvc_archive *archive = &planner->archive;
    float share = EXPLORE_SHARE * (float)planner->experience.total;
    if (all_alike(planner) ||
        (planner->gainful && archive->count > 0 && (float)planner->explored < share)) {
        enter(planner, CELLS);
        memset(planner->cells, 0, planner->cells_bytes);
        return;
    }
    if (archive->count > 0 && pauses(planner)) {
        try_again(planner);
        return;
    }
    enter(planner, SEARCH);
    rlvc_planner_count(&planner->searches, 1);
    planner->searched = planner->experience.total;
    planner->planning.candidate.nodes = 0; /* there is none: of the first search any is one */
    planner->planning.tries = 0;
    planner->planning.derives = archive->count > 0;
    if (planner->searches == 1u || planner->counter % SCRATCH_EVERY == 0)
        planner->planning.tries = SCRATCH_TRIES;
    else if (planner->failures > 0)
        planner->planning.tries = 1;
    if (archive->count > 0)
        begin_search(planner, &archive->trial[rlvc_archive_best(archive, 0.0f)].tree, 0);
    else
        search_from_nothing(planner, 0);
}

static uint32_t mark_cells(rlvc_planner *planner) {
    rlvc_planning_cursor *planning = &planner->planning;
    uint32_t row = rlvc_experience_row(&planner->experience, planning->at);
    (void)rlvc_cells_mark(planner->model, rlvc_experience_percept(&planner->experience, row),
                          planner->cells);
    if (++planning->at == planner->experience.count) {
        enter(planner, EXPLORE);
        search_from_nothing(planner, 0);
    }
    return rlvc_cells_pairs(planner->components);
}

static uint32_t explore(rlvc_planner *planner, uint32_t budget) {
    rlvc_search_cursor *search = &planner->planning.search;
    uint32_t spent = rlvc_search_step(search, budget);
    if (search->done)
        choose(planner, &search->tree, 0, RLVC_PLANNER_EXPLORE);
    return spent;
}

static float priced(float value, uint32_t leaves) {
    return value - 0.002f * (value < 0.0f ? -value : value) * (float)leaves;
}

static uint32_t search(rlvc_planner *planner, uint32_t budget) {
    rlvc_planning_cursor *planning = &planner->planning;
    rlvc_search_cursor *search = &planning->search;
    uint32_t spent = rlvc_search_step(search, budget);
    if (!search->done)
        return spent;
    rlvc_planner_count(&planner->candidates, search->tried);
    float value = priced(search->best, search->tree.leaves);
    if (planning->candidate.nodes == 0 || value > planning->candidate_value) {
        planning->candidate_value = value;
        planning->candidate = search->tree;
        planning->derived = planning->derives;
    }
    planning->derives = 0;
    if (planning->tries > 0)
        search_from_nothing(planner, planning->tries--);
    else
        enter(planner, CANDIDATE);
    return spent;
}

/* What the candidate is held to earn: its promise, calibrated by what all policies earned. One that
 * the search made of the best policy earns what that does, and more by what it promises more. */
static float worth_of_candidate(const rlvc_planner *planner, const rlvc_trial *best) {
    const rlvc_archive *archive = &planner->archive;
    float promised = planner->planning.value_sum;
    float worth = archive->beta * promised + archive->common;
    float made = best->score + archive->beta * (promised - best->promise);
    return planner->planning.derived && made > worth ? made : worth;
}

/* The candidate acts unless it is held to earn less than the best policy by more than an episode's
 * return may deviate: those that the models cannot tell apart are not equally good, and only trying
 * tells. The search gained if the candidate is held to earn more by a quarter of that. */
static uint32_t try_candidate(rlvc_planner *planner) {
    rlvc_planning_cursor *planning = &planner->planning;
    rlvc_archive *archive = &planner->archive;
    if (!mean_step(planner, &planning->candidate))
        return rlvc_rollout_units(planner->model);
    float worth = planning->value_sum;
    int gains = 1, near = 1;
    if (archive->count > 0 && !rlvc_archive_flat(archive, planner->most)) {
        const rlvc_trial *best = archive->trial + rlvc_archive_best(archive, 0.0f);
        worth = worth_of_candidate(planner, best);
        gains = worth > best->score + 0.25f * archive->deviation;
        near = worth >= best->score - archive->deviation;
    }
    if (gains)
        planner->failures = 0;
    else
        rlvc_planner_count(&planner->failures, 1);
    if (near) {
        uint32_t added = rlvc_archive_add(archive, &planning->candidate, planning->value_sum);
        archive->trial[added].score = worth;
        choose(planner, &planning->candidate, added, RLVC_PLANNER_NEW);
    } else {
        try_again(planner);
    }
    return rlvc_rollout_units(planner->model);
}

uint32_t rlvc_planning_step(rlvc_planner *planner, uint32_t budget) {
    uint32_t spent = 0;
    while (spent < budget && planner->learning) {
        uint32_t left = budget - spent;
        switch (planner->planning.phase) {
        case FIT:
            spent += fit_model(planner, left);
            break;
        case PROMISE:
            spent += promise(planner);
            break;
        case DECIDE:
            decide(planner);
            spent++;
            break;
        case CELLS:
            spent += mark_cells(planner);
            break;
        case EXPLORE:
            spent += explore(planner, left);
            break;
        case SEARCH:
            spent += search(planner, left);
            break;
        default:
            spent += try_candidate(planner);
            break;
        }
    }
    return spent;
}
