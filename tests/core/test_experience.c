/* SPDX-License-Identifier: MIT */
/* The ring of rows against a plain list. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "base/rng.h"
#include "dynamics/experience.h"
#include <string.h>

#define ROWS 16u
#define LIST 400u

typedef struct row {
    float percept[2];
    float reward;
    uint8_t action;
    uint8_t end;
} row;

static uint64_t block[256];
static rlvc_experience ring;
static row list[LIST];
static uint32_t listed;

static void make_ring(void) {
    rlvc_arena arena = {NULL, 0};
    rlvc_experience_carve(&ring, &arena, 2, ROWS);
    assert_true(arena.used <= sizeof block);
    arena.base = (unsigned char *)block;
    arena.used = 0;
    rlvc_experience_carve(&ring, &arena, 2, ROWS);
    listed = 0;
}

static void append_to_list(float x) {
    row *made = list + listed++;
    memset(made, 0, sizeof *made);
    made->percept[0] = x;
    made->percept[1] = -2.0f * x;
    made->end = RLVC_ROW_LAST;
}

static void begin(float x) {
    append_to_list(x);
    rlvc_experience_begin(&ring, list[listed - 1u].percept);
}

static void append(uint8_t action, float x, uint8_t end) {
    row *last = list + listed - 1u;
    last->action = action;
    last->reward = x + 1.0f;
    last->end = end;
    append_to_list(x);
    rlvc_experience_append(&ring, action, x + 1.0f, list[listed - 1u].percept, end);
}

static void compare(void) {
    uint32_t count = listed < ROWS ? listed : ROWS;
    float low = list[0].percept[0], high = low;
    assert_int_equal(ring.count, count);
    for (uint32_t i = 0; i < listed; i++) {
        low = list[i].percept[0] < low ? list[i].percept[0] : low;
        high = list[i].percept[0] > high ? list[i].percept[0] : high;
    }
    assert_true(ring.low[0] == low && ring.high[0] == high);
    assert_true(ring.low[1] == -2.0f * high && ring.high[1] == -2.0f * low);
    for (uint32_t i = 0; i < count; i++) {
        const row *expected = list + (listed - count + i);
        uint32_t at = rlvc_experience_row(&ring, i);
        assert_memory_equal(rlvc_experience_percept(&ring, at), expected->percept, 8);
        assert_int_equal(ring.end[at], expected->end);
        if (expected->end == RLVC_ROW_LAST)
            continue;
        assert_int_equal(ring.action[at], expected->action);
        assert_true(ring.reward[at] == expected->reward);
        assert_int_equal(rlvc_experience_next(&ring, at), rlvc_experience_row(&ring, i + 1u));
    }
}

static void test_a_ring_keeps_the_newest_rows(void **state) {
    (void)state;
    rlvc_rng rng;
    rlvc_rng_seed(&rng, 7);
    make_ring();
    begin(0.5f);
    compare();
    uint32_t total = 0;
    while (listed < LIST - 1u) {
        uint8_t end = (uint8_t)(rlvc_rng_below(&rng, 6) == 0 ? 1u + rlvc_rng_below(&rng, 2) : 0u);
        append((uint8_t)rlvc_rng_below(&rng, 3), rlvc_rng_uniform(&rng) - 0.5f, end);
        compare();
        total++;
        if (listed < LIST - 1u && (end != RLVC_GOES_ON || rlvc_rng_below(&rng, 20) == 0)) {
            begin(rlvc_rng_uniform(&rng));
            compare();
        }
    }
    assert_int_equal(ring.total, total);
    ring.total = UINT32_MAX; /* and counts no further */
    append(0, 0.0f, RLVC_GOES_ON);
    assert_int_equal(ring.total, UINT32_MAX);
}

/* Of a full ring an eighth may leave; of one with room for that none need. */
static void test_frozen_rows_stay(void **state) {
    (void)state;
    for (uint32_t rows = 2; rows <= ROWS + 3u; rows++) {
        make_ring();
        begin(0.0f);
        while (listed < rows)
            append(1, (float)listed, RLVC_GOES_ON);
        uint32_t first, count = ring.count, kept = rlvc_experience_freeze(&ring, &first);
        uint32_t room = ROWS - count, leave = room < 2u ? 2u - room : 0u;
        assert_int_equal(kept, count - leave - 1u);
        assert_int_equal(first, rlvc_experience_row(&ring, leave));
        float oldest = rlvc_experience_percept(&ring, first)[0];
        for (uint32_t i = 0; i < room + leave; i++) {
            assert_true(rlvc_experience_has_room(&ring));
            append(1, 100.0f, RLVC_GOES_ON);
        }
        assert_false(rlvc_experience_has_room(&ring));
        assert_true(rlvc_experience_percept(&ring, first)[0] == oldest);
        ring.frozen = 0;
        assert_true(rlvc_experience_has_room(&ring));
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_a_ring_keeps_the_newest_rows),
        cmocka_unit_test(test_frozen_rows_stay),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
