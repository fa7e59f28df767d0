/* SPDX-License-Identifier: MIT */
/* Which split wins: the written rules for ties, what is too little to split by, and the domain's
 * own oracle. (tests/oracle compares whole searches with a second implementation.) */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "player.h"

static player p;

static void begin(uint32_t actions, uint32_t features_at_once) {
    player_enter_world(&p, BATCH);
    p.config.actions = actions;
    p.config.features_at_once = features_at_once;
    player_init(&p);
}

/* `count` interactions that end at once. */
static void add(uint32_t count, unsigned char percept, uint8_t action, float reward) {
    const rlvc_choice choice = {action, 0};
    for (uint32_t i = 0; i < count; i++) {
        assert_int_equal(rlvc_begin(p.agent, &percept), RLVC_OK);
        assert_int_equal(rlvc_observe(p.agent, choice, reward, NULL, RLVC_TERMINATED), RLVC_OK);
    }
}

/* Learns, and fails unless the root tests a bit after an action (`actions`: after all together). */
static void expect_root(uint32_t bit, uint32_t action) {
    rlvc_split split;
    unsigned char feature[2];
    player_learn(&p, RLVC_BUDGET_UNBOUNDED, NULL);
    assert_int_equal(rlvc_split_at(p.agent, 0, &split, feature), RLVC_OK);
    assert_int_equal(rlvc_bits_feature(feature), bit);
    assert_int_equal(split.action, action);
    assert_int_equal(split.class_id, 0);
    assert_int_equal(split.step, 0);
}

static void expect_none(void) {
    player_learn(&p, RLVC_BUDGET_UNBOUNDED, NULL);
    assert_int_equal(player_stats(&p).classes, 1);
    assert_int_equal(player_stats(&p).refused, 0);
}

/* Of equal evidence the lower action's wins, although the block that shows it comes later. */
static void test_tie_of_actions(void **state) {
    (void)state;
    for (uint32_t at_once = 1; at_once < 7u; at_once++) {
        begin(2, at_once);
        for (uint8_t action = 0; action < 2u; action++) {
            const unsigned char bit = action == 0 ? 16 : 2; /* bit 4 after action 0, 1 after 1 */
            const unsigned char other = 18 - bit;           /* says nothing */
            add(10, 0, action, 0.0f);
            add(10, other, action, 0.0f);
            add(10, bit, action, 5.0f);
            add(10, 18, action, 5.0f);
        }
        expect_root(4, 0);
    }
}

/* Then the earlier feature. */
static void test_tie_of_features(void **state) {
    (void)state;
    for (uint32_t at_once = 1; at_once < 7u; at_once++)
        for (uint8_t action = 0; action < 2u; action++) {
            begin(2, at_once);
            add(20, 0, action, 0.0f);
            add(20, 2 | 8 | 16, action, 5.0f);
            expect_root(1, action);
        }
}

/* What tells a little after each action tells enough after all together. */
static void test_together(void **state) {
    (void)state;
    begin(4, 3);
    for (uint8_t action = 0; action < 4u; action++) {
        add(9, 0, action, 0.0f);
        add(3, 4, action, 0.0f);
        add(3, 0, action, 1.0f);
        add(9, 4, action, 1.0f);
    }
    expect_root(2, 4);
}

/* min_samples counts those of the actions whose targets differ. */
static void test_min_samples(void **state) {
    (void)state;
    for (uint32_t count = 10; count < 13u; count++) {
        player_enter_world(&p, BATCH);
        p.config.actions = 2;
        p.config.min_samples = 12;
        player_init(&p);
        add(30, 3, 1, 7.0f);
        add(count / 2u, 1, 0, 0.0f);
        add(count - count / 2u, 0, 0, 5.0f);
        if (count < 12u)
            expect_none();
        else
            expect_root(0, 0);
    }
}

/* Targets within twice the tolerance are equal under the residual criterion, counted from the
 * lowest of a cluster; under the returns criterion none are that differ. */
static void test_near_targets(void **state) {
    (void)state;
    for (int i = 0; i < 4; i++) {
        player_enter_world(&p, BATCH);
        p.config.actions = 1;
        p.config.tolerance = 0.5f;
        p.config.criterion =
            (uint8_t)(i / 2 == 0 ? RLVC_CRITERION_RESIDUAL : RLVC_CRITERION_RETURNS);
        player_init(&p);
        const unsigned char percepts[2] = {0, 8};
        const rlvc_choice greedy = {0, 1};
        for (uint32_t n = 0; n < 40u; n++) {
            float reward = n % 2u == 0 ? 1.0f : i % 2 == 0 ? 2.0f : 2.0000002f;
            assert_int_equal(rlvc_begin(p.agent, &percepts[n % 2u]), RLVC_OK);
            assert_int_equal(rlvc_observe(p.agent, greedy, reward, NULL, RLVC_TERMINATED), RLVC_OK);
        }
        if (i == 0)
            expect_none();
        else
            expect_root(3, 0);
    }
}

/* Targets differ, and no feature tells them apart: all percepts are alike, or it is chance. */
static void test_nothing_tells(void **state) {
    (void)state;
    begin(1, 6);
    add(20, 5, 0, 0.0f);
    add(20, 5, 0, 1.0f);
    expect_none();
    begin(1, 6);
    for (unsigned char percept = 0; percept < 64u; percept++) {
        add(1, percept, 0, 0.0f);
        add(1, percept, 0, 1.0f);
    }
    expect_none();
}

/* ------------------------------------------------------------------ the domain's own oracle */

