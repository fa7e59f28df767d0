/* SPDX-License-Identifier: MIT */
/* Marks of cursors, and the way back to them: see cursor_marks.h. */
#include "rlvc/float_rules.h"

#include "cursor_marks.h"

#include "../agent/learn.h"
#include <string.h>

/* ------------------------------------------------------------------ marks */

void rlvc_cursor_marks_take(const rlvc_agent *agent, rlvc_cursor_mark *mark) {
    const rlvc_learner *learner = &agent->learner;
    memset(mark, 0, sizeof *mark);
    if (learner->phase == RLVC_PHASE_GROUP)
        rlvc_grouping_mark(&learner->work.grouping, mark->word);
    else if (learner->phase == RLVC_PHASE_MODEL)
        rlvc_model_mark(&learner->work.model, mark->word);
    else if (learner->phase == RLVC_PHASE_SOLVE)
        rlvc_solver_mark(&learner->work.solver, mark->word);
    else if (learner->phase == RLVC_PHASE_NOVELTY)
        rlvc_novelty_mark(&learner->work.novelty, mark->word);
    else if (learner->phase == RLVC_PHASE_SEARCH && learner->searching) {
        rlvc_split_search_mark(&learner->work.split, mark->word);
        if (learner->work.split.done) {
            mark->word[8] = learner->dependence.wanted + 2u * learner->dependence.again;
            mark->word[9] = learner->dependence.at;
        }
    } else if (rlvc_phase_splits(learner->phase) && learner->searching)
        rlvc_successor_search_mark(&learner->work.successors, mark->word);
}

/* ------------------------------------------------------------------ checks */

/* The highest `at` of each phase, or 0 where it is not used. */
static uint32_t last_at(const rlvc_agent *agent) {
    switch (agent->learner.phase) {
    case RLVC_PHASE_LABEL:
        return agent->replay.frozen;
    case RLVC_PHASE_COPY_VALUES:
    case RLVC_PHASE_FINISH:
        return agent->tree.classes;
    case RLVC_PHASE_SEARCH:
    case RLVC_PHASE_SUCCESSORS:
        return agent->learner.classes;
    default:
        return 0;
    }
}

/* Does the config have this phase? */
static int phase_is_possible(const rlvc_agent *agent) {
    int incremental = rlvc_is_incremental(&agent->config);
    switch (agent->learner.phase) {
    case RLVC_PHASE_COPY_VALUES:
        return incremental && agent->config.criterion == RLVC_CRITERION_RESIDUAL;
    case RLVC_PHASE_MODEL:
    case RLVC_PHASE_SOLVE:
        return !incremental;
    case RLVC_PHASE_NOVELTY:
        return !incremental && agent->config.explore == RLVC_EXPLORE_DIRECTED;
    case RLVC_PHASE_INFLUENCE:
    case RLVC_PHASE_SUCCESSORS:
        return agent->config.successors && agent->config.criterion == RLVC_CRITERION_RESIDUAL;
    default:
        return 1;
    }
}

/* Is the database what rlvc_replay_freeze made of some ring: does each s' in it have a label to
 * come? */
static int database_is_sound(const rlvc_agent *agent) {
    const rlvc_replay *replay = &agent->replay;
    uint32_t end = agent->learner.end;
    if (replay->frozen < end || replay->frozen - end > 1u)
        return 0;
    int awaited = end > 0 && rlvc_replay_linked(replay, rlvc_replay_slot(replay, end - 1u));
    return awaited == (replay->frozen > end);
}

/* Labels that were given in this step are classes of the round. */
static int labels_are_sound(const rlvc_agent *agent) {
    const rlvc_learner *learner = &agent->learner;
    const rlvc_replay *replay = &agent->replay;
    uint32_t given = learner->phase == RLVC_PHASE_LABEL ? learner->at : replay->frozen;
    for (uint32_t position = 0; position < given; position++) {
        if (replay->label[rlvc_replay_slot(replay, position)] >= learner->classes)
            return 0;
    }
    return 1;
}

/* Where `pending` names a class, that was split from this one. */
static int pending_is_sound(const rlvc_agent *agent) {
    for (uint32_t c = 0; c < agent->tree.classes; c++) {
        uint32_t made = agent->pending[c];
        if (made != 0 &&
            (made >= agent->tree.classes || agent->tree.split[made - 1u].about.class_id != c))
            return 0;
    }
    return 1;
}

static int counts_are_sound(const rlvc_agent *agent) {
    const rlvc_learner *learner = &agent->learner;
    const uint32_t classes = agent->tree.classes;
    uint32_t made = rlvc_phase_splits(learner->phase) ? learner->made : 0;
    return learner->at <= last_at(agent) && learner->walk.node <= 2u * (classes - 1u) &&
           learner->made <= classes && learner->splits < classes &&
           learner->classes == classes - made;
}

