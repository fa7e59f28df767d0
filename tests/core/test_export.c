/* SPDX-License-Identifier: MIT */
/* What rlvc_export_c refuses, and a write that fails. That what it writes is the policy is shown by
 * tests/export. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "rlvc/rlvc.h"

#define BITS 2u

static union {
    uint64_t aligned;
    unsigned char bytes[RLVC_AGENT_BYTES(2, 400, 8, 1, RLVC_BITS_FEATURE_BYTES, BITS)];
} memory;

/* Counts the writes; fails the one numbered `failing`, from 1. */
typedef struct writer {
    uint32_t count;
    uint32_t failing;
    rlvc_agent *reenter;
    rlvc_status reentered;
} writer;

static int count_writes(void *ctx, const char *text, size_t bytes) {
    writer *w = ctx;
    assert_non_null(text);
    assert_true(bytes > 0);
    if (w->reenter)
        w->reentered = rlvc_export_c(w->reenter, "again", count_writes, ctx, NULL);
    return ++w->count == w->failing;
}

/* An agent that has learnt to do action 1 where both bits are 1, else action 0. */
static rlvc_agent *make(uint32_t kind) {
    rlvc_domain domain;
    rlvc_config config;
    rlvc_agent *agent;
    rlvc_progress progress;
    assert_int_equal(rlvc_bits_domain(BITS, &domain), RLVC_OK);
    domain.kind = kind;
    assert_int_equal(rlvc_config_default(&config, &domain, 2), RLVC_OK);
    config.capacity = 400;
    config.classes = 8;
    assert_int_equal(rlvc_agent_init(&config, &domain, &memory, sizeof memory, &agent), RLVC_OK);
    for (uint32_t i = 0; i < 400; i++) {
        unsigned char percept = (unsigned char)(i % 4u);
        rlvc_choice choice = {(uint8_t)(i / 4u % 2u), 0};
        float reward = choice.action == (percept == 3) ? 1.0f : 0.0f;
        assert_int_equal(rlvc_begin(agent, &percept), RLVC_OK);
        assert_int_equal(rlvc_observe(agent, choice, reward, NULL, RLVC_TERMINATED), RLVC_OK);
    }
    assert_int_equal(rlvc_learn(agent, RLVC_BUDGET_UNBOUNDED, &progress), RLVC_OK);
    return agent;
}

static void test_refusals(void **unused) {
    (void)unused;
    static const char *const wrong[] = {"", "1st", "a-b", "a b", "a{", "a[", "a@",
                                        "a2345678901234567890123456789012345678901234567890"};
    static const char *const right[] = {"a", "_", "Z9", "a_z"};
    writer w = {0, 0, NULL, RLVC_OK};
    rlvc_agent *agent = make(RLVC_DOMAIN_BITS);
    assert_int_equal(rlvc_export_c(NULL, "a", count_writes, &w, NULL), RLVC_E_NULL);
    assert_int_equal(rlvc_export_c(agent, NULL, count_writes, &w, NULL), RLVC_E_NULL);
    assert_int_equal(rlvc_export_c(agent, "a", NULL, &w, NULL), RLVC_E_NULL);
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++)
        assert_int_equal(rlvc_export_c(agent, wrong[i], count_writes, &w, NULL), RLVC_E_RANGE);
    assert_int_equal(w.count, 0);
    for (size_t i = 0; i < sizeof right / sizeof *right; i++)
        assert_int_equal(rlvc_export_c(agent, right[i], count_writes, &w, NULL), RLVC_OK);
    agent = make(RLVC_DOMAIN_OWN);
    assert_int_equal(rlvc_export_c(agent, "a", count_writes, &w, NULL), RLVC_E_CONFIG);
}

static void test_each_write_failing(void **unused) {
    (void)unused;
    rlvc_agent *agent = make(RLVC_DOMAIN_BITS);
    writer all = {0, 0, NULL, RLVC_OK};
    rlvc_export_info info;
    assert_int_equal(rlvc_export_c(agent, "a", count_writes, &all, &info), RLVC_OK);
    assert_int_equal(info.leaves, 3);
    assert_int_equal(info.compact, 3);
    assert_int_equal(info.bytes, 4);
    for (uint32_t n = 1; n <= all.count; n++) {
        writer w = {0, n, NULL, RLVC_OK};
        assert_int_equal(rlvc_export_c(agent, "a", count_writes, &w, NULL), RLVC_E_CALLBACK);
        assert_int_equal(w.count, n);
        assert_int_equal(rlvc_agent_check(agent), RLVC_OK);
    }
}

static void test_reentering(void **unused) {
    (void)unused;
    writer w = {0, 0, make(RLVC_DOMAIN_BITS), RLVC_OK};
    assert_int_equal(rlvc_export_c(w.reenter, "a", count_writes, &w, NULL), RLVC_OK);
    assert_int_equal(w.reentered, RLVC_E_REENTERED);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_refusals),
        cmocka_unit_test(test_each_write_failing),
        cmocka_unit_test(test_reentering),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
