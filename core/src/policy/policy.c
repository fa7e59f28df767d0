/* SPDX-License-Identifier: MIT */
/* The policy by itself: see rlvc/policy.h.
 *
 * Its tree has the layout of the agent's (tree.h), so that it is walked, printed and exported
 * alike. In the block it comes first, with the actions of its leaves; behind it is what only its
 * making needs:
 *
 *     number, origin   the tree's distinct features: which one each split tests, and a split of
 * each tested           which one each split of the small tree tests row, allowed     the ring's
 * distinct percepts, by these features worth            the class-level model, to know what a
 * policy is worth scratch          first an index of the rows, to find duplicates; then the block
 * of rlvc_min_tree, with its tree; or else the leaf that each node of the agent's tree begins in
 * the collapsed one
 *
 * A tree is made for what may be taken at each percept, and what it takes is evaluated. If that
 * costs more than was allowed, less is allowed, down to the agent's own actions. */
#include "rlvc/float_rules.h"

#include "policy.h"

#include "rlvc/min_tree.h"
#include "rlvc/planner.h"

#include "../export/collapse.h"
#include "../export/export_tree.h"
#include "../export/print.h"
#include "worth.h"
#include <string.h>

#define PERCEPTS_DEFAULT 16384u

/* What an action may cost in the next step is at first what a policy may cost in all. A mistake at
 * every step adds up, so that it becomes a fourth of that, and so on; then just ties, and then
 * nothing but the agent's own action. */
enum { ATTEMPTS_WITH_LOSS = 6, ATTEMPT_TIES = ATTEMPTS_WITH_LOSS, ATTEMPT_OWN };

typedef struct maker {
    const rlvc_agent *agent;
    const rlvc_policy_config *config;
    rlvc_policy *policy;
    rlvc_policy made; /* laid out, until there is a place for it */
    rlvc_min_tree_task task;
    uint64_t kept; /* bytes of the policy itself */
    uint64_t scratch_bytes;
    uint32_t index_mask; /* entries of the index - 1 */
    uint32_t words;      /* of a row */
    uint32_t *number;    /* [splits] */
    uint32_t *origin;    /* [features] */
    uint32_t *tested;    /* [splits] */
    rlvc_worth worth;
    uint64_t *row;     /* [percepts + 1][words] the last is that of a percept looked at */
    uint64_t *allowed; /* [percepts] */
    void *scratch;
} maker;

/* ------------------------------------------------------------------ laying out */

/* The first split whose feature is that of split j. */
static uint32_t first_alike(const rlvc_tree *tree, uint32_t j) {
    uint32_t i = 0;
    while (memcmp(rlvc_tree_feature(tree, i), rlvc_tree_feature(tree, j), tree->feature_bytes) != 0)
        i++;
    return i;
}

static uint32_t distinct_features(const rlvc_tree *tree) {
    uint32_t count = 0;
    for (uint32_t j = 0; j + 1u < tree->classes; j++)
        count += (uint32_t)(first_alike(tree, j) == j);
    return count;
}

static void at_least(uint64_t *bytes, uint64_t needed) {
    if (*bytes < needed)
        *bytes = needed;
}

static void carve(maker *m, rlvc_arena *arena) {
    const rlvc_tree *tree = &m->agent->tree;
    const uint32_t percepts = m->config->percepts;
    m->words = RLVC_MIN_TREE_WORDS(m->task.features);
    for (m->index_mask = 1; m->index_mask < 2u * m->config->percepts;)
        m->index_mask = 2u * m->index_mask + 1u;
    m->policy = rlvc_arena_carve(arena, 1, sizeof *m->policy);
    rlvc_tree_carve(&m->made.tree, arena, tree->classes, tree->feature_bytes);
    m->made.action = rlvc_arena_carve(arena, tree->classes, sizeof *m->made.action);
    m->kept = arena->used;
    m->number = rlvc_arena_carve(arena, tree->classes, sizeof *m->number);
    m->origin = rlvc_arena_carve(arena, m->task.features, sizeof *m->origin);
    m->tested = rlvc_arena_carve(arena, tree->classes, sizeof *m->tested);
    m->row = rlvc_arena_carve(arena, percepts + 1u, m->words * (uint32_t)sizeof *m->row);
    m->allowed = rlvc_arena_carve(arena, percepts, sizeof *m->allowed);
    rlvc_worth_carve(&m->worth, arena, m->agent);
    at_least(&m->scratch_bytes, ((uint64_t)m->index_mask + 1u) * sizeof(uint32_t));
    at_least(&m->scratch_bytes, 2u * (uint64_t)tree->classes * sizeof(uint32_t));
    m->scratch = rlvc_arena_carve_bytes(arena, m->scratch_bytes);
}

