/* SPDX-License-Identifier: MIT */
/* What the agent influences, and what lasts, by counts of what follows: successor_search.c makes
 * the same tables of words of bits, and split/successor_evidence.h says what they are worth. */
#include "rlvc/float_rules.h"

#include "../agent/learn.h"
#include "../split/successor_evidence.h"
#include "table.h"
#include <string.h>

/* Adds up the tables of the class, an action after another. */
static void add_up(rlvc_count_table *table, const rlvc_agent *agent, uint32_t class_id) {
    const rlvc_counts *counts = table->counts;
    const size_t cells = (size_t)(counts->features + 1u) * (counts->features + 1u);
    memset(table->follow, 0, agent->config.actions * cells * sizeof *table->follow);
    for (uint32_t i = 0; i < counts->pairs; i++) {
        if (table->pair[i] != class_id)
            continue;
        uint64_t *to = table->follow + counts->pair[i].action * cells;
        const uint64_t *from = counts->follow + i * cells;
        for (size_t j = 0; j < cells; j++)
            to[j] += from[j];
    }
}

/* What followed an action of the class that was added up. */
static rlvc_following following(const rlvc_count_table *table, uint32_t action, uint32_t feature) {
    const size_t width = table->counts->features + 1u, f = feature + 1u;
    const uint64_t *of = table->follow + action * width * width;
    const rlvc_count all = (rlvc_count)of[0], now = (rlvc_count)of[f * width];
    const rlvc_count next = (rlvc_count)of[f], both = (rlvc_count)of[f * width + f];
    const rlvc_following made = {{{all - now - next + both, next - both}, {now - both, both}}};
    return made;
}

uint32_t rlvc_count_influence(rlvc_count_table *table, const rlvc_agent *agent) {
    const uint32_t features = table->counts->features, actions = agent->config.actions;
    const float log_level = rlvc_learner_log_level(agent) -
                            rlvc_successor_evidence_log_tests(agent->domain.features_max);
    uint32_t kept = 0;
    memset(table->influence, 0, features * sizeof *table->influence);
    for (uint32_t c = 0; c < agent->tree.classes; c++) {
        add_up(table, agent, c);
        for (uint32_t a = 0; a < actions; a++) {
            for (uint32_t f = 0; f < features; f++) {
                const rlvc_following action = following(table, a, f);
                rlvc_influence_add(&table->influence[f], &action, a + 1u == actions);
            }
        }
    }
    for (uint32_t f = 0; f < features && kept < agent->config.features_at_once; f++) {
        if (rlvc_successor_evidence_log_p(&table->influence[f]) < log_level)
            table->influenced[kept++] = f;
    }
    return kept;
}

const void *rlvc_count_lasting(rlvc_count_table *table, const rlvc_agent *agent, uint32_t class_id,
                               uint32_t influenced, rlvc_split *about) {
    static const rlvc_successor_evidence nothing = {{{{0, 0}, {0, 0}}}, 0.0f, 0};
    const uint32_t actions = agent->config.actions;
    const uint32_t *first =
        agent->values.begin.sample + rlvc_values_pair(&agent->values, class_id, 0);
    const rlvc_count all = rlvc_count_table_size(table, first[0], first[actions]);
    const void *feature = NULL;
    float least = 0.0f;
    if (all < agent->config.min_samples)
        return NULL;
    about->action = actions + 1u;
    about->samples = rlvc_count_stored(all);
    about->log_tests = rlvc_successor_evidence_log_tests(influenced);
    add_up(table, agent, class_id);
    for (uint32_t j = 0; j < influenced; j++) {
        rlvc_successor_evidence evidence = nothing;
        for (uint32_t a = 0; a < actions; a++) {
            const rlvc_following action = following(table, a, table->influenced[j]);
            rlvc_lasting_add(&evidence, &action);
        }
        float log_p = rlvc_successor_evidence_log_p(&evidence);
        if (log_p < least) {
            least = log_p;
            about->score = evidence.statistic / (float)all;
            feature = (const unsigned char *)table->counts->feature +
                      (size_t)table->influenced[j] * agent->tree.feature_bytes;
        }
    }
    about->log_p = least + about->log_tests;
    return feature;
}
