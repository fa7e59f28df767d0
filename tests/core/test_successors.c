/* SPDX-License-Identifier: MIT */
/* What follows an action: what counts as influenced, as lasting, and for how much a feature counts
 * that stays. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "block.h"
#include "store.h"
#include "agent/learn.h"
#include "base/rng.h"
#include "rlvc/bits.h"
#include "split/successor_evidence.h"

#include <string.h>

static void assert_near(float got, float expected, float error) {
    if (!(got >= expected - error && got <= expected + error))
        fail_msg("%g is not %g", (double)got, (double)expected);
}

/* ------------------------------------------------------------------ dependence */

static void test_effect(void **state) {
    (void)state;
    static const struct {
        uint32_t count;
        float sum[3];
        float effect;
    } cases[] = {
        {100, {0, 0, 0}, 1.0f},           /* the feature explains the targets */
        {100, {10, 0, 0}, 1.0f},          /* anew at each visit */
        {100, {10, -5, 2}, 1.0f},         /* changes more often than by chance */
        {100, {10, 8, 6.4f}, 9.0f},       /* r = 0.8, and its square */
        {100, {10, 4, 3.2f}, 5.0f},       /* falls off by 0.8 beneath noise */
        {100, {10, 4, 1}, 1.4f / 0.6f},   /* no faster than by r */
        {50, {10, 4, 3.2f}, 1.4f / 0.6f}, /* too few to tell how it falls off */
        {100, {10, 4, 6}, 81.0f},         /* does not fall off */
        {100, {10, 12, 13}, 199.0f},      /* likewise */
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        rlvc_dependence dependence;
        rlvc_dependence_begin(&dependence);
        memcpy(dependence.sum, cases[i].sum, sizeof dependence.sum);
        dependence.count = cases[i].count;
        assert_near(rlvc_dependence_effect(&dependence), cases[i].effect, 1e-4f * cases[i].effect);
    }
}

/* ------------------------------------------------------------------ evidence */

static void test_influence(void **state) {
    (void)state;
    const rlvc_following turned = {{{10, 30, 0}, {30, 10, 0}}}, kept = {{{30, 10, 0}, {10, 30, 0}}};
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

/* A feature that never changes, but tells where an action ends the episode. */
static void test_what_ends_an_episode(void **state) {
    (void)state;
    const rlvc_following goes_on = {{{40, 0, 0}, {0, 40, 0}}}, ends = {{{40, 0, 0}, {0, 20, 20}}},
                         always = {{{0, 0, 40}, {0, 0, 40}}};
    rlvc_successor_evidence evidence;
    memset(&evidence, 0, sizeof evidence);
    rlvc_influence_add(&evidence, &goes_on, 0);
    rlvc_influence_add(&evidence, &always, 1);
    assert_int_equal(evidence.degrees, 0); /* it tells nothing */
    rlvc_influence_add(&evidence, &ends, 0);
    assert_int_equal(evidence.degrees, 1);
    /* 80 (40 * 20)^2 / (40 * 40 * 20 * 60), times 79 / 80 */
    assert_near(evidence.statistic, 79.0f / 3.0f, 1e-3f);
    memset(&evidence, 0, sizeof evidence);
    rlvc_lasting_add(&evidence, &always); /* of what has ended nothing lasts */
    assert_int_equal(evidence.degrees, 0);
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
    evidence.degrees--; /* an odd number: the next one */
    assert_near(rlvc_successor_evidence_log_p(&evidence), log_p, 0.0f);
    evidence.degrees = RLVC_SUCCESSOR_ODD_MAX;
    evidence.statistic = 27.0f;
    assert_near(rlvc_successor_evidence_log_p(&evidence), -12.0427f, 0.01f);
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
 * What is earned is bit `earns`, and now and then a quarter more; nothing, if that is 4. */
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
        const float more = 0.25f * (float)rlvc_rng_below(&rng, 2);
        const float reward = earns < 4u ? (float)(percept >> earns & 1u) + more : 0.0f;
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
        live(&l, 1, 1, at_once); /* what it leaves unexplained does not stay */
        count_tests(&l, tests);
        assert_true(tests[1] > 0 && tests[2] == 0 && tests[3] == 0);
    }
}

/* ------------------------------------------------------------------ many at once */

