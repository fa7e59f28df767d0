/* SPDX-License-Identifier: MIT */
/* Learning from counts: from many more interactions than fit into one ring, or one machine.
 *
 * What a learning step decides (rlvc_learn, by the residual criterion and a batch solver) depends
 * only on how often things happened. Let S be some features, among them all that the tree tests,
 * and a cell one combination of their presence. Then it is enough to count, of all interactions,
 *
 *     rows    by cell of s, action, reward, cell of s' and whether the episode terminated there:
 *             how many, of how many s exhibits each feature, of how many s' does, and of how many
 *             both do.
 *
 * Tables of parts of the data add up to the table of the whole, in any order. The tree, Q and V
 * are those that rlvc_learn makes of the same interactions in one ring, bit for bit, but for a mean
 * reward, which here is exact: rlvc_learn's is within 1e-14 of it before it is rounded.
 *
 *     begin with S = the tree's features (at first none), or with more;
 *     repeat  count with S; then rlvc_learn_counts until it is done, or until the tree tests a
 *             feature that is not in S: add it to S and count again. */
#ifndef RLVC_COUNTS_H
#define RLVC_COUNTS_H

#include "rlvc/agent.h"

#ifdef __cplusplus
extern "C" {
#endif

#define RLVC_COUNTS_FEATURES_MAX 1024u
#define RLVC_CELL_BITS_MAX 64u
/* Interactions in all. Where a pointer has 32 bits it is 2^31 - 1. */
#define RLVC_COUNTS_MAX 281474976710655u /* 2^48 - 1 */

#define RLVC_EXACT_SUM_WORDS 4u

/* A sum of rewards, exactly: an integer in two's complement, lowest word first, in units of
 * 2^-149, of which every binary32 number is a multiple. */
typedef struct rlvc_exact_sum {
    uint64_t word[RLVC_EXACT_SUM_WORDS];
} rlvc_exact_sum;

/* Adds x, `count` times, to a sum that began with all 0. Does nothing for a null pointer. O(1).
 * @param x     a reward, within +-RLVC_REWARD_MAX
 * @param count the counts of all that is added add up to RLVC_COUNTS_MAX at most */
RLVC_API void rlvc_exact_sum_add(rlvc_exact_sum *sum, float x, uint64_t count);

/* Adds another sum. Does nothing for a null pointer. O(1). */
RLVC_API void rlvc_exact_sum_join(rlvc_exact_sum *sum, const rlvc_exact_sum *other);

/* Interactions that are alike. */
typedef struct rlvc_count_row {
    uint64_t count;      /* how many, [1, RLVC_COUNTS_MAX] */
    uint64_t now;        /* cell of s: bit i says whether it exhibits the feature tested[i] */
    uint64_t next;       /* cell of s'; 0 if terminated */
    float reward;        /* within +-RLVC_REWARD_MAX */
    uint8_t action;      /* [0, actions) */
    uint8_t terminated;  /* 0 or 1 */
    uint8_t reserved[2]; /* 0 */
} rlvc_count_row;

/* Interactions of one cell and action. */
typedef struct rlvc_count_pair {
    uint64_t now;      /* cell of s */
    uint32_t action;   /* [0, actions) */
    uint32_t reserved; /* 0 */
} rlvc_count_pair;

/* The tables. Rows and pairs may come in any order, and need not be distinct. */
typedef struct rlvc_counts {
    const rlvc_count_row *row; /* [rows] */
    const uint64_t *with;      /* [rows][features]: of how many of the row's s exhibits each */
    /* [rows][2][features]: of how many of the row's s' exhibits each, and of how many s and s' do;
     * 0 where terminated. Needed if config.successors. */
    const uint64_t *follow;
    const rlvc_count_pair *pair; /* [pairs]; needed if reward is not null */
    /* [pairs]: sums of rewards, for rows whose rewards are rounded. Optional: then they are sums of
     * the rows' rewards. A mean beyond 2 RLVC_REWARD_MAX counts as that. */
    const rlvc_exact_sum *reward;
    const void *feature;    /* [features] records of feature_bytes, in the order of candidates */
    const uint32_t *tested; /* [cell_bits]: which feature a bit of a cell stands for */
    uint32_t rows;          /* [1, 2^31 - 1] */
    uint32_t pairs;         /* [0, 2^31 - 1] */
    uint32_t features;      /* F, [1, RLVC_COUNTS_FEATURES_MAX] */
    uint32_t cell_bits;     /* [0, RLVC_CELL_BITS_MAX] */
} rlvc_counts;

/* The memory that rlvc_learn_counts needs with the tree as it is. O(rows).
 * @return RLVC_OK; RLVC_E_NULL: an array of *counts, too; RLVC_E_RANGE: a number or a row of
 *         *counts; RLVC_E_MEMORY: no size_t holds it; *bytes is then 0. */
RLVC_API rlvc_status rlvc_counts_size(const rlvc_agent *agent, const rlvc_counts *counts,
                                      size_t *bytes);

/* One round of a learning step: solves for the values, splits the classes that are aliased, and,
 * if none is, those aliased by what follows. A round that splits none ends the step, like one of
 * rlvc_learn: progress->done is 1. `rounds` and `splits` are those of the call. Numbers of samples
 * above 2^32 - 1 appear as that in what the agent reports. The interactions in the agent's ring
 * take no part; they are classified anew by the next rlvc_learn.
 *
 * Not sliced: O(rows (log rows + features) + classes actions features), and the
 * solution.
 * @param memory aligned to RLVC_ALIGNMENT; `bytes` of it, rlvc_counts_size or more; only used
 *               during the call
 * @return RLVC_OK; RLVC_E_CONFIG: the criterion is not the residual, the solver not a batch solver,
 *         the score not the gain, config.dependence and config.successors are 1
 *         (counts know no order), or the domain
 *         has its own oracle; RLVC_E_BUSY: rlvc_learn is under way; RLVC_E_NULL: an array of
 * *counts, too; RLVC_E_RANGE: *counts contradicts itself, or counts too many, or the domain does
 * not vouch for a feature; RLVC_E_MEMORY; RLVC_E_MISMATCH: the tree tests a feature that is not in
 * `tested`. */
RLVC_API rlvc_status rlvc_learn_counts(rlvc_agent *agent, const rlvc_counts *counts, void *memory,
                                       size_t bytes, rlvc_progress *progress);

#ifdef __cplusplus
}
#endif

#endif
