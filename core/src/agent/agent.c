/* SPDX-License-Identifier: MIT */
/* The method of classes: making an agent, acting and observing (section 4.2.1, part 2), and asking
 * it. */
#include "rlvc/float_rules.h"

#include "rlvc/agent.h"

#include "../solve/td.h"
#include "state.h"
#include <string.h>

/* The macro of agent.h allows for this. */
typedef char fixed_part_fits[sizeof(rlvc_agent) <= RLVC_AGENT_FIXED_BYTES ? 1 : -1];
typedef char config_is_first[offsetof(rlvc_agent, config) == 0 ? 1 : -1];
typedef char split_record_fits[sizeof(rlvc_tree_split) == RLVC_SPLIT_BYTES ? 1 : -1];

/* ------------------------------------------------------------------ making an agent */

/* Lays the agent out behind *agent. */
static void carve(rlvc_agent *agent, const rlvc_config *config, const rlvc_domain *domain,
                  rlvc_arena *arena) {
    (void)rlvc_arena_carve(arena, 1, sizeof *agent);
    rlvc_replay_carve(&agent->replay, arena, config, domain->percept_bytes);
    rlvc_tree_carve(&agent->tree, arena, config->classes, domain->feature_bytes);
    rlvc_values_carve(&agent->values, arena, config);
    rlvc_explorer_carve(&agent->explorer, arena, config);
    agent->pending = rlvc_arena_carve(arena, config->classes, sizeof *agent->pending);
    rlvc_workspace_carve(&agent->space, arena, config, domain->feature_bytes);
}

rlvc_status rlvc_classes_size(const rlvc_config *config, const rlvc_domain *domain, size_t *bytes) {
    if (!bytes)
        return RLVC_E_NULL;
    rlvc_status status = rlvc_config_status(config, domain);
    rlvc_arena arena = {NULL, 0};
    if (status == RLVC_OK) {
        rlvc_agent agent;
        carve(&agent, config, domain, &arena);
        if (arena.used > SIZE_MAX) {
            arena.used = 0;
            status = RLVC_E_MEMORY;
        }
    }
    if (status != RLVC_E_NULL)
        *bytes = (size_t)arena.used;
    return status;
}

rlvc_status rlvc_classes_init(const rlvc_config *config, const rlvc_domain *domain, void *memory,
                              size_t bytes, rlvc_agent **agent) {
    if (!agent)
        return RLVC_E_NULL;
    *agent = NULL;
    size_t needed = 0;
    rlvc_status status = rlvc_classes_size(config, domain, &needed);
    if (status == RLVC_OK)
        status = rlvc_arena_check(memory, bytes, needed);
    if (status != RLVC_OK)
        return status;
    rlvc_arena arena = {(unsigned char *)memory, 0};
    rlvc_agent *made = memory;
    const rlvc_config copied_config = *config; /* they may lie in the block */
    const rlvc_domain copied_domain = *domain;
    RLVC_UNPOISON(memory, needed);
    memset(made, 0, sizeof *made);
    made->config = copied_config;
    made->domain = copied_domain;
    carve(made, &made->config, &made->domain, &arena);
    rlvc_tree_clear(&made->tree);
    rlvc_values_clear(&made->values);
    rlvc_explorer_clear(&made->explorer, made->config.actions);
    made->pending[0] = 0;
    if (rlvc_workspace_remembers(&made->space))
        memset(made->space.in_vain.units, 0,
               made->config.classes * sizeof *made->space.in_vain.units);
    rlvc_rng_seed(&made->rng, made->config.seed);
    *agent = made;
    return RLVC_OK;
}

/* ------------------------------------------------------------------ acting and observing */

static rlvc_status available(const rlvc_agent *agent) {
    if (!agent)
        return RLVC_E_NULL;
    if (rlvc_agent_plans(agent))
        return RLVC_E_MISMATCH;
    return agent->busy ? RLVC_E_REENTERED : RLVC_OK;
}

static rlvc_status classify(rlvc_agent *agent, const void *percept, uint32_t *class_id) {
    agent->busy = 1;
    rlvc_status status = rlvc_tree_classify(&agent->tree, &agent->domain, percept, class_id);
    agent->busy = 0;
    return status;
}

/* Asks the domain about a percept. */
static rlvc_status vouch(rlvc_agent *agent, const void *percept) {
    const rlvc_domain *domain = &agent->domain;
    if (!RLVC_HAS_OTHER_DOMAINS || !domain->check_percept)
        return RLVC_OK;
    agent->busy = 1;
    int refused = domain->check_percept(domain->ctx, percept);
    agent->busy = 0;
    return refused ? RLVC_E_PERCEPT : RLVC_OK;
}

