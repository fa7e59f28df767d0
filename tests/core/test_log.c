/* SPDX-License-Identifier: MIT */
/* The log of interactions: what is written is read, and what is damaged is passed over. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "base/bytes.h"
#include "base/crc.h"
#include "rlvc/log.h"
#include "base/rng.h"

#include <string.h>

#define PERCEPT 3u
#define RECORDS 60u
#define ACTIONS 4u

/* ------------------------------------------------------------------ a log in memory */

typedef struct tape {
    unsigned char bytes[4096];
    uint32_t length;
    uint32_t at;    /* of the reader */
    uint32_t piece; /* bytes that a read gives at most; 0: all */
    uint32_t calls; /* of either callback; */
    uint32_t fail_at;
    uint32_t surplus; /* what a read claims to have read beyond what it may */
} tape;

static int tape_write(void *ctx, const void *bytes, uint32_t count) {
    tape *t = (tape *)ctx;
    if (++t->calls == t->fail_at)
        return 1;
    assert_true(t->length + count <= sizeof t->bytes);
    memcpy(t->bytes + t->length, bytes, count);
    t->length += count;
    return 0;
}

static int tape_read(void *ctx, void *bytes, uint32_t room, uint32_t *got) {
    tape *t = (tape *)ctx;
    uint32_t n = t->length - t->at;
    if (++t->calls == t->fail_at)
        return 1;
    assert_true(room > 0);
    n = n < room ? n : room;
    n = t->piece > 0 && t->piece < n ? t->piece : n;
    memcpy(bytes, t->bytes + t->at, n);
    t->at += n;
    *got = n + t->surplus;
    return 0;
}

/* ------------------------------------------------------------------ what was written */

typedef struct item {
    uint8_t kind;
    uint8_t end;
    rlvc_choice choice;
    float reward;
    unsigned char percept[PERCEPT];
    uint32_t from, to; /* bytes of the tape */
} item;

static item written[RECORDS];
static tape t;

static void write_item(rlvc_log_writer *writer, item *it, rlvc_rng *rng, int open) {
    for (uint32_t i = 0; i < PERCEPT; i++) /* also what looks like the beginning of a record */
        it->percept[i] = rlvc_rng_below(rng, 3) ? (unsigned char)rlvc_rng_next(rng) : 0xa5u;
    it->from = t.length;
    if (!open) {
        it->kind = RLVC_LOG_BEGIN;
        assert_int_equal(rlvc_log_begin(writer, it->percept), RLVC_OK);
    } else {
        it->kind = RLVC_LOG_OBSERVE;
        it->end = (uint8_t)(rlvc_rng_below(rng, 6) < 4 ? 0 : rlvc_rng_below(rng, 3));
        it->choice.action = (uint8_t)rlvc_rng_below(rng, ACTIONS);
        it->choice.exploited = (uint8_t)rlvc_rng_below(rng, 2);
        it->reward = rlvc_rng_uniform(rng) - 0.5f;
        assert_int_equal(rlvc_log_observe(writer, it->choice, it->reward,
                                          it->end == RLVC_TERMINATED ? NULL : it->percept, it->end),
                         RLVC_OK);
    }
    it->to = t.length;
}

static void write_log(void) {
    rlvc_log_writer writer;
    rlvc_rng rng;
    int open = 0;
    memset(&t, 0, sizeof t);
    memset(written, 0, sizeof written);
    rlvc_rng_seed(&rng, 5);
    assert_int_equal(rlvc_log_open(&writer, PERCEPT, ACTIONS, tape_write, &t), RLVC_OK);
    for (uint32_t i = 0; i < RECORDS; i++) {
        write_item(&writer, &written[i], &rng, open);
        open = written[i].kind == RLVC_LOG_BEGIN || written[i].end == RLVC_GOES_ON;
    }
}

static unsigned char buffer[RLVC_LOG_RECORD_BYTES(PERCEPT)];
static rlvc_log_reader reader;

static void read_from_start(uint32_t percept_bytes) {
    t.at = 0;
    t.calls = 0;
    assert_int_equal(rlvc_log_read(&reader, percept_bytes, percept_bytes ? ACTIONS : 0, buffer,
                                   sizeof buffer, tape_read, &t),
                     RLVC_OK);
}

static rlvc_log_record next(void) {
    rlvc_log_record record;
    assert_int_equal(rlvc_log_next(&reader, &record), RLVC_OK);
    return record;
}

