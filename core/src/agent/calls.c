/* SPDX-License-Identifier: MIT */
/* The calls that serve every method: each goes to the agent's own (base/method.h). */
#include "rlvc/float_rules.h"

#include "../base/method.h"

#if (RLVC_METHODS) == 3

static const rlvc_method *method_of(const rlvc_agent *agent) {
    return ((const rlvc_config *)(const void *)agent)->method;
}

/* Has the config a method? */
static rlvc_status check(const rlvc_config *config) {
    if (!config)
        return RLVC_E_NULL;
    return config->method ? RLVC_OK : RLVC_E_CONFIG;
}

rlvc_status rlvc_agent_size(const rlvc_config *config, const rlvc_domain *domain, size_t *bytes) {
    const rlvc_status status = check(config);
    if (status == RLVC_OK)
        return config->method->size(config, domain, bytes);
    if (bytes && config)
        *bytes = 0;
    return bytes ? status : RLVC_E_NULL;
}

rlvc_status rlvc_snapshot_size(const rlvc_config *config, const rlvc_domain *domain,
                               uint32_t *bytes) {
    const rlvc_status status = check(config);
    if (status == RLVC_OK)
        return config->method->snapshot_size(config, domain, bytes);
    if (bytes)
        *bytes = 0;
    return bytes ? status : RLVC_E_NULL;
}

rlvc_status rlvc_agent_init(const rlvc_config *config, const rlvc_domain *domain, void *memory,
                            size_t bytes, rlvc_agent **agent) {
    const rlvc_status status = check(config);
    if (status == RLVC_OK)
        return config->method->init(config, domain, memory, bytes, agent);
    if (agent)
        *agent = NULL;
    return agent ? status : RLVC_E_NULL;
}

rlvc_status rlvc_load(const rlvc_config *config, const rlvc_domain *domain, void *memory,
                      size_t bytes, const rlvc_store *store, rlvc_agent **agent) {
    const rlvc_status status = check(config);
    if (status == RLVC_OK)
        return config->method->load(config, domain, memory, bytes, store, agent);
    if (agent)
        *agent = NULL;
    return agent ? status : RLVC_E_NULL;
}

rlvc_status rlvc_begin(rlvc_agent *agent, const void *percept) {
    return agent ? method_of(agent)->begin(agent, percept) : RLVC_E_NULL;
}

rlvc_status rlvc_act(rlvc_agent *agent, rlvc_choice *choice) {
    return agent ? method_of(agent)->act(agent, choice) : RLVC_E_NULL;
}

rlvc_status rlvc_observe(rlvc_agent *agent, rlvc_choice choice, float reward, const void *next,
                         uint8_t end) {
    return agent ? method_of(agent)->observe(agent, choice, reward, next, end) : RLVC_E_NULL;
}

rlvc_status rlvc_learn(rlvc_agent *agent, uint32_t budget, rlvc_progress *progress) {
    return agent ? method_of(agent)->learn(agent, budget, progress) : RLVC_E_NULL;
}

rlvc_status rlvc_budget_min(const rlvc_agent *agent, uint32_t *budget) {
    return agent ? method_of(agent)->budget_min(agent, budget) : RLVC_E_NULL;
}

rlvc_status rlvc_predict(rlvc_agent *agent, const void *percept, uint32_t *class_id,
                         uint32_t *action) {
    return agent ? method_of(agent)->predict(agent, percept, class_id, action) : RLVC_E_NULL;
}

rlvc_status rlvc_stats(const rlvc_agent *agent, rlvc_statistics *statistics) {
    return agent ? method_of(agent)->summary(agent, statistics) : RLVC_E_NULL;
}

rlvc_status rlvc_agent_check(rlvc_agent *agent) {
    return agent ? method_of(agent)->check(agent) : RLVC_E_NULL;
}

void rlvc_view(rlvc_agent *agent, rlvc_learnt *learnt) {
    method_of(agent)->view(agent, learnt);
}

rlvc_status rlvc_save(rlvc_agent *agent, const rlvc_store *store) {
    return agent ? method_of(agent)->save(agent, store) : RLVC_E_NULL;
}

#else

typedef char one_method[(RLVC_METHODS) == 1 || (RLVC_METHODS) == 2 ? 1 : -1];

#endif
