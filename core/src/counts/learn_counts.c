/* SPDX-License-Identifier: MIT */
/* A learning step of counts: the rounds of agent/learn.c, with its decisions, on rows. */
#include "rlvc/float_rules.h"

#include "../agent/learn.h"
#include "table.h"
#include <string.h>

static int can_learn(const rlvc_agent *agent) {
    const rlvc_config *config = &agent->config;
    return !RLVC_BY_RETURNS(config->criterion) && !rlvc_is_incremental(config) &&
           config->score == RLVC_SCORE_GAIN && !(config->dependence && config->successors) &&
           !agent->domain.oracle;
}

rlvc_status rlvc_counts_size(const rlvc_agent *agent, const rlvc_counts *counts, size_t *bytes) {
    if (!agent || !counts || !bytes)
        return RLVC_E_NULL;
    if (rlvc_agent_plans(agent))
        return RLVC_E_MISMATCH;
    rlvc_arena arena = {NULL, 0};
    rlvc_count_table table;
    uint64_t total;
    *bytes = 0;
    rlvc_status status = rlvc_counts_check(agent, counts, &total);
    if (status != RLVC_OK)
        return status;
    rlvc_count_table_carve(&table, &arena, agent, counts);
    if (arena.used > SIZE_MAX)
        return RLVC_E_MEMORY;
    *bytes = (size_t)arena.used;
    return RLVC_OK;
}

/* What is novel, by the model; counts do not tell where episodes began. */
static void seek(rlvc_agent *agent, const rlvc_solver_input *input, uint64_t total) {
    rlvc_novelty_cursor *novelty = &agent->learner.work.novelty;
    uint32_t interactions = rlvc_count_stored((rlvc_count)total);
    agent->explorer.min_tried =
        rlvc_explorer_min_tried(interactions, agent->tree.classes * agent->config.actions);
    rlvc_novelty_begin(novelty, input, &agent->values, 0);
    while (!novelty->done)
        (void)rlvc_novelty_step(novelty, input, &agent->values, &agent->replay, &agent->explorer,
                                RLVC_BUDGET_UNBOUNDED);
}

/* The model and the values. */
static void solve(rlvc_agent *agent, rlvc_count_table *table, uint64_t total) {
    rlvc_solver_cursor *solver = &agent->learner.work.solver;
    rlvc_count_table_group(table, agent);
    rlvc_count_model(table, agent);
    rlvc_solver_input input = rlvc_learner_solver_input(agent);
    input.transition = table->transition;
    rlvc_solver_begin(solver, agent->config.solver);
    while (!solver->done)
        (void)rlvc_solver_step(solver, &input, &agent->values, RLVC_BUDGET_UNBOUNDED);
    agent->sweeps = solver->sweeps;
    agent->residual = rlvc_solver_residual(solver);
    if (agent->config.explore == RLVC_EXPLORE_DIRECTED)
        seek(agent, &input, total);
}

/* Looks for splits in each class. What is found is decided upon as in rlvc_learn. */
static void search(rlvc_agent *agent, rlvc_count_table *table, uint8_t phase) {
    rlvc_learner *learner = &agent->learner;
    learner->phase = phase;
    learner->at = 0;
    learner->walk.compared = 0;
    learner->classes = agent->tree.classes;
    learner->made = 0;
    if (phase == RLVC_PHASE_SUCCESSORS)
        learner->influenced = rlvc_count_influence(table, agent);
    while (learner->at < learner->classes) {
        uint32_t class_id = learner->at;
        rlvc_split split;
        const void *feature =
            phase == RLVC_PHASE_SEARCH
                ? rlvc_count_search(table, agent, class_id, &split)
                : rlvc_count_lasting(table, agent, class_id, learner->influenced, &split);
        while (learner->at == class_id)
            (void)rlvc_learner_decide(agent, &split, feature);
    }
}

/* A round on tables that are sound. */
static void learn_round(rlvc_agent *agent, rlvc_count_table *table, uint64_t total,
                        rlvc_progress *progress) {
    rlvc_learner *learner = &agent->learner;
    rlvc_progress ended;
    learner->rounds = 1;
    learner->splits = 0;
    solve(agent, table, total);
    rlvc_count_table_group(table, agent);
    search(agent, table, RLVC_PHASE_SEARCH);
    if (learner->made == 0 && agent->config.successors)
        search(agent, table, RLVC_PHASE_SUCCESSORS);
    progress->rounds = 1;
    progress->splits = learner->splits;
    if (learner->splits > 0) {
        (void)rlvc_learn_abandon(agent); /* the ring's labels are of the tree as it was */
        return;
    }
    progress->done = 1;
    agent->interactions += total;
    learner->phase = RLVC_PHASE_FINISH;
    learner->at = 0;
    (void)rlvc_classes_learn(agent, RLVC_BUDGET_UNBOUNDED, &ended);
}

rlvc_status rlvc_learn_counts(rlvc_agent *agent, const rlvc_counts *counts, void *memory,
                              size_t bytes, rlvc_progress *progress) {
    if (!agent || !counts || !progress)
        return RLVC_E_NULL;
    if (rlvc_agent_plans(agent))
        return RLVC_E_MISMATCH;
    if (agent->busy)
        return RLVC_E_REENTERED;
    if (!can_learn(agent))
        return RLVC_E_CONFIG;
    if (agent->learner.phase != RLVC_PHASE_IDLE)
        return RLVC_E_BUSY;
    uint64_t total;
    rlvc_status status = rlvc_counts_check(agent, counts, &total);
    if (status != RLVC_OK)
        return status;
    if (!rlvc_counts_check_features(agent, counts))
        return RLVC_E_RANGE;
    rlvc_arena arena = {NULL, 0};
    rlvc_count_table table;
    rlvc_count_table_carve(&table, &arena, agent, counts);
    status = rlvc_arena_check(memory, bytes, (size_t)arena.used);
    if (status != RLVC_OK)
        return status;
    arena.base = memory;
    arena.used = 0;
    rlvc_count_table_carve(&table, &arena, agent, counts);
    memset(progress, 0, sizeof *progress);
    status = rlvc_count_table_classify(&table, agent);
    if (status == RLVC_OK)
        learn_round(agent, &table, total, progress);
    return status;
}