/* A split that is being made leads down the chain of its class. */
static int search_is_sound(const rlvc_agent *agent) {
    const rlvc_learner *learner = &agent->learner;
    const int may_search = rlvc_phase_splits(learner->phase) && learner->at < learner->classes;
    if (learner->searching == RLVC_GROWING)
        return may_search && rlvc_tree_first_class(&agent->tree, learner->walk.node) == learner->at;
    return learner->searching <= may_search;
}

int rlvc_cursor_marks_check(const rlvc_agent *agent) {
    const rlvc_learner *learner = &agent->learner;
    if (learner->phase > RLVC_PHASE_INFLUENCE || !phase_is_possible(agent) ||
        !pending_is_sound(agent))
        return 0;
    //@ split learner->phase;
    if (learner->phase == RLVC_PHASE_IDLE)
        return agent->replay.frozen == 0;
    return counts_are_sound(agent) && search_is_sound(agent) && database_is_sound(agent) &&
           labels_are_sound(agent);
}

/* ------------------------------------------------------------------ the way back */

static int is_done(const rlvc_agent *agent) {
    const rlvc_learner *learner = &agent->learner;
    if (learner->phase == RLVC_PHASE_GROUP)
        return learner->work.grouping.done;
    if (learner->phase == RLVC_PHASE_INFLUENCE || learner->phase == RLVC_PHASE_SUCCESSORS)
        return learner->work.successors.done;
    if (learner->phase == RLVC_PHASE_NOVELTY)
        return learner->work.novelty.done;
    if (learner->phase == RLVC_PHASE_MODEL)
        return learner->work.model.done;
    if (RLVC_HAS_DEPENDENCE && learner->dependence.wanted)
        return 0;
    return learner->work.split.done &&
           (!RLVC_HAS_DEPENDENCE || rlvc_dependence_done(&learner->dependence, learner->end));
}

/* What was counted while the phase was under way stays as it was loaded. */
static void novelty_single(rlvc_agent *agent) {
    rlvc_solver_input input = rlvc_learner_solver_input(agent);
    rlvc_explorer counted = agent->explorer;
    counted.count = NULL;
    (void)rlvc_novelty_step(&agent->learner.work.novelty, &input, &agent->values, &agent->replay,
                            &counted, 1);
}

/* Begins, looks at a position of the ring, or weighs what was found. */
static rlvc_status redo_dependence(rlvc_agent *agent) {
    rlvc_learner *learner = &agent->learner;
    rlvc_split split;
    uint32_t used;
    const void *feature = rlvc_split_search_result(&learner->work.split, &agent->space, &split);
    if (!feature)
        return RLVC_E_DAMAGED;
    if (!learner->dependence.wanted) {
        learner->dependence.wanted = 1;
        return RLVC_OK;
    }
    if (rlvc_learner_discount(agent))
        return RLVC_OK;
    return rlvc_learner_weigh_dependence(agent, feature, RLVC_DEPENDENCE_UNITS, &used);
}

static rlvc_status single(rlvc_agent *agent) {
    rlvc_learner *learner = &agent->learner;
    rlvc_target_input criterion = rlvc_learner_target_input(agent, agent->config.criterion);
    rlvc_target_input successor = rlvc_learner_target_input(agent, RLVC_TARGET_SUCCESSOR);
    rlvc_split_input input = rlvc_learner_split_input(agent, &criterion);
    if (RLVC_HAS_DEPENDENCE && learner->phase == RLVC_PHASE_SEARCH && learner->work.split.done)
        return redo_dependence(agent);
    if (learner->phase == RLVC_PHASE_SEARCH)
        return rlvc_split_search_single(&learner->work.split, &input);
    if (learner->phase == RLVC_PHASE_INFLUENCE || learner->phase == RLVC_PHASE_SUCCESSORS)
        return rlvc_successor_search_single(&learner->work.successors, &input,
                                            agent->values.begin.sample);
    if (learner->phase == RLVC_PHASE_NOVELTY)
        novelty_single(agent);
    else if (learner->phase == RLVC_PHASE_GROUP)
        (void)rlvc_grouping_step(&learner->work.grouping, &criterion, agent->space.rows.sample,
                                 agent->values.begin.sample, 1);
    else
        rlvc_model_single(&learner->work.model, &successor, &agent->values, agent->space.rows,
                          agent->space.columns);
    return RLVC_OK;
}

/* Goes on until the mark is reached; without one, until the phase is done. */
static rlvc_status advance_to(rlvc_agent *agent, const rlvc_cursor_mark *mark) {
    for (;;) {
        rlvc_cursor_mark here;
        rlvc_cursor_marks_take(agent, &here);
        if (mark && memcmp(&here, mark, sizeof here) == 0)
            return RLVC_OK;
        if (is_done(agent))
            return mark ? RLVC_E_DAMAGED : RLVC_OK;
        rlvc_status status = single(agent);
        if (status != RLVC_OK)
            return status;
    }
}

