/* SPDX-License-Identifier: MIT */
/* A learning step (section 4.2.1, part 3), in slices.
 *
 * A step is a sequence of rounds. A round assigns a class to each percept (LABEL), computes the
 * target of each sample (GROUP) and searches each class once (SEARCH). A significant split is made
 * at the end of the class, and the next round searches both children. When a round makes no split,
 * no class is aliased any more. Then classes may still be aliased by their successors (SUCCESSORS);
 * a split by these begins another round. In the end (FINISH) the policy is made greedy and k is
 * incremented.
 *
 *     residual:  LABEL MODEL SOLVE NOVELTY GROUP SEARCH   each round: targets need the values
 *                SUCCESSORS                               if that made no split, config.successors
 *     returns:   LABEL GROUP SEARCH                       each round: targets need no values
 *                MODEL SOLVE NOVELTY                      once, after the last
 *
 * NOVELTY is for directed exploration. It uses the model, which the next GROUP overwrites.
 *
 * With an incremental solver Q is learnt while observing, and there is no MODEL and no SOLVE.
 * Instead COPY_VALUES copies V for the targets, since V may change while the step is under way.
 *
 * The whole state of a phase is in the learner and in the tables. So a budget may end between any
 * two elementary steps, and the result does not depend on where. */
#include "rlvc/float_rules.h"

#include "learn.h"

#include "../base/float_math.h"
#include "../base/solver_select.h"
#include <string.h>

static uint32_t pairs(const rlvc_agent *agent) {
    return agent->tree.classes * agent->config.actions;
}

rlvc_target_input rlvc_learner_target_input(const rlvc_agent *agent, uint8_t kind) {
    rlvc_target_input made;
    made.returns.replay = &agent->replay;
    made.returns.end = agent->learner.end;
    made.returns.horizon = agent->step;
    made.returns.discount = agent->config.discount;
    made.returns.continuing = agent->config.continuing;
    made.values = &agent->values;
    made.gap = kind == RLVC_CRITERION_RESIDUAL ? 2.0f * agent->config.tolerance : 0.0f;
    made.kind = kind;
    return made;
}

rlvc_split_input rlvc_learner_split_input(const rlvc_agent *agent,
                                          const rlvc_target_input *criterion) {
    rlvc_split_input made = {&agent->space,
                             &agent->replay,
                             criterion,
                             &agent->domain,
                             agent->config.min_samples,
                             RLVC_HAS_EFFECT ? agent->config.smallest_effect : 0.0f,
                             RLVC_HAS_SCORE(RLVC_SCORE_RANKS) &&
                                 agent->config.score == RLVC_SCORE_RANKS};
    return made;
}

rlvc_solver_input rlvc_learner_solver_input(const rlvc_agent *agent) {
    rlvc_solver_input made = {agent->space.rows.transition, agent->tree.classes,
                              agent->config.max_sweeps, agent->config.discount,
                              agent->config.tolerance};
    return made;
}

/* The steps share alpha by doublings, 1, 2, 4, ... steps long: the d-th has 1 / (d (d + 1)) of it,
 * in equal parts, and so all together have it once. In a step the two phases share alike. */
float rlvc_learner_log_level(const rlvc_agent *agent) {
    float steps = 1.0f; /* of the doubling */
    uint32_t d = 1;
    /* (k + 1) / 2, where k + 1 may not fit. */
    for (uint32_t left = agent->step / 2u + agent->step % 2u; left != 0; left /= 2u) {
        steps *= 2.0f;
        d++;
    }
    float phases = agent->config.successors ? 2.0f : 1.0f;
    return rlvc_ln(agent->config.alpha) - rlvc_ln((float)(d * (d + 1u)) * steps * phases);
}

static void enter(rlvc_agent *agent, uint8_t phase) {
    rlvc_learner *learner = &agent->learner;
    learner->phase = phase;
    learner->at = 0;
    learner->walk.node = 0;
    learner->classes = agent->tree.classes;
    learner->searching = 0;
    if (phase == RLVC_PHASE_LABEL) {
        learner->rounds++;
    } else if (phase == RLVC_PHASE_GROUP) {
        rlvc_grouping_begin(&learner->work.grouping, pairs(agent));
    } else if (rlvc_phase_splits(phase)) {
        learner->made = 0;
    } else if (phase == RLVC_PHASE_MODEL) {
        rlvc_model_begin(&learner->work.model, pairs(agent));
    } else if (phase == RLVC_PHASE_SOLVE) {
        rlvc_solver_begin(&learner->work.solver, agent->config.solver);
    } else if (phase == RLVC_PHASE_NOVELTY) {
        rlvc_solver_input input = rlvc_learner_solver_input(agent);
        agent->explorer.min_tried = rlvc_explorer_min_tried(learner->end, pairs(agent));
        rlvc_novelty_begin(&learner->work.novelty, &input, &agent->values, learner->end);
    }
}

