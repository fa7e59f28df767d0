/* SPDX-License-Identifier: MIT */
/* The class of a percept by the weight of evidence. Where things are seen as they never were while
 * they were learnt, a percept scores less by the bag of its own thing than is needed, but still
 * more than by those of other things. So bags compete.
 *
 * A class's weight is the product of what is to be found in its percepts, each in parts of what is
 * needed; more of one bag than is needed does not make up for less of the next. What is not to be
 * found there weighs nothing, or a class at the end of many tests would lose by their number. But
 * one that the last test of its path leaves counts less: it has the percepts that no other class
 * claims. */
#include "rlvc/float_rules.h"

#include "rlvc/bags.h"

#include "bag.h"

#define LEFT 0.4f
#define RATIO_MAX 4.0f

static float lesser(float a, float b) {
    return a < b ? a : b;
}

static float ratio_of(const rlvc_layout *layout, const void *percept, const void *feature) {
    const float needed = rlvc_bags_needed(feature);
    rlvc_bag bag;
    rlvc_bag_read(layout, feature, &bag);
    return lesser(rlvc_bag_score(layout, &bag, percept, RATIO_MAX * needed) / needed, RATIO_MAX);
}

/* The splits in order: split j of class c gives the percepts with its bag to class j + 1. A minus
 * marks a class that was split. */
static rlvc_status weigh_splits(const rlvc_layout *layout, const rlvc_agent *agent,
                                const void *percept, void *feature, float *weight,
                                uint32_t *classes) {
    rlvc_split split;
    rlvc_status status;
    uint32_t j = 0;
    weight[0] = 1.0f;
    while ((status = rlvc_split_at(agent, j, &split, feature)) == RLVC_OK) {
        const float marked = weight[split.class_id], parent = marked < 0.0f ? -marked : marked;
        weight[split.class_id] = -parent;
        weight[++j] = lesser(parent, 1.0f) * ratio_of(layout, percept, feature);
    }
    *classes = j + 1u;
    return status == RLVC_E_RANGE ? RLVC_OK : status; /* none is left */
}

/* Takes off the marks, too. */
static uint32_t heaviest(float *weight, uint32_t classes) {
    uint32_t best = 0;
    for (uint32_t c = 0; c < classes; c++) {
        if (weight[c] < 0.0f)
            weight[c] *= -LEFT;
        if (weight[c] > weight[best])
            best = c;
    }
    return best;
}

rlvc_status rlvc_bags_weigh(const rlvc_bags *bags, const rlvc_agent *agent, const void *percept,
                            void *feature, float *weight, uint32_t *class_id, uint32_t *action) {
    uint32_t classes = 1;
    if (bags == NULL || agent == NULL || percept == NULL || feature == NULL || weight == NULL)
        return RLVC_E_NULL;
    if (rlvc_vectors_check_percept(&bags->vectors, percept) != 0)
        return RLVC_E_PERCEPT;
    const rlvc_layout layout = rlvc_bag_layout(bags);
    const rlvc_status status = weigh_splits(&layout, agent, percept, feature, weight, &classes);
    if (status != RLVC_OK)
        return status;
    const uint32_t best = heaviest(weight, classes);
    if (class_id != NULL)
        *class_id = best;
    return action == NULL ? RLVC_OK : rlvc_value(agent, best, NULL, action);
}
