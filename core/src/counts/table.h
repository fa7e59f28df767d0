/* SPDX-License-Identifier: MIT */
/* The tables of rlvc/counts.h as the tree sees them: which class each row belongs to. */
#ifndef RLVC_SRC_COUNTS_TABLE_H
#define RLVC_SRC_COUNTS_TABLE_H

#include "../agent/state.h"
#include "../split/successor_evidence.h"
#include "rlvc/counts.h"

/* A transition is stored in parts of at most so many interactions, as its count has 32 bits. */
#define RLVC_PART_MAX (UINT32_C(1) << 31)

/* The caller's memory. Samples are {key, row}, as those of the ring are {key, slot}. */
typedef struct rlvc_count_table {
    const rlvc_counts *counts;
    rlvc_sample *sample;                /* [rows] by class and action: begin.sample of the values */
    rlvc_transition *transition;        /* [rows + parts] likewise: begin.transition */
    rlvc_exact_sum *sum;                /* [classes][actions] of rewards */
    rlvc_following *follow;             /* [actions][features] of a class */
    rlvc_successor_evidence *influence; /* [features] */
    uint32_t *influenced;               /* [features] */
    uint32_t *scratch;                  /* RLVC_SORT_SCRATCH_BYTES */
    uint32_t *place;                    /* [classes] which bit of a cell tells a split's feature */
    uint16_t *now;                      /* [rows] class of s, */
    uint16_t *next;                     /* [rows] of s', RLVC_NO_CLASS if terminated, */
    uint16_t *pair;                     /* [pairs] and of a pair's s */
    rlvc_count *cuts;                   /* [actions] cutpoints of the class at work */
    uint8_t *cut; /* [rows] whether a cluster of targets begins with a sample */
} rlvc_count_table;

/* Carves the arrays; without a block it only counts. O(rows). */
void rlvc_count_table_carve(rlvc_count_table *table, rlvc_arena *arena, const rlvc_agent *agent,
                            const rlvc_counts *counts);

/* Do the numbers of *counts fit together, and to the agent? O(rows features + pairs).
 * @param total becomes the number of all interactions
 * @return RLVC_OK; RLVC_E_NULL: an array is missing; RLVC_E_RANGE. */
rlvc_status rlvc_counts_check(const rlvc_agent *agent, const rlvc_counts *counts, uint64_t *total);

/* Does the domain vouch for each feature of *counts? O(features). */
int rlvc_counts_check_features(rlvc_agent *agent, const rlvc_counts *counts);

/* Finds the classes of all rows and pairs.
 * @return RLVC_OK; RLVC_E_MISMATCH: no bit of a cell tells a feature of the tree.
 *         O((rows + pairs) depth + classes cell_bits). */
rlvc_status rlvc_count_table_classify(rlvc_count_table *table, const rlvc_agent *agent);

/* Groups the rows by class and action, with their targets as keys. O(rows + pairs of classes and
 * actions). */
void rlvc_count_table_group(rlvc_count_table *table, rlvc_agent *agent);

/* The number of interactions in samples [begin, end). O(end - begin). */
rlvc_count rlvc_count_table_size(const rlvc_count_table *table, uint32_t begin, uint32_t end);

/* Sorts samples [begin, end) by key. */
void rlvc_count_table_sort(rlvc_count_table *table, uint32_t begin, uint32_t end);

/* Makes the class-level model (solve/model.h) of the rows, grouped by class and action. */
void rlvc_count_model(rlvc_count_table *table, rlvc_agent *agent);

/* The best split of a class, like rlvc_split_search_result; the class's samples get sorted.
 * @return the feature, or null. */
const void *rlvc_count_search(rlvc_count_table *table, rlvc_agent *agent, uint32_t class_id,
                              rlvc_split *about);

/* Finds the features that the agent influences (split/successor_search.h).
 * @return how many, which table->influenced begins with. */
uint32_t rlvc_count_influence(rlvc_count_table *table, const rlvc_agent *agent);

/* What lasts in a class, of these, like rlvc_successor_search_result.
 * @return the feature, or null. */
const void *rlvc_count_lasting(rlvc_count_table *table, const rlvc_agent *agent, uint32_t class_id,
                               uint32_t influenced, rlvc_split *about);

#endif