static uint16_t *label_at(const rlvc_replay *replay, uint32_t position) {
    return &replay->label[rlvc_replay_slot(replay, position)];
}

/* A step that has no new interaction to learn from would do again what the last one did. Without
 * one the last interaction has its label still: those of a step are given in order, abandoned
 * steps and pruning take them away, and so does step_finish where one is yet to come. */
static int is_learnt(const rlvc_agent *agent) {
    const uint32_t end = agent->learner.end;
    return end > 0 && !RLVC_BY_RETURNS(agent->config.criterion) &&
           *label_at(&agent->replay, end - 1u) != RLVC_NO_CLASS;
}

static void begin_step(rlvc_agent *agent) {
    agent->learner.end = rlvc_replay_freeze(&agent->replay);
    agent->learner.rounds = 0;
    agent->learner.splits = 0;
    enter(agent, is_learnt(agent) ? RLVC_PHASE_FINISH : RLVC_PHASE_LABEL);
}

/* ------------------------------------------------------------------ LABEL */

/* One test of the percept at position `at`: the whole way down the tree if it is new, else only the
 * split that the last round made of its class, if any. A unit each. */
static rlvc_status step_label(rlvc_agent *agent) {
    rlvc_learner *learner = &agent->learner;
    rlvc_replay *replay = &agent->replay;
    if (learner->at == replay->frozen) {
        if (RLVC_BY_RETURNS(agent->config.criterion))
            enter(agent, RLVC_PHASE_GROUP);
        else
            enter(agent,
                  rlvc_is_incremental(&agent->config) ? RLVC_PHASE_COPY_VALUES : RLVC_PHASE_MODEL);
        return RLVC_OK;
    }
    uint32_t slot = rlvc_replay_slot(replay, learner->at);
    uint16_t label = replay->label[slot];
    const void *percept = rlvc_replay_percept(replay, slot);
    if (label == RLVC_NO_CLASS) {
        if (rlvc_tree_is_leaf(&agent->tree, learner->walk.node)) {
            replay->label[slot] = (uint16_t)rlvc_tree_class(&agent->tree, learner->walk.node);
            learner->walk.node = 0;
            learner->at++;
            return RLVC_OK;
        }
        return rlvc_tree_descend(&agent->tree, &agent->domain, percept, &learner->walk.node);
    }
    if (agent->pending[label] != 0) {
        uint32_t split = agent->pending[label] - 1u;
        uint32_t node = agent->tree.split[split].node;
        rlvc_status status = rlvc_tree_descend(&agent->tree, &agent->domain, percept, &node);
        if (status != RLVC_OK)
            return status;
        if (node == 2u * split + 2u)
            replay->label[slot] = agent->pending[label];
    }
    learner->at++;
    return RLVC_OK;
}

/* ------------------------------------------------------------------ SEARCH */

/* What it is charged to decide upon a split: some logarithms, or this many features compared, or
 * nodes on the way to the leaf. */
#define DECIDE_UNITS 32u

/* Carries a split of class `at` out. @return 1; -1: its leaf is further away. */
static int grow(rlvc_agent *agent, rlvc_split *split, const void *feature) {
    rlvc_learner *learner = &agent->learner;
    uint32_t made = agent->tree.classes;
    if (learner->searching != RLVC_GROWING) {
        learner->searching = RLVC_GROWING;
        learner->walk.node = 2u * learner->at;
    }
    if (!rlvc_tree_seek_leaf(&agent->tree, &learner->walk.node, DECIDE_UNITS))
        return -1;
    split->class_id = learner->at;
    split->step = agent->step;
    rlvc_tree_grow(&agent->tree, learner->walk.node, split, feature);
    rlvc_values_inherit(&agent->values, made, learner->at);
    if (!rlvc_is_incremental(&agent->config)) { /* the next solution separates the two */
        rlvc_values_forget(&agent->values, made);
        rlvc_values_forget(&agent->values, learner->at);
    }
    rlvc_explorer_inherit(&agent->explorer, agent->config.actions, made, learner->at);
    agent->pending[learner->at] = (uint16_t)made;
    agent->pending[made] = 0;
    agent->last_split = agent->step;
    learner->made++;
    learner->splits++;
    return 1;
}

