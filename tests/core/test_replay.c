/* SPDX-License-Identifier: MIT */
/* The ring of interactions against a plain list (history.h), and its invariant checker. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "history.h"

static history list;
static rlvc_replay replay;

enum { BEGIN, GO_ON, TERMINATE, TRUNCATE, FREEZE, THAW, CLEAR, OPERATIONS };

/* The frozen interactions are those stored now, and their last s' if it is the current percept. */
static void freeze(void) {
    uint32_t end = rlvc_replay_freeze(&replay), slots = 0;
    for (uint32_t i = 0; i < list.count; i++)
        slots += history_room(&list.item[i]);
    assert_int_equal(end, slots);
    int awaited = list.count > 0 && list.item[list.count - 1u].end == RLVC_GOES_ON &&
                  !list.item[list.count - 1u].torn;
    assert_int_equal(replay.frozen, slots + (awaited ? 1u : 0u));
    list.frozen = list.count > 0;
}

static void operate(uint32_t operation, uint32_t number) {
    rlvc_choice choice = {(uint8_t)(number % HISTORY_ACTIONS), (uint8_t)(number % 2u)};
    switch (operation) {
    case BEGIN:
        history_do_begin(&list, &replay);
        break;
    case FREEZE:
        freeze();
        break;
    case THAW:
        replay.frozen = 0;
        list.frozen = 0;
        break;
    case CLEAR:
        rlvc_replay_clear(&replay);
        history_clear(&list);
        break;
    default:
        if (list.current != 0)
            history_do_append(&list, &replay, choice, (float)number, (uint8_t)(operation - GO_ON));
        break;
    }
    history_compare(&list, &replay);
}

/* Every sequence of six operations on every small ring. */
static void test_every_short_history(void **state) {
    (void)state;
    enum { LENGTH = 6, SEQUENCES = 117649 /* 7^6 */ };
    const uint32_t capacities[] = {1, 2, 3, 5};
    for (size_t i = 0; i < sizeof capacities / sizeof capacities[0]; i++)
        for (uint32_t sequence = 0; sequence < SEQUENCES; sequence++) {
            uint32_t rest = sequence;
            history_init(&list, &replay, capacities[i]);
            for (uint32_t j = 0; j < LENGTH; j++, rest /= OPERATIONS)
                operate(rest % OPERATIONS, j);
        }
}

/* Long ones, that go round the ring many times. */
static void test_long_histories(void **state) {
    (void)state;
    for (uint32_t capacity = 1; capacity < 40u; capacity++) {
        rlvc_rng rng;
        rlvc_rng_seed(&rng, capacity);
        history_init(&list, &replay, capacity);
        for (uint32_t i = 0; i < 2000u; i++) {
            if (rlvc_rng_below(&rng, 20u) == 0)
                operate(BEGIN + rlvc_rng_below(&rng, OPERATIONS), i);
            history_do_random(&list, &replay, &rng, 4u);
            history_compare(&list, &replay);
        }
    }
}

/* A ring with a terminated, a truncated and an open episode in it. */
static void fill(void) {
    history_init(&list, &replay, 8);
    const uint32_t operations[] = {BEGIN, GO_ON, TERMINATE, BEGIN, TRUNCATE, BEGIN, GO_ON};
    for (size_t i = 0; i < sizeof operations / sizeof operations[0]; i++)
        operate(operations[i], (uint32_t)i);
    replay.action[5] = 0; /* of the current percept: not set yet, or it would be found for that */
    replay.reward[5] = 0.0f;
}

/* What to write where, to break one invariant. */
typedef struct damage {
    void *place;
    size_t bytes;
    uint32_t value; /* its low bytes */
} damage;

static void test_check_finds_damage(void **state) {
    (void)state;
    fill();
    const damage damages[] = {
        {&replay.head, 4, replay.slots},
        {&replay.count, 4, replay.slots + 1u},
        {&replay.count, 4, 0},
        {&replay.count, 4, replay.count - 1u}, /* without the current percept */
        {&replay.open, 1, 2},
        {&replay.frozen, 4, replay.count + 1u},
        {&replay.stored, 4, replay.stored + 1u},
        {&replay.label[1], 2, 1},
        {&replay.action[0], 1, HISTORY_ACTIONS},
        {&replay.reward[0], 4, 0x539184e8}, /* 1.25e12 */
        {&replay.reward[0], 4, 0xd39184e8},
        {&replay.reward[0], 4, 0x7fc00000},      /* not a number */
        {&replay.flags[0], 1, 0},                /* the oldest has no interaction */
        {&replay.flags[2], 1, 0},                /* two in a row have none */
        {&replay.flags[5], 1, RLVC_SLOT_STORED}, /* the current percept */
        {&replay.flags[5], 1, RLVC_SLOT_STORED | RLVC_SLOT_TERMINATED}, /* has one */
    };
    for (size_t i = 0; i < sizeof damages / sizeof damages[0]; i++) {
        fill();
        memcpy(damages[i].place, &damages[i].value, damages[i].bytes);
        if (rlvc_replay_check(&replay, HISTORY_ACTIONS, 1))
            fail_msg("damage %u not found", (unsigned)i);
    }
}

/* The last interaction of a ring without a current percept has lost its s'. */
static void test_check_finds_a_missing_percept(void **state) {
    (void)state;
    fill();
    operate(TERMINATE, 7);
    replay.flags[5] = RLVC_SLOT_STORED;
    assert_false(rlvc_replay_check(&replay, HISTORY_ACTIONS, 1));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_every_short_history),
        cmocka_unit_test(test_long_histories),
        cmocka_unit_test(test_check_finds_damage),
        cmocka_unit_test(test_check_finds_a_missing_percept),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