rlvc_status rlvc_classes_begin(rlvc_agent *agent, const void *percept) {
    rlvc_status status = available(agent);
    if (status != RLVC_OK)
        return status;
    if (!percept)
        return RLVC_E_NULL;
    status = vouch(agent, percept);
    if (status != RLVC_OK)
        return status;
    /* A run of exploitation goes on where the window of definition 1 does. */
    int goes_on = RLVC_BY_RETURNS(agent->config.criterion) && agent->config.continuing &&
                  !agent->replay.open && agent->replay.count > 0 &&
                  (agent->replay.flags[rlvc_replay_slot(&agent->replay, agent->replay.count - 1)] &
                   RLVC_SLOT_TERMINATED);
    status = rlvc_replay_begin(&agent->replay, percept);
    if (status == RLVC_E_BUSY && agent->learner.failed) {
        (void)rlvc_learn_abandon(agent);
        status = rlvc_replay_begin(&agent->replay, percept);
    }
    if (status == RLVC_OK && !goes_on)
        agent->run = 0;
    return status;
}

/* The class of the current percept. */
static rlvc_status current_class(rlvc_agent *agent, uint32_t *class_id) {
    uint32_t slot = rlvc_replay_slot(&agent->replay, agent->replay.count - 1);
    return classify(agent, rlvc_replay_percept(&agent->replay, slot), class_id);
}

static uint32_t explore(const rlvc_agent *agent, uint32_t class_id, rlvc_rng *rng) {
    if (agent->config.explore == RLVC_EXPLORE_DIRECTED)
        return rlvc_explorer_choose(&agent->explorer, agent->config.actions, class_id, rng);
    return rlvc_rng_below(rng, agent->config.actions);
}

rlvc_status rlvc_classes_act(rlvc_agent *agent, rlvc_choice *choice) {
    rlvc_status status = available(agent);
    if (status != RLVC_OK)
        return status;
    if (!choice)
        return RLVC_E_NULL;
    if (!agent->replay.open)
        return RLVC_E_ORDER;
    int directed = agent->config.explore == RLVC_EXPLORE_DIRECTED;
    rlvc_rng rng = agent->rng;
    uint32_t run = agent->run, class_id = 0, action;
    if (run == 0 && !(rlvc_rng_uniform(&rng) < agent->config.epsilon))
        run = RLVC_BY_RETURNS(agent->config.criterion) ? agent->step + 1u : 1u;
    if (run > 0 || directed)
        status = current_class(agent, &class_id);
    if (status != RLVC_OK)
        return status;
    action = run > 0 ? agent->values.policy[class_id] : explore(agent, class_id, &rng);
    if (directed)
        rlvc_explorer_note(&agent->explorer, agent->config.actions, class_id, action);
    choice->action = (uint8_t)action;
    choice->exploited = run > 0;
    agent->run = run - (run > 0);
    agent->rng = rng;
    return RLVC_OK;
}

static rlvc_status check_observation(const rlvc_agent *agent, rlvc_choice choice, float reward,
                                     const void *next, uint8_t end) {
    if (end > RLVC_TRUNCATED || choice.action >= agent->config.actions || choice.exploited > 1)
        return RLVC_E_RANGE;
    if (!next && end != RLVC_TERMINATED)
        return RLVC_E_NULL;
    if (!(reward >= -RLVC_REWARD_MAX && reward <= RLVC_REWARD_MAX))
        return RLVC_E_REWARD;
    if (!agent->replay.open)
        return RLVC_E_ORDER;
    return end == RLVC_TERMINATED || rlvc_replay_has_room(&agent->replay) || agent->learner.failed
               ? RLVC_OK
               : RLVC_E_BUSY;
}

rlvc_status rlvc_classes_observe(rlvc_agent *agent, rlvc_choice choice, float reward,
                                 const void *next, uint8_t end) {
    rlvc_status status = available(agent);
    if (status == RLVC_OK)
        status = check_observation(agent, choice, reward, next, end);
    if (status == RLVC_OK && end != RLVC_TERMINATED)
        status = vouch(agent, next);
    if (status != RLVC_OK)
        return status;
    if (rlvc_is_incremental(&agent->config)) {
        rlvc_td_updates updates;
        agent->busy = 1;
        status = rlvc_td_prepare(&updates, &agent->config, &agent->domain, &agent->tree,
                                 &agent->replay, &agent->values, choice, reward, next, end);
        agent->busy = 0;
        if (status != RLVC_OK)
            return status;
        rlvc_td_apply(&updates, agent->config.learning_rate, &agent->values);
    }
    if (end != RLVC_TERMINATED && !rlvc_replay_has_room(&agent->replay))
        (void)rlvc_learn_abandon(agent); /* it failed */
    rlvc_replay_append(&agent->replay, choice, reward, next, end);
    agent->interactions++;
    return RLVC_OK;
}

/* ------------------------------------------------------------------ asking */

