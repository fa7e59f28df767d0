/* SPDX-License-Identifier: MIT */
/* Planners for the tests that look at what is in one: the calls of rlvc/agent.h on an rlvc_planner,
 * with the domain of the last planner_default. */
#ifndef RLVC_TESTS_PLANNERS_H
#define RLVC_TESTS_PLANNERS_H

#include "plan/planner_state.h"

static rlvc_thresholds planner_thresholds;
static rlvc_domain planner_domain;

/* Of how many components the domain is from now on. */
static inline void planner_components(uint32_t components) {
    (void)rlvc_thresholds_default(&planner_thresholds, components);
    (void)rlvc_thresholds_domain(&planner_thresholds, &planner_domain);
}

static inline rlvc_config planner_default(uint32_t components, uint32_t actions) {
    rlvc_config config;
    planner_components(components);
    (void)rlvc_config_default(&config, &planner_domain, actions);
    return config;
}

static inline rlvc_status planner_size(const rlvc_config *config, size_t *bytes) {
    return rlvc_agent_size(config, &planner_domain, bytes);
}

static inline rlvc_status planner_init(const rlvc_config *config, void *memory, size_t bytes,
                                       rlvc_planner **planner) {
    return rlvc_agent_init(config, &planner_domain, memory, bytes, (rlvc_agent **)planner);
}

static inline rlvc_agent *as_agent(rlvc_planner *planner) {
    return (rlvc_agent *)(void *)planner;
}

static inline rlvc_status planner_begin(rlvc_planner *planner, const float *percept) {
    return rlvc_begin(as_agent(planner), percept);
}

static inline rlvc_status planner_act(rlvc_planner *planner, uint32_t *action) {
    rlvc_choice choice = {0, 0};
    rlvc_status status = rlvc_act(as_agent(planner), &choice);
    *action = choice.action;
    return status;
}

static inline rlvc_status planner_observe(rlvc_planner *planner, uint32_t action, float reward,
                                          const float *next, uint8_t end) {
    rlvc_choice choice = {(uint8_t)action, 0};
    return rlvc_observe(as_agent(planner), choice, reward, next, end);
}

static inline rlvc_status planner_learn(rlvc_planner *planner, uint32_t budget,
                                        rlvc_progress *progress) {
    return rlvc_learn(as_agent(planner), budget, progress);
}

static inline rlvc_status planner_predict(rlvc_planner *planner, const float *percept,
                                          uint32_t *action) {
    return rlvc_predict(as_agent(planner), percept, NULL, action);
}

#endif
