/* SPDX-License-Identifier: MIT */
/* The planner where percepts have many numbers and episodes are long. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "block.h"
#include "base/rng.h"
#include "planners.h"
#include <string.h>

#define COMPONENTS 45u /* with two actions 47 terms: a fit that looks at ten rows a term */
#define STEPS 200u     /* of an episode: more than there are cells of two components */
#define EPISODES (RLVC_STRIDE > 1u ? 1u : 3u)

static uint64_t memory[120000];

/* Component 0 goes where the action says, the others are noise. */
static void move(float *s, uint32_t action, rlvc_rng *rng) {
    s[0] += action ? 0.01f : -0.01f;
    for (uint32_t i = 1; i < COMPONENTS; i++)
        s[i] = rlvc_rng_uniform(rng);
}

static void test_many_components(void **state) {
    rlvc_config config;
    rlvc_planner *planner;
    rlvc_progress progress;
    rlvc_planner_statistics statistics;
    rlvc_rng rng;
    float s[COMPONENTS] = {0};
    size_t bytes;
    (void)state;
    rlvc_rng_seed(&rng, 1);
    config = planner_default(COMPONENTS, 2);
    config.candidates = 50;
    config.model_leaves = 4;
    assert_int_equal(planner_size(&config, &bytes), RLVC_OK);
    assert_true(bytes <= sizeof memory);
    assert_int_equal(planner_init(&config, memory, sizeof memory, &planner), RLVC_OK);
    for (uint32_t episode = 0; episode < EPISODES; episode++) {
        memset(s, 0, sizeof s);
        assert_int_equal(planner_begin(planner, s), RLVC_OK);
        for (uint32_t t = 1; t <= STEPS; t++) {
            uint32_t action;
            assert_int_equal(planner_act(planner, &action), RLVC_OK);
            move(s, action, &rng);
            assert_int_equal(planner_observe(planner, action, s[0], s,
                                             t == STEPS ? RLVC_TRUNCATED : RLVC_GOES_ON),
                             RLVC_OK);
        }
        do {
            assert_int_equal(planner_learn(planner, RLVC_BUDGET_UNBOUNDED, &progress), RLVC_OK);
        } while (!progress.done);
    }
    assert_int_equal(rlvc_planner_stats(as_agent(planner), &statistics), RLVC_OK);
    assert_int_equal(statistics.interactions, EPISODES * STEPS);
    assert_true(statistics.fits > 0);
}

/* In builds that have zones between arrays, the planner's arrays have them as well: each byte may
 * be touched, and not one behind. */
static void test_zones(void **state) {
    (void)state;
#ifdef RLVC_RED_ZONES
    rlvc_config config = planner_default(3, 2);
    rlvc_planner *planner;
    assert_int_equal(planner_init(&config, memory, sizeof memory, &planner), RLVC_OK);
    const rlvc_experience *experience = &planner->experience;
    const rlvc_dynamics *model = planner->model + 1;
    const struct {
        const void *array;
        size_t bytes;
    } arrays[] = {
        {planner, sizeof *planner},
        {experience->percept, (size_t)config.capacity * 3u * sizeof(float)},
        {experience->reward, config.capacity * sizeof(float)},
        {experience->action, config.capacity},
        {experience->end, config.capacity},
        {planner->sample.row, config.sample * sizeof *planner->sample.row},
        {model->basis.mean, 3u * sizeof(float)},
        {model->tree, 4u * sizeof *model->tree},
        {planner->archive.trial, RLVC_ARCHIVE_POLICIES * sizeof *planner->archive.trial},
        {planner->start, RLVC_PLANNER_STARTS * 3u * sizeof(float)},
        {planner->now, 3u * sizeof(float)},
        {planner->cells, planner->cells_bytes},
        {planner->fresh, planner->cells_bytes},
    };
    for (size_t i = 0; i < sizeof arrays / sizeof arrays[0]; i++) {
        const unsigned char *array = arrays[i].array;
        for (size_t k = 0; k < arrays[i].bytes; k++)
            assert_false(__asan_address_is_poisoned(array + k));
        assert_true(__asan_address_is_poisoned(array + arrays[i].bytes));
    }
#else
    skip();
#endif
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_many_components),
        cmocka_unit_test(test_zones),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