/* Which cutpoint it answers at, and what it proposes there. */
static struct { uint32_t below, bit, considered; } answer;

static int scripted(void *ctx, const rlvc_samples *samples, uint32_t below, void *feature,
                    uint32_t *considered) {
    const unsigned char record[2] = {(unsigned char)answer.bit, 0};
    (void)ctx;
    assert_in_range(below, 1, samples->count - 1u);
    *considered = below == answer.below ? answer.considered : 0;
    if (*considered > 0)
        memcpy(feature, record, sizeof record);
    return 0;
}

static void test_oracle(void **state) {
    (void)state;
    const struct {
        uint32_t below, bit, considered;
        int splits;
    } cases[] = {
        {20, 1, 1, 1},         /* the cutpoint that bit 1 explains */
        {20, 1, 0, 0},         /* proposes none */
        {30, 1, 6, 1},         /* explains a part */
        {20, 3, 6, 0},         /* a bit that no percept shows */
        {20, 4, 6, 0},         /* one that all show */
        {20, 5, 6, 0},         /* one that has nothing to do with it */
        {20, 1, 400000000, 0}, /* chosen among so many that it may be chance */
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        answer.below = cases[i].below;
        answer.bit = cases[i].bit;
        answer.considered = cases[i].considered;
        player_enter_world(&p, OWN_ORACLE);
        p.faulty.inner.oracle = scripted;
        p.config.actions = 1;
        player_init(&p);
        add(10, 16 | 32, 0, 0.0f);
        add(10, 16, 0, 0.0f);
        add(5, 16 | 2 | 32, 0, 1.0f);
        add(5, 16 | 2, 0, 1.0f);
        add(5, 16 | 2 | 32, 0, 2.0f);
        add(5, 16 | 2, 0, 2.0f);
        if (cases[i].splits)
            expect_root(1, 0);
        else
            expect_none();
    }
}

/* One side of a feature: `count` samples of bit 4 as it is, half of them of either target. */
typedef struct side {
    uint8_t action, present;
    uint32_t count;
    float low, high;
} side;

/* What a split must be worth: surely less is not made, and little data make nothing sure. */
static void test_smallest_effect(void **state) {
    (void)state;
    static const struct {
        float smallest;
        side side[4];
        uint8_t splits;
    } cases[] = {
        {0.2f, {{0, 0, 300, 0, 0}, {0, 1, 300, 0.1f, 0.1f}}, 0},
        {0.05f, {{0, 0, 300, 0, 0}, {0, 1, 300, 0.1f, 0.1f}}, 1},
        {0.2f, {{0, 1, 300, 0, 0}, {0, 0, 300, 0.1f, 0.1f}}, 0}, /* less with it than without */
        {0.05f, {{0, 1, 300, 0, 0}, {0, 0, 300, 0.1f, 0.1f}}, 1},
        {0.2f, {{0, 0, 300, 0, 0}, {0, 1, 8, 0.1f, 0.1f}}, 0},
        {0.2f, {{0, 0, 300, 0, 0}, {0, 1, 7, 0.1f, 0.1f}}, 1}, /* below min_samples */
        {0.2f, {{0, 1, 300, 0, 0}, {0, 0, 7, 0.1f, 0.1f}}, 1},
        {0.2f, {{0, 0, 300, -0.5f, 0.5f}, {0, 1, 300, 0, 0}}, 0},  /* wider, on an average equal */
        {0.05f, {{0, 0, 300, -0.5f, 0.5f}, {0, 1, 300, 0, 0}}, 1}, /* but not surely */
        {0.5f, {{0, 0, 300, 0, 0}, {0, 1, 300, 0.1f, 0.1f}, {1, 0, 99, 0, 0}, {1, 1, 99, 1, 1}}, 1},
        {2.0f, {{0, 0, 300, 0, 0}, {0, 1, 300, 0.1f, 0.1f}, {1, 0, 99, 0, 0}, {1, 1, 99, 1, 1}}, 0},
        {0.2f, {{0, 0, 300, 0, 0}, {0, 1, 300, 0.1f, 0.1f}, {1, 0, 99, 0, 5}}, 0}, /* not divided */
        {0.2f, {{0, 0, 300, 0, 0}, {0, 1, 300, 0.1f, 0.1f}, {1, 0, 99, 5, 5}}, 0}, /* no cutpoint */
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        for (int detects = 0; detects < 2; detects++) {
            player_enter_world(&p, detects ? BATCH : ONE_BY_ONE);
            p.config.actions = 2;
            p.config.capacity = 1000;
            p.config.smallest_effect = cases[i].smallest;
            player_init(&p);
            for (uint32_t j = 0; j < 4u; j++) {
                const side *s = &cases[i].side[j];
                add(s->count / 2u, s->present ? 16 : 0, s->action, s->low);
                add(s->count - s->count / 2u, s->present ? 16 : 0, s->action, s->high);
            }
            player_learn(&p, RLVC_BUDGET_UNBOUNDED, NULL);
            if (player_stats(&p).classes != 1u + cases[i].splits)
                fail_msg("case %u: %u classes", (unsigned)i, (unsigned)player_stats(&p).classes);
        }
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_tie_of_actions), cmocka_unit_test(test_tie_of_features),
        cmocka_unit_test(test_together),       cmocka_unit_test(test_min_samples),
        cmocka_unit_test(test_near_targets),   cmocka_unit_test(test_nothing_tells),
        cmocka_unit_test(test_oracle),         cmocka_unit_test(test_smallest_effect),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