/* Checks the config and lays out, in a block if there is one. */
static rlvc_status lay_out(maker *m, const rlvc_agent *agent, const rlvc_policy_config *config,
                           void *memory, size_t *bytes) {
    rlvc_arena arena = {memory, 0};
    size_t search_bytes = 0;
    memset(m, 0, sizeof *m);
    m->agent = agent;
    m->config = config;
    m->task.rows = config->percepts;
    m->task.features = distinct_features(&agent->tree);
    m->task.entries = config->entries;
    m->task.reserved = config->reserved;
    m->task.effort = config->effort;
    rlvc_status status = rlvc_min_tree_size(&m->task, &search_bytes);
    if (!(config->tolerance >= 0.0f && config->tolerance <= 1.0f))
        status = RLVC_E_RANGE;
    if (status != RLVC_OK)
        return status;
    m->scratch_bytes = search_bytes;
    carve(m, &arena);
    if (arena.used > SIZE_MAX)
        return RLVC_E_MEMORY;
    *bytes = (size_t)arena.used;
    return RLVC_OK;
}

/* ------------------------------------------------------------------ the ring's percepts as rows */

static void number_features(maker *m) {
    const rlvc_tree *tree = &m->agent->tree;
    uint32_t count = 0;
    for (uint32_t j = 0; j + 1u < tree->classes; j++) {
        const uint32_t first = first_alike(tree, j);
        m->number[j] = first == j ? count : m->number[first];
        if (first == j)
            m->origin[count++] = j;
    }
}

/* Which of the features a percept exhibits. */
static rlvc_status detect(const maker *m, const void *percept, uint64_t *row) {
    const rlvc_domain *domain = &m->agent->domain;
    memset(row, 0, m->words * sizeof *row);
    for (uint32_t f = 0; f < m->task.features; f++) {
        const void *feature = rlvc_tree_feature(&m->agent->tree, m->origin[f]);
        uint8_t present = 0;
        if (domain->exhibits(domain->ctx, percept, feature, &present) != 0)
            return RLVC_E_CALLBACK;
        row[f / 64u] |= (uint64_t)(present != 0) << f % 64u;
    }
    return RLVC_OK;
}

/* The class of a percept that exhibits these, in a tree whose splits test features number[]. */
static uint32_t class_of(const rlvc_tree *tree, const uint32_t *number, const uint64_t *row) {
    uint32_t node = 0;
    while (!rlvc_tree_is_leaf(tree, node)) {
        const uint32_t f = number[rlvc_tree_split_of(tree, node)];
        node = tree->node[node] + (uint32_t)(row[f / 64u] >> f % 64u & 1u);
    }
    return rlvc_tree_class(tree, node);
}

/* Where the row behind the last one stands in the index, or would. */
static uint32_t find(const maker *m, const uint32_t *index) {
    const uint64_t *row = m->row + (size_t)m->task.rows * m->words;
    uint64_t hash = 0;
    for (uint32_t w = 0; w < m->words; w++) {
        hash = (hash ^ row[w]) * 0x9E3779B97F4A7C15u;
        hash ^= hash >> 32;
    }
    uint32_t at = (uint32_t)hash & m->index_mask;
    while (index[at] != 0 &&
           memcmp(m->row + (size_t)(index[at] - 1u) * m->words, row, m->words * sizeof *row) != 0)
        at = (at + 1u) & m->index_mask;
    return at;
}

/* Makes rows of the ring's percepts. *fit: there are some, and no more than there is room for. */
static rlvc_status gather(maker *m, int *fit) {
    const rlvc_replay *replay = &m->agent->replay;
    uint32_t *index = m->scratch;
    memset(index, 0, ((size_t)m->index_mask + 1u) * sizeof *index);
    number_features(m);
    m->task.rows = 0;
    for (uint32_t position = 0; position < replay->count; position++) {
        uint64_t *row = m->row + (size_t)m->task.rows * m->words;
        const uint32_t slot = rlvc_replay_slot(replay, position);
        const rlvc_status status = detect(m, rlvc_replay_percept(replay, slot), row);
        if (status != RLVC_OK)
            return status;
        const uint32_t at = find(m, index);
        if (index[at] != 0)
            continue;
        if (m->task.rows == m->config->percepts)
            return RLVC_OK;
        index[at] = ++m->task.rows;
    }
    *fit = m->task.rows > 0;
    return RLVC_OK;
}

/* ------------------------------------------------------------------ its tree */

static void begin_tree(rlvc_policy *policy, uint8_t action) {
    rlvc_tree_clear(&policy->tree);
    policy->action[0] = action;
}

