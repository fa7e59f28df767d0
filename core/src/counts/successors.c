/* SPDX-License-Identifier: MIT */
/* The feature that predicts what follows, by counts of pairs of features: successor_search.c makes
 * the same tables of columns of bits, and split/successor_pair.h says what they are worth. */
#include "rlvc/float_rules.h"

#include "../split/successor_pair.h"
#include "table.h"
#include <string.h>

/* Adds up the tables of the class, an action after another. Returns how many interactions. */
static rlvc_count add_up(rlvc_count_table *table, const rlvc_agent *agent, uint32_t class_id) {
    const rlvc_counts *counts = table->counts;
    const size_t cells = (size_t)(counts->features + 1u) * (counts->features + 1u);
    rlvc_count all = 0;
    memset(table->follow, 0, agent->config.actions * cells * sizeof *table->follow);
    for (uint32_t i = 0; i < counts->pairs; i++) {
        if (table->pair[i] != class_id)
            continue;
        uint64_t *to = table->follow + counts->pair[i].action * cells;
        const uint64_t *from = counts->follow + i * cells;
        for (size_t j = 0; j < cells; j++)
            to[j] += from[j];
        all += (rlvc_count)from[0];
    }
    return all;
}

/* The pair of feature f of s and g of s'. */
static void weigh(const rlvc_count_table *table, const rlvc_agent *agent, uint32_t f, uint32_t g,
                  rlvc_successor_pair *sum) {
    const size_t width = table->counts->features + 1u;
    for (uint32_t a = 0; a < agent->config.actions; a++) {
        const uint64_t *of = table->follow + a * width * width;
        rlvc_successor_pair_add(sum, (rlvc_count)of[0], (rlvc_count)of[(f + 1u) * width],
                                (rlvc_count)of[g + 1u], (rlvc_count)of[(f + 1u) * width + g + 1u]);
    }
}

const void *rlvc_count_successors(rlvc_count_table *table, const rlvc_agent *agent,
                                  uint32_t class_id, rlvc_split *about) {
    static const rlvc_successor_pair nothing = {0.0f, 0.0f, 0, 0, 0};
    rlvc_successor_pair sum = nothing, best = nothing;
    const uint32_t features = table->counts->features;
    rlvc_count all = add_up(table, agent, class_id);
    if (all < agent->config.min_samples)
        return NULL;
    for (uint32_t g = 0; g < features; g++) {
        for (uint32_t f = 0; f < features; f++) {
            weigh(table, agent, f, g, &sum);
            rlvc_successor_pair_close(&sum, f, g, features, &best);
        }
    }
    if (!rlvc_successor_pair_result(&best, rlvc_successor_pair_log_p(&best), features, all,
                                    agent->config.actions, about))
        return NULL;
    return (const unsigned char *)table->counts->feature +
           (size_t)best.feature * agent->tree.feature_bytes;
}