/* Does GROUP or MODEL anew, up to a mark or to its end. */
static rlvc_status redo(rlvc_agent *agent, uint8_t phase, const rlvc_cursor_mark *mark) {
    rlvc_learner *learner = &agent->learner;
    uint8_t now = learner->phase;
    uint32_t pairs = learner->classes * agent->config.actions;
    learner->phase = phase;
    if (phase == RLVC_PHASE_GROUP)
        rlvc_grouping_begin(&learner->work.grouping, pairs);
    else
        rlvc_model_begin(&learner->work.model, pairs);
    rlvc_status status = advance_to(agent, mark);
    learner->phase = now;
    return status;
}

/* Sorts what GROUP has put in order of time, class by class as far as the step had searched them:
 * INFLUENCE hands the samples of all classes to candidates(), which may go by their order. Those of
 * bits do not. */
static void redo_order(rlvc_agent *agent) {
    rlvc_learner *learner = &agent->learner;
    rlvc_target_input criterion = rlvc_learner_target_input(agent, agent->config.criterion);
    rlvc_split_input input = rlvc_learner_split_input(agent, &criterion);
    const uint32_t searched = learner->phase == RLVC_PHASE_SEARCH ? learner->at : learner->classes;
    for (uint32_t c = 0; c < searched; c++)
        rlvc_split_search_sort(&learner->work.split, &input,
                               agent->values.begin.sample + rlvc_values_pair(&agent->values, c, 0));
}

/* The features that are influenced, anew. `step` and the classes, which tell the level and the
 * strata, are as they were. */
static rlvc_status redo_influence(rlvc_agent *agent) {
    rlvc_learner *learner = &agent->learner;
    learner->phase = RLVC_PHASE_INFLUENCE;
    rlvc_learner_begin_search(agent);
    rlvc_status status = advance_to(agent, NULL);
    learner->phase = RLVC_PHASE_SUCCESSORS;
    learner->influenced = learner->work.successors.kept;
    return status;
}

static rlvc_status redo_search(rlvc_agent *agent, const rlvc_cursor_mark *mark) {
    rlvc_learner *learner = &agent->learner;
    uint8_t searching = learner->searching;
    rlvc_status status = RLVC_OK;
    (void)redo(agent, RLVC_PHASE_GROUP, NULL);
    if (RLVC_HAS_OTHER_DOMAINS)
        redo_order(agent);
    if (learner->phase == RLVC_PHASE_SUCCESSORS)
        status = redo_influence(agent);
    if (status == RLVC_OK && searching) {
        rlvc_learner_begin_search(agent);
        status = advance_to(agent, mark);
    }
    learner->searching = searching;
    return status;
}

/* The solver goes over the values in place, so that its cursor is taken from the mark itself. */
static rlvc_status redo_solve(rlvc_agent *agent, const rlvc_cursor_mark *mark) {
    rlvc_solver_cursor *solver = &agent->learner.work.solver;
    rlvc_solver_input input = rlvc_learner_solver_input(agent);
    (void)redo(agent, RLVC_PHASE_MODEL, NULL);
    rlvc_solver_begin(solver, agent->config.solver);
    return rlvc_solver_restore(solver, &input, &agent->values, mark->word) ? RLVC_OK
                                                                           : RLVC_E_DAMAGED;
}

static rlvc_status redo_seek(rlvc_agent *agent, const rlvc_cursor_mark *mark) {
    rlvc_solver_input input = rlvc_learner_solver_input(agent);
    (void)redo(agent, RLVC_PHASE_MODEL, NULL);
    rlvc_novelty_begin(&agent->learner.work.novelty, &input, &agent->values, agent->learner.end);
    return advance_to(agent, mark);
}

rlvc_status rlvc_cursor_marks_resume(rlvc_agent *agent, const rlvc_cursor_mark *mark) {
    static const rlvc_cursor_mark none = {{0}};
    rlvc_learner *learner = &agent->learner;
    if (learner->phase == RLVC_PHASE_NOVELTY)
        return redo_seek(agent, mark);
    if (learner->phase == RLVC_PHASE_SOLVE)
        return redo_solve(agent, mark);
    if (rlvc_phase_splits(learner->phase) && learner->searching)
        return redo_search(agent, mark);
    if (learner->phase == RLVC_PHASE_GROUP || learner->phase == RLVC_PHASE_MODEL)
        return redo(agent, learner->phase, mark);
    if (memcmp(mark, &none, sizeof none) != 0)
        return RLVC_E_DAMAGED;
    return rlvc_phase_splits(learner->phase) ? redo_search(agent, mark) : RLVC_OK;
}