/* Compares some more of the tree's features with one.
 * @return 1 if it is among them; 0 if not, and then `node` is the tree's last split or there are
 * more. */
static int recognise(rlvc_agent *agent, const void *feature) {
    const rlvc_tree *tree = &agent->tree;
    rlvc_learner *learner = &agent->learner;
    for (uint32_t i = 0; i < DECIDE_UNITS && learner->walk.compared + 1u < tree->classes; i++) {
        if (memcmp(rlvc_tree_feature(tree, learner->walk.compared), feature, tree->feature_bytes) ==
            0)
            return 1;
        learner->walk.compared++;
    }
    return 0;
}

/* Whether a split that was found is significant if its feature is known. */
static int is_conceivable(const rlvc_agent *agent, const rlvc_split *split) {
    float level = rlvc_learner_log_level(agent), known = rlvc_ln(agent->config.alpha_known);
    return split->log_p < (level > known ? level : known);
}

/* Whether a split that was found is to be made; -1: not known yet. A feature that the tree tests is
 * no noise, and neither is one that the agent influences. */
static int is_significant(rlvc_agent *agent, const rlvc_split *split, const void *feature) {
    rlvc_learner *learner = &agent->learner;
    if (learner->searching == RLVC_GROWING)
        return 1;
    float level = rlvc_learner_log_level(agent);
    if (!is_conceivable(agent, split))
        return 0;
    if (learner->phase == RLVC_PHASE_SUCCESSORS || recognise(agent, feature))
        return 1;
    if (learner->walk.compared + 1u < agent->tree.classes)
        return -1; /* there are more features to compare with */
    if (!(split->log_p < level))
        return 0;
    if (!RLVC_HAS_DEPENDENCE || rlvc_dependence_done(&learner->dependence, learner->end))
        return 1; /* it is part of the p-value */
    /* All are 0 or 1, and 1 is the residual criterion. */
    learner->dependence.wanted =
        agent->config.dependence & agent->config.successors & agent->config.criterion;
    return learner->dependence.wanted ? -1 : 1;
}

rlvc_status rlvc_learner_weigh_dependence(rlvc_agent *agent, const void *feature, uint32_t budget,
                                          uint32_t *used) {
    rlvc_learner *learner = &agent->learner;
    rlvc_dependence *dependence = &learner->dependence;
    rlvc_target_input criterion = rlvc_learner_target_input(agent, RLVC_CRITERION_RESIDUAL);
    rlvc_split_input input = rlvc_learner_split_input(agent, &criterion);
    return rlvc_dependence_step(dependence, &input, learner->at, feature, budget, used);
}

int rlvc_learner_discount(rlvc_agent *agent) {
    rlvc_learner *learner = &agent->learner;
    rlvc_dependence *dependence = &learner->dependence;
    if (!dependence->wanted || !rlvc_dependence_done(dependence, learner->end))
        return 0;
    dependence->wanted = 0;
    rlvc_evidence_discount(&learner->work.split.evidence, rlvc_dependence_effect(dependence));
    return 1;
}

uint32_t rlvc_learner_decide(rlvc_agent *agent, rlvc_split *split, const void *feature) {
    rlvc_learner *learner = &agent->learner;
    uint32_t used = 1u;
    if (feature) {
        int made = is_significant(agent, split, feature);
        used = DECIDE_UNITS;
        if (made > 0 && agent->tree.classes == agent->tree.classes_max)
            agent->refused++;
        else if (made > 0)
            made = grow(agent, split, feature);
        if (made < 0)
            return used;
    }
    learner->searching = 0;
    learner->walk.compared = 0;
    if (RLVC_HAS_DEPENDENCE)
        rlvc_dependence_begin(&learner->dependence);
    learner->at++;
    return used;
}

static void end_round(rlvc_agent *agent) {
    const rlvc_config *config = &agent->config;
    if (agent->learner.made > 0)
        enter(agent, RLVC_PHASE_LABEL);
    else if (RLVC_BY_RETURNS(config->criterion))
        enter(agent, rlvc_is_incremental(config) ? RLVC_PHASE_FINISH : RLVC_PHASE_MODEL);
    else
        enter(agent, config->successors && agent->learner.phase == RLVC_PHASE_SEARCH
                         ? RLVC_PHASE_INFLUENCE
                         : RLVC_PHASE_FINISH);
}

