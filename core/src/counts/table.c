/* SPDX-License-Identifier: MIT */
/* The rows by class and action: see table.h. */
#include "rlvc/float_rules.h"

#include "table.h"

#include "../agent/learn.h"
#include <string.h>

void rlvc_count_table_carve(rlvc_count_table *table, rlvc_arena *arena, const rlvc_agent *agent,
                            const rlvc_counts *counts) {
    uint64_t parts = counts->rows;
    uint64_t pairs = agent->config.actions;
    for (uint32_t i = 0; i < counts->rows; i++)
        parts += counts->row[i].count / RLVC_PART_MAX;
    table->counts = counts;
    table->sample = rlvc_arena_carve(arena, counts->rows, sizeof *table->sample);
    table->transition = rlvc_arena_carve_bytes(arena, parts * sizeof *table->transition);
    table->sum = rlvc_arena_carve_bytes(arena, pairs * agent->tree.classes * sizeof *table->sum);
    table->follow = rlvc_arena_carve_bytes(
        arena, agent->config.successors ? pairs * counts->features * sizeof *table->follow : 0);
    table->influence = rlvc_arena_carve(arena, counts->features, sizeof *table->influence);
    table->influenced = rlvc_arena_carve(arena, counts->features, sizeof *table->influenced);
    table->scratch = rlvc_arena_carve(arena, 1, RLVC_SORT_SCRATCH_BYTES);
    table->place = rlvc_arena_carve(arena, agent->tree.classes, sizeof *table->place);
    table->now = rlvc_arena_carve(arena, counts->rows, sizeof *table->now);
    table->next = rlvc_arena_carve(arena, counts->rows, sizeof *table->next);
    table->pair = rlvc_arena_carve(arena, counts->pairs, sizeof *table->pair);
    table->cuts = rlvc_arena_carve(arena, agent->config.actions, sizeof *table->cuts);
    table->cut = rlvc_arena_carve(arena, counts->rows, sizeof *table->cut);
}

/* ------------------------------------------------------------------ classes */

/* Finds the bit of a cell that tells the feature of a split. */
static int find_place(rlvc_count_table *table, const rlvc_tree *tree, uint32_t split) {
    const rlvc_counts *counts = table->counts;
    const unsigned char *feature = counts->feature;
    for (uint32_t i = 0; i < counts->cell_bits; i++) {
        if (memcmp(feature + (size_t)counts->tested[i] * tree->feature_bytes,
                   rlvc_tree_feature(tree, split), tree->feature_bytes) == 0) {
            table->place[split] = i;
            return 1;
        }
    }
    return 0;
}

static uint16_t class_of(const rlvc_count_table *table, const rlvc_tree *tree, uint64_t cell) {
    uint32_t node = 0;
    while (!rlvc_tree_is_leaf(tree, node)) {
        uint32_t place = table->place[rlvc_tree_split_of(tree, node)];
        node = tree->node[node] + (uint32_t)(cell >> place & 1u);
    }
    return (uint16_t)rlvc_tree_class(tree, node);
}

rlvc_status rlvc_count_table_classify(rlvc_count_table *table, const rlvc_agent *agent) {
    const rlvc_tree *tree = &agent->tree;
    const rlvc_counts *counts = table->counts;
    for (uint32_t split = 0; split + 1u < tree->classes; split++) {
        if (!find_place(table, tree, split))
            return RLVC_E_MISMATCH;
    }
    for (uint32_t i = 0; i < counts->rows; i++) {
        const rlvc_count_row *row = &counts->row[i];
        table->now[i] = class_of(table, tree, row->now);
        table->next[i] = row->terminated ? RLVC_NO_CLASS : class_of(table, tree, row->next);
    }
    for (uint32_t i = 0; i < counts->pairs; i++)
        table->pair[i] = class_of(table, tree, counts->pair[i].now);
    return RLVC_OK;
}

/* ------------------------------------------------------------------ groups */

/* The target of a row's interactions, as targets.c has it of one. */
static uint32_t key_of(const rlvc_count_table *table, const rlvc_agent *agent, uint32_t i) {
    uint16_t next = table->next[i];
    float value = next == RLVC_NO_CLASS ? 0.0f : agent->values.target[next];
    return rlvc_target_key(table->counts->row[i].reward + agent->config.discount * value);
}

void rlvc_count_table_group(rlvc_count_table *table, rlvc_agent *agent) {
    const rlvc_counts *counts = table->counts;
    const rlvc_values *values = &agent->values;
    uint32_t *first = values->begin.sample;
    size_t pairs = rlvc_values_pair(values, agent->tree.classes, 0);
    memset(first, 0, (pairs + 1u) * sizeof *first);
    for (uint32_t i = 0; i < counts->rows; i++)
        first[rlvc_values_pair(values, table->now[i], counts->row[i].action) + 1u]++;
    for (size_t p = 0; p < pairs; p++)
        first[p + 1u] += first[p];
    for (uint32_t i = 0; i < counts->rows; i++) {
        rlvc_sample *sample =
            table->sample + first[rlvc_values_pair(values, table->now[i], counts->row[i].action)]++;
        sample->key = key_of(table, agent, i);
        sample->slot = i;
    }
    for (size_t p = pairs; p > 0; p--)
        first[p] = first[p - 1u];
    first[0] = 0;
}

rlvc_count rlvc_count_table_size(const rlvc_count_table *table, uint32_t begin, uint32_t end) {
    rlvc_count size = 0;
    for (uint32_t i = begin; i < end; i++)
        size += (rlvc_count)table->counts->row[table->sample[i].slot].count;
    return size;
}

void rlvc_count_table_sort(rlvc_count_table *table, uint32_t begin, uint32_t end) {
    rlvc_sort_cursor sort;
    rlvc_sort_begin(&sort, table->sample + begin, end - begin, table->scratch);
    while (!sort.done)
        (void)rlvc_sort_step(&sort, RLVC_BUDGET_UNBOUNDED);
}
