/* SPDX-License-Identifier: MIT */
/* Searches that were in vain are skipped, and nobody can tell: a twin that is made to forget them
 * before each call does the same work by the same budgets and grows the same tree, byte for byte.
 * The domain counts what it is asked, and is asked less. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "agent/learn.h"
#include "agent/state.h"
#include "base/rng.h"
#include "rlvc/bits.h"
#define MEDIUM_BYTES 262144u
#include "block.h"
#include "store.h"

#define BITS 12u
#define WIDE 70u
#define CAPACITY 600u
#define STEPS 24u
#define BLOCK_BYTES (1u << 18)

typedef struct twin {
    uint64_t block[BLOCK_BYTES / 8u];
    uint64_t kept[BLOCK_BYTES / 8u];
    rlvc_agent *agent;
    medium medium;
    uint64_t asked;
} twin;

static twin one, forgetful;
static rlvc_config config;
static rlvc_domain bits, counting;
static size_t bytes;

static uint64_t asked;

static int count_detect(void *ctx, const rlvc_samples *samples, uint32_t first, uint32_t n,
                        const void *features, uint32_t m, uint64_t *present) {
    asked++;
    return bits.detect(ctx, samples, first, n, features, m, present);
}

static void make(twin *t) {
    t->asked = 0;
    assert_int_equal(rlvc_agent_size(&config, &counting, &bytes), RLVC_OK);
    assert_true(bytes <= BLOCK_BYTES);
    block_fill(t->block, 0xa5, BLOCK_BYTES);
    assert_int_equal(rlvc_agent_init(&config, &counting, t->block, BLOCK_BYTES, &t->agent),
                     RLVC_OK);
}

/* An episode of one interaction. */
static void play(rlvc_agent *agent, uint32_t number, float reward, uint32_t next, uint8_t end) {
    rlvc_choice choice;
    const unsigned char percept[RLVC_BITS_PERCEPT_BYTES(WIDE)] = {(unsigned char)number,
                                                                  (unsigned char)(number >> 8)};
    const unsigned char then[RLVC_BITS_PERCEPT_BYTES(WIDE)] = {(unsigned char)next,
                                                               (unsigned char)(next >> 8)};
    assert_int_equal(rlvc_begin(agent, percept), RLVC_OK);
    assert_int_equal(rlvc_act(agent, &choice), RLVC_OK);
    assert_int_equal(rlvc_observe(agent, choice, reward, then, end), RLVC_OK);
}

static void play_both(uint32_t number, float reward, uint32_t next, uint8_t end) {
    play(one.agent, number, reward, next, end);
    play(forgetful.agent, number, reward, next, end);
}

/* Episodes in one of four places, so that the others have what they had. A place is worth its
 * number and some noise; the other bits tell nothing, and in the last place there is none. */
static void visit(rlvc_agent *agent, rlvc_rng rng, uint32_t place) {
    for (uint32_t i = 0; i < 20u; i++) {
        const uint32_t noise = place == 3u ? 0u : rlvc_rng_below(&rng, 1u << (BITS - 2u));
        const uint32_t number = place | noise << 2;
        play(agent, number, (float)(8u * place + rlvc_rng_below(&rng, 4)), 0, RLVC_TERMINATED);
    }
}

static void visit_both(rlvc_rng *rng, uint32_t place) {
    visit(one.agent, *rng, place);
    visit(forgetful.agent, *rng, place);
    rng->state += place + 1u;
}

static void forget(rlvc_agent *agent) {
    for (uint32_t c = 0; c < config.classes; c++)
        agent->space.in_vain.units[c] = 0;
}

/* A call of both. @return whether the step is done. */
static int learn_by(uint32_t budget) {
    rlvc_progress here, there;
    forget(forgetful.agent);
    asked = 0;
    assert_int_equal(rlvc_learn(one.agent, budget, &here), RLVC_OK);
    one.asked += asked;
    asked = 0;
    assert_int_equal(rlvc_learn(forgetful.agent, budget, &there), RLVC_OK);
    forgetful.asked += asked;
    assert_memory_equal(&here, &there, sizeof here);
    assert_int_equal(one.agent->learner.phase, forgetful.agent->learner.phase);
    assert_int_equal(one.agent->learner.at, forgetful.agent->learner.at);
    return here.done;
}

static void save(twin *t) {
    const rlvc_store store = medium_store(&t->medium, &config, &counting, 0);
    assert_int_equal(rlvc_save(t->agent, &store), RLVC_OK);
}