#define WIDE_CAPACITY 700u
#define WIDE_BYTES                                                                                 \
    RLVC_AGENT_BYTES(2, WIDE_CAPACITY, 16, 8, RLVC_BITS_FEATURE_BYTES, RLVC_DETECT_FEATURES)
static uint64_t wide[WIDE_BYTES / 8u], before[WIDE_BYTES / 8u], at_once[WIDE_BYTES / 8u];

/* Of so many bits one is turned round by action 1, and the others are drawn. The ring is gone round
 * more than once, and now and then an episode ends. */
static rlvc_agent *live_widely(life *l, uint32_t bits, uint32_t turned, uint32_t seed) {
    rlvc_rng rng;
    uint64_t percept = 0;
    unsigned char bytes[8] = {0};
    assert_int_equal(rlvc_bits_domain(bits, &l->domain), RLVC_OK);
    assert_int_equal(rlvc_config_default(&l->config, &l->domain, 2), RLVC_OK);
    l->config.capacity = WIDE_CAPACITY;
    l->config.classes = 16;
    assert_int_equal(rlvc_agent_init(&l->config, &l->domain, wide, sizeof wide, &l->agent),
                     RLVC_OK);
    rlvc_rng_seed(&rng, seed);
    for (uint32_t i = 0; i < 2u * WIDE_CAPACITY + 17u * seed; i++) {
        const rlvc_choice choice = {(uint8_t)rlvc_rng_below(&rng, 2), 0};
        const uint64_t one = UINT64_C(1) << turned;
        const uint64_t noise = (uint64_t)rlvc_rng_next(&rng) << 32 | rlvc_rng_next(&rng);
        if (i == 0 || rlvc_rng_below(&rng, 30) == 0)
            assert_int_equal(rlvc_begin(l->agent, bytes), RLVC_OK);
        percept = ((percept ^ (choice.action ? one : 0u)) & one) | (noise & ~one);
        for (uint32_t byte = 0; byte < 8u; byte++)
            bytes[byte] = (unsigned char)(percept >> 8u * byte);
        const int over = rlvc_rng_below(&rng, 40) == 0;
        assert_int_equal(
            rlvc_observe(l->agent, choice, 0.0f, bytes, over ? RLVC_TERMINATED : RLVC_GOES_ON),
            RLVC_OK);
        if (over)
            assert_int_equal(rlvc_begin(l->agent, bytes), RLVC_OK);
    }
    return l->agent;
}

/* Runs of samples make what one sample at a time makes, which is what small budgets leave; and the
 * bit that is influenced is found, and no other. */
static void test_runs_of_samples(void **state) {
    (void)state;
    const uint32_t widths[] = {2, 31, 32, 33, 63, 64};
    for (uint32_t i = 0; i < 12u; i++) {
        const uint32_t bits = widths[i / 2u], turned = i % 2u == 0 ? 0 : bits - 1u;
        life l;
        rlvc_progress progress;
        rlvc_agent *agent = live_widely(&l, bits, turned, i + 1u);
        block_copy(before, wide, sizeof wide);
        assert_int_equal(rlvc_learn(agent, RLVC_BUDGET_UNBOUNDED, &progress), RLVC_OK);
        block_copy(at_once, wide, sizeof wide);
        block_copy(wide, before, sizeof wide);
        do
            assert_int_equal(rlvc_learn(agent, RLVC_BUDGET_MIN, &progress), RLVC_OK);
        while (!progress.done);
        assert_true(block_equal(wide, at_once, sizeof wide));
        assert_int_equal(agent->tree.classes, 2);
        assert_int_equal(rlvc_bits_feature(rlvc_tree_feature(&agent->tree, 0)), turned);
    }
}

/* ------------------------------------------------------------------ dependence */

