/* SPDX-License-Identifier: MIT */
/* The policies that were tried: see archive.h. */
#include "rlvc/float_rules.h"

#include "archive.h"

#include "../base/float_math.h"
#include <string.h>

#define BETA_LEAST 0.05f
#define FINALISTS 4u
#define LEAF_PRICE 0.004f
#define COMMON_EPISODES 12.0f /* that the common difference counts for in a score */

void rlvc_archive_carve(rlvc_archive *archive, rlvc_arena *arena, uint32_t components) {
    memset(archive, 0, sizeof *archive);
    archive->components = components;
    archive->beta = 1.0f;
    archive->trial = rlvc_arena_carve(arena, RLVC_ARCHIVE_POLICIES, sizeof *archive->trial);
    archive->start = rlvc_arena_carve(
        arena, RLVC_ARCHIVE_POLICIES * RLVC_ARCHIVE_EPISODES * components, sizeof(float));
}

uint32_t rlvc_archive_add(rlvc_archive *archive, const rlvc_small_tree *tree, float promise) {
    uint32_t place = 0;
    if (archive->count < RLVC_ARCHIVE_POLICIES) {
        place = archive->count++;
    } else {
        for (uint32_t i = 1; i < archive->count; i++)
            if (archive->trial[i].score < archive->trial[place].score)
                place = i;
    }
    rlvc_trial *trial = archive->trial + place;
    memset(trial, 0, sizeof *trial);
    trial->serial = archive->added++;
    trial->tree = *tree;
    trial->promise = promise;
    trial->promise_known = 1;
    return place;
}

void rlvc_archive_note(rlvc_archive *archive, uint32_t policy, const float *start, float earned) {
    rlvc_trial *trial = archive->trial + policy;
    if (trial->episodes == UINT32_MAX) /* no more are counted, but the oldest is replaced */
        trial->episodes -= RLVC_ARCHIVE_EPISODES;
    uint32_t place = trial->episodes++ % RLVC_ARCHIVE_EPISODES;
    memcpy(rlvc_archive_start(archive, policy, place), start, archive->components * sizeof(float));
    trial->earned[place] = earned;
    if (trial->valued > place)
        trial->valued = place;
}

void rlvc_archive_forget(rlvc_archive *archive) {
    for (uint32_t i = 0; i < archive->count; i++) {
        archive->trial[i].promise_known = 0;
        archive->trial[i].valued = 0;
    }
}

/* ------------------------------------------------------------------ scores */

/* The regression of real on promised returns, drawn towards a slope of 1 as by two episodes. */
static void fit_beta(rlvc_archive *archive) {
    float n = 0.0f, x = 0.0f, y = 0.0f, xx = 0.0f, xy = 0.0f;
    for (uint32_t i = 0; i < archive->count; i++) {
        const rlvc_trial *trial = archive->trial + i;
        for (uint32_t e = 0; e < trial->valued; e++) {
            n += 1.0f;
            x += trial->promised[e];
            y += trial->earned[e];
        }
    }
    archive->beta = 1.0f;
    archive->common = 0.0f;
    if (!(n > 0.0f))
        return;
    x /= n;
    y /= n;
    for (uint32_t i = 0; i < archive->count; i++) {
        const rlvc_trial *trial = archive->trial + i;
        for (uint32_t e = 0; e < trial->valued; e++) {
            xx += (trial->promised[e] - x) * (trial->promised[e] - x);
            xy += (trial->promised[e] - x) * (trial->earned[e] - y);
        }
    }
    float prior = 2.0f * xx / n, beta = (xy + prior) / (xx + prior + 1e-12f);
    archive->beta = beta < BETA_LEAST ? BETA_LEAST : beta > 1.0f ? 1.0f : beta;
    if (!(xx > 0.0f))
        archive->beta = 1.0f;
    archive->common = y - archive->beta * x;
}

static float difference(const rlvc_archive *archive, const rlvc_trial *trial, uint32_t episode) {
    return trial->earned[episode] - archive->beta * trial->promised[episode];
}

