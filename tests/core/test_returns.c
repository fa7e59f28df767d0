/* SPDX-License-Identifier: MIT */
/* Truncated discounted returns against definition 1 taken literally, on plain lists. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "history.h"
#include "samples/returns.h"

static history list;
static rlvc_replay replay;

/* R_t^H of item t as a sum of doubles; 0 if it is undefined. */
static int naive(uint32_t t, const rlvc_return_input *returns, double *value) {
    double weight = 1.0;
    *value = 0.0;
    for (uint32_t i = 0; i <= returns->horizon; i++) {
        if (t + i >= list.count || !list.item[t + i].choice.exploited)
            return 0;
        if (i > 0 && !history_links(&list.item[t + i - 1u], returns->continuing))
            return 0;
        *value += weight * (double)list.item[t + i].reward;
        weight *= (double)returns->discount;
    }
    return 1;
}

/* The window at a position, with budgets of `slice`. */
static rlvc_return_cursor window_at(uint32_t position, const rlvc_return_input *returns,
                                    uint32_t slice, uint64_t *work) {
    rlvc_return_cursor window;
    rlvc_return_begin(&window, position);
    *work = 0;
    while (!window.done) {
        uint32_t used = rlvc_return_step(&window, returns, slice);
        assert_in_range(used, 1, slice);
        *work += used;
    }
    return window;
}

static void check(uint32_t t, uint32_t position, const rlvc_return_input *returns) {
    double expected = 0.0;
    uint64_t work, slice_work;
    rlvc_return_cursor whole = window_at(position, returns, UINT32_MAX, &work);
    int defined = naive(t, returns, &expected);
    if (whole.defined != defined || (defined && fabs((double)whole.value - expected) > 1e-4))
        fail_msg("item %u, horizon %u, discount %g, continuing %u: %u %.9g, not %d %.9g", t,
                 returns->horizon, (double)returns->discount, returns->continuing, whole.defined,
                 (double)whole.value, defined, expected);
    assert_true(work <= 2u * ((uint64_t)returns->horizon + 1u));
    for (uint32_t slice = 1; slice <= 3u; slice++) {
        rlvc_return_cursor sliced = window_at(position, returns, slice, &slice_work);
        assert_memory_equal(&sliced.value, &whole.value, sizeof whole.value);
        assert_int_equal(sliced.defined, whole.defined);
        assert_int_equal(slice_work, work);
    }
}

/* Every window of the list; a slot without an interaction has no window. */
static void check_all(const rlvc_return_input *returns) {
    uint32_t position = 0;
    uint64_t work;
    for (uint32_t t = 0; t < list.count; t++) {
        check(t, position, returns);
        position += history_room(&list.item[t]);
        if (history_room(&list.item[t]) == 2u)
            assert_false(window_at(position - 1u, returns, 1, &work).defined);
    }
    assert_false(window_at(returns->end, returns, 1, &work).defined);
}

static void test_against_the_definition(void **state) {
    (void)state;
    const float discounts[] = {0.0f, 0.5f, 0.9f, 1.0f};
    for (uint32_t seed = 0; seed < 8u; seed++) {
        rlvc_rng rng;
        rlvc_rng_seed(&rng, seed);
        history_init(&list, &replay, 60u + seed);
        for (uint32_t i = 0; i < 40u + 20u * seed; i++)
            history_do_random(&list, &replay, &rng, seed % 2u == 0 ? 7u : 8u);
        for (uint32_t horizon = 0; horizon < 12u; horizon++)
            for (int i = 0; i < 8; i++) {
                rlvc_return_input returns = {&replay, rlvc_replay_freeze(&replay), horizon,
                                             discounts[i / 2], (uint8_t)(i % 2)};
                check_all(&returns);
            }
    }
}

/* One episode of `length` exploited interactions, each rewarded by 1, that ends as told. */
static uint32_t episode(uint32_t length, uint8_t end) {
    const rlvc_choice greedy = {0, 1};
    history_init(&list, &replay, 300);
    history_do_begin(&list, &replay);
    for (uint32_t i = 0; i < length; i++)
        history_do_append(&list, &replay, greedy, 1.0f, i + 1u == length ? end : RLVC_GOES_ON);
    return rlvc_replay_freeze(&replay);
}

/* The window that just fits into the database, and the one that is one longer. */
static void test_edges(void **state) {
    (void)state;
    const uint8_t ends[] = {RLVC_GOES_ON, RLVC_TERMINATED, RLVC_TRUNCATED};
    for (int i = 0; i < 6; i++)
        for (uint32_t horizon = 0; horizon < 255u; horizon += 127u) {
            uint64_t work;
            rlvc_return_input returns = {&replay, 0, horizon, 1.0f, (uint8_t)(i / 3)};
            returns.end = episode(horizon + 1u, ends[i % 3]);
            rlvc_return_cursor window = window_at(0, &returns, 7, &work);
            assert_true(window.defined);
            assert_float_equal(window.value, (float)(horizon + 1u), 0.0f);
            assert_int_equal(work, 2u * (horizon + 1u));
            assert_false(window_at(1, &returns, 7, &work).defined);
            returns.horizon = UINT32_MAX;
            assert_false(window_at(0, &returns, 7, &work).defined);
        }
}

/* The same rewards give the same bits, wherever in the ring they stand. */
static void test_place_does_not_matter(void **state) {
    (void)state;
    const float rewards[] = {0.1f, -3.3f, 100.0f, 1e-3f};
    const rlvc_choice greedy = {0, 1};
    float first = 0.0f;
    history_init(&list, &replay, 6);
    for (int round = 0; round < 20; round++) {
        history_do_begin(&list, &replay);
        for (int i = 0; i < 4; i++)
            history_do_append(&list, &replay, greedy, rewards[i],
                              i == 3 ? RLVC_TERMINATED : RLVC_GOES_ON);
        uint32_t end = rlvc_replay_freeze(&replay);
        rlvc_return_input returns = {&replay, end, 3, 0.9f, 0};
        uint64_t work;
        rlvc_return_cursor window = window_at(end - 4u, &returns, 1, &work);
        replay.frozen = 0;
        assert_true(window.defined);
        first = round == 0 ? window.value : first;
        assert_memory_equal(&window.value, &first, sizeof first);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_against_the_definition),
        cmocka_unit_test(test_edges),
        cmocka_unit_test(test_place_does_not_matter),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