void rlvc_learner_begin_search(rlvc_agent *agent) {
    rlvc_learner *learner = &agent->learner;
    rlvc_target_input criterion = rlvc_learner_target_input(agent, agent->config.criterion);
    rlvc_split_input input = rlvc_learner_split_input(agent, &criterion);
    const uint32_t *first = agent->values.begin.sample;
    if (learner->phase == RLVC_PHASE_SEARCH)
        rlvc_split_search_begin(&learner->work.split, &input,
                                first + rlvc_values_pair(&agent->values, learner->at, 0));
    else if (learner->phase == RLVC_PHASE_SUCCESSORS)
        rlvc_lasting_begin(&learner->work.successors, &input, first, learner->at,
                           learner->influenced);
    else
        rlvc_influence_begin(&learner->work.successors, &input, first,
                             learner->classes * agent->space.actions,
                             rlvc_learner_log_level(agent));
    learner->searching = RLVC_SEARCHING;
}

/* Goes on with what is sought in the phase. */
static rlvc_status look(rlvc_agent *agent, uint32_t budget, uint32_t *used) {
    rlvc_learner *learner = &agent->learner;
    rlvc_target_input criterion = rlvc_learner_target_input(agent, agent->config.criterion);
    rlvc_split_input input = rlvc_learner_split_input(agent, &criterion);
    return learner->phase == RLVC_PHASE_SEARCH
               ? rlvc_split_search_step(&learner->work.split, &input, budget, used)
               : rlvc_successor_search_step(&learner->work.successors, &input,
                                            agent->values.begin.sample, budget, used);
}

/* Whether class `at` is sorted, and what its search finds rests on the order of samples and
 * cutpoints alone. A slot holds the same sample until the first is given up; every other slot at
 * least holds an interaction, so that the head cannot have gone round by then. */
static int rests_on_order(const rlvc_agent *agent) {
    const rlvc_learner *learner = &agent->learner;
    return rlvc_workspace_remembers(&agent->space) && learner->phase == RLVC_PHASE_SEARCH &&
           rlvc_split_search_is_sorted(&learner->work.split) &&
           !RLVC_BY_RETURNS(agent->config.criterion) && !(agent->config.smallest_effect > 0.0f) &&
           agent->replay.head == 0 && agent->interactions <= agent->config.capacity;
}

/* Whether class `at` was searched in vain when its samples were in the same order: it would be
 * again, as the level only falls. It has to fit into the budget whole, so that no call ends
 * elsewhere than if it were searched. */
static int is_in_vain(const rlvc_agent *agent, uint32_t budget) {
    const rlvc_learner *learner = &agent->learner;
    const uint32_t units = agent->space.in_vain.units[learner->at];
    return units > 0 && agent->space.in_vain.order[learner->at] == learner->work.split.order &&
           budget > units && budget - units >= RLVC_BUDGET_MIN;
}

/* Searches class `at` from where it is sorted, and remembers if that was in vain. */
static rlvc_status look_on(rlvc_agent *agent, uint32_t budget, uint32_t *used) {
    const rlvc_learner *learner = &agent->learner;
    rlvc_status status = look(agent, budget, used);
    rlvc_split split;
    if (!learner->work.split.done)
        return status;
    const void *feature = rlvc_split_search_result(&learner->work.split, &agent->space, &split);
    if (feature && is_conceivable(agent, &split))
        return status;
    agent->space.in_vain.order[learner->at] = learner->work.split.order;
    agent->space.in_vain.units[learner->at] = *used + (feature ? DECIDE_UNITS : 1u);
    return status;
}

/* Does what follows when class `at` is sorted, or charges for what that would come to. */
static rlvc_status search_sorted(rlvc_agent *agent, uint32_t budget, uint32_t *used) {
    if (!is_in_vain(agent, budget))
        return look_on(agent, budget, used);
    *used = agent->space.in_vain.units[agent->learner.at];
    (void)rlvc_learner_decide(agent, NULL, NULL);
    return RLVC_OK;
}

/* Begins the search of class `at`, if it is not under way. */
static void open_class(rlvc_agent *agent) {
    if (!agent->learner.searching) {
        agent->pending[agent->learner.at] = 0;
        rlvc_learner_begin_search(agent);
    }
}