static void expect_item(const item *it) {
    rlvc_log_record record = next();
    assert_int_equal(record.kind, it->kind);
    assert_int_equal(record.end, it->end);
    assert_int_equal(record.choice.action, it->choice.action);
    assert_int_equal(record.choice.exploited, it->choice.exploited);
    assert_memory_equal(&record.reward, &it->reward, sizeof record.reward);
    if (it->end == RLVC_TERMINATED)
        assert_null(record.percept);
    else
        assert_memory_equal(record.percept, it->percept, PERCEPT);
}

/* ------------------------------------------------------------------ whole logs */

static void test_round_trip(void **state) {
    (void)state;
    write_log();
    for (t.piece = 0; t.piece < 20; t.piece++) {
        for (uint32_t known = 0; known < 2; known++) {
            read_from_start(known ? PERCEPT : 0);
            assert_int_equal(next().kind, RLVC_LOG_HEADER);
            assert_int_equal(reader.percept_bytes, PERCEPT);
            assert_int_equal(reader.actions, ACTIONS);
            for (uint32_t i = 0; i < RECORDS; i++)
                expect_item(&written[i]);
            assert_int_equal(next().kind, RLVC_LOG_END);
            assert_int_equal(next().kind, RLVC_LOG_END);
            assert_int_equal(reader.skipped, 0);
            assert_int_equal(reader.damaged, 0);
            assert_int_equal(reader.lost, 0);
            assert_int_equal(reader.torn, 0);
        }
    }
}

static void test_golden(void **state) {
    (void)state;
    static const unsigned char golden[] = {
        0xa5, 0x01, 0x00, 0x00, 0x01, 0x00, 0x04, 0x00, 0x03, 0x00, 0x00, 0x00, /* header */
        0x00, 0x00, 0x00, 0x00,                                                 /* its CRC */
        0xa5, 0x02, 0x01, 0x00, 0x07, 0x08, 0x09, 0x00, 0x00, 0x00, 0x00, 0xa5, 0x07, 0x02,
        0x00, 0x03, 0x00, 0x00, 0x80, 0xbf, 0x01, 0x02, 0x03, 0x00, 0x00, 0x00, 0x00, 0xa5,
        0x0b, 0x03, 0x00, 0x02, 0x00, 0x00, 0xc8, 0x42, 0x00, 0x00, 0x00, 0x00,
    };
    static const uint32_t crc_at[] = {12, 23, 39, 52}, begins[] = {0, 16, 27, 43};
    const unsigned char first[] = {7, 8, 9}, second[] = {1, 2, 3};
    const rlvc_choice exploited = {3, 1}, explored = {2, 0};
    rlvc_log_writer writer;
    unsigned char expected[sizeof golden];
    memset(&t, 0, sizeof t);
    assert_int_equal(rlvc_log_open(&writer, PERCEPT, ACTIONS, tape_write, &t), RLVC_OK);
    assert_int_equal(rlvc_log_begin(&writer, first), RLVC_OK);
    assert_int_equal(rlvc_log_observe(&writer, exploited, -1.0f, second, RLVC_GOES_ON), RLVC_OK);
    assert_int_equal(rlvc_log_observe(&writer, explored, 100.0f, NULL, RLVC_TERMINATED), RLVC_OK);
    memcpy(expected, golden, sizeof golden);
    for (int i = 0; i < 4; i++)
        rlvc_put(expected + crc_at[i], rlvc_crc(0, golden + begins[i], crc_at[i] - begins[i]), 4);
    assert_int_equal(t.length, sizeof golden);
    assert_memory_equal(t.bytes, expected, sizeof golden);
}

/* ------------------------------------------------------------------ damage */

/* May a record that was read be this one that was written? s' of an interaction may have become the
 * beginning of an episode. */
static int may_be(const rlvc_log_record *record, const item *it) {
    if (record->kind == RLVC_LOG_BEGIN)
        return it->end != RLVC_TERMINATED && record->percept &&
               memcmp(record->percept, it->percept, PERCEPT) == 0;
    return it->kind == RLVC_LOG_OBSERVE && record->end == it->end &&
           memcmp(&record->reward, &it->reward, sizeof it->reward) == 0;
}

/* Reads all there is and fails unless it is a part of what was written, in order, and could be
 * played. Returns how many records came as they were written. */
