/* SPDX-License-Identifier: MIT */
/* Numbers in records are stored lowest byte first: in snapshots and in logs, whatever the target.
 * tools/check/alone.py writes both on a machine of one order and reads them on one of the other.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "store.h"
#include "base/rng.h"
#include "rlvc/log.h"
#include "rlvc/thresholds.h"

#define COMPONENTS 2u
#define SAMPLES 60u
#define BLOCK_BYTES 65536u

static uint64_t block[BLOCK_BYTES / 8u], other_block[BLOCK_BYTES / 8u];
static medium store_bytes;
static rlvc_thresholds thresholds;
static rlvc_domain domain;
static rlvc_config config;

/* A learner that is halfway through a step; the reward says whether x[1] > 5. */
static rlvc_agent *learn(void) {
    rlvc_agent *agent;
    rlvc_progress progress;
    rlvc_rng rng;
    rlvc_rng_seed(&rng, 7);
    assert_int_equal(rlvc_thresholds_default(&thresholds, COMPONENTS), RLVC_OK);
    assert_int_equal(rlvc_thresholds_domain(&thresholds, &domain), RLVC_OK);
    assert_int_equal(rlvc_config_default(&config, &domain, 2), RLVC_OK);
    config.method = &rlvc_method_classes;
    config.capacity = SAMPLES;
    config.classes = 4;
    assert_int_equal(rlvc_agent_init(&config, &domain, block, sizeof block, &agent), RLVC_OK);
    for (uint32_t i = 0; i < SAMPLES; i++) {
        const float x[COMPONENTS] = {1.5f, 10.0f * rlvc_rng_uniform(&rng)};
        const rlvc_choice choice = {(uint8_t)(i % 2u), 0};
        const float reward = (x[1] > 5.0f) == choice.action ? 1.0f : 0.0f;
        assert_int_equal(rlvc_begin(agent, x), RLVC_OK);
        assert_int_equal(rlvc_observe(agent, choice, reward, x, RLVC_TERMINATED), RLVC_OK);
    }
    assert_int_equal(rlvc_learn(agent, 20000, &progress), RLVC_OK);
    return agent;
}

/* How often the bytes of 1.5 stand in the first slot, the lowest first. */
static uint32_t count_percepts(void) {
    static const unsigned char one_and_a_half[4] = {0, 0, 0xc0, 0x3f};
    uint32_t found = 0;
    for (uint32_t at = 0; at + 8u <= config.capacity * 16u + 1000u; at++)
        found += memcmp(store_bytes.bytes + at, one_and_a_half, 4) == 0;
    return found;
}

static void test_snapshot(void **state) {
    (void)state;
    rlvc_agent *agent = learn(), *loaded;
    rlvc_statistics statistics, again;
    rlvc_split split;
    unsigned char feature[RLVC_THRESHOLDS_FEATURE_BYTES], same[RLVC_THRESHOLDS_FEATURE_BYTES];
    rlvc_store store = medium_store(&store_bytes, &config, &domain, 0);
    assert_int_equal(rlvc_save(agent, &store), RLVC_OK);
    assert_true(count_percepts() >= SAMPLES);
    assert_int_equal(rlvc_load(&config, &domain, other_block, sizeof other_block, &store, &loaded),
                     RLVC_OK);
    assert_int_equal(rlvc_stats(agent, &statistics), RLVC_OK);
    assert_int_equal(rlvc_stats(loaded, &again), RLVC_OK);
    assert_int_equal(statistics.classes, again.classes);
    assert_true(statistics.classes > 1u);
    assert_int_equal(rlvc_split_at(agent, 0, &split, feature), RLVC_OK);
    assert_int_equal(rlvc_split_at(loaded, 0, &split, same), RLVC_OK);
    assert_memory_equal(feature, same, sizeof feature);
    assert_int_equal(rlvc_thresholds_feature(same).component, 1);
}

/* A domain that says of more numbers than its records hold has records of numbers. */
static void test_numbers_beyond_the_record(void **state) {
    (void)state;
    rlvc_agent *agent, *loaded;
    rlvc_store store;
    const float x[COMPONENTS] = {1.5f, 2.0f};
    (void)learn();
    domain.percept_words = UINT32_MAX;
    domain.feature_words = UINT32_MAX;
    domain.feature_halves = UINT32_MAX;
    assert_int_equal(rlvc_agent_init(&config, &domain, block, sizeof block, &agent), RLVC_OK);
    assert_int_equal(rlvc_begin(agent, x), RLVC_OK);
    store = medium_store(&store_bytes, &config, &domain, 0);
    assert_int_equal(rlvc_save(agent, &store), RLVC_OK);
    assert_int_equal(rlvc_load(&config, &domain, other_block, sizeof other_block, &store, &loaded),
                     RLVC_OK);
}

