/* SPDX-License-Identifier: MIT */
/* What the agent influences, and what lasts, by counts of what follows: successor_search.c makes
 * the same tables of words of bits, and split/successor_evidence.h says what they are worth. */
#include "rlvc/float_rules.h"

#include "../agent/learn.h"
#include "../split/successor_evidence.h"
#include "table.h"
#include <string.h>

/* What follows the actions of a class: adds up its rows. */
static void add_up(rlvc_count_table *table, const rlvc_agent *agent, uint32_t class_id) {
    const rlvc_counts *counts = table->counts;
    const uint32_t features = counts->features, actions = agent->config.actions;
    const uint32_t *first =
        agent->values.begin.sample + rlvc_values_pair(&agent->values, class_id, 0);
    memset(table->follow, 0, (size_t)actions * features * sizeof *table->follow);
    for (uint32_t at = first[0]; at < first[actions]; at++) {
        const size_t i = table->sample[at].slot;
        const rlvc_count_row *row = &counts->row[i];
        const uint64_t *with = counts->with + i * features;
        const uint64_t *next = counts->follow + i * 2u * features, *both = next + features;
        rlvc_following *to = table->follow + (size_t)row->action * features;
        for (uint32_t f = 0; row->terminated && f < features; f++) {
            to[f].n[1][RLVC_ENDED] += (rlvc_count)with[f];
            to[f].n[0][RLVC_ENDED] += (rlvc_count)(row->count - with[f]);
        }
        for (uint32_t f = 0; !row->terminated && f < features; f++) {
            to[f].n[1][1] += (rlvc_count)both[f];
            to[f].n[1][0] += (rlvc_count)(with[f] - both[f]);
            to[f].n[0][1] += (rlvc_count)(next[f] - both[f]);
            to[f].n[0][0] += (rlvc_count)(row->count - with[f] - (next[f] - both[f]));
        }
    }
}

static const rlvc_following *following(const rlvc_count_table *table, uint32_t action,
                                       uint32_t feature) {
    return &table->follow[(size_t)action * table->counts->features + feature];
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
                rlvc_influence_add(&table->influence[f], following(table, a, f), a + 1u == actions);
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
    static const rlvc_successor_evidence nothing = {{{0, 0}, {0, 0}}, 0.0f, 0};
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
        for (uint32_t a = 0; a < actions; a++)
            rlvc_lasting_add(&evidence, following(table, a, table->influenced[j]));
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