static uint32_t read_what_is_left(void) {
    uint32_t i = 0, whole = 0;
    int open = 0;
    read_from_start(PERCEPT);
    for (;;) {
        rlvc_log_record record = next();
        if (record.kind == RLVC_LOG_END)
            return whole;
        if (record.kind == RLVC_LOG_HEADER)
            continue;
        assert_true(record.kind == RLVC_LOG_BEGIN || open);
        while (i < RECORDS && !may_be(&record, &written[i]))
            i++;
        assert_true(i < RECORDS);
        whole += record.kind == written[i].kind;
        open = record.kind == RLVC_LOG_BEGIN || record.end == RLVC_GOES_ON;
        i++;
    }
}

/* Cut anywhere, a log loses the record that was cut. */
static void test_torn_tails(void **state) {
    (void)state;
    write_log();
    const uint32_t length = t.length;
    for (t.length = 16; t.length < length; t.length++) {
        uint32_t whole = 0, edge = t.length == 16;
        for (uint32_t i = 0; i < RECORDS; i++) {
            whole += written[i].to <= t.length;
            edge |= written[i].to == t.length;
        }
        assert_int_equal(read_what_is_left(), whole);
        assert_int_equal(reader.torn, !edge);
        assert_int_equal(reader.damaged, !edge);
        assert_int_equal(reader.lost, 0);
    }
}

/* A changed bit costs its record, and the link of the next. */
static void test_bit_flips(void **state) {
    (void)state;
    write_log();
    for (uint32_t bit = 0; bit < 8u * t.length; bit++) {
        t.bytes[bit / 8u] ^= (unsigned char)(1u << bit % 8u);
        uint32_t whole = read_what_is_left();
        assert_true(whole >= RECORDS - 2u);
        assert_true(whole < RECORDS || bit < 8u * 16u);
        assert_int_equal(reader.damaged, 1);
        assert_true(reader.lost >= 1 || reader.torn || bit < 8u * 16u);
        t.bytes[bit / 8u] ^= (unsigned char)(1u << bit % 8u);
    }
}

/* A record that is gone without a trace is missed all the same; rubbish between records is not. */
static void test_gaps_and_rubbish(void **state) {
    (void)state;
    write_log();
    static tape whole;
    whole = t;
    for (uint32_t i = 0; i + 1u < RECORDS; i++) {
        const item *it = &written[i];
        memmove(t.bytes + it->from, t.bytes + it->to, t.length - it->to);
        t.length -= it->to - it->from;
        assert_true(read_what_is_left() >= RECORDS - 2u);
        assert_int_equal(reader.damaged, 0);
        assert_true(reader.lost >= 1 && reader.lost <= 2);
        t = whole;
        memmove(t.bytes + it->from + 20, t.bytes + it->from, t.length - it->from);
        memset(t.bytes + it->from, i % 2 ? 0xa5 : 0x03, 20);
        t.length += 20;
        assert_int_equal(read_what_is_left(), RECORDS);
        assert_int_equal(reader.damaged, 1);
        assert_int_equal(reader.skipped, 20);
        assert_int_equal(reader.lost, 0);
        t = whole;
    }
}

/* A writer that is opened anew after a cut: what came before and what comes after are both used. */
static void test_appending(void **state) {
    (void)state;
    const unsigned char percept[PERCEPT] = {1, 2, 3};
    rlvc_log_writer writer;
    write_log();
    t.length -= 3;
    assert_int_equal(rlvc_log_open(&writer, PERCEPT, ACTIONS, tape_write, &t), RLVC_OK);
    assert_int_equal(rlvc_log_begin(&writer, percept), RLVC_OK);
    read_from_start(PERCEPT);
    assert_int_equal(next().kind, RLVC_LOG_HEADER);
    for (uint32_t i = 0; i + 1u < RECORDS; i++)
        expect_item(&written[i]);
    assert_int_equal(next().kind, RLVC_LOG_HEADER);
    assert_memory_equal(next().percept, percept, PERCEPT);
    assert_int_equal(next().kind, RLVC_LOG_END);
    assert_int_equal(reader.damaged, 1);
    assert_int_equal(reader.torn, 0);
    /* A log that begins in its middle is unreadable up to a header, if the percepts are unknown. */
    read_from_start(0);
    t.at = 16;
    assert_int_equal(next().kind, RLVC_LOG_HEADER);
    assert_int_equal(next().kind, RLVC_LOG_BEGIN);
}

/* ------------------------------------------------------------------ refusals */

