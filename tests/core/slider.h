/* SPDX-License-Identifier: MIT */
/* A world for the tests of the planner: a mass on a line, pushed left, not at all or right.
 *
 *     x' = x + v / 10,  v' = v + (a - 1) / 10,  reward 1 - x^2 of s,  terminated where |x'| > 1
 *
 * It is linear but for the reward, which is linear in products, so that the model can be exact. */
#ifndef RLVC_TESTS_SLIDER_H
#define RLVC_TESTS_SLIDER_H

#include "base/rng.h"
#include "rlvc/planner.h"

#define SLIDER_COMPONENTS 2u
#define SLIDER_ACTIONS 3u
#define SLIDER_STEPS 60u

typedef struct slider {
    float s[SLIDER_COMPONENTS];
    uint32_t steps;
} slider;

static inline void slider_reset(slider *world, rlvc_rng *rng) {
    world->s[0] = rlvc_rng_uniform(rng) - 0.5f;
    world->s[1] = rlvc_rng_uniform(rng) - 0.5f;
    world->steps = 0;
}

/* One step. @return the end. */
static inline uint8_t slider_step(slider *world, uint32_t action, float *reward) {
    float x = world->s[0];
    *reward = 1.0f - x * x;
    world->s[0] = x + 0.1f * world->s[1];
    world->s[1] += 0.1f * ((float)action - 1.0f);
    world->steps++;
    if (world->s[0] > 1.0f || world->s[0] < -1.0f)
        return RLVC_TERMINATED;
    return world->steps == SLIDER_STEPS ? RLVC_TRUNCATED : RLVC_GOES_ON;
}

#endif
