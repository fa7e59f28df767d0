/* SPDX-License-Identifier: MIT */
/* What it costs to read a log: as much for a byte of a hostile one, but for a constant. What is
 * counted are the bytes that pass the CRC, which stands in here for the library's own.
 * RLVC_LOG_BYTES=67108864 makes the logs so long. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#define rlvc_crc plain_crc
#define rlvc_crc_shift plain_shift
#include "base/crc.c"
#undef rlvc_crc
#undef rlvc_crc_shift

#include "base/bytes.h"
#include "base/rng.h"
#include "rlvc/log.h"

#include <string.h>

#define PERCEPT 4000u
#define BYTES 400000u  /* of a log */
#define SHIFT_COSTS 5u /* as much as so many bytes */

static uint64_t work;

uint32_t rlvc_crc(uint32_t crc, const void *data, size_t bytes) {
    work += bytes;
    return plain_crc(crc, data, bytes);
}

uint32_t rlvc_crc_shift(uint32_t crc, const uint32_t multiple[16]) {
    work += SHIFT_COSTS;
    return plain_shift(crc, multiple);
}

static unsigned char *tape;
static uint32_t tape_bytes, length, at, piece;

static int tape_write(void *ctx, const void *bytes, uint32_t count) {
    (void)ctx;
    assert_true(length + count <= tape_bytes);
    memcpy(tape + length, bytes, count);
    length += count;
    return 0;
}

static int tape_read(void *ctx, void *bytes, uint32_t room, uint32_t *got) {
    (void)ctx;
    *got = length - at < room ? length - at : room;
    *got = piece > 0 && piece < *got ? piece : *got;
    memcpy(bytes, tape + at, *got);
    at += *got;
    return 0;
}

/* Reads all of the tape and returns the work; *records, how many there were. */
static uint64_t read_all(uint32_t room, uint32_t *records) {
    static unsigned char buffer[4u * RLVC_LOG_RECORD_BYTES(PERCEPT)];
    rlvc_log_reader reader;
    rlvc_log_record record;
    assert_true(room <= sizeof buffer);
    assert_int_equal(rlvc_log_read(&reader, PERCEPT, 4, buffer, room, tape_read, NULL), RLVC_OK);
    work = 0;
    at = 0;
    for (*records = 0;; ++*records) {
        assert_int_equal(rlvc_log_next(&reader, &record), RLVC_OK);
        if (record.kind == RLVC_LOG_END)
            return work;
    }
}

/* A log of `count` terminated interactions, each after its percept. */
static void write_honest(uint32_t count) {
    static unsigned char percept[PERCEPT];
    const rlvc_choice choice = {1, 0};
    rlvc_log_writer writer;
    length = 0;
    assert_int_equal(rlvc_log_open(&writer, PERCEPT, 4, tape_write, NULL), RLVC_OK);
    for (uint32_t i = 0; i < count; i++) {
        assert_int_equal(rlvc_log_begin(&writer, percept), RLVC_OK);
        assert_int_equal(rlvc_log_observe(&writer, choice, 1.0f, NULL, RLVC_TERMINATED), RLVC_OK);
    }
}

static void test_honest(void **state) {
    uint32_t records;
    (void)state;
    write_honest(90);
    assert_true(read_all(RLVC_LOG_RECORD_BYTES(PERCEPT), &records) <= length + 181u * SHIFT_COSTS);
    assert_int_equal(records, 181);
}

static const uint32_t rooms[] = {RLVC_LOG_RECORD_BYTES(PERCEPT),
                                 RLVC_LOG_RECORD_BYTES(PERCEPT) + 1u,
                                 4u * RLVC_LOG_RECORD_BYTES(PERCEPT)};

static void expect_linear(uint32_t expected) {
    for (size_t i = 0; i < sizeof rooms / sizeof rooms[0]; i++) {
        for (piece = 0; piece < 8; piece += 7) {
            uint32_t records;
            uint64_t spent = read_all(rooms[i], &records);
            assert_int_equal(records, expected);
            assert_true(spent <= (uint64_t)20u * length);
        }
    }
    piece = 0;
}