/* Makes the header of a log again with one field changed. */
static void forge(uint32_t at, uint32_t number, uint32_t bytes) {
    write_log();
    rlvc_put(t.bytes + at, number, bytes);
    rlvc_put(t.bytes + 12, rlvc_crc(0, t.bytes, 12), 4);
}

static void test_headers(void **state) {
    (void)state;
    rlvc_log_record record;
    const struct {
        uint32_t at, number, bytes;
        rlvc_status known, unknown;
    } forged[] = {
        {4, 2, 2, RLVC_E_VERSION, RLVC_E_VERSION},
        {6, 5, 2, RLVC_E_MISMATCH, RLVC_OK},
        {8, 2, 4, RLVC_E_MISMATCH, RLVC_OK},
        {6, 0, 2, RLVC_E_MISMATCH, RLVC_E_MISMATCH},
        {6, 256, 2, RLVC_E_MISMATCH, RLVC_E_MISMATCH},
        {8, 0, 4, RLVC_E_MISMATCH, RLVC_E_MISMATCH},
        {8, (1u << 20) + 1u, 4, RLVC_E_MISMATCH, RLVC_E_MISMATCH},
        {8, 4, 4, RLVC_E_MISMATCH, RLVC_E_MEMORY},
    };
    for (size_t i = 0; i < sizeof forged / sizeof forged[0]; i++) {
        forge(forged[i].at, forged[i].number, forged[i].bytes);
        read_from_start(PERCEPT);
        assert_int_equal(rlvc_log_next(&reader, &record), forged[i].known);
        assert_int_equal(rlvc_log_next(&reader, &record), RLVC_OK);
        read_from_start(0);
        assert_int_equal(rlvc_log_next(&reader, &record), forged[i].unknown);
    }
}

/* Interactions that cannot be, under a CRC that is right. */
static void test_forged_interactions(void **state) {
    (void)state;
    write_log();
    assert_int_equal(written[1].kind, RLVC_LOG_OBSERVE);
    unsigned char *at = t.bytes + written[1].from;
    const uint32_t crc_at = written[1].to - written[1].from - 4u;
    const struct {
        uint32_t at, number, bytes;
    } forged[] = {{4, ACTIONS, 1}, {5, 0x7fc00000u, 4}, {5, 0x7f800000u, 4}, {5, 0xff800000u, 4}};
    for (size_t i = 0; i < sizeof forged / sizeof forged[0]; i++) {
        uint64_t before = rlvc_get(at + forged[i].at, forged[i].bytes);
        rlvc_put(at + forged[i].at, forged[i].number, forged[i].bytes);
        rlvc_put(at + crc_at, rlvc_crc(0, at, crc_at), 4);
        assert_true(read_what_is_left() >= RECORDS - 2u);
        assert_true(reader.lost >= 1);
        rlvc_put(at + forged[i].at, before, forged[i].bytes);
    }
    rlvc_put(at + 1, 3u | 3u << 3, 1); /* an end of another kind */
    rlvc_put(at + crc_at, rlvc_crc(0, at, crc_at), 4);
    assert_true(read_what_is_left() >= RECORDS - 2u);
    assert_int_equal(reader.damaged, 1);
}

static void test_failing_callbacks(void **state) {
    (void)state;
    const unsigned char percept[PERCEPT] = {1, 2, 3};
    const rlvc_choice choice = {0, 0};
    rlvc_log_writer writer;
    rlvc_log_record record;
    for (uint32_t n = 1; n <= 8; n++) {
        memset(&t, 0, sizeof t);
        t.fail_at = n;
        rlvc_status opened = rlvc_log_open(&writer, PERCEPT, ACTIONS, tape_write, &t);
        rlvc_status begun = rlvc_log_begin(&writer, percept);
        rlvc_status observed = rlvc_log_observe(&writer, choice, 1.0f, percept, RLVC_GOES_ON);
        assert_int_equal(opened, n <= 2 ? RLVC_E_CALLBACK : RLVC_OK);
        assert_true((opened != RLVC_OK) + (begun != RLVC_OK) + (observed != RLVC_OK) == 1);
        t.fail_at = 0;
        assert_int_equal(rlvc_log_begin(&writer, percept), RLVC_OK);
        read_from_start(PERCEPT);
        do
            assert_int_equal(rlvc_log_next(&reader, &record), RLVC_OK);
        while (record.kind != RLVC_LOG_END);
        assert_int_equal(reader.torn, 0);
    }
    write_log();
    t.piece = 5;
    t.fail_at = 7;
    read_from_start(PERCEPT);
    uint32_t failed = 0, records = 0;
    do {
        rlvc_status status = rlvc_log_next(&reader, &record);
        failed += status == RLVC_E_STORE;
        records += status == RLVC_OK && record.kind != RLVC_LOG_END;
        if (status == RLVC_OK && record.kind == RLVC_LOG_END)
            break;
    } while (failed < 3);
    assert_int_equal(failed, 1);
    assert_int_equal(records, RECORDS + 1u);
    t.surplus = 100;
    read_from_start(PERCEPT);
    assert_int_equal(rlvc_log_next(&reader, &record), RLVC_E_STORE);
}

