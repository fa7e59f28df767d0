/* SPDX-License-Identifier: MIT */
/* What a split is worth (config.smallest_effect): after an action, how far the mean targets of the
 * samples with and without a feature are apart, in units of return.
 *
 * Of very many samples any difference becomes significant. One is surely smaller than s if
 *
 *     |mean with - mean without| + 3 standard errors < s
 *
 * and both sides have min_samples or more. A split is worth it unless that holds after each action
 * that has cutpoints. The samples come by ascending target, and equal ones are added at once: so
 * columns of samples (split_search.c) and rows of counts (counts/search.c) give the same bits. */
#ifndef RLVC_SRC_EFFECT_H
#define RLVC_SRC_EFFECT_H

#include "../base/count.h"
#include "../base/float_math.h"
#include "../samples/targets.h"

/* Of one action. Index 1: with the feature. */
typedef struct rlvc_effect {
    rlvc_count equal[2]; /* samples whose target is `key`, not yet added */
    float count[2];
    float sum[2]; /* of targets less the lowest, */
    float squares[2];
    float lowest;
    uint32_t key;
    uint8_t any;     /* there was a sample */
    uint8_t matters; /* after this action or one before it */
} rlvc_effect;

/* Adds the samples that are equal. O(1). */
static inline void rlvc_effect_flush(rlvc_effect *effect) {
    const float target = rlvc_target_of(effect->key) - effect->lowest;
    for (uint32_t v = 0; v < 2; v++) {
        const float times = (float)effect->equal[v];
        effect->count[v] += times;
        effect->sum[v] += times * target;
        effect->squares[v] += times * (target * target);
        effect->equal[v] = 0;
    }
}

/* Adds samples of one target, no lower than those before. O(1). */
static inline void rlvc_effect_add(rlvc_effect *effect, uint32_t key, rlvc_count without,
                                   rlvc_count with) {
    if (!effect->any) {
        effect->any = 1;
        effect->lowest = rlvc_target_of(key);
    } else if (key != effect->key) {
        rlvc_effect_flush(effect);
    }
    effect->key = key;
    effect->equal[0] += without;
    effect->equal[1] += with;
}

/* Variance of a side's mean; below 0 only by rounding. O(1). */
static inline float rlvc_effect_variance(const rlvc_effect *effect, uint32_t v) {
    const float mean = effect->sum[v] / effect->count[v];
    return (effect->squares[v] / effect->count[v] - mean * mean) / effect->count[v];
}

/* Ends an action, of which there was a sample. O(1). */
static inline void rlvc_effect_close(rlvc_effect *effect, float smallest, uint32_t min_samples) {
    static const rlvc_effect nothing = {{0, 0}, {0, 0}, {0, 0}, {0, 0}, 0.0f, 0, 0, 0};
    uint8_t matters = effect->matters;
    rlvc_effect_flush(effect);
    const float *count = effect->count, fewer = count[0] < count[1] ? count[0] : count[1];
    if (fewer > 0.0f) {
        float apart = effect->sum[1] / count[1] - effect->sum[0] / count[0];
        const float variance = rlvc_effect_variance(effect, 0) + rlvc_effect_variance(effect, 1);
        apart = apart < 0.0f ? -apart : apart;
        if (variance > 0.0f)
            apart += 3.0f * rlvc_sqrt(variance);
        matters |= fewer < (float)min_samples || !(apart < smallest);
    }
    *effect = nothing;
    effect->matters = matters;
}

#endif
