/* SPDX-License-Identifier: MIT */
/* The methods of learning: what an agent's calls do (rlvc/agent.h).
 *
 * A method is a table of functions, which a config names and the agent's copy of that config keeps.
 * Every agent's block begins with that copy, so that a call finds the table. What no config and no
 * domain's constructor names is not linked. Where one method alone is built in (RLVC_METHODS in
 * solver_select.h) its functions are the public ones, and there is no table. */
#ifndef RLVC_SRC_METHOD_H
#define RLVC_SRC_METHOD_H

#include "rlvc/snapshot.h"

#include "solver_select.h"

/* method.kind */
#define RLVC_BY_CLASSES 1u
#define RLVC_BY_PLANNER 2u

struct rlvc_tree;
struct rlvc_values;

/* What an agent has learnt, to be printed and exported. */
typedef struct rlvc_learnt {
    const rlvc_domain *domain;
    const struct rlvc_tree *tree;
    const uint8_t *policy;            /* [classes] */
    const struct rlvc_values *values; /* or null: there are none */
    uint8_t *busy;                    /* 1 while a callback is being called */
    uint32_t actions;
    uint32_t step;
} rlvc_learnt;

/* The functions of a method, as rlvc/agent.h and rlvc/snapshot.h have them: `summary` is
 * rlvc_stats, and `check` rlvc_agent_check. The agent, and in the first three and the last the
 * config, is never null. */
#define RLVC_METHOD_FUNCTIONS(method)                                                              \
    rlvc_status method##_size(const rlvc_config *, const rlvc_domain *, size_t *);                 \
    rlvc_status method##_snapshot_size(const rlvc_config *, const rlvc_domain *, uint32_t *);      \
    rlvc_status method##_init(const rlvc_config *, const rlvc_domain *, void *, size_t,            \
                              rlvc_agent **);                                                      \
    rlvc_status method##_begin(rlvc_agent *, const void *);                                        \
    rlvc_status method##_act(rlvc_agent *, rlvc_choice *);                                         \
    rlvc_status method##_observe(rlvc_agent *, rlvc_choice, float, const void *, uint8_t);         \
    rlvc_status method##_learn(rlvc_agent *, uint32_t, rlvc_progress *);                           \
    rlvc_status method##_budget_min(const rlvc_agent *, uint32_t *);                               \
    rlvc_status method##_predict(rlvc_agent *, const void *, uint32_t *, uint32_t *);              \
    rlvc_status method##_summary(const rlvc_agent *, rlvc_statistics *);                           \
    rlvc_status method##_check(rlvc_agent *);                                                      \
    void method##_view(rlvc_agent *, rlvc_learnt *);                                               \
    rlvc_status method##_save(rlvc_agent *, const rlvc_store *);                                   \
    rlvc_status method##_load(const rlvc_config *, const rlvc_domain *, void *, size_t,            \
                              const rlvc_store *, rlvc_agent **)

struct rlvc_method {
    uint8_t kind;
#if (RLVC_METHODS) == 3
    rlvc_status (*size)(const rlvc_config *, const rlvc_domain *, size_t *);
    rlvc_status (*snapshot_size)(const rlvc_config *, const rlvc_domain *, uint32_t *);
    rlvc_status (*init)(const rlvc_config *, const rlvc_domain *, void *, size_t, rlvc_agent **);
    rlvc_status (*begin)(rlvc_agent *, const void *);
    rlvc_status (*act)(rlvc_agent *, rlvc_choice *);
    rlvc_status (*observe)(rlvc_agent *, rlvc_choice, float, const void *, uint8_t);
    rlvc_status (*learn)(rlvc_agent *, uint32_t, rlvc_progress *);
    rlvc_status (*budget_min)(const rlvc_agent *, uint32_t *);
    rlvc_status (*predict)(rlvc_agent *, const void *, uint32_t *, uint32_t *);
    rlvc_status (*summary)(const rlvc_agent *, rlvc_statistics *);
    rlvc_status (*check)(rlvc_agent *);
    void (*view)(rlvc_agent *, rlvc_learnt *);
    rlvc_status (*save)(rlvc_agent *, const rlvc_store *);
    rlvc_status (*load)(const rlvc_config *, const rlvc_domain *, void *, size_t,
                        const rlvc_store *, rlvc_agent **);
#endif
};

