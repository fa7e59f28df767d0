/* SPDX-License-Identifier: MIT */
/* The chance that an episode begins where none has begun, against plain counting over a list of the
 * interactions (history.h). */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "explore/starts.h"
#include "history.h"

#define CLASSES 40u

static history list;
static rlvc_replay replay;

static uint32_t class_of(uint32_t percept, uint32_t classes) {
    return (percept * 2654435761u >> 8) % classes;
}

/* Gives each percept a class. @return how many positions are learnt from. */
static uint32_t label_all(uint32_t classes) {
    for (uint32_t position = 0; position < replay.count; position++)
        replay.label[rlvc_replay_slot(&replay, position)] =
            (uint16_t)class_of(history_percept_at(&replay, position), classes);
    return rlvc_replay_freeze(&replay);
}

static float count_plainly(uint32_t classes) {
    uint32_t begun[CLASSES] = {0}, episodes = 0, once = 0;
    for (uint32_t i = 1; i < list.count; i++) {
        if (history_links(&list.item[i - 1u], 0))
            continue;
        begun[class_of(list.item[i].percept, classes)]++;
        episodes++;
    }
    for (uint32_t c = 0; c < classes; c++)
        once += begun[c] == 1u;
    return episodes == 0 ? 0.0f : (float)once / (float)episodes;
}

static float count_in_slices(uint32_t end, uint32_t budget) {
    uint32_t begun[CLASSES] = {0}, work = 0, used;
    rlvc_starts_cursor starts;
    rlvc_starts_begin(&starts, end);
    while ((used = rlvc_starts_step(&starts, &replay, begun, budget)) > 0) {
        assert_in_range(used, 1, budget);
        work += used;
    }
    assert_int_equal(work, end > 0 ? end - 1u : 0u);
    return rlvc_starts_chance(&starts);
}

/* On rings that hold all, or only the newest; of few classes and of many. */
static void test_chance(void **state) {
    (void)state;
    uint32_t between = 0;
    for (uint32_t seed = 0; seed < 60u; seed++) {
        const uint32_t classes = 1u + seed * (CLASSES - 1u) / 59u;
        rlvc_rng rng;
        rlvc_rng_seed(&rng, seed);
        history_init(&list, &replay, 30u + seed % 3u * 100u);
        for (uint32_t i = 0; i < 3u * seed; i++)
            history_do_random(&list, &replay, &rng, 4u);
        const uint32_t end = label_all(classes);
        const float chance = count_plainly(classes);
        for (uint32_t budget = 1; budget < 500u; budget = budget * 7u + 1u)
            assert_float_equal(count_in_slices(end, budget), chance, 0.0f);
        between += chance > 0.0f && chance < 1.0f;
    }
    assert_true(between > 20);
}

/* Episodes of an interaction each, the first percepts of which are those in `first`. */
static float chance_of(const uint16_t *first, uint32_t episodes) {
    const rlvc_choice choice = {0, 0};
    history_init(&list, &replay, 20);
    for (uint32_t i = 0; i < episodes; i++) {
        history_do_begin(&list, &replay);
        history_do_append(&list, &replay, choice, 0.0f, RLVC_TERMINATED);
        replay.label[rlvc_replay_slot(&replay, i)] = first[i];
    }
    return count_in_slices(rlvc_replay_freeze(&replay), 3);
}

/* The first episode is not counted. */
static void test_some_starts(void **state) {
    (void)state;
    const uint16_t one[5] = {7, 7, 7, 7, 7}, each[5] = {1, 2, 3, 4, 5}, mixed[5] = {9, 3, 3, 3, 8};
    assert_float_equal(chance_of(one, 0), 0.0f, 0.0f);
    assert_float_equal(chance_of(one, 1), 0.0f, 0.0f);
    assert_float_equal(chance_of(one, 2), 1.0f, 0.0f);
    assert_float_equal(chance_of(one, 3), 0.0f, 0.0f);
    assert_float_equal(chance_of(one, 5), 0.0f, 0.0f);
    assert_float_equal(chance_of(each, 5), 1.0f, 0.0f);
    assert_float_equal(chance_of(mixed, 5), 0.25f, 0.0f);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_chance),
        cmocka_unit_test(test_some_starts),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
