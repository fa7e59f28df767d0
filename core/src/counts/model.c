/* SPDX-License-Identifier: MIT */
/* The class-level model (section 4.1) of rows of counts. Rewards are summed exactly, so that their
 * mean does not depend on the order of the rows. */
#include "rlvc/float_rules.h"

#include "../base/exact_sum.h"
#include "../base/solver_select.h"
#include "../split/evidence.h"
#include "table.h"
#include <string.h>

static void sum_rewards(rlvc_count_table *table, const rlvc_agent *agent) {
    const rlvc_counts *counts = table->counts;
    const rlvc_values *values = &agent->values;
    memset(table->sum, 0, rlvc_values_pair(values, agent->tree.classes, 0) * sizeof *table->sum);
    if (counts->reward) {
        for (uint32_t i = 0; i < counts->pairs; i++) {
            size_t pair = rlvc_values_pair(values, table->pair[i], counts->pair[i].action);
            rlvc_exact_sum_join(&table->sum[pair], &counts->reward[i]);
        }
        return;
    }
    for (uint32_t i = 0; i < counts->rows; i++) {
        const rlvc_count_row *row = &counts->row[i];
        size_t pair = rlvc_values_pair(values, table->now[i], row->action);
        rlvc_exact_sum_add(&table->sum[pair], row->reward, row->count);
    }
}

/* Appends what follows the samples [begin, end), whose keys are the classes of s', ascending.
 * Returns the end of what is packed. */
static uint32_t pack(rlvc_count_table *table, uint32_t begin, uint32_t end, uint32_t packed) {
    uint32_t at = begin;
    while (at < end) {
        uint32_t from = at, next = table->sample[at].key;
        while (at < end && table->sample[at].key == next)
            at++;
        uint64_t left = rlvc_count_table_size(table, from, at);
        while (left > 0) {
            uint32_t part = left < RLVC_PART_MAX ? (uint32_t)left : RLVC_PART_MAX;
            table->transition[packed].next = next;
            table->transition[packed++].count = part;
            left -= part;
        }
    }
    return packed;
}

/* The mean of the pair's rewards; of sums that no such rewards have, the nearest that is. */
static float mean_reward(const rlvc_exact_sum *sum, rlvc_count size) {
    const float most = 2.0f * RLVC_REWARD_MAX; /* a mean may be rounded up */
    float mean = rlvc_exact_sum_float(sum) / (float)size;
    mean = mean < most ? mean : most;
    return mean > -most ? mean : -most;
}

void rlvc_count_model(rlvc_count_table *table, rlvc_agent *agent) {
    rlvc_values *values = &agent->values;
    size_t pairs = rlvc_values_pair(values, agent->tree.classes, 0);
    uint32_t begin = 0, packed = 0;
    sum_rewards(table, agent);
    for (uint32_t i = 0; i < table->counts->rows; i++)
        table->sample[i].key = table->next[table->sample[i].slot];
    for (size_t pair = 0; pair < pairs; pair++) {
        uint32_t end = values->begin.sample[pair + 1u];
        rlvc_count size = rlvc_count_table_size(table, begin, end);
        values->begin.transition[pair] = packed;
        values->pair.reward[pair] = 0.0f;
        if (size > 0) {
            values->tried[pair] = rlvc_count_stored(size);
            values->pair.reward[pair] = mean_reward(&table->sum[pair], size);
        }
        if (RLVC_HAS_UNDISCOUNTED)
            rlvc_values_note_reward(values, pair);
        rlvc_count_table_sort(table, begin, end);
        packed = pack(table, begin, end, packed);
        begin = end;
    }
    values->begin.transition[pairs] = packed;
}
