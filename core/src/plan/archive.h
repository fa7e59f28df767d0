/* SPDX-License-Identifier: MIT */
/* The policies that were tried, each with a score: the models' promise, corrected by real returns.
 *
 * M(s) is the return that the models promise from a start s. beta, in [0.05, 1], is the slope of
 * the regression of real on promised returns over all episodes; it says how far the model is
 * trusted. An episode that starts in s differs from its promise by return - beta M(s). So
 *
 *     score = beta mean M(starts) + (sum of (return - beta M(s)) + 12 common) / (episodes + 12),
 *
 * where the common difference counts as twelve more episodes. The score removes the luck of the
 * start when episodes are few. It also ranks policies that were never tried among those that were.
 */
#ifndef RLVC_SRC_ARCHIVE_H
#define RLVC_SRC_ARCHIVE_H

#include "../base/arena.h"
#include "small_tree.h"

#define RLVC_ARCHIVE_POLICIES 16u
#define RLVC_ARCHIVE_EPISODES 24u

typedef struct rlvc_trial {
    rlvc_small_tree tree;
    float earned[RLVC_ARCHIVE_EPISODES];   /* the returns of its last episodes */
    float promised[RLVC_ARCHIVE_EPISODES]; /* what the models promise from their starts */
    float promise;                         /* mean over the common starts */
    float score;
    uint32_t serial;   /* no two policies have the same */
    uint32_t episodes; /* that it was tried for, ever */
    uint32_t valued;   /* of its last episodes, whose promise is known */
    uint8_t promise_known;
} rlvc_trial;

typedef struct rlvc_archive {
    rlvc_trial *trial; /* [RLVC_ARCHIVE_POLICIES] */
    float *start;      /* [RLVC_ARCHIVE_POLICIES][RLVC_ARCHIVE_EPISODES][components] */
    uint32_t components;
    uint32_t count;
    uint32_t added; /* ever */
    float beta;
    float common;
    float deviation; /* of a return from its policy's mean, what was promised taken out */
} rlvc_archive;

void rlvc_archive_carve(rlvc_archive *archive, rlvc_arena *arena, uint32_t components);

/* How many of a policy's episodes are remembered. */
static inline uint32_t rlvc_trial_kept(const rlvc_trial *trial) {
    return trial->episodes < RLVC_ARCHIVE_EPISODES ? trial->episodes : RLVC_ARCHIVE_EPISODES;
}

static inline float *rlvc_archive_start(const rlvc_archive *archive, uint32_t policy,
                                        uint32_t episode) {
    return archive->start +
           ((size_t)policy * RLVC_ARCHIVE_EPISODES + episode) * archive->components;
}

/* Adds a policy; of a full archive the one of the lowest score goes. @return its index. */
uint32_t rlvc_archive_add(rlvc_archive *archive, const rlvc_small_tree *tree, float promise);

/* Notes an episode of a policy. O(components). */
void rlvc_archive_note(rlvc_archive *archive, uint32_t policy, const float *start, float earned);

/* Forgets all promises: the model is another one. O(1). */
void rlvc_archive_forget(rlvc_archive *archive);

/* beta, common, deviation and all scores, from the episodes whose promise is known.
 * @param spread the greatest return so far less the least. O(all episodes). */
void rlvc_archive_score(rlvc_archive *archive, float spread);

/* The policy of the highest score, less `caution` standard errors of its episodes' mean and, for
 * each leaf, `caution` times 0.4 % of the score: where returns do not tell policies apart the
 * smaller one is chosen. Those that were never tried only if none was. The archive is not empty. */
uint32_t rlvc_archive_best(const rlvc_archive *archive, float caution);

/* Did all episodes of all policies earn the same, less than `more`? Then their returns tell nothing
 * of the model yet. O(all episodes). */
int rlvc_archive_flat(const rlvc_archive *archive, float more);

/* The policy to try again, of the best four: the one of the highest upper confidence bound. */
uint32_t rlvc_archive_race(const rlvc_archive *archive);

#endif