static void split(maker *m, uint32_t leaf, const void *feature) {
    rlvc_split about;
    memset(&about, 0, sizeof about);
    about.class_id = leaf;
    rlvc_tree_grow(&m->policy->tree, rlvc_tree_leaf(&m->policy->tree, leaf), &about, feature);
}

/* The tree that was found. */
static void take_fewest(maker *m, const rlvc_min_tree_result *found) {
    begin_tree(m->policy, 0);
    for (uint32_t j = 0; j + 1u < found->leaves; j++)
        split(m, found->split[j].leaf,
              rlvc_tree_feature(&m->agent->tree, m->origin[found->split[j].feature]));
    memcpy(m->policy->action, found->action, found->leaves);
    for (uint32_t j = 0; j + 1u < found->leaves; j++)
        m->tested[j] = found->split[j].feature;
}

/* The collapsed tree: in pre-order a node's leaf is known before those of its children. */
static void take_collapsed(maker *m, const rlvc_compact *collapsed) {
    uint32_t *leaf = m->scratch, node = 0;
    begin_tree(m->policy, 0);
    leaf[0] = 0;
    do {
        if (rlvc_compact_is_mixed(collapsed, node)) {
            const uint32_t absent = collapsed->tree->node[node];
            leaf[absent] = leaf[node];
            leaf[absent + 1u] = m->policy->tree.classes;
            split(m, leaf[node], rlvc_compact_feature(collapsed, node));
        } else {
            m->policy->action[leaf[node]] = (uint8_t)rlvc_compact_action(collapsed, node);
        }
        node = rlvc_compact_next(collapsed, node);
    } while (node != 0);
}

/* ------------------------------------------------------------------ what it is worth */

/* What may be taken at each row; `loss` < 0: just the agent's action. */
static void allow(maker *m, float loss) {
    for (uint32_t i = 0; i < m->task.rows; i++) {
        const uint64_t *row = m->row + (size_t)i * m->words;
        const uint32_t class_id = class_of(&m->agent->tree, m->number, row);
        m->allowed[i] = loss < 0.0f ? (uint64_t)1 << m->agent->values.policy[class_id]
                                    : rlvc_worth_allowed(&m->worth, class_id, loss);
    }
}

/* Does the policy keep the agent's value, but for `loss`? */
static int is_kept(maker *m, float loss) {
    const rlvc_policy *policy = m->policy;
    rlvc_worth_take_none(&m->worth);
    for (uint32_t i = 0; i < m->task.rows; i++) {
        const uint64_t *row = m->row + (size_t)i * m->words;
        rlvc_worth_take(&m->worth, class_of(&m->agent->tree, m->number, row),
                        policy->action[class_of(&policy->tree, m->tested, row)]);
    }
    return rlvc_worth_is_kept(&m->worth, loss);
}

/* Seeks a tree with fewer leaves than the collapsed one has, for the rows.
 * @return 1 if it is the policy's. */
static int seek(maker *m, rlvc_policy_info *info) {
    const float loss = m->config->tolerance * m->worth.spread;
    float share = loss;
    uint32_t attempt = loss > 0.0f ? 0 : ATTEMPT_TIES;
    m->task.row = m->row;
    m->task.allowed = m->allowed;
    for (;; attempt++) { /* the agent's own actions are worth as much as the agent */
        rlvc_min_tree_result found;
        allow(m, attempt == ATTEMPT_OWN ? -1.0f : attempt == ATTEMPT_TIES ? 0.0f : share);
        memset(&found, 0, sizeof found);
        (void)rlvc_min_tree(&m->task, m->scratch, (size_t)m->scratch_bytes, &found);
        info->exact = found.exact;
        if (found.leaves < info->collapsed)
            take_fewest(m, &found);
        RLVC_UNPOISON(m->scratch, (size_t)m->scratch_bytes);
        if (found.leaves >= info->collapsed)
            return 0; /* the less is allowed, the more leaves there are */
        if (is_kept(m, loss))
            return 1;
        share *= 0.25f;
    }
}

/* Makes the smaller of the two trees the policy's. */
static rlvc_status choose(maker *m, rlvc_policy_info *info) {
    const rlvc_agent *agent = m->agent;
    rlvc_compact collapsed = {
        {NULL, NULL, RLVC_OK}, &agent->tree, agent->values.policy, NULL, agent->config.actions, 0};
    int fit = 0;
    rlvc_compact_count(&collapsed);
    if (agent->config.actions <= RLVC_MIN_TREE_ACTIONS_MAX) {
        const rlvc_status status = gather(m, &fit);
        if (status != RLVC_OK)
            return status;
    }
    rlvc_worth_begin(&m->worth);
    info->classes = agent->tree.classes;
    info->collapsed = collapsed.mixed + 1u;
    info->percepts = fit ? m->task.rows : 0;
    info->features = m->task.features;
    info->bytes = (uint32_t)m->kept;
    info->value_before = rlvc_worth_mean(&m->worth, m->worth.model.value);
    info->value_after = info->value_before;
    info->as_agent = !fit || !seek(m, info);
    if (info->as_agent)
        take_collapsed(m, &collapsed);
    else
        info->value_after = rlvc_worth_mean(&m->worth, m->worth.least);
    info->leaves = m->policy->tree.classes;
    return RLVC_OK;
}

