/* SPDX-License-Identifier: MIT */
/* What follows an action: what counts as influenced, as lasting, and for how much a feature counts
 * that stays. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "store.h"
#include "agent/state.h"
#include "base/rng.h"
#include "rlvc/bits.h"
#include "split/successor_evidence.h"

#include <string.h>

static void assert_near(float got, float expected, float error) {
    if (!(got >= expected - error && got <= expected + error))
        fail_msg("%g is not %g", (double)got, (double)expected);
}

/* ------------------------------------------------------------------ persistence */

static void test_effect(void **state) {
    (void)state;
    static const struct {
        uint32_t count[2][2];
        float effect;
    } cases[] = {
        {{{25, 25}, {25, 25}}, 1.0f},        /* anew at each visit */
        {{{10, 40}, {40, 10}}, 1.0f},        /* changes more often than by chance */
        {{{45, 5}, {5, 45}}, 9.0f},          /* r = 0.8 */
        {{{99, 1}, {1, 99}}, 99.0f},         /* r = 0.98 */
        {{{90, 10}, {20, 20}}, 1.4f / 0.6f}, /* r = 0.4 */
        {{{100, 0}, {0, 0}}, 1999999.0f},    /* never changes */
        {{{0, 0}, {0, 0}}, 1999999.0f},      /* was never seen twice */
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        rlvc_persistence persistence;
        rlvc_persistence_begin(&persistence);
        memcpy(persistence.count, cases[i].count, sizeof persistence.count);
        assert_near(rlvc_persistence_effect(&persistence), cases[i].effect,
                    1e-5f * cases[i].effect);
    }
}

/* ------------------------------------------------------------------ evidence */

static void test_influence(void **state) {
    (void)state;
    const rlvc_following turned = {{{10, 30}, {30, 10}}}, kept = {{{30, 10}, {10, 30}}};
    rlvc_successor_evidence evidence;
    memset(&evidence, 0, sizeof evidence);
    rlvc_influence_add(&evidence, &kept, 0);
    assert_int_equal(evidence.degrees, 0); /* nothing to compare with */
    rlvc_influence_add(&evidence, &turned, 1);
    assert_int_equal(evidence.degrees, 2);
    assert_near(evidence.statistic, 2.0f * 20.0f * 79.0f / 80.0f, 1e-3f);
    rlvc_influence_add(&evidence, &turned, 0); /* of another class */
    assert_int_equal(evidence.degrees, 2);
    /* Noise stays, whatever the action. */
    memset(&evidence, 0, sizeof evidence);
    rlvc_influence_add(&evidence, &kept, 0);
    rlvc_influence_add(&evidence, &kept, 1);
    assert_int_equal(evidence.degrees, 2);
    assert_near(evidence.statistic, 0.0f, 1e-6f);
    assert_near(rlvc_successor_evidence_log_p(&evidence), 0.0f, 0.0f);
}

/* As many standard deviations above the mean: ln p goes on where the degrees end. */
static void test_many_degrees(void **state) {
    (void)state;
    rlvc_successor_evidence evidence;
    memset(&evidence, 0, sizeof evidence);
    evidence.degrees = RLVC_SUCCESSOR_DEGREES_MAX;
    evidence.statistic = 24.0f + 40.0f;
    const float log_p = rlvc_successor_evidence_log_p(&evidence);
    assert_near(log_p, -10.9798f, 0.01f);
    evidence.degrees = 4u * RLVC_SUCCESSOR_DEGREES_MAX;
    evidence.statistic = 4.0f * 24.0f + 80.0f;
    assert_near(rlvc_successor_evidence_log_p(&evidence), log_p, 1e-3f);
}

/* A sum of very many tables, each too small to tell anything, has no bias. */
static void test_small_tables(void **state) {
    (void)state;
    rlvc_rng rng;
    rlvc_rng_seed(&rng, 1);
    rlvc_successor_evidence evidence;
    memset(&evidence, 0, sizeof evidence);
    for (uint32_t class_id = 0; class_id < 5000u; class_id++) {
        rlvc_following action[2];
        memset(action, 0, sizeof action);
        for (uint32_t i = 0; i < 6u; i++)
            action[i % 2u].n[1][rlvc_rng_below(&rng, 2)]++;
        rlvc_influence_add(&evidence, &action[0], 0);
        rlvc_influence_add(&evidence, &action[1], 1);
    }
    assert_in_range(evidence.degrees, 4000, 5000);
    assert_true(evidence.statistic < 1.02f * (float)evidence.degrees);
    assert_true(evidence.statistic > 0.9f * (float)evidence.degrees);
}

/* ------------------------------------------------------------------ an agent */

#define CAPACITY 600u
static uint64_t block[RLVC_AGENT_BYTES(2, CAPACITY, 16, 1, RLVC_BITS_FEATURE_BYTES, 4) / 8u];

typedef struct life {
    rlvc_domain domain;
    rlvc_config config;
    rlvc_agent *agent;
} life;

/* Bit 0 is turned round by action 1, bit 1 stays with probability 0.95, bits 2 and 3 are drawn.
 * What is earned is bit `earns`; nothing, if that is 4. */