/* A record seems to begin at every other byte: of each kind alone, and of all of them. */
static void test_false_beginnings(void **state) {
    static const unsigned char kinds[] = {0x01, 0x02, 0x03, 0x07, 0x0b, 0x13};
    (void)state;
    length = tape_bytes;
    for (uint32_t kind = 0; kind <= sizeof kinds; kind++) {
        for (uint32_t i = 0; i < length; i++)
            tape[i] =
                i % 2u == 0 ? 0xa5u : kinds[kind < sizeof kinds ? kind : i / 2u % sizeof kinds];
        expect_linear(0);
    }
}

/* Whole records stand between false beginnings of longer ones, and all are found. */
static void test_whole_records_between(void **state) {
    unsigned char record[13] = {0xa5, 0x0b, 0, 0, 1};
    uint32_t count = 0;
    (void)state;
    length = tape_bytes;
    memset(tape, 0, length);
    for (uint32_t i = 0; i + 16u <= length; i += 16u) {
        rlvc_put(record + 2, count++, 2);
        rlvc_put(record + 9, rlvc_crc(0, record, 9), 4);
        tape[i] = 0xa5;
        tape[i + 1] = i % 32u ? 0x02 : 0x03;
        memcpy(tape + i + 3, record, sizeof record);
    }
    for (size_t i = 0; i < sizeof rooms / sizeof rooms[0]; i++) {
        rlvc_log_reader reader;
        rlvc_log_record read;
        static unsigned char buffer[4u * RLVC_LOG_RECORD_BYTES(PERCEPT)];
        assert_int_equal(rlvc_log_read(&reader, PERCEPT, 4, buffer, rooms[i], tape_read, NULL),
                         RLVC_OK);
        at = 0;
        work = 0;
        assert_int_equal(rlvc_log_next(&reader, &read), RLVC_OK);
        assert_int_equal(read.kind, RLVC_LOG_END);
        assert_int_equal(reader.lost, count); /* each is of an episode that is not known */
        assert_true(work <= (uint64_t)20u * length);
    }
}

/* Random bytes of a small alphabet, in which an honest record stands now and then: found, wherever
 * the ring's end falls in it. */
static void test_found_anywhere(void **state) {
    static const unsigned char alphabet[] = {0xa5, 0x01, 0x02, 0x03, 0x0b, 0x00};
    static unsigned char honest[RLVC_LOG_RECORD_BYTES(PERCEPT)];
    rlvc_rng rng;
    uint32_t placed = 0;
    (void)state;
    rlvc_rng_seed(&rng, 3);
    for (uint32_t i = 0; i < tape_bytes; i++)
        tape[i] = alphabet[rlvc_rng_below(&rng, sizeof alphabet)];
    for (uint32_t i = 3000; i + sizeof honest < tape_bytes;
         i += PERCEPT + 13u + rlvc_rng_below(&rng, 9000)) {
        honest[0] = 0xa5;
        honest[1] = 0x02;
        rlvc_put(honest + 2, placed++, 2);
        for (uint32_t k = 0; k < PERCEPT; k++)
            honest[4 + k] = alphabet[rlvc_rng_below(&rng, sizeof alphabet)];
        rlvc_put(honest + 4 + PERCEPT, plain_crc(0, honest, 4 + PERCEPT), 4);
        memcpy(tape + i, honest, PERCEPT + 8u);
    }
    length = tape_bytes;
    assert_true(placed > 30);
    expect_linear(placed);
}

/* The CRC of a string from those of its two halves. */
static void test_crc_of_parts(void **state) {
    static const unsigned char text[] = "123456789";
    (void)state;
    for (uint32_t cut = 0; cut <= 9; cut++) {
        uint32_t multiple[16], head = plain_crc(0, text, cut);
        rlvc_crc_shift_by(9u - cut, multiple);
        assert_int_equal(plain_shift(head, multiple) ^ plain_crc(0, text + cut, 9u - cut),
                         0xcbf43926u);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_honest),
        cmocka_unit_test(test_false_beginnings),
        cmocka_unit_test(test_whole_records_between),
        cmocka_unit_test(test_found_anywhere),
        cmocka_unit_test(test_crc_of_parts),
    };
    const char *wanted = getenv("RLVC_LOG_BYTES");
    tape_bytes = wanted ? (uint32_t)strtoul(wanted, NULL, 10) : BYTES;
    tape = malloc(tape_bytes);
    int failed = tape ? cmocka_run_group_tests(tests, NULL, NULL) : 1;
    free(tape);
    return failed;
}
