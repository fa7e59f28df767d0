/* SPDX-License-Identifier: MIT */
/* The smallest decision tree that respects sets of allowed actions. Given rows, each a vector of
 * bits with a set of allowed actions, it finds the binary tree with the fewest leaves in which
 * every row ends in a leaf whose action it allows. (Section 7 asks for "techniques to remove
 * learned features that are subsequently proved useless".) It does not depend on agents:
 * rlvc/policy.h connects the two. */
#ifndef RLVC_MIN_TREE_H
#define RLVC_MIN_TREE_H

#include <stddef.h>
#include <stdint.h>

#include "rlvc/status.h"

#ifdef __cplusplus
extern "C" {
#endif

#define RLVC_MIN_TREE_ACTIONS_MAX 64u
#define RLVC_MIN_TREE_ROWS_MAX (UINT32_C(1) << 24)
#define RLVC_MIN_TREE_FEATURES_MAX 65535u
#define RLVC_MIN_TREE_ENTRIES_MAX (UINT32_C(1) << 28)
#define RLVC_MIN_TREE_EFFORT_MAX ((uint64_t)1 << 39)

/* Words of a row. */
#define RLVC_MIN_TREE_WORDS(features) (((uint32_t)(features) + 63u) / 64u)

/* The rows, and the limits of the search. */
typedef struct rlvc_min_tree_task {
    const uint64_t *row;     /* [rows][words] feature f is bit f % 64 of word f / 64 of a row; the
                                bits from `features` on are 0 */
    const uint64_t *allowed; /* [rows] bit a: action a is allowed. Not 0 */
    uint32_t rows;           /* [1, RLVC_MIN_TREE_ROWS_MAX] */
    uint32_t features;       /* [0, RLVC_MIN_TREE_FEATURES_MAX] */
    uint32_t entries;        /* of the table of subsets, [2, RLVC_MIN_TREE_ENTRIES_MAX]; only the
                                greatest power of two in it is used, and of that seven eighths */
    uint32_t reserved;       /* 0 */
    uint64_t effort;         /* words looked at, at most about so many for the whole, and for a
                                part of the rows in proportion, [1, RLVC_MIN_TREE_EFFORT_MAX] */
} rlvc_min_tree_task;

/* A split of leaf `leaf`: rows without the feature stay in it, those with it get the next new
 * leaf. */
typedef struct rlvc_min_tree_split {
    uint32_t leaf;
    uint32_t feature;
} rlvc_min_tree_split;

/* The tree. It begins as leaf 0, and its splits are to be made in their order. */
typedef struct rlvc_min_tree_result {
    const rlvc_min_tree_split *split; /* [leaves - 1] split j makes leaf j + 1 */
    const uint8_t *action;            /* [leaves] the lowest that all its rows allow */
    uint32_t leaves;
    uint8_t exact; /* 1: no tree has fewer; 0: the table or the effort did not suffice for all of
                      the rows, so that those were parted greedily until it did */
    uint8_t reserved[3];
} rlvc_min_tree_result;

/* The exact size of the block that rlvc_min_tree needs, about entries * (8 + 16 * words)
 * + 20 * rows + 70 * features bytes. O(1).
 * @return RLVC_OK; RLVC_E_NULL; RLVC_E_RANGE: a field of the task, or RLVC_E_MEMORY if no size_t
 * holds the size: *bytes is then 0. */
RLVC_API rlvc_status rlvc_min_tree_size(const rlvc_min_tree_task *task, size_t *bytes);

/* Finds the tree. Dynamic programming over the subsets of rows that tests can reach, at most
 * 3^features; a lower bound prunes most of them. Each subset is solved once and kept in the table.
 * If the table is full or the effort is spent, the rows are split by the feature with the lowest
 * Gini impurity, and each part is tried again. O(effort * depth) at worst.
 * @param memory aligned to 8; `bytes` of it, rlvc_min_tree_size or more. The tree lies in it
 * @return RLVC_OK; RLVC_E_NULL; RLVC_E_RANGE: a field of the task, or two rows that are alike in
 * every feature allow no common action; RLVC_E_MEMORY. */
RLVC_API rlvc_status rlvc_min_tree(const rlvc_min_tree_task *task, void *memory, size_t bytes,
                                   rlvc_min_tree_result *tree);

#ifdef __cplusplus
}
#endif

#endif
