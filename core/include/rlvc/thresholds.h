/* SPDX-License-Identifier: MIT */
/* The ready-made domain of thresholds: a percept is a vector of real numbers, a feature is a
 * component and a cutpoint, and a percept exhibits the feature if that component lies above the
 * cutpoint. Optionally a feature may also combine two components (oblique tests). */
#ifndef RLVC_THRESHOLDS_H
#define RLVC_THRESHOLDS_H

#include "rlvc/domain.h"
#include "rlvc/status.h"

#ifdef __cplusplus
extern "C" {
#endif

#define RLVC_THRESHOLDS_COMPONENTS_MAX 1024u
#define RLVC_THRESHOLDS_OBLIQUE_MAX 64u /* components, if tests are oblique */
#define RLVC_THRESHOLDS_CUTPOINTS_MAX 65535u
#define RLVC_THRESHOLDS_NUMBER_MAX 1e15f

/* Percepts and candidate features. It belongs to the caller, who keeps it in place and unchanged
 * while an agent uses the domain.
 *
 * A percept's record is D numbers of binary32, each finite and of absolute value at most
 * RLVC_THRESHOLDS_NUMBER_MAX. rlvc_thresholds_check checks that. rlvc_begin and rlvc_observe
 * refuse other percepts with RLVC_E_PERCEPT, and every callback fails on one. */
typedef struct rlvc_thresholds {
    uint32_t components; /* D, [1, RLVC_THRESHOLDS_COMPONENTS_MAX] */

    /* B: at most so many cutpoints for each component (and each direction of an oblique test), just
     * above the quantiles 0, 1 / B, ..., (B - 1) / B of the class's own values;
     * [1, RLVC_THRESHOLDS_CUTPOINTS_MAX]. 0: exact, every midpoint between neighbouring values.
     * Default 15. */
    uint32_t cutpoints;

    /* 1: also tests x[i] + w x[j] > c of each pair i < j, where w is s_i / s_j times 1/2, 1 or 2,
     * of either sign, and s the distance of a component's quartiles in the class; at most
     * RLVC_THRESHOLDS_OBLIQUE_MAX components. Default 0. */
    uint8_t oblique;

    uint8_t reserved[3]; /* 0 */
} rlvc_thresholds;

#define RLVC_THRESHOLDS_PERCEPT_BYTES(components) (4u * (uint32_t)(components))

/* A feature: x[component] + slope * x[other] > cutpoint. Where slope is 0, `other` means nothing
 * and is 0. A cutpoint of RLVC_THRESHOLDS_NONE is that of a candidate without one: no percept
 * exhibits it. */
typedef struct rlvc_threshold {
    float cutpoint;
    float slope;
    uint16_t component;
    uint16_t other;
} rlvc_threshold;

#define RLVC_THRESHOLDS_FEATURE_BYTES 12u
#define RLVC_THRESHOLDS_NONE 3e38f

/* Fills *thresholds with the defaults for vectors of so many components. Nothing is checked. O(1).
 * @return RLVC_OK; RLVC_E_NULL. */
RLVC_API rlvc_status rlvc_thresholds_default(rlvc_thresholds *thresholds, uint32_t components);

/* Makes *domain the domain of such percepts, with *thresholds as its ctx. Its agents learn as
 * rlvc/planner.h says, unless config.method becomes &rlvc_method_classes: what follows is for
 * these.
 *
 * Detecting is O(1) for each percept and feature. A cutpoint of a class lies half-way between two
 * neighbouring values that are distinct (on the lower one if rounding would put it on the upper).
 * Quantiles that are alike make one, so that a component of few values has few. To find one,
 * candidates() looks at each of the class's percepts ten times at most: O(room * samples), in one
 * call. Exact search has a candidate for each two neighbours in order, so that it costs
 * O(samples^2) a class and component: it is for small classes.
 *
 * @return RLVC_OK; RLVC_E_NULL; RLVC_E_RANGE (a field), *domain unchanged. O(1). */
RLVC_API rlvc_status rlvc_thresholds_domain(rlvc_thresholds *thresholds, rlvc_domain *domain);

/* The same domain without a method of learning, for a policy that was learnt elsewhere
 * (rlvc_planner_policy_of): a program that only acts then links no learner.
 * @return as of rlvc_thresholds_domain. */
RLVC_API rlvc_status rlvc_thresholds_policy_domain(rlvc_thresholds *thresholds,
                                                   rlvc_domain *domain);

/* Is this a percept of the domain? O(D).
 * @return RLVC_OK; RLVC_E_NULL; RLVC_E_RANGE: a NaN, an infinite number, or one out of range. */
RLVC_API rlvc_status rlvc_thresholds_check(const rlvc_thresholds *thresholds, const void *percept);

/* The feature of a record, which need not be aligned; of a null pointer that of a candidate without
 * a cutpoint. O(1). */
RLVC_API rlvc_threshold rlvc_thresholds_feature(const void *record);

#ifdef __cplusplus
}
#endif

#endif