static void test_arguments(void **state) {
    (void)state;
    const unsigned char percept[PERCEPT] = {1, 2, 3};
    const rlvc_choice good = {0, 1}, action = {ACTIONS, 0}, exploited = {0, 2};
    const float infinite = 1e38f * 1e38f;
    rlvc_log_writer w;
    rlvc_log_record record;
    memset(&t, 0, sizeof t);
    assert_int_equal(rlvc_log_open(NULL, 1, 1, tape_write, &t), RLVC_E_NULL);
    assert_int_equal(rlvc_log_open(&w, 1, 1, NULL, &t), RLVC_E_NULL);
    assert_int_equal(rlvc_log_open(&w, 0, 1, tape_write, &t), RLVC_E_RANGE);
    assert_int_equal(rlvc_log_open(&w, 1, 256, tape_write, &t), RLVC_E_RANGE);
    assert_int_equal(rlvc_log_open(&w, PERCEPT, ACTIONS, tape_write, &t), RLVC_OK);
    assert_int_equal(rlvc_log_begin(NULL, percept), RLVC_E_NULL);
    assert_int_equal(rlvc_log_begin(&w, NULL), RLVC_E_NULL);
    assert_int_equal(rlvc_log_observe(NULL, good, 0.0f, percept, 0), RLVC_E_NULL);
    assert_int_equal(rlvc_log_observe(&w, good, 0.0f, NULL, 0), RLVC_E_NULL);
    assert_int_equal(rlvc_log_observe(&w, good, 0.0f, percept, 3), RLVC_E_RANGE);
    assert_int_equal(rlvc_log_observe(&w, action, 0.0f, percept, 0), RLVC_E_RANGE);
    assert_int_equal(rlvc_log_observe(&w, exploited, 0.0f, percept, 0), RLVC_E_RANGE);
    assert_int_equal(rlvc_log_observe(&w, good, infinite, percept, 0), RLVC_E_REWARD);
    assert_int_equal(rlvc_log_observe(&w, good, -infinite, percept, 0), RLVC_E_REWARD);
    assert_int_equal(rlvc_log_read(NULL, 3, 4, buffer, 16, tape_read, &t), RLVC_E_NULL);
    assert_int_equal(rlvc_log_read(&reader, 3, 4, NULL, 16, tape_read, &t), RLVC_E_NULL);
    assert_int_equal(rlvc_log_read(&reader, 3, 4, buffer, 16, NULL, &t), RLVC_E_NULL);
    assert_int_equal(rlvc_log_read(&reader, 3, 0, buffer, 16, tape_read, &t), RLVC_E_RANGE);
    assert_int_equal(rlvc_log_read(&reader, 0, 4, buffer, 16, tape_read, &t), RLVC_E_RANGE);
    assert_int_equal(rlvc_log_read(&reader, 1, 4, buffer, 15, tape_read, &t), RLVC_E_MEMORY);
    assert_int_equal(rlvc_log_read(&reader, 4, 4, buffer, 16, tape_read, &t), RLVC_E_MEMORY);
    assert_int_equal(rlvc_log_next(NULL, &record), RLVC_E_NULL);
    assert_int_equal(rlvc_log_next(&reader, NULL), RLVC_E_NULL);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_round_trip),        cmocka_unit_test(test_golden),
        cmocka_unit_test(test_torn_tails),        cmocka_unit_test(test_bit_flips),
        cmocka_unit_test(test_gaps_and_rubbish),  cmocka_unit_test(test_appending),
        cmocka_unit_test(test_headers),           cmocka_unit_test(test_forged_interactions),
        cmocka_unit_test(test_failing_callbacks), cmocka_unit_test(test_arguments),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