rlvc_status rlvc_classes_predict(rlvc_agent *agent, const void *percept, uint32_t *class_id,
                                 uint32_t *action) {
    rlvc_status status = available(agent);
    if (status != RLVC_OK)
        return status;
    if (!percept)
        return RLVC_E_NULL;
    uint32_t found = 0;
    status = classify(agent, percept, &found);
    if (status == RLVC_OK && class_id)
        *class_id = found;
    if (status == RLVC_OK && action)
        *action = agent->values.policy[found];
    return status;
}

rlvc_status rlvc_classes_summary(const rlvc_agent *agent, rlvc_statistics *statistics) {
    rlvc_status status = available(agent);
    if (status != RLVC_OK)
        return status;
    if (!statistics)
        return RLVC_E_NULL;
    statistics->interactions = agent->interactions;
    statistics->stored = agent->replay.stored;
    statistics->step = agent->step;
    statistics->classes = agent->tree.classes;
    statistics->depth = rlvc_tree_deepest(&agent->tree);
    statistics->last_split = agent->last_split;
    statistics->refused = agent->refused;
    statistics->sweeps = agent->sweeps;
    statistics->residual = agent->residual;
    statistics->solution = agent->sweeps == agent->config.max_sweeps;
    if (RLVC_HAS_UNDISCOUNTED && agent->residual == RLVC_RESIDUAL_ENDLESS)
        statistics->solution = RLVC_SOLUTION_ENDLESS;
    statistics->reserved = 0;
    return RLVC_OK;
}

rlvc_status rlvc_q(const rlvc_agent *agent, uint32_t class_id, uint32_t action, float *q,
                   uint32_t *samples) {
    rlvc_status status = available(agent);
    if (status != RLVC_OK)
        return status;
    if (class_id >= agent->tree.classes || action >= agent->config.actions)
        return RLVC_E_RANGE;
    size_t pair = rlvc_values_pair(&agent->values, class_id, action);
    if (q)
        *q = agent->values.q[pair];
    if (samples)
        *samples = agent->values.tried[pair];
    return RLVC_OK;
}

rlvc_status rlvc_value(const rlvc_agent *agent, uint32_t class_id, float *value, uint32_t *action) {
    rlvc_status status = available(agent);
    if (status != RLVC_OK)
        return status;
    if (class_id >= agent->tree.classes)
        return RLVC_E_RANGE;
    if (value)
        *value = agent->values.value[class_id];
    if (action)
        *action = agent->values.policy[class_id];
    return RLVC_OK;
}

rlvc_status rlvc_split_at(const rlvc_agent *agent, uint32_t index, rlvc_split *split,
                          void *feature) {
    rlvc_status status = available(agent);
    if (status != RLVC_OK)
        return status;
    if (index >= agent->tree.classes - 1u)
        return RLVC_E_RANGE;
    if (split)
        *split = agent->tree.split[index].about;
    if (feature)
        memcpy(feature, rlvc_tree_feature(&agent->tree, index), agent->tree.feature_bytes);
    return RLVC_OK;
}

rlvc_status rlvc_classes_budget_min(const rlvc_agent *agent, uint32_t *budget) {
    if (!agent || !budget)
        return RLVC_E_NULL;
    *budget = RLVC_BUDGET_MIN;
    return RLVC_OK;
}

void rlvc_classes_view(rlvc_agent *agent, rlvc_learnt *learnt) {
    learnt->domain = &agent->domain;
    learnt->tree = &agent->tree;
    learnt->policy = agent->values.policy;
    learnt->values = &agent->values;
    learnt->busy = &agent->busy;
    learnt->actions = agent->config.actions;
    learnt->step = agent->step;
}

/* Does the domain vouch for all features of the tree and all percepts in the ring? */
static int records_are_sound(rlvc_agent *agent) {
    const rlvc_domain *domain = &agent->domain;
    const rlvc_replay *replay = &agent->replay;
    int sound = 1;
    agent->busy = 1;
    for (uint32_t j = 0; domain->check_feature && sound && j + 1u < agent->tree.classes; j++)
        sound = !domain->check_feature(domain->ctx, rlvc_tree_feature(&agent->tree, j));
    for (uint32_t position = 0; domain->check_percept && sound && position < replay->count;
         position++) {
        uint32_t slot = rlvc_replay_slot(replay, position);
        sound = !domain->check_percept(domain->ctx, rlvc_replay_percept(replay, slot));
    }
    agent->busy = 0;
    return sound;
}

rlvc_status rlvc_classes_check(rlvc_agent *agent) {
    rlvc_status status = available(agent);
    if (status != RLVC_OK)
        return status;
    int sound = rlvc_config_status(&agent->config, &agent->domain) == RLVC_OK &&
                rlvc_tree_check(&agent->tree) &&
                rlvc_replay_check(&agent->replay, agent->config.actions, agent->tree.classes) &&
                rlvc_values_check(&agent->values, agent->tree.classes) &&
                rlvc_explorer_check(&agent->explorer, agent->config.actions, agent->tree.classes) &&
                records_are_sound(agent);
    return sound ? RLVC_OK : RLVC_E_MEMORY;
}
