/* SPDX-License-Identifier: MIT */
/* How far samples depend on each other: see dependence.h. */
#include "rlvc/float_rules.h"

#include "dependence.h"

#include <string.h>

/* Correlations above count as this. */
#define CORRELATION_MAX 0.99f
/* Standard errors. */
#define CLEARLY 3.0f

void rlvc_dependence_begin(rlvc_dependence *dependence) {
    memset(dependence, 0, sizeof *dependence);
}

/* The mean target of the samples with or without the feature. */
static float mean(const rlvc_sides *sides, uint32_t present) {
    return sides->sum[present] / (float)sides->count[present];
}

static void add_product(rlvc_dependence *dependence, const rlvc_target_input *aliasing,
                        const rlvc_sides *sides, uint32_t present, float target) {
    const float share = (float)sides->count[1] / ((float)sides->count[0] + (float)sides->count[1]);
    const float rest = target - mean(sides, present);
    const float u = rest > aliasing->gap || rest < -aliasing->gap
                        ? ((float)present - share) * rest
                        : 0.0f; /* the targets count as equal */
    dependence->sum[0] += u * u;
    dependence->sum[1] += u * dependence->before[0];
    dependence->sum[2] += u * dependence->before[1];
    dependence->before[1] = dependence->before[0];
    dependence->before[0] = u;
    dependence->count++;
}

/* Looks at the sample in a slot, for the second time or the first. */
static rlvc_status look(rlvc_dependence *dependence, const rlvc_split_input *input, uint32_t slot,
                        const void *feature, float target) {
    rlvc_sides *sides = input->space->of_action.sides + input->replay->action[slot];
    uint8_t present;
    if (rlvc_split_input_exhibits(input, slot, feature, &present) != RLVC_OK)
        return RLVC_E_CALLBACK;
    present = present != 0;
    if (dependence->again) {
        add_product(dependence, input->aliasing, sides, present, target);
    } else {
        sides->sum[present] += target;
        sides->count[present]++;
    }
    return RLVC_OK;
}

rlvc_status rlvc_dependence_step(rlvc_dependence *dependence, const rlvc_split_input *input,
                                 uint32_t class_id, const void *feature, uint32_t budget,
                                 uint32_t *used) {
    const rlvc_replay *replay = input->replay;
    const uint32_t end = input->aliasing->returns.end;
    if (dependence->at == 0 && !dependence->again)
        memset(input->space->of_action.sides, 0,
               input->space->actions * sizeof *input->space->of_action.sides);
    for (*used = 0;
         budget - *used >= RLVC_DEPENDENCE_UNITS && !rlvc_dependence_done(dependence, end);
         *used += RLVC_DEPENDENCE_UNITS) {
        const uint32_t slot = rlvc_replay_slot(replay, dependence->at);
        rlvc_target_cursor target;
        rlvc_target_begin(&target, dependence->at);
        (void)rlvc_target_step(&target, input->aliasing, 1);
        if (target.defined && replay->label[slot] == class_id &&
            look(dependence, input, slot, feature, rlvc_target_of(target.key)) != RLVC_OK)
            return RLVC_E_CALLBACK;
        if (++dependence->at == end && !dependence->again) {
            dependence->again = 1;
            dependence->at = 0;
        }
    }
    return RLVC_OK;
}

float rlvc_dependence_effect(const rlvc_dependence *dependence) {
    const float *sum = dependence->sum;
    if (!(sum[1] > 0.0f))
        return 1.0f;
    const float r1 = sum[1] < CORRELATION_MAX * sum[0] ? sum[1] / sum[0] : CORRELATION_MAX;
    float falls = r1;
    if (r1 * r1 * (float)dependence->count > CLEARLY * CLEARLY && sum[2] > r1 * sum[1])
        falls = sum[2] < CORRELATION_MAX * sum[1] ? sum[2] / sum[1] : CORRELATION_MAX;
    return 1.0f + 2.0f * r1 / (1.0f - falls);
}