/* ------------------------------------------------------------------ logs */

#define WORDS 17u /* more than what is written at once */
#define PERCEPT (4u * WORDS + 2u)

typedef struct tape {
    unsigned char bytes[512];
    uint32_t length, at;
    uint32_t calls, fail_at;
} tape;

static int tape_write(void *ctx, const void *bytes, uint32_t count) {
    tape *t = (tape *)ctx;
    if (++t->calls == t->fail_at)
        return 1;
    memcpy(t->bytes + t->length, bytes, count);
    t->length += count;
    return 0;
}

static int tape_read(void *ctx, void *bytes, uint32_t room, uint32_t *got) {
    tape *t = (tape *)ctx;
    *got = room < t->length - t->at ? room : t->length - t->at;
    memcpy(bytes, t->bytes + t->at, *got);
    t->at += *got;
    return 0;
}

/* Percept i: the numbers i + 0x01020300, ..., and two bytes. */
static void fill(unsigned char percept[PERCEPT], uint32_t i) {
    for (uint32_t k = 0; k < WORDS; k++) {
        const uint32_t number = UINT32_C(0x01020300) + i + k;
        memcpy(percept + 4u * k, &number, sizeof number);
    }
    percept[4u * WORDS] = 0xab;
    percept[4u * WORDS + 1u] = 0xcd;
}

static void test_log(void **state) {
    (void)state;
    static tape t;
    rlvc_log_writer writer;
    rlvc_log_reader reader;
    rlvc_log_record record;
    unsigned char percept[PERCEPT], buffer[RLVC_LOG_RECORD_BYTES(PERCEPT) + 5u];
    const rlvc_choice choice = {1, 0};
    memset(&t, 0, sizeof t);
    assert_int_equal(rlvc_log_open(&writer, PERCEPT, 2, tape_write, &t), RLVC_OK);
    writer.percept_words = WORDS;
    const uint32_t header = t.length;
    fill(percept, 0);
    assert_int_equal(rlvc_log_begin(&writer, percept), RLVC_OK);
    assert_int_equal(t.bytes[header + 4u], 0x00); /* the lowest byte of the first number */
    assert_int_equal(t.bytes[header + 7u], 0x01);
    fill(percept, 1);
    assert_int_equal(rlvc_log_observe(&writer, choice, 0.5f, percept, RLVC_GOES_ON), RLVC_OK);
    assert_int_equal(rlvc_log_observe(&writer, choice, 0.5f, NULL, RLVC_TERMINATED), RLVC_OK);
    assert_int_equal(rlvc_log_read(&reader, PERCEPT, 2, buffer, sizeof buffer, tape_read, &t),
                     RLVC_OK);
    reader.percept_words = WORDS;
    assert_int_equal(rlvc_log_next(&reader, &record), RLVC_OK);
    for (uint32_t i = 0; i < 2u; i++) {
        assert_int_equal(rlvc_log_next(&reader, &record), RLVC_OK);
        fill(percept, i);
        assert_memory_equal(record.percept, percept, PERCEPT);
    }
    assert_int_equal(rlvc_log_next(&reader, &record), RLVC_OK);
    assert_null(record.percept);
    assert_int_equal(reader.skipped, 0);
}

static void test_log_of_a_failing_tape(void **state) {
    (void)state;
    static tape t;
    rlvc_log_writer writer;
    unsigned char percept[PERCEPT];
    fill(percept, 0);
    for (uint32_t fail_at = 1; fail_at <= 5u; fail_at++) {
        memset(&t, 0, sizeof t);
        assert_int_equal(rlvc_log_open(&writer, PERCEPT, 2, tape_write, &t), RLVC_OK);
        writer.percept_words = UINT32_MAX; /* all but the last two bytes */
        t.calls = 0;
        t.fail_at = fail_at;
        assert_int_equal(rlvc_log_begin(&writer, percept), RLVC_E_CALLBACK);
    }
}

/* Of numbers alone, no bytes are left to be written after them. */
static void test_log_of_numbers(void **state) {
    (void)state;
    static tape t;
    rlvc_log_writer writer;
    unsigned char percept[PERCEPT];
    fill(percept, 0);
    memset(&t, 0, sizeof t);
    assert_int_equal(rlvc_log_open(&writer, 4, 2, tape_write, &t), RLVC_OK);
    writer.percept_words = 1;
    const uint32_t calls = t.calls;
    assert_int_equal(rlvc_log_begin(&writer, percept), RLVC_OK);
    assert_int_equal(t.calls, calls + 3u); /* head, number, check */
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_snapshot),
        cmocka_unit_test(test_numbers_beyond_the_record),
        cmocka_unit_test(test_log),
        cmocka_unit_test(test_log_of_a_failing_tape),
        cmocka_unit_test(test_log_of_numbers),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
