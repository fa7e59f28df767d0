/* SPDX-License-Identifier: MIT */
/* A planner that plays the slider and learns after each episode, for tests. Include after cmocka.h.
 */
#ifndef RLVC_TESTS_SLIDER_PLAYER_H
#define RLVC_TESTS_SLIDER_PLAYER_H

#include "planners.h"
#include "slider.h"

#include <string.h>

typedef struct player {
    rlvc_planner *planner;
    rlvc_rng rng;
    slider world;
    uint32_t budget; /* of one call of rlvc_planner_learn */
    uint64_t work;   /* of all calls */
} player;

/* A planner of the slider with models that are soon done. */
static inline rlvc_config slider_config(void) {
    rlvc_config config;
    config = planner_default(SLIDER_COMPONENTS, SLIDER_ACTIONS);
    config.model_leaves = 8;
    config.random = 150;
    return config;
}

/* The same, with searches that are soon done. */
static inline rlvc_config small_config(void) {
    rlvc_config config = slider_config();
    config.sample = 500;
    config.candidates = 150;
    config.patience = 60;
    return config;
}

/* @return a planner in `block`, which has `most` bytes. */
static inline rlvc_planner *make_in(const rlvc_config *config, void *block, size_t most) {
    rlvc_planner *planner;
    size_t bytes;
    assert_int_equal(planner_size(config, &bytes), RLVC_OK);
    assert_true(bytes <= most);
    assert_int_equal(planner_init(config, block, bytes, &planner), RLVC_OK);
    return planner;
}

static inline rlvc_planner_statistics stats_of(rlvc_planner *planner) {
    rlvc_planner_statistics statistics;
    assert_int_equal(rlvc_planner_stats(as_agent(planner), &statistics), RLVC_OK);
    return statistics;
}

/* One step of learning, in calls of `budget` units each. @return its units. */
static inline uint64_t learn_in_slices(rlvc_planner *planner, uint32_t budget) {
    rlvc_progress progress;
    uint64_t work = 0;
    do {
        assert_int_equal(planner_learn(planner, budget, &progress), RLVC_OK);
        assert_true(progress.work <= budget);
        work += progress.work;
    } while (!progress.done);
    return work;
}

static inline void learn(rlvc_planner *planner) {
    (void)learn_in_slices(planner, RLVC_BUDGET_UNBOUNDED);
}

static inline void begin(player *p) {
    slider_reset(&p->world, &p->rng);
    assert_int_equal(planner_begin(p->planner, p->world.s), RLVC_OK);
}

static inline void start(player *p, rlvc_planner *planner, uint32_t seed) {
    memset(p, 0, sizeof *p);
    p->planner = planner;
    p->budget = RLVC_BUDGET_UNBOUNDED;
    rlvc_rng_seed(&p->rng, seed);
    begin(p);
}

static inline void play(player *p, uint32_t interactions) {
    for (uint32_t i = 0; i < interactions; i++) {
        uint32_t action;
        float reward;
        assert_int_equal(planner_act(p->planner, &action), RLVC_OK);
        uint8_t end = slider_step(&p->world, action, &reward);
        assert_int_equal(planner_observe(p->planner, action, reward, p->world.s, end), RLVC_OK);
        if (end != RLVC_GOES_ON) {
            p->work += learn_in_slices(p->planner, p->budget);
            begin(p);
        }
    }
}

/* @return a planner of the small configuration in `block` after so many interactions. */
static inline rlvc_planner *play_small(player *p, void *block, size_t most, uint32_t seed,
                                       uint32_t interactions) {
    rlvc_config config = small_config();
    rlvc_planner *planner = make_in(&config, block, most);
    start(p, planner, seed);
    play(p, interactions);
    return planner;
}

#endif