/* Pooled over the policies, with one degree of freedom of a tenth of the spread of all returns: few
 * episodes that earned the same are no proof that the next will. */
static void fit_deviation(rlvc_archive *archive, float spread) {
    float squares = 0.01f * spread * spread, free = 1.0f;
    for (uint32_t i = 0; i < archive->count; i++) {
        const rlvc_trial *trial = archive->trial + i;
        uint32_t kept = trial->valued;
        float sum = 0.0f;
        for (uint32_t e = 0; e < kept; e++)
            sum += difference(archive, trial, e);
        for (uint32_t e = 0; e < kept; e++) {
            float off = difference(archive, trial, e) - sum / (float)kept;
            squares += off * off;
        }
        free += kept > 1u ? (float)(kept - 1u) : 0.0f;
    }
    archive->deviation = squares > 1e-20f ? rlvc_sqrt(squares / free) : 0.0f;
}

void rlvc_archive_score(rlvc_archive *archive, float spread) {
    fit_beta(archive);
    fit_deviation(archive, spread);
    for (uint32_t i = 0; i < archive->count; i++) {
        rlvc_trial *trial = archive->trial + i;
        uint32_t kept = trial->valued;
        float sum = COMMON_EPISODES * archive->common;
        for (uint32_t e = 0; e < kept; e++)
            sum += difference(archive, trial, e);
        trial->score = archive->beta * trial->promise + sum / ((float)kept + COMMON_EPISODES);
    }
}

/* ------------------------------------------------------------------ choosing */

static float standard_error(const rlvc_archive *archive, const rlvc_trial *trial) {
    return archive->deviation / rlvc_sqrt((float)rlvc_trial_kept(trial));
}

static float price_of(const rlvc_trial *trial) {
    float size = trial->score < 0.0f ? -trial->score : trial->score;
    return LEAF_PRICE * size * (float)trial->tree.leaves;
}

uint32_t rlvc_archive_best(const rlvc_archive *archive, float caution) {
    uint32_t best = 0;
    float most = -3e38f;
    for (uint32_t i = 0; i < archive->count; i++) {
        const rlvc_trial *trial = archive->trial + i;
        float value = -2e38f;
        if (trial->episodes > 0)
            value = trial->score - caution * (standard_error(archive, trial) + price_of(trial));
        if (value > most) {
            most = value;
            best = i;
        }
    }
    return best;
}

int rlvc_archive_flat(const rlvc_archive *archive, float more) {
    float first = more;
    for (uint32_t i = 0; i < archive->count; i++) {
        const rlvc_trial *trial = archive->trial + i;
        for (uint32_t e = 0; e < rlvc_trial_kept(trial); e++) {
            if (!(first < more))
                first = trial->earned[e];
            if (trial->earned[e] != first || first >= more)
                return 0;
        }
    }
    return 1;
}

uint32_t rlvc_archive_race(const rlvc_archive *archive) {
    uint32_t finalist[FINALISTS], finalists = 0, best = 0;
    float episodes = 1.0f, most = -3e38f;
    for (uint32_t i = 0; i < archive->count; i++) {
        uint32_t at = finalists < FINALISTS ? finalists++ : FINALISTS;
        for (; at > 0 && archive->trial[finalist[at - 1u]].score < archive->trial[i].score; at--)
            if (at < FINALISTS)
                finalist[at] = finalist[at - 1u];
        if (at < FINALISTS)
            finalist[at] = i;
    }
    for (uint32_t k = 0; k < finalists; k++)
        episodes += (float)rlvc_trial_kept(archive->trial + finalist[k]);
    for (uint32_t k = 0; k < finalists; k++) {
        const rlvc_trial *trial = archive->trial + finalist[k];
        float bound = 2e38f;
        if (trial->episodes > 0)
            bound =
                trial->score + standard_error(archive, trial) * rlvc_sqrt(0.5f * rlvc_ln(episodes));
        if (bound > most) {
            most = bound;
            best = finalist[k];
        }
    }
    return best;
}