static void live(life *l, uint32_t earns, uint8_t dependence, uint32_t features_at_once) {
    rlvc_rng rng;
    unsigned char percept = 0;
    assert_int_equal(rlvc_bits_domain(4, &l->domain), RLVC_OK);
    assert_int_equal(rlvc_config_default(&l->config, &l->domain, 2), RLVC_OK);
    l->config.capacity = CAPACITY;
    l->config.classes = 16;
    l->config.features_at_once = features_at_once;
    l->config.dependence = dependence;
    assert_int_equal(rlvc_agent_init(&l->config, &l->domain, block, sizeof block, &l->agent),
                     RLVC_OK);
    rlvc_rng_seed(&rng, 5);
    assert_int_equal(rlvc_begin(l->agent, &percept), RLVC_OK);
    for (uint32_t i = 0; i < CAPACITY - 1u; i++) {
        const rlvc_choice choice = {(uint8_t)rlvc_rng_below(&rng, 2), 0};
        const float reward = earns < 4u ? (float)(percept >> earns & 1u) : 0.0f;
        const uint32_t turned = rlvc_rng_below(&rng, 20) == 0 ? 2u : 0u;
        const uint32_t noise = rlvc_rng_below(&rng, 4) << 2;
        percept = (unsigned char)(((percept & 3u) ^ choice.action ^ turned) | noise);
        assert_int_equal(rlvc_observe(l->agent, choice, reward, &percept, RLVC_GOES_ON), RLVC_OK);
    }
}

/* Learns, and counts how many tests are of each bit. */
static void count_tests(life *l, uint32_t tests[4]) {
    rlvc_progress progress;
    assert_int_equal(rlvc_learn(l->agent, RLVC_BUDGET_UNBOUNDED, &progress), RLVC_OK);
    assert_int_equal(rlvc_agent_check(l->agent), RLVC_OK);
    memset(tests, 0, 4u * sizeof *tests);
    for (uint32_t j = 0; j + 1u < l->agent->tree.classes; j++)
        tests[rlvc_bits_feature(rlvc_tree_feature(&l->agent->tree, j))]++;
}

static void test_what_is_split(void **state) {
    (void)state;
    for (uint32_t at_once = 1; at_once <= 4u; at_once++) {
        life l;
        uint32_t tests[4];
        live(&l, 4, 1, at_once); /* no reward: what is influenced and lasts */
        count_tests(&l, tests);
        const uint32_t structure[4] = {1, 0, 0, 0};
        assert_memory_equal(tests, structure, sizeof tests);
        live(&l, 1, 0, at_once); /* what stays, but is rewarded */
        count_tests(&l, tests);
        assert_true(tests[1] > 0);
        live(&l, 1, 1, at_once); /* some 30 values of it are enough */
        count_tests(&l, tests);
        assert_true(tests[1] > 0 && tests[2] == 0 && tests[3] == 0);
    }
}

/* Learns up to where it is weighed how long a feature stays. */
static void weigh(life *l) {
    rlvc_progress progress;
    live(l, 1, 1, 4);
    const rlvc_learner *learner = &l->agent->learner;
    do
        assert_int_equal(rlvc_learn(l->agent, RLVC_BUDGET_MIN, &progress), RLVC_OK);
    while (!progress.done && (!learner->persistence.wanted || learner->persistence.at == 0));
    assert_false(progress.done);
}

static int fails(void *ctx, const void *percept, const void *feature, uint8_t *present) {
    (void)ctx;
    (void)percept;
    (void)feature;
    (void)present;
    return 1;
}

/* A callback that fails there is tried again. */
static void test_persistence_of_a_failing_callback(void **state) {
    (void)state;
    life l;
    rlvc_progress progress;
    uint32_t tests[4];
    weigh(&l);
    int (*works)(void *, const void *, const void *, uint8_t *) = l.agent->domain.exhibits;
    l.agent->domain.exhibits = fails;
    assert_int_equal(rlvc_learn(l.agent, RLVC_BUDGET_MIN, &progress), RLVC_E_CALLBACK);
    l.agent->domain.exhibits = works;
    count_tests(&l, tests);
    assert_true(tests[1] > 0 && tests[2] == 0 && tests[3] == 0);
}

/* A snapshot that says that a feature is weighed, but holds rewards of which none was found. */
static void test_persistence_without_a_feature(void **state) {
    (void)state;
    static medium bytes;
    life l;
    weigh(&l);
    for (uint32_t slot = 0; slot < CAPACITY; slot++)
        l.agent->replay.reward[slot] = 0.0f;
    rlvc_store store = medium_store(&bytes, &l.config, &l.domain, 0);
    assert_int_equal(rlvc_save(l.agent, &store), RLVC_OK);
    assert_int_equal(rlvc_load(&l.config, &l.domain, block, sizeof block, &store, &l.agent),
                     RLVC_E_DAMAGED);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_effect),
        cmocka_unit_test(test_influence),
        cmocka_unit_test(test_many_degrees),
        cmocka_unit_test(test_small_tables),
        cmocka_unit_test(test_what_is_split),
        cmocka_unit_test(test_persistence_of_a_failing_callback),
        cmocka_unit_test(test_persistence_without_a_feature),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