/* ------------------------------------------------------------------ for the caller */

rlvc_status rlvc_policy_default(const rlvc_agent *agent, rlvc_policy_config *config) {
    static const rlvc_policy_config of_planner = {.percepts = 1, .entries = 2, .effort = 1};
    if (!agent || !config)
        return RLVC_E_NULL;
    if (rlvc_agent_plans(agent)) {
        *config = of_planner;
        return RLVC_OK;
    }
    if (agent->busy)
        return RLVC_E_REENTERED;
    memset(config, 0, sizeof *config);
    config->percepts =
        agent->replay.slots < PERCEPTS_DEFAULT ? agent->replay.slots : PERCEPTS_DEFAULT;
    config->entries = 65536u;
    config->effort = (uint64_t)1 << 26;
    return RLVC_OK;
}

rlvc_status rlvc_policy_size(const rlvc_agent *agent, const rlvc_policy_config *config,
                             size_t *bytes) {
    maker m;
    if (!agent || !config || !bytes)
        return RLVC_E_NULL;
    if (rlvc_agent_plans(agent)) {
        *bytes = RLVC_PLANNER_POLICY_BYTES;
        return RLVC_OK;
    }
    *bytes = 0;
    if (agent->busy)
        return RLVC_E_REENTERED;
    return lay_out(&m, agent, config, NULL, bytes);
}

rlvc_status rlvc_policy_make(rlvc_agent *agent, const rlvc_policy_config *config, void *memory,
                             size_t bytes, rlvc_policy **policy, rlvc_policy_info *info) {
    maker m;
    rlvc_policy_info made;
    size_t needed = 0;
    if (!policy)
        return RLVC_E_NULL;
    *policy = NULL;
    rlvc_status status = rlvc_policy_size(agent, config, &needed);
    if (status == RLVC_OK && rlvc_agent_plans(agent))
        return rlvc_policy_of_planner(agent, memory, bytes, policy, info);
    if (status == RLVC_OK)
        status = rlvc_arena_check(memory, bytes, needed);
    if (status != RLVC_OK)
        return status;
    const rlvc_policy_config copied = *config; /* it may lie in the block */
    (void)lay_out(&m, agent, &copied, memory, &needed);
    m.made.domain = agent->domain;
    m.made.actions = agent->config.actions;
    *m.policy = m.made;
    memset(&made, 0, sizeof made);
    agent->busy = 1;
    status = choose(&m, &made);
    agent->busy = 0;
    if (status != RLVC_OK)
        return status;
    if (info)
        *info = made;
    *policy = m.policy;
    return RLVC_OK;
}

rlvc_status rlvc_policy_act(rlvc_policy *policy, const void *percept, uint32_t *action) {
    uint32_t leaf = 0;
    if (!policy || !percept || !action)
        return RLVC_E_NULL;
    if (policy->busy)
        return RLVC_E_REENTERED;
    policy->busy = 1;
    const rlvc_status status = rlvc_tree_classify(&policy->tree, &policy->domain, percept, &leaf);
    policy->busy = 0;
    if (status == RLVC_OK)
        *action = policy->action[leaf];
    return status;
}

rlvc_status rlvc_policy_print(rlvc_policy *policy, uint32_t format, rlvc_write write, void *ctx) {
    if (!policy || !write)
        return RLVC_E_NULL;
    if (policy->busy)
        return RLVC_E_REENTERED;
    if (format > RLVC_PRINT_JSON)
        return RLVC_E_RANGE;
    rlvc_printer p = {{write, ctx, RLVC_OK},
                      &policy->domain,
                      &policy->tree,
                      policy->action,
                      NULL,
                      policy->actions,
                      0};
    policy->busy = 1;
    rlvc_printer_run(&p, format);
    policy->busy = 0;
    return p.text.status;
}

rlvc_status rlvc_policy_export_c(rlvc_policy *policy, const char *name, rlvc_write write, void *ctx,
                                 rlvc_export_info *info) {
    if (!policy || !name || !write)
        return RLVC_E_NULL;
    if (policy->busy)
        return RLVC_E_REENTERED;
    policy->busy = 1;
    const rlvc_status status = rlvc_export_tree(&policy->domain, &policy->tree, policy->action,
                                                policy->actions, name, write, ctx, info);
    policy->busy = 0;
    return status;
}