/* Works on class `at`, or on what is influenced in all. */
static rlvc_status step_search(rlvc_agent *agent, uint32_t budget, uint32_t *used) {
    rlvc_learner *learner = &agent->learner;
    const int succession = learner->phase != RLVC_PHASE_SEARCH;
    rlvc_split split;
    const void *feature;
    *used = 1;
    if (learner->at == learner->classes) {
        end_round(agent);
        return RLVC_OK;
    }
    open_class(agent);
    if (rests_on_order(agent))
        return search_sorted(agent, budget, used);
    if (succession ? !learner->work.successors.done : !learner->work.split.done)
        return look(agent, budget, used);
    if (learner->phase == RLVC_PHASE_INFLUENCE) {
        learner->influenced = learner->work.successors.kept;
        enter(agent, learner->influenced > 0 ? RLVC_PHASE_SUCCESSORS : RLVC_PHASE_FINISH);
        return RLVC_OK;
    }
    if (RLVC_HAS_DEPENDENCE && rlvc_learner_discount(agent)) {
        *used = RLVC_TEST_UNITS;
        return RLVC_OK;
    }
    feature = succession
                  ? rlvc_successor_search_result(&learner->work.successors, &agent->space, &split)
                  : rlvc_split_search_result(&learner->work.split, &agent->space, &split);
    if (RLVC_HAS_DEPENDENCE && learner->dependence.wanted)
        return rlvc_learner_weigh_dependence(agent, feature, budget, used);
    *used = rlvc_learner_decide(agent, &split, feature);
    return RLVC_OK;
}

/* ------------------------------------------------------------------ the other phases */

/* Keeps V of class `at`, for targets. A unit each. */
static void step_copy_values(rlvc_agent *agent) {
    uint32_t c = agent->learner.at++;
    if (c < agent->tree.classes)
        agent->values.target[c] = agent->values.value[c];
    else
        enter(agent, RLVC_PHASE_GROUP);
}

static uint32_t step_group(rlvc_agent *agent, uint32_t budget) {
    rlvc_grouping_cursor *grouping = &agent->learner.work.grouping;
    rlvc_target_input criterion = rlvc_learner_target_input(agent, agent->config.criterion);
    uint32_t used = rlvc_grouping_step(grouping, &criterion, agent->space.rows.sample,
                                       agent->values.begin.sample, budget);
    if (grouping->done)
        enter(agent, RLVC_PHASE_SEARCH);
    return used;
}

static uint32_t step_model(rlvc_agent *agent, uint32_t budget) {
    rlvc_model_cursor *model = &agent->learner.work.model;
    rlvc_target_input successor = rlvc_learner_target_input(agent, RLVC_TARGET_SUCCESSOR);
    uint32_t used = rlvc_model_step(model, &successor, &agent->values, agent->space.rows,
                                    agent->space.columns, budget);
    if (model->done)
        enter(agent, RLVC_PHASE_SOLVE);
    return used;
}

/* What a unit of the solver's is charged: it is arithmetic, where others but look. */
#define SOLVE_UNITS 2u

/* The values are there: what comes then. */
static void leave_model(rlvc_agent *agent) {
    enter(agent, RLVC_BY_RETURNS(agent->config.criterion) ? RLVC_PHASE_FINISH : RLVC_PHASE_GROUP);
}

static uint32_t step_solve(rlvc_agent *agent, uint32_t budget) {
    rlvc_solver_cursor *solver = &agent->learner.work.solver;
    rlvc_solver_input input = rlvc_learner_solver_input(agent);
    uint32_t used =
        SOLVE_UNITS * rlvc_solver_step(solver, &input, &agent->values, budget / SOLVE_UNITS);
    if (solver->done) {
        agent->sweeps = solver->sweeps;
        agent->residual = rlvc_solver_residual(solver);
        if (agent->config.explore == RLVC_EXPLORE_DIRECTED)
            enter(agent, RLVC_PHASE_NOVELTY);
        else
            leave_model(agent);
    }
    return used;
}

static uint32_t step_seek(rlvc_agent *agent, uint32_t budget) {
    rlvc_novelty_cursor *seeking = &agent->learner.work.novelty;
    rlvc_solver_input input = rlvc_learner_solver_input(agent);
    uint32_t used = SOLVE_UNITS * rlvc_novelty_step(seeking, &input, &agent->values, &agent->replay,
                                                    &agent->explorer, budget / SOLVE_UNITS);
    if (seeking->done)
        leave_model(agent);
    return used;
}

