/* SPDX-License-Identifier: MIT */
/* The domain (section 5): percepts, features, the feature detector and the refining oracle.
 *
 * Percepts and features are records of a fixed size, kept by value: percepts in the agent's ring,
 * one feature in each internal node of its tree. A callback must not call the agent that
 * called it, must not keep a pointer it was given, and must always give the same result for the
 * same arguments. A callback returns 0, or anything else to fail: the agent's call then ends with
 * RLVC_E_CALLBACK. */
#ifndef RLVC_DOMAIN_H
#define RLVC_DOMAIN_H

#include "rlvc/status.h"

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* One sample of a class: a place in the agent's ring, and a key that sorts as its target does. */
typedef struct rlvc_sample {
    uint32_t key;
    uint32_t slot;
} rlvc_sample;

/* The samples of one class and action, by ascending target: what a refining oracle looks at. */
typedef struct rlvc_samples {
    const unsigned char *percepts; /* the ring's percepts, one record after another */
    const rlvc_sample *sample;     /* [count] */
    uint32_t percept_bytes;
    uint32_t count;
} rlvc_samples;

/* The percept of sample i, i in [0, count). O(1). */
static inline const void *rlvc_samples_percept(const rlvc_samples *samples, uint32_t i) {
    return samples->percepts + (size_t)samples->sample[i].slot * samples->percept_bytes;
}

/* How many samples detect() is asked about at once, and how many features at most. */
#define RLVC_DETECT_SAMPLES 64u
#define RLVC_DETECT_FEATURES 64u

/* domain.kind: what a ready-made domain is known by where its features must be understood
 * (exporting). */
#define RLVC_DOMAIN_OWN 0u /* yours */
#define RLVC_DOMAIN_BITS 1u
#define RLVC_DOMAIN_DESCRIPTORS 2u
#define RLVC_DOMAIN_THRESHOLDS 3u
#define RLVC_DOMAIN_SPATIAL 4u
#define RLVC_DOMAIN_BAGS 5u

/* How an agent learns: see rlvc/agent.h and rlvc/planner.h. A program links a method if it names
 * it, or calls a domain's constructor that does. */
typedef struct rlvc_method rlvc_method;
extern RLVC_API const rlvc_method rlvc_method_classes; /* classes of percepts */
extern RLVC_API const rlvc_method rlvc_method_planner; /* small trees in a learnt model */

typedef struct rlvc_domain {
    void *ctx; /* passed to every callback */

    uint32_t percept_bytes; /* size of a percept's record, [1, 2^20]. A record is aligned to 4
                               (8) if its size is a multiple of 4 (8), else to 1. */
    uint32_t feature_bytes; /* size of a feature's record, [1, 2^16], aligned likewise */
    uint32_t features_max;  /* how many candidates there can be for one class, or 0 if not known;
                               only sizes memory */
    uint32_t kind;          /* RLVC_DOMAIN_* */

    /* Feature detector: *present becomes 1 if the percept exhibits the feature, else 0. Required.
     * Acting calls it once per level of the tree. */
    int (*exhibits)(void *ctx, const void *percept, const void *feature, uint8_t *present);

    /* Candidates of the default refining oracle, which is an exhaustive search over the features
     * that the class's own percepts exhibit (section 4.2.3). Writes the candidates numbered first,
     * first + 1, ... into features (at most `room` records of feature_bytes) and sets *written;
     * fewer than room means that there are no more. The order is the tie-break: of two features
     * that score alike, the earlier wins. Required unless `oracle` is set. */
    int (*candidates)(void *ctx, const rlvc_samples *samples, uint32_t first, uint32_t room,
                      void *features, uint32_t *written);

    /* Batch detector, optional (null: exhibits() is called for each pair). For samples first + i,
     * i < n <= RLVC_DETECT_SAMPLES, and features j < m <= RLVC_DETECT_FEATURES: bit i of columns[j]
     * becomes 1 if the sample exhibits features[j], else 0; bits n and above become 0. Must agree
     * with exhibits(). */
    int (*detect)(void *ctx, const rlvc_samples *samples, uint32_t first, uint32_t n,
                  const void *features, uint32_t m, uint64_t *columns);

    /* The domain's own refining oracle, optional (null: the default one). Given samples [0, below)
     * and [below, count), proposes the feature that best explains this partition and says in
     * *considered (1 or more) among how many it chose, for the correction of the p-value.
     * *considered = 0 proposes none. Called once per cutpoint. */
    int (*oracle)(void *ctx, const rlvc_samples *samples, uint32_t below, void *feature,
                  uint32_t *considered);

    /* A feature's name, such as "bit 3": at most `room` - 1 characters and a final 0. No quote,
     * backslash or control character, so that it fits into JSON and DOT as it is. Required. */
    int (*name)(void *ctx, const void *feature, char *text, uint32_t room);

    /* Is a record a percept of this domain; is it a feature that a tree may hold? 0 if so, else
     * anything. Each is optional: null means that any record is one, whose bytes may then come from
     * a forged snapshot. After a 0 no other callback may read or write beyond its arguments because
     * of the record, nor fail for ever because of it. Must not look at anything but the record and
     * ctx.
     *
     * Percepts are asked about where they come in (rlvc_begin, rlvc_observe), both where they are
     * loaded (rlvc_load) and by rlvc_agent_check. */
    int (*check_percept)(void *ctx, const void *percept);
    int (*check_feature)(void *ctx, const void *feature);

    /* Of what a record is made, for snapshots and logs that are the same bytes on every target: it
     * begins with so many numbers of 4 bytes (float, uint32_t), in a feature then so many of 2
     * bytes, which are stored lowest byte first. The rest are bytes, stored as they are. Numbers
     * beyond the record's end do not count. All 0: a record of bytes. */
    uint32_t percept_words;
    uint32_t feature_words;
    uint32_t feature_halves;

    /* How is learnt where the config does not say otherwise: of your own domains set
     * &rlvc_method_classes. Only rlvc_config_default looks at it. */
    const rlvc_method *method;
} rlvc_domain;

#define RLVC_NAME_BYTES 64u /* the room that name() gets */

/* Spells a finite number in decimal as rlvc_print does, for name(): by the fewest significant
 * digits that read back as the same float, at most nine, or rounded to `digits`, [1, 9], if these
 * are fewer. At most `room` - 1 characters and a final 0; nothing where there is no room. O(1).
 * @return how many characters; 0 for a null pointer. */
RLVC_API uint32_t rlvc_spell(float number, uint32_t digits, char *text, uint32_t room);

#ifdef __cplusplus
}
#endif

#endif