/* Where the ring is short, fewer features than asked for have room for what is counted of them. */
static void test_many_that_are_influenced(void **state) {
    (void)state;
    static uint64_t small[RLVC_AGENT_BYTES(2, 64, 16, 8, RLVC_BITS_FEATURE_BYTES, 64) / 8u];
    rlvc_domain domain;
    rlvc_config config;
    rlvc_agent *agent;
    rlvc_progress progress;
    unsigned char percept[8] = {0};
    assert_int_equal(rlvc_bits_domain(64, &domain), RLVC_OK);
    assert_int_equal(rlvc_config_default(&config, &domain, 2), RLVC_OK);
    config.capacity = 64;
    config.classes = 16;
    config.alpha = 1.0f;
    assert_int_equal(rlvc_agent_init(&config, &domain, small, sizeof small, &agent), RLVC_OK);
    assert_int_equal(rlvc_begin(agent, percept), RLVC_OK);
    for (uint32_t i = 0; i < 63u; i++) { /* action 1 turns all bits round */
        const rlvc_choice choice = {(uint8_t)(i * i % 3u), 0};
        for (uint32_t j = 0; j < sizeof percept; j++)
            percept[j] = (unsigned char)(choice.action ? ~percept[j] : percept[j]);
        assert_int_equal(rlvc_observe(agent, choice, 0.0f, percept, RLVC_GOES_ON), RLVC_OK);
    }
    assert_int_equal(rlvc_learn(agent, RLVC_BUDGET_UNBOUNDED, &progress), RLVC_OK);
    assert_int_equal(rlvc_agent_check(agent), RLVC_OK);
    assert_int_equal(agent->tree.classes, 2);
    assert_int_equal(agent->learner.influenced, 23); /* 2,048 bytes of columns */
}

/* Learns up to where it is measured how far samples depend on each other, in the first of two
 * times or the second. */
static void weigh(life *l, uint8_t again) {
    rlvc_progress progress;
    live(l, 1, 1, 4);
    const rlvc_learner *learner = &l->agent->learner;
    do
        assert_int_equal(rlvc_learn(l->agent, RLVC_BUDGET_MIN, &progress), RLVC_OK);
    while (!progress.done && (!learner->dependence.wanted || learner->dependence.again != again ||
                              learner->dependence.at == 0));
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
static void test_dependence_of_a_failing_callback(void **state) {
    (void)state;
    for (uint8_t again = 0; again < 2; again++) {
        life l;
        rlvc_progress progress;
        uint32_t tests[4];
        weigh(&l, again);
        int (*works)(void *, const void *, const void *, uint8_t *) = l.agent->domain.exhibits;
        l.agent->domain.exhibits = fails;
        assert_int_equal(rlvc_learn(l.agent, RLVC_BUDGET_MIN, &progress), RLVC_E_CALLBACK);
        l.agent->domain.exhibits = works;
        count_tests(&l, tests);
        assert_true(tests[1] > 0 && tests[2] == 0 && tests[3] == 0);
    }
}

/* A snapshot that says that a feature is weighed, but holds rewards of which none was found. */
static void test_dependence_without_a_feature(void **state) {
    (void)state;
    static medium bytes;
    life l;
    weigh(&l, 0);
    for (uint32_t slot = 0; slot < CAPACITY; slot++)
        l.agent->replay.reward[slot] = 0.0f;
    rlvc_store store = medium_store(&bytes, &l.config, &l.domain, 0);
    assert_int_equal(rlvc_save(l.agent, &store), RLVC_OK);
    assert_int_equal(rlvc_load(&l.config, &l.domain, block, sizeof block, &store, &l.agent),
                     RLVC_E_DAMAGED);
}

/* What is looked at is charged: a search of 4 bits in so many samples is cut into many slices. */
static void test_slices(void **state) {
    (void)state;
    life l;
    rlvc_progress progress;
    uint32_t slices[2] = {0, 0};
    live(&l, 4, 1, 4);
    do {
        assert_int_equal(rlvc_learn(l.agent, RLVC_BUDGET_MIN, &progress), RLVC_OK);
        slices[0] += l.agent->learner.phase == RLVC_PHASE_INFLUENCE;
        slices[1] += l.agent->learner.phase == RLVC_PHASE_SUCCESSORS;
    } while (!progress.done);
    assert_true(slices[0] > 4u * CAPACITY / RLVC_BUDGET_MIN);
    assert_true(slices[1] > 4u);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_effect),
        cmocka_unit_test(test_influence),
        cmocka_unit_test(test_what_ends_an_episode),
        cmocka_unit_test(test_many_degrees),
        cmocka_unit_test(test_small_tables),
        cmocka_unit_test(test_what_is_split),
        cmocka_unit_test(test_runs_of_samples),
        cmocka_unit_test(test_many_that_are_influenced),
        cmocka_unit_test(test_dependence_of_a_failing_callback),
        cmocka_unit_test(test_dependence_without_a_feature),
        cmocka_unit_test(test_slices),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
