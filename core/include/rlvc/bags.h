/* SPDX-License-Identifier: MIT */
/* The ready-made domain of bags of vectors: a percept is the vectors found at a picture's interest
 * points, as in rlvc/descriptors.h, and a feature is a bag of vectors that tend to be seen
 * together. A percept exhibits it if enough of them are among its own. So a feature is still found
 * where some of its points are covered, lost, or seen before something else, and it is not found
 * because a single foreign vector happens to be like one of its own. */
#ifndef RLVC_BAGS_H
#define RLVC_BAGS_H

#include "rlvc/agent.h"
#include "rlvc/descriptors.h"

#ifdef __cplusplus
extern "C" {
#endif

#define RLVC_BAGS_SIZE_MAX 32u

/* Percepts, features and candidates. It belongs to the caller, who keeps it in place and unchanged
 * while an agent uses the domain. */
typedef struct rlvc_bags {
    rlvc_descriptors vectors; /* radius: tau, beyond which a vector does not count. candidates: the
                                 most bags looked at for one class, default 16. draws and margin
                                 are in range, and of no meaning */
    uint32_t size; /* K: the most vectors of a bag, [1, RLVC_BAGS_SIZE_MAX]. Default 32 */
} rlvc_bags;

/* Bytes of a feature: float needed; uint32_t count, in [0, K]; K vectors, of which the first
 * `count` mean something; then zeros up to a multiple of 4.
 *
 * Each vector of the bag that is d < tau away from the nearest of a percept's scores tau^2 - d^2.
 * The percept exhibits the feature if the sum is at least `needed`. If that is negative, the
 * candidate was refused: no percept exhibits it. */
#define RLVC_BAGS_FEATURE_BYTES(size, dimensions, form)                                            \
    (8u + ((uint32_t)(size)*RLVC_DESCRIPTORS_VECTOR_BYTES(dimensions, form) + 3u) / 4u * 4u)

/* Fills *bags with the defaults for such percepts. Nothing is checked. O(1).
 * @return RLVC_OK; RLVC_E_NULL. */
RLVC_API rlvc_status rlvc_bags_default(rlvc_bags *bags, uint32_t points, uint32_t dimensions,
                                       uint32_t form, float radius);

/* Makes *domain the domain of such percepts, with *bags as its ctx. Percepts are refused as by
 * rlvc_descriptors_domain.
 *
 * Detecting costs O(K P D) for each percept and feature, at most. A candidate begins as the vectors
 * of one percept, drawn from all targets alike that are not nearly all of their action's. Twice it
 * becomes the vectors that the percepts which have most of it have in common, and percepts with
 * other targets have not; then `needed` is put where it parts those targets best. A percept's own
 * vectors do not count in that.
 *
 * Of noise, too, something is always found that fits the targets. So candidates are gathered from
 * every second sample of the class only, and the others must bear them out: by Fisher's exact test
 * (of many samples chi-square), corrected by the number of candidates, one class of noise in a
 * hundred has any. What was borne out is gathered once more, from all samples. The agent tests
 * these as all features, by all samples. Targets that are hardly ever equal have no candidates: a
 * run of one sample has no second. A candidate costs O((4 K + 72) 512 P D), at most.
 *
 * @return RLVC_OK; RLVC_E_NULL; RLVC_E_RANGE (a field), *domain unchanged. O(1). */
RLVC_API rlvc_status rlvc_bags_domain(rlvc_bags *bags, rlvc_domain *domain);

/* How many vectors a feature has; how much a percept needs. A null pointer has no vector and is
 * exhibited by no percept: 0 and -1. O(1). */
RLVC_API uint32_t rlvc_bags_count(const void *feature);
RLVC_API float rlvc_bags_needed(const void *feature);

/* Which vector of a percept is the nearest to vector `which` of a feature (of equals the first),
 * and how far it is, squared. To show where a feature was found; acting and learning do not need
 * it. O(P D).
 * @param point, squared each optional
 * @return RLVC_OK; RLVC_E_NULL; RLVC_E_RANGE: the percept has no vector, or a count above P; the
 *         feature has no vector `which`. */
RLVC_API rlvc_status rlvc_bags_nearest(const rlvc_bags *bags, const void *percept,
                                       const void *feature, uint32_t which, uint32_t *point,
                                       float *squared);

/* The class of a percept by the weight of evidence, and its greedy action: as rlvc_predict, for
 * places that differ from those of learning. Before clutter, partly covered, or from another side a
 * thing may show too little of its bag, and then a path that asks for enough of it goes astray.
 * Here each class weighs as the product, over the bags of which its percepts have enough, of the
 * score in parts of what is needed: of the last at most 4, of those before at most 1. A class whose
 * percepts have not enough of the last bag of their path weighs 0.4 of that. The heaviest is the
 * answer, of equals the first. Where enough of one thing's bag is to be seen, and not 0.4 of any
 * other's, that is the class that rlvc_predict finds. O(classes K P D); changes nothing but what is
 * written to.
 * @param bags    of the domain of the agent, an agent of classes
 * @param feature room for a feature, aligned to 4; what is left there means nothing
 * @param weight  [classes of the agent]: how much each weighs, [0, 4]
 * @param class_id, action each optional
 * @return RLVC_OK; RLVC_E_NULL; RLVC_E_PERCEPT: a count above P, or a number out of range, and
 *         nothing is written; RLVC_E_MISMATCH: a planner. */
RLVC_API rlvc_status rlvc_bags_weigh(const rlvc_bags *bags, const rlvc_agent *agent,
                                     const void *percept, void *feature, float *weight,
                                     uint32_t *class_id, uint32_t *action);

#ifdef __cplusplus
}
#endif

#endif