/* The table of a method, in the order of its functions. */
#if (RLVC_METHODS) == 3
#define RLVC_METHOD_TABLE(kind, method)                                                            \
    {                                                                                              \
        kind, method##_size, method##_snapshot_size, method##_init, method##_begin, method##_act,  \
            method##_observe, method##_learn, method##_budget_min, method##_predict,               \
            method##_summary, method##_check, method##_view, method##_save, method##_load          \
    }
#else
#define RLVC_METHOD_TABLE(kind, method)                                                            \
    { kind }
#endif

/* By which method a domain learns: its own, or the only one that is built in. Is a method built in?
 */
#if (RLVC_METHODS) == 3
#define RLVC_METHOD_OF(domain) ((domain)->method)
#define RLVC_METHOD_IS_IN(method) ((method) != NULL)
#else
#define RLVC_METHOD_OF(domain) ((RLVC_METHODS) == 1 ? &rlvc_method_classes : &rlvc_method_planner)
#define RLVC_METHOD_IS_IN(method) ((method) == RLVC_METHOD_OF(method))
#endif

#if (RLVC_METHODS) == 1
#define rlvc_classes_size rlvc_agent_size
#define rlvc_classes_snapshot_size rlvc_snapshot_size
#define rlvc_classes_init rlvc_agent_init
#define rlvc_classes_begin rlvc_begin
#define rlvc_classes_act rlvc_act
#define rlvc_classes_observe rlvc_observe
#define rlvc_classes_learn rlvc_learn
#define rlvc_classes_budget_min rlvc_budget_min
#define rlvc_classes_predict rlvc_predict
#define rlvc_classes_summary rlvc_stats
#define rlvc_classes_check rlvc_agent_check
#define rlvc_classes_view rlvc_view
#define rlvc_classes_save rlvc_save
#define rlvc_classes_load rlvc_load
#elif (RLVC_METHODS) == 2
#define rlvc_planner_size rlvc_agent_size
#define rlvc_planner_snapshot_size rlvc_snapshot_size
#define rlvc_planner_init rlvc_agent_init
#define rlvc_planner_begin rlvc_begin
#define rlvc_planner_act rlvc_act
#define rlvc_planner_observe rlvc_observe
#define rlvc_planner_learn rlvc_learn
#define rlvc_planner_budget_min rlvc_budget_min
#define rlvc_planner_predict rlvc_predict
#define rlvc_planner_summary rlvc_stats
#define rlvc_planner_check rlvc_agent_check
#define rlvc_planner_view rlvc_view
#define rlvc_planner_save rlvc_save
#define rlvc_planner_load rlvc_load
#endif

RLVC_METHOD_FUNCTIONS(rlvc_classes);
RLVC_METHOD_FUNCTIONS(rlvc_planner);

/* Of a config, up to its last field: padding may come after it, and tells nothing. */
#define RLVC_CONFIG_BYTES (offsetof(rlvc_config, patience) + sizeof(uint32_t))

/* What rlvc_config_check returns, without saying why, and so without text in flash. O(1). */
rlvc_status rlvc_config_status(const rlvc_config *config, const rlvc_domain *domain);

/* What the agent has learnt. It lies in the agent's block, and changes when the agent does. */
void rlvc_view(rlvc_agent *agent, rlvc_learnt *learnt);

/* Is a config's or an agent's method the planner? O(1). */
static inline int rlvc_config_plans(const rlvc_config *config) {
    return (RLVC_METHODS) == 2 || ((RLVC_METHODS) == 3 && config->method->kind == RLVC_BY_PLANNER);
}

static inline int rlvc_agent_plans(const rlvc_agent *agent) {
    return rlvc_config_plans((const rlvc_config *)(const void *)agent);
}

#endif