static void check_same(void) {
    save(&one);
    save(&forgetful);
    assert_memory_equal(one.medium.bytes, forgetful.medium.bytes, MEDIUM_BYTES);
}

/* Steps of both, by budgets up to RLVC_BUDGET_MIN + `most`. */
static void check_twins(uint32_t most, int skips) {
    rlvc_rng rng, budgets;
    make(&one);
    make(&forgetful);
    rlvc_rng_seed(&rng, 7);
    rlvc_rng_seed(&budgets, 8);
    for (uint32_t k = 0; k < STEPS; k++) {
        visit_both(&rng, k % 4u);
        while (!learn_by(most == 0 ? RLVC_BUDGET_UNBOUNDED
                                   : RLVC_BUDGET_MIN + rlvc_rng_below(&budgets, most))) {
        }
        check_same();
    }
    assert_true(skips ? one.asked < forgetful.asked : one.asked == forgetful.asked);
}

static void defaults(uint32_t actions, uint32_t of_bits, uint32_t at_once) {
    assert_int_equal(rlvc_bits_domain(of_bits, &bits), RLVC_OK);
    counting = bits;
    counting.detect = count_detect;
    assert_int_equal(rlvc_config_default(&config, &bits, actions), RLVC_OK);
    config.method = &rlvc_method_classes;
    config.capacity = CAPACITY;
    config.classes = RLVC_CLASSES_SMALL + 1u;
    config.min_samples = 4;
    config.features_at_once = at_once;
}

static void test_twins(void **state) {
    (void)state;
    defaults(2, BITS, 5);
    check_twins(0, 1);
    check_twins(20000, 1);
    check_twins(900, 1);
    check_twins(1, 0); /* no budget holds a search */
}

/* What is found then goes by the targets, too. */
static void test_smallest_effect(void **state) {
    (void)state;
    defaults(2, BITS, 5);
    config.smallest_effect = 0.01f;
    check_twins(0, 0);
}

/* A call with each budget up to what the search of a class takes and some more, and another. */
static void check_budgets(void) {
    uint32_t charge = one.agent->space.in_vain.units[one.agent->learner.at];
    block_copy(one.kept, one.block, bytes);
    block_copy(forgetful.kept, forgetful.block, bytes);
    for (uint32_t budget = RLVC_BUDGET_MIN; budget < charge + 16u * RLVC_BUDGET_MIN; budget++) {
        (void)learn_by(budget);
        (void)learn_by(charge + 16u * RLVC_BUDGET_MIN);
        block_copy(one.block, one.kept, bytes);
        block_copy(forgetful.block, forgetful.kept, bytes);
    }
}

/* Whatever is left of a budget where a search is skipped, the call ends where it would, and so does
 * the next, wherever that begins. */
static void check_every_budget(uint32_t of_bits, uint32_t at_once, uint32_t classes) {
    rlvc_rng rng;
    uint32_t checked = 0;
    defaults(2, of_bits, at_once);
    config.capacity = 180;
    make(&one);
    make(&forgetful);
    rlvc_rng_seed(&rng, 9);
    for (uint32_t k = 0; k < 9u; k++) {
        visit_both(&rng, k % 4u);
        while (k < 8u && !learn_by(RLVC_BUDGET_UNBOUNDED)) {
        }
    }
    while (!learn_by(RLVC_BUDGET_MIN)) {
        const rlvc_learner *learner = &one.agent->learner;
        if (learner->phase == RLVC_PHASE_SEARCH && !learner->searching &&
            learner->at < learner->classes && one.agent->space.in_vain.units[learner->at] > 0 &&
            checked < classes) {
            check_budgets();
            checked++;
        }
    }
    assert_int_equal(checked, classes);
    check_same();
}

static void test_every_budget(void **state) {
    (void)state;
    check_every_budget(BITS, 5, 2);
    check_every_budget(WIDE, 64, 2); /* a call may end between two blocks */
}

/* In the slots of the first `first` interactions come others, of the same rewards in the same
 * places, that bit 1 tells apart now. The rewards are all different. */
