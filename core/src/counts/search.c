/* SPDX-License-Identifier: MIT */
/* The best split of a class (section 4.2.3) by rows of counts. The tables come from running sums
 * over the rows by ascending target, where split_search.c has columns of bits; what they are worth
 * is the same code's to say (split/evidence.h). */
#include "rlvc/float_rules.h"

#include "../agent/learn.h"
#include "../split/effect.h"
#include "../stats/score.h"
#include "table.h"
#include <string.h>

/* The samples of the class after one action. */
typedef struct group {
    uint32_t begin, end, action;
    rlvc_count size, cuts;
} group;

/* Marks where clusters of targets begin, as split_search.c does. */
static void mark(rlvc_count_table *table, const rlvc_target_input *aliasing, group *of) {
    uint32_t lowest = 0;
    of->cuts = 0;
    for (uint32_t i = of->begin; i < of->end; i++) {
        uint32_t key = table->sample[i].key;
        table->cut[i] = i > of->begin && rlvc_target_distinct(aliasing, lowest, key);
        of->cuts += table->cut[i];
        if (i == of->begin || table->cut[i])
            lowest = key;
    }
}

static uint64_t with(const rlvc_count_table *table, uint32_t i, uint32_t f) {
    return table->counts->with[(size_t)table->sample[i].slot * table->counts->features + f];
}

/* The best cutpoint of a feature that `present` samples exhibit, the lowest among equals. */
static float best_cutpoint(const rlvc_count_table *table, const group *of, uint32_t f,
                           rlvc_count present, rlvc_table *best) {
    float highest = 0.0f;
    rlvc_count below = 0, x = 0;
    for (uint32_t i = of->begin; i < of->end; i++) {
        if (table->cut[i]) {
            const rlvc_table at = {x, below - x, present - x, of->size - present - (below - x)};
            float score = rlvc_score(at.a, at.b, at.c, at.d);
            if (score > highest) {
                highest = score;
                *best = at;
            }
        }
        below += (rlvc_count)table->counts->row[table->sample[i].slot].count;
        x += (rlvc_count)with(table, i, f);
    }
    return highest;
}

/* Adds to the evidence for a feature what one group says.
 * @return 1 if it is the best of one action so far */
static int weigh(const rlvc_count_table *table, const group *of, uint32_t f,
                 rlvc_evidence *evidence, rlvc_pooled *pool) {
    rlvc_count present = 0;
    for (uint32_t i = of->begin; i < of->end; i++)
        present += (rlvc_count)with(table, i, f);
    if (present == 0 || present == of->size)
        return 0;
    rlvc_evidence_divides(pool, of->cuts);
    rlvc_table best = {0, 0, 0, 0};
    float score = best_cutpoint(table, of, f, present, &best);
    if (!(score > 0.0f))
        return 0;
    rlvc_per_action weighed = rlvc_evidence_weigh(&best, score, of->action, 0);
    rlvc_evidence_pool(pool, &weighed, 0);
    return rlvc_evidence_keep(evidence, &weighed);
}

static group group_of(const rlvc_count_table *table, const rlvc_agent *agent, uint32_t class_id,
                      uint32_t action) {
    const uint32_t *first =
        agent->values.begin.sample + rlvc_values_pair(&agent->values, class_id, action);
    group made = {first[0], first[1], action, 0, 0};
    made.size = rlvc_count_table_size(table, made.begin, made.end);
    return made;
}

/* Sorts and marks the groups of the class. Returns how many interactions they hold. */
static rlvc_count open(rlvc_count_table *table, const rlvc_agent *agent, uint32_t class_id,
                       rlvc_evidence *evidence) {
    rlvc_target_input aliasing = rlvc_learner_target_input(agent, RLVC_CRITERION_RESIDUAL);
    rlvc_count all = 0;
    for (uint32_t a = 0; a < agent->config.actions; a++) {
        group of = group_of(table, agent, class_id, a);
        rlvc_count_table_sort(table, of.begin, of.end);
        mark(table, &aliasing, &of);
        rlvc_evidence_group(evidence, of.size, of.cuts);
        table->cuts[a] = of.cuts;
        all += of.size;
    }
    return all;
}

/* Whether a split of the class by a feature may be worth what is asked for (split/effect.h). */
static int matters(const rlvc_count_table *table, const rlvc_agent *agent, uint32_t class_id,
                   uint32_t f) {
    rlvc_effect effect;
    memset(&effect, 0, sizeof effect);
    for (uint32_t a = 0; a < agent->config.actions; a++) {
        if (table->cuts[a] == 0)
            continue;
        const group of = group_of(table, agent, class_id, a);
        for (uint32_t i = of.begin; i < of.end; i++) {
            const uint64_t count = table->counts->row[table->sample[i].slot].count;
            const uint64_t present = with(table, i, f);
            rlvc_effect_add(&effect, table->sample[i].key, (rlvc_count)(count - present),
                            (rlvc_count)present);
        }
        rlvc_effect_close(&effect, agent->config.smallest_effect, agent->config.min_samples);
    }
    return effect.matters;
}

/* Weighs a feature in all groups that take part.
 * @return bit 0 if it is the best of one action so far, bit 1 if it is the best of all together */
static uint32_t weigh_feature(const rlvc_count_table *table, const rlvc_agent *agent,
                              uint32_t class_id, uint32_t f, rlvc_evidence *evidence) {
    rlvc_pooled pool = {0.0f, 0.0f, 0.0f, 0};
    uint32_t best = 0;
    for (uint32_t a = 0; a < agent->config.actions; a++) {
        if (table->cuts[a] == 0)
            continue;
        group of = group_of(table, agent, class_id, a);
        of.cuts = table->cuts[a];
        best |= (uint32_t)weigh(table, &of, f, evidence, &pool);
    }
    return best | (uint32_t)rlvc_evidence_close(evidence, &pool) << 1u;
}

const void *rlvc_count_search(rlvc_count_table *table, rlvc_agent *agent, uint32_t class_id,
                              rlvc_split *about) {
    static const rlvc_evidence nothing = {
        {0.0f, 0.0f, {0, 0, 0, 0}, 0}, {0.0f, 0.0f, 0.0f, 0}, 0, 0, 0, 0, 0.0f, 0.0f};
    rlvc_evidence evidence = nothing;
    uint32_t per_action = 0, pooled = 0;
    rlvc_count all = open(table, agent, class_id, &evidence);
    if (all < agent->config.min_samples || evidence.samples < agent->config.min_samples)
        return NULL;
    for (uint32_t f = 0; f < table->counts->features; f++) {
        const uint32_t best = weigh_feature(table, agent, class_id, f, &evidence);
        per_action = best & 1u ? f : per_action;
        pooled = best & 2u ? f : pooled;
    }
    if (!rlvc_evidence_found(&evidence))
        return NULL;
    rlvc_evidence_test_per_action(&evidence, 0);
    if (rlvc_evidence_is_pooled(&evidence))
        rlvc_evidence_test_pooled(&evidence);
    rlvc_evidence_result(&evidence, agent->config.actions, about);
    uint32_t found = about->action == agent->config.actions ? pooled : per_action;
    if (agent->config.smallest_effect > 0.0f && !matters(table, agent, class_id, found))
        return NULL;
    return (const unsigned char *)table->counts->feature +
           (size_t)found * agent->tree.feature_bytes;
}
