/* SPDX-License-Identifier: MIT */
/* Directed exploration: what goes after little-tried pairs, the weights of the rest, counting. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "block.h"
#include "explore/explore.h"

#define CLASSES 3u
#define ACTIONS 4u
#define DRAWS 40000u

static uint64_t block[256];
static rlvc_explorer explorer;

static void make(void) {
    rlvc_arena arena = {(unsigned char *)block, 0};
    rlvc_config config;
    (void)rlvc_config_default(&config, &(rlvc_domain){0}, ACTIONS);
    config.classes = CLASSES;
    rlvc_explorer_carve(&explorer, &arena, &config);
    assert_true(arena.used <= sizeof block);
    rlvc_explorer_clear(&explorer, ACTIONS);
}

static void set_seen(uint32_t class_id, uint8_t a, uint8_t b, uint8_t c, uint8_t d) {
    const uint8_t seen[ACTIONS] = {a, b, c, d};
    for (uint32_t i = 0; i < ACTIONS; i++)
        explorer.count[class_id * ACTIONS + i] = seen[i];
}

/* How often each action is chosen is what it should be, by more than four standard deviations. */
static void check_shares(uint32_t class_id, const double share[ACTIONS]) {
    uint32_t count[ACTIONS] = {0};
    rlvc_rng rng;
    rlvc_rng_seed(&rng, 5);
    for (uint32_t i = 0; i < DRAWS; i++) {
        uint32_t action = rlvc_explorer_choose(&explorer, ACTIONS, class_id, &rng);
        assert_in_range(action, 0, ACTIONS - 1u);
        count[action]++;
    }
    for (uint32_t a = 0; a < ACTIONS; a++) {
        double expected = share[a] * DRAWS;
        double deviation = sqrt(expected * (1.0 - share[a]));
        if (fabs(count[a] - expected) > 4.0 * deviation)
            fail_msg("class %u: action %u was chosen %u times, not some %g", class_id, a, count[a],
                     expected);
    }
}

/* Before the first learning step all is drawn, by (1 + n)^-4 and four times as often if it was the
 * last. */
static void test_weights(void **state) {
    (void)state;
    make();
    check_shares(0, (const double[ACTIONS]){0.25, 0.25, 0.25, 0.25});
    explorer.last = 2;
    check_shares(0, (const double[ACTIONS]){1.0 / 7.0, 1.0 / 7.0, 4.0 / 7.0, 1.0 / 7.0});
    set_seen(0, 1, 0, 8, 200); /* beyond 8 all are alike */
    const double sum = 1.0 / 16.0 + 1.0 + 4.0 / 6561.0 + 1.0 / 6561.0;
    check_shares(0, (const double[ACTIONS]){1.0 / 16.0 / sum, 1.0 / sum, 4.0 / 6561.0 / sum,
                                            1.0 / 6561.0 / sum});
}

/* Afterwards every other action goes after what was little tried. */
static void test_going_after(void **state) {
    (void)state;
    make();
    explorer.min_tried = 5;
    set_seen(0, 9, 4, 9, 9); /* little tried, here */
    const double rest = 3.0 / 6561.0 + 1.0 / 625.0;
    check_shares(0, (const double[ACTIONS]){0.5 / 6561.0 / rest, 0.5 + 0.5 / 625.0 / rest,
                                            0.5 / 6561.0 / rest, 0.5 / 6561.0 / rest});
    set_seen(0, 9, 9, 9, 9);
    explorer.to_novel[0] = 2; /* elsewhere */
    check_shares(0, (const double[ACTIONS]){0.125, 0.125, 0.625, 0.125});
    explorer.to_novel[0] = RLVC_NO_ACTION; /* neither */
    check_shares(0, (const double[ACTIONS]){0.25, 0.25, 0.25, 0.25});
}

static void test_counting(void **state) {
    (void)state;
    make();
    set_seen(0, 254, 0, 7, 0);
    explorer.to_novel[0] = 1;
    rlvc_explorer_inherit(&explorer, ACTIONS, 2, 0);
    for (int i = 0; i < 3; i++)
        rlvc_explorer_note(&explorer, ACTIONS, 2, 0);
    rlvc_explorer_note(&explorer, ACTIONS, 2, 3);
    assert_int_equal(explorer.count[0], 254);
    assert_int_equal(explorer.count[8], 255);
    assert_int_equal(explorer.count[10], 7);
    assert_int_equal(explorer.count[11], 1);
    assert_int_equal(explorer.to_novel[2], 1);
    rlvc_explorer_join(&explorer, ACTIONS, 2, 0);
    assert_int_equal(explorer.count[8], 255);
    assert_int_equal(explorer.count[10], 14);
    assert_int_equal(explorer.count[11], 1);
    assert_int_equal(explorer.last, 3);
}

static void test_least(void **state) {
    (void)state;
    assert_int_equal(rlvc_explorer_min_tried(0, 1), 3);
    assert_int_equal(rlvc_explorer_min_tried(183, 12), 3);
    assert_int_equal(rlvc_explorer_min_tried(192, 12), 4);
    assert_int_equal(rlvc_explorer_min_tried(1020, 1), 255);
    assert_int_equal(rlvc_explorer_min_tried(UINT32_MAX, 1), 255);
}

static void test_check(void **state) {
    (void)state;
    make();
    explorer.to_novel[1] = ACTIONS - 1u;
    assert_true(rlvc_explorer_check(&explorer, ACTIONS, 2));
    explorer.to_novel[1] = ACTIONS;
    assert_true(rlvc_explorer_check(&explorer, ACTIONS, 1));
    assert_false(rlvc_explorer_check(&explorer, ACTIONS, 2));
    explorer.to_novel[1] = RLVC_NO_ACTION;
    assert_true(rlvc_explorer_check(&explorer, ACTIONS, 2));
    explorer.last = ACTIONS - 1u;
    assert_true(rlvc_explorer_check(&explorer, ACTIONS, 1));
    explorer.last = ACTIONS;
    assert_false(rlvc_explorer_check(&explorer, ACTIONS, 1));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_weights),  cmocka_unit_test(test_going_after),
        cmocka_unit_test(test_counting), cmocka_unit_test(test_least),
        cmocka_unit_test(test_check),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