/* Makes the policy of class `at` greedy; after the last class ends the step. A unit each. */
static void step_finish(rlvc_agent *agent) {
    rlvc_learner *learner = &agent->learner;
    if (learner->at < agent->tree.classes) {
        agent->values.policy[learner->at] =
            (uint8_t)rlvc_values_greedy(&agent->values, learner->at);
        learner->at++;
        return;
    }
    /* The next step of the returns criterion looks at longer windows under another policy: the
     * database must be collected afresh (section 4.2.1). */
    if (RLVC_BY_RETURNS(agent->config.criterion))
        rlvc_replay_clear(&agent->replay);
    if (agent->replay.frozen > learner->end)
        *label_at(&agent->replay, learner->end) = RLVC_NO_CLASS; /* its interaction is to come */
    agent->replay.frozen = 0;
    agent->run = 0;
    agent->step++;
    learner->phase = RLVC_PHASE_IDLE;
}

static rlvc_status step_phase(rlvc_agent *agent, uint32_t budget, uint32_t *used) {
    rlvc_status status = RLVC_OK;
    *used = 1;
    switch (agent->learner.phase) {
    case RLVC_PHASE_LABEL:
        status = step_label(agent);
        break;
    case RLVC_PHASE_COPY_VALUES:
        if (RLVC_HAS_INCREMENTAL)
            step_copy_values(agent);
        break;
    case RLVC_PHASE_GROUP:
        *used = step_group(agent, budget);
        break;
    case RLVC_PHASE_SEARCH:
    case RLVC_PHASE_INFLUENCE:
    case RLVC_PHASE_SUCCESSORS:
        status = step_search(agent, budget, used);
        break;
    case RLVC_PHASE_MODEL:
        *used = step_model(agent, budget);
        break;
    case RLVC_PHASE_SOLVE:
        *used = step_solve(agent, budget);
        break;
    case RLVC_PHASE_NOVELTY:
        *used = step_seek(agent, budget);
        break;
    default:
        step_finish(agent);
        break;
    }
    return status;
}

/* The units that the phase needs to get on: some have steps that are not divided further. */
static uint32_t needed(const rlvc_agent *agent) {
    uint8_t phase = agent->learner.phase;
    return phase == RLVC_PHASE_MODEL || rlvc_phase_splits(phase) ? RLVC_BUDGET_MIN : SOLVE_UNITS;
}

rlvc_status rlvc_classes_learn(rlvc_agent *agent, uint32_t budget, rlvc_progress *progress) {
    if (!agent || !progress)
        return RLVC_E_NULL;
    if (agent->busy)
        return RLVC_E_REENTERED;
    if (budget < RLVC_BUDGET_MIN)
        return RLVC_E_RANGE;
    rlvc_status status = RLVC_OK;
    uint32_t work = 0;
    int unbounded = budget == RLVC_BUDGET_UNBOUNDED;
    if (agent->learner.phase == RLVC_PHASE_IDLE)
        begin_step(agent);
    agent->busy = 1;
    while (status == RLVC_OK && agent->learner.phase != RLVC_PHASE_IDLE &&
           (unbounded || budget - work >= needed(agent))) {
        uint32_t used = 0;
        status = step_phase(agent, unbounded ? budget : budget - work, &used);
        work += used;
        work |= 0u - (uint32_t)(work < used); /* all ones where it does not fit */
    }
    agent->busy = 0;
    agent->learner.failed = status != RLVC_OK;
    memset(progress, 0, sizeof *progress);
    progress->work = work;
    progress->rounds = agent->learner.rounds;
    progress->splits = agent->learner.splits;
    progress->done = agent->learner.phase == RLVC_PHASE_IDLE;
    return status;
}

/* In the middle of a step labels and `pending` go together; without either all is well. */
rlvc_status rlvc_learn_abandon(rlvc_agent *agent) {
    if (!agent)
        return RLVC_E_NULL;
    if (rlvc_agent_plans(agent))
        return RLVC_E_MISMATCH;
    if (agent->busy)
        return RLVC_E_REENTERED;
    if (agent->learner.phase == RLVC_PHASE_IDLE)
        return RLVC_OK;
    rlvc_replay *replay = &agent->replay;
    memset(replay->label, 0xff, replay->slots * sizeof *replay->label); /* RLVC_NO_CLASS */
    memset(agent->pending, 0, agent->tree.classes * sizeof *agent->pending);
    replay->frozen = 0;
    if (RLVC_HAS_DEPENDENCE) /* what was weighed may never be found again */
        rlvc_dependence_begin(&agent->learner.dependence);
    agent->learner.phase = RLVC_PHASE_IDLE;
    agent->learner.failed = 0;
    return RLVC_OK;
}