static void check_slots_given_up(uint32_t first, uint32_t last, uint8_t end) {
    rlvc_rng rng;
    defaults(1, BITS, 5);
    config.capacity = CAPACITY - 1u; /* the ring has CAPACITY slots */
    make(&one);
    make(&forgetful);
    const uint32_t around = end == RLVC_TERMINATED ? CAPACITY : CAPACITY / 2u;
    rlvc_rng_seed(&rng, 10);
    for (uint32_t i = 0; i < last; i++) {
        const uint32_t slot = i % around, place = slot % 2u, rank = slot * 181u % 601u;
        const uint32_t tells = i < around ? rlvc_rng_below(&rng, 2) : rank > 300u;
        const uint32_t noise = rlvc_rng_below(&rng, 1u << (BITS - 2u));
        const uint32_t number = place | tells << 1 | noise << 2;
        play_both(number, (float)(rank + 5000u * place), number, end);
        if (i + 1u == first) {
            assert_true(learn_by(RLVC_BUDGET_UNBOUNDED));
            assert_int_equal(one.agent->tree.classes, 2);
            assert_true(one.agent->space.in_vain.units[0] > 0);
            assert_true(one.agent->space.in_vain.units[1] > 0);
        }
    }
    assert_true(learn_by(RLVC_BUDGET_UNBOUNDED));
    assert_true(one.agent->tree.classes > 2);
    check_same();
}

/* A slot does not hold the same for ever: neither when the ring has gone round just once and begins
 * with its first slot again, nor when episodes that were cut short have filled it sooner. */
static void test_slots_given_up(void **state) {
    (void)state;
    check_slots_given_up(CAPACITY - 1u, 2u * CAPACITY, RLVC_TERMINATED);
    assert_int_equal(one.agent->replay.head, 0);
    check_slots_given_up(CAPACITY / 2u, CAPACITY - 1u, RLVC_TRUNCATED);
    assert_true(one.agent->interactions <= config.capacity);
}

/* From a class that was searched in vain an action leads to three places, worth 1, 2 and 3, until
 * in the second other rewards come.
 * @return whether the targets' order is another one then, or where they differ. */
static int order_changes(float reward) {
    rlvc_rng rng;
    defaults(1, BITS, 5);
    config.tolerance = 0.1f;
    make(&one);
    make(&forgetful);
    rlvc_rng_seed(&rng, 11);
    for (uint32_t i = 0; i < 30u; i++) {
        const uint32_t place = 1u + i % 3u;
        play_both(rlvc_rng_below(&rng, 1u << (BITS - 2u)) << 2, 0.0f, place, RLVC_TRUNCATED);
        play_both(place, (float)place, 0, RLVC_TERMINATED);
    }
    while (!learn_by(RLVC_BUDGET_UNBOUNDED)) {
    }
    const uint32_t class_id = one.agent->replay.label[0];
    assert_true(one.agent->space.in_vain.units[class_id] > 0);
    const uint64_t order = one.agent->space.in_vain.order[class_id];
    for (uint32_t i = 0; i < 200u; i++)
        play_both(2, reward, 0, RLVC_TERMINATED);
    while (!learn_by(RLVC_BUDGET_UNBOUNDED)) {
    }
    assert_int_equal(one.agent->replay.label[0], class_id);
    assert_true(one.agent->space.in_vain.units[class_id] > 0);
    return order != one.agent->space.in_vain.order[class_id];
}

static void test_order(void **state) {
    (void)state;
    assert_false(order_changes(2.0f));
    assert_false(order_changes(2.3f)); /* all are worth something else, but in the same order */
    assert_true(order_changes(0.96f)); /* the second is worth as much as the first, */
    assert_true(order_changes(0.2f));  /* or less */
}

/* By returns each step begins with the same slots. */
static void test_returns(void **state) {
    (void)state;
    rlvc_rng rng;
    defaults(1, BITS, 5);
    config.criterion = RLVC_CRITERION_RETURNS;
    config.successors = config.dependence = 0;
    config.continuing = 1;
    config.discount = config.epsilon = 0.0f;
    make(&one);
    make(&forgetful);
    rlvc_rng_seed(&rng, 12);
    for (uint32_t k = 0; k < 2u; k++) {
        for (uint32_t i = 0; i < 200u; i++) {
            const uint32_t place = (i & 1u) | (uint32_t)(i > 190u), rank = i * 81u % 211u;
            const uint32_t tells = k == 0 ? rlvc_rng_below(&rng, 2) : rank > 105u;
            play_both(place | tells << 1 | rlvc_rng_below(&rng, 1u << (BITS - 2u)) << 2,
                      (float)(rank + 5000u * place), 0, RLVC_TERMINATED);
        }
        assert_true(learn_by(RLVC_BUDGET_UNBOUNDED));
        assert_true(k == 0 ? one.agent->tree.classes == 2 : one.agent->tree.classes > 2);
    }
    check_same();
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_twins),        cmocka_unit_test(test_smallest_effect),
        cmocka_unit_test(test_every_budget), cmocka_unit_test(test_slots_given_up),
        cmocka_unit_test(test_order),        cmocka_unit_test(test_returns),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
