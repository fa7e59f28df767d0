/* SPDX-License-Identifier: MIT */
/* What rlvc_export_c refuses, and a write that fails. That what it writes is the policy is shown by
 * tests/export. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "agent/state.h"
#include "rlvc/descriptors.h"
#include "rlvc/rlvc.h"

#include <string.h>

#define BITS 2u
#define DIMENSIONS 9u
#define PERCEPT_BYTES RLVC_DESCRIPTORS_PERCEPT_BYTES(3, DIMENSIONS, RLVC_DESCRIPTORS_FLOAT)
#define BAG_SIZE 2u
#define FEATURE_BYTES RLVC_BAGS_FEATURE_BYTES(BAG_SIZE, DIMENSIONS, RLVC_DESCRIPTORS_FLOAT)

#define PLANE 258u /* components: more than a byte can number */
#define NUMBERS 1728u

static union {
    uint64_t aligned;
    unsigned char bytes[RLVC_AGENT_BYTES(2, 400, 8, 1, RLVC_BITS_FEATURE_BYTES, BITS)];
    unsigned char vectors[RLVC_AGENT_BYTES(255, 1920, 16, PERCEPT_BYTES, FEATURE_BYTES, 64)];
    unsigned char numbers[RLVC_AGENT_BYTES(255, NUMBERS, 16, RLVC_THRESHOLDS_PERCEPT_BYTES(PLANE),
                                           RLVC_THRESHOLDS_FEATURE_BYTES, 64)];
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

static rlvc_agent *make_agent(const rlvc_domain *domain, uint32_t actions, uint32_t capacity,
                              uint32_t classes) {
    rlvc_config config;
    rlvc_agent *agent;
    assert_int_equal(rlvc_config_default(&config, domain, actions), RLVC_OK);
    config.method = &rlvc_method_classes;
    config.capacity = capacity;
    config.classes = classes;
    assert_int_equal(rlvc_agent_init(&config, domain, &memory, sizeof memory, &agent), RLVC_OK);
    return agent;
}

/* One decision is an episode: 1 for an action that is right, else 0. */
static void decide(rlvc_agent *agent, const void *percept, uint32_t action, int right) {
    const rlvc_choice choice = {(uint8_t)action, 0};
    const float reward = right ? 1.0f : 0.0f;
    assert_int_equal(rlvc_begin(agent, percept), RLVC_OK);
    assert_int_equal(rlvc_observe(agent, choice, reward, NULL, RLVC_TERMINATED), RLVC_OK);
}

static void learn(rlvc_agent *agent) {
    rlvc_progress progress;
    assert_int_equal(rlvc_learn(agent, RLVC_BUDGET_UNBOUNDED, &progress), RLVC_OK);
}

/* Exports once, and then as often as there are writes, of which each fails once. */
static rlvc_export_info fail_each_write(rlvc_agent *agent) {
    writer all = {0, 0, NULL, RLVC_OK};
    rlvc_export_info info;
    assert_int_equal(rlvc_export_c(agent, "a", count_writes, &all, &info), RLVC_OK);
    for (uint32_t n = 1; n <= all.count; n++) {
        writer w = {0, n, NULL, RLVC_OK};
        assert_int_equal(rlvc_export_c(agent, "a", count_writes, &w, NULL), RLVC_E_CALLBACK);
        assert_int_equal(w.count, n);
        assert_int_equal(rlvc_agent_check(agent), RLVC_OK);
    }
    return info;
}

/* An agent that has learnt to do action 1 where both bits are 1, else action 0. */
static rlvc_agent *make(uint32_t kind) {
    rlvc_domain domain;
    assert_int_equal(rlvc_bits_domain(BITS, &domain), RLVC_OK);
    domain.kind = kind;
    rlvc_agent *agent = make_agent(&domain, 2, 400, 8);
    for (uint32_t i = 0; i < 400; i++) {
        const unsigned char percept = (unsigned char)(i % 4u);
        const uint32_t action = i / 4u % 2u;
        decide(agent, &percept, action, action == (percept == 3));
    }
    learn(agent);
    return agent;
}

static void test_refusals(void **unused) {
    (void)unused;
    static const char *const wrong[] = {
        "",   "1st", "a-b", "a b",
        "a{", "a[",  "a@",  "a2345678901234567890123456789012345678901234567890"};
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
    const rlvc_export_info info = fail_each_write(make(RLVC_DOMAIN_BITS));
    assert_int_equal(info.leaves, 3);
    assert_int_equal(info.compact, 3);
    assert_int_equal(info.bytes, 4);
}

static void test_reentering(void **unused) {
    (void)unused;
    writer w = {0, 0, make(RLVC_DOMAIN_BITS), RLVC_OK};
    assert_int_equal(rlvc_export_c(w.reenter, "a", count_writes, &w, NULL), RLVC_OK);
    assert_int_equal(w.reentered, RLVC_E_REENTERED);
}

/* ------------------------------------------------------------------ descriptors */

/* Vector `which` of three: whole numbers, fractions, small and large ones of either sign. */
static void put_vector(unsigned char *out, uint32_t which, uint32_t form) {
    static const float number[DIMENSIONS] = {0.0f,   1.5f, -7.0f, 1e-7f,       2e9f,
                                             -3e12f, 1e9f, 0.1f,  999999940.0f};
    for (uint32_t k = 0; k < DIMENSIONS; k++) {
        const float value = number[(which + k) % DIMENSIONS];
        const int8_t byte = (int8_t)((int)((which + k) % 3u) * 100 - 100);
        if (form == RLVC_DESCRIPTORS_INT8)
            memcpy(out + k, &byte, 1);
        else
            memcpy(out + 4u * k, &value, sizeof value);
    }
}

/* Those of the three whose bits are set. */
static void make_percept(uint32_t set, uint32_t form, uint32_t percept[PERCEPT_BYTES / 4u]) {
    unsigned char *at = (unsigned char *)percept + 4u;
    memset(percept, 0, PERCEPT_BYTES);
    for (uint32_t which = 0; which < 3; which++)
        if (set >> which & 1u) {
            put_vector(at, which, form);
            at += RLVC_DESCRIPTORS_VECTOR_BYTES(DIMENSIONS, form);
            percept[0]++;
        }
}

/* Learns which action is wanted of six, where the first so many percepts are seen. */
static rlvc_agent *teach_vectors(const rlvc_domain *domain, uint32_t form, uint32_t actions,
                                 uint32_t percepts, const uint8_t wanted[8]) {
    rlvc_agent *agent = make_agent(domain, actions, 1920, 16);
    for (uint32_t i = 0; i < 1920; i++) {
        uint32_t percept[PERCEPT_BYTES / 4u];
        const uint32_t set = i % percepts, action = i / 8u % 6u;
        make_percept(set, form, percept);
        decide(agent, percept, action, action == wanted[set]);
    }
    learn(agent);
    return agent;
}

/* An agent that has learnt to act by the first two vectors where the first is absent, else by all
 * three; or, if it knows one percept only, that there is nothing to tell apart. */
static rlvc_agent *make_of_vectors(uint32_t form, uint32_t actions, uint32_t percepts) {
    static rlvc_descriptors descriptors;
    static const uint8_t wanted[8] = {0, 2, 1, 3, 0, 4, 1, 5};
    rlvc_domain domain;
    assert_int_equal(rlvc_descriptors_default(&descriptors, 3, DIMENSIONS, form, 0.5f), RLVC_OK);
    descriptors.margin = 1.0f;
    assert_int_equal(rlvc_descriptors_domain(&descriptors, &domain), RLVC_OK);
    return teach_vectors(&domain, form, actions, percepts, wanted);
}

/* An agent that has learnt to act by whether one of the last two vectors is there. */
static rlvc_agent *make_of_bags(uint32_t form, uint32_t actions, uint32_t percepts) {
    static rlvc_bags bags;
    static const uint8_t wanted[8] = {0, 0, 3, 3, 3, 3, 3, 3};
    rlvc_domain domain;
    assert_int_equal(rlvc_bags_default(&bags, 3, DIMENSIONS, form, 0.5f), RLVC_OK);
    bags.size = BAG_SIZE;
    assert_int_equal(rlvc_bags_domain(&bags, &domain), RLVC_OK);
    return teach_vectors(&domain, form, actions, percepts, wanted);
}

/* Keeps what is written. */
typedef struct text {
    char text[16384];
    size_t bytes;
} text;

static int keep(void *ctx, const char *written, size_t bytes) {
    text *t = ctx;
    assert_true(t->bytes + bytes < sizeof t->text);
    memcpy(t->text + t->bytes, written, bytes);
    t->bytes += bytes;
    return 0;
}

static text exported;

static rlvc_export_info export_to_text(rlvc_agent *agent) {
    rlvc_export_info info;
    memset(&exported, 0, sizeof exported);
    assert_int_equal(rlvc_export_c(agent, "v", keep, &exported, &info), RLVC_OK);
    return info;
}

static rlvc_export_info export_vectors(uint32_t form, uint32_t actions, uint32_t percepts) {
    return export_to_text(make_of_vectors(form, actions, percepts));
}

/* Three distinct features, of which two are tested twice and written once. */
static void test_vectors(void **unused) {
    (void)unused;
    rlvc_export_info info = export_vectors(RLVC_DESCRIPTORS_FLOAT, 6, 8);
    assert_int_equal(info.compact, 6);
    assert_int_equal(info.bytes, 5 * 3 + 3 * (4 + 4 * DIMENSIONS));
    assert_non_null(strstr(exported.text, "static const unsigned char v_node[5][3]"));
    assert_non_null(strstr(exported.text, "v_vector[3][9]"));
    assert_non_null(strstr(exported.text, "0.0f, 1.5f, -7.0f, 1e-7f, 2e+9f, "
                                          "-3e+12f, 1e+9f, 0.1f,\n"
                                          "     999999940.0f}"));
    info = export_vectors(RLVC_DESCRIPTORS_INT8, 255, 8);
    assert_int_equal(info.compact, 6);
    assert_int_equal(info.bytes, 5 * 12 + 3 * (4 + DIMENSIONS));
    assert_non_null(strstr(exported.text, "static const unsigned v_node[5][3]"));
    assert_non_null(strstr(exported.text, "{-100, 0, 100, -100, 0, 100, -100, 0,\n     100}"));
}

static void test_vectors_that_do_not_matter(void **unused) {
    (void)unused;
    rlvc_export_info info = export_vectors(RLVC_DESCRIPTORS_FLOAT, 6, 1);
    assert_int_equal(info.compact, 1);
    assert_int_equal(info.bytes, 0);
    assert_non_null(strstr(exported.text, "v_act(const void *percept) {\n    (void)percept;\n"
                                          "    return 0u;\n}\n"));
}

static void test_each_write_of_vectors_failing(void **unused) {
    (void)unused;
    (void)fail_each_write(make_of_vectors(RLVC_DESCRIPTORS_INT8, 6, 8));
}

/* ------------------------------------------------------------------ bags */

static void test_bags(void **unused) {
    (void)unused;
    rlvc_export_info info = export_to_text(make_of_bags(RLVC_DESCRIPTORS_FLOAT, 6, 8));
    assert_int_equal(info.compact, 2);
    assert_int_equal(info.bytes, 3 + 4 + 1 + BAG_SIZE * 4 * DIMENSIONS);
    assert_non_null(strstr(exported.text, "static const unsigned char v_count[1] = {\n    2};\n"));
    assert_non_null(strstr(exported.text, "static const float v_vector[1][2][9] = {\n    {{"));
    assert_non_null(strstr(exported.text, "float least = 0.25f;"));
    info = export_to_text(make_of_bags(RLVC_DESCRIPTORS_INT8, 6, 8));
    assert_int_equal(info.compact, 2);
    assert_int_equal(info.bytes, 3 + 4 + 1 + BAG_SIZE * DIMENSIONS);
    assert_non_null(strstr(exported.text, "static const int8_t v_vector[1][2][9] = {\n    {{"));
}

static void test_bags_that_do_not_matter(void **unused) {
    (void)unused;
    const rlvc_export_info info = export_to_text(make_of_bags(RLVC_DESCRIPTORS_FLOAT, 6, 1));
    assert_int_equal(info.compact, 1);
    assert_int_equal(info.bytes, 0);
    assert_non_null(strstr(exported.text, "v_act(const void *percept) {\n    (void)percept;\n"));
}

static void test_each_write_of_bags_failing(void **unused) {
    (void)unused;
    (void)fail_each_write(make_of_bags(RLVC_DESCRIPTORS_INT8, 6, 8));
}

/* ------------------------------------------------------------------ thresholds */

/* What an agent of two components learns to tell apart. */
enum {
    PARTS,    /* three actions: left, and right below and above */
    DIAGONAL, /* two: on either side of one */
    STRIPES,  /* eight: one for each */
    NOTHING
};

/* Percept i of a kind at x[0] and x[1]; returns the action that is wanted. */
static uint32_t put_numbers(int kind, uint32_t i, float *x) {
    const uint32_t place = i / 9u * 7u % 16u, part = i / 9u % 3u;
    x[0] = kind == PARTS ? (part > 0 ? 1.5f : -0.5f) : (float)(place / 4u);
    x[1] = kind == PARTS ? (part > 1u ? 2.0f : -1e-7f) : (float)(place % 4u);
    if (kind == STRIPES)
        x[0] = (float)(place % 8u);
    return kind == PARTS      ? part
           : kind == DIAGONAL ? place / 4u + place % 4u > 3u
           : kind == STRIPES  ? place % 8u
                              : 0;
}

/* An agent that has learnt it. The components lie at `at`. */
static rlvc_agent *make_of_numbers(int kind, uint32_t at, uint32_t actions) {
    static rlvc_thresholds thresholds;
    static float x[PLANE];
    rlvc_domain domain;
    assert_int_equal(rlvc_thresholds_default(&thresholds, at + 2u), RLVC_OK);
    thresholds.oblique = kind == DIAGONAL;
    assert_int_equal(rlvc_thresholds_domain(&thresholds, &domain), RLVC_OK);
    rlvc_agent *agent = make_agent(&domain, actions, NUMBERS, 16);
    for (uint32_t i = 0; i < NUMBERS; i++) {
        const uint32_t wanted = put_numbers(kind, i, x + at), action = i % 9u % actions;
        decide(agent, x, action, kind == NOTHING || action == wanted);
    }
    learn(agent);
    return agent;
}

static rlvc_export_info export_numbers(int kind, uint32_t at, uint32_t actions) {
    rlvc_export_info info;
    rlvc_agent *agent = make_of_numbers(kind, at, actions);
    memset(&exported, 0, sizeof exported);
    assert_int_equal(rlvc_export_c(agent, "t", keep, &exported, &info), RLVC_OK);
    return info;
}

static void test_numbers(void **unused) {
    (void)unused;
    rlvc_export_info info = export_numbers(PARTS, 0, 3);
    assert_int_equal(info.compact, 3);
    assert_int_equal(info.bytes, 2 * 7);
    assert_non_null(strstr(exported.text, "static const unsigned char t_node[2][3]"));
    assert_non_null(strstr(exported.text, "1: x["));
    assert_non_null(strstr(exported.text, "value = x[t_node[at][0]];"));
    /* A component or an action that a byte has no room for. */
    info = export_numbers(PARTS, PLANE - 2u, 3);
    assert_int_equal(info.bytes, 2 * 16);
    assert_non_null(strstr(exported.text, "static const unsigned t_node[2][3]"));
    info = export_numbers(PARTS, 0, 255);
    assert_int_equal(info.bytes, 2 * 16);
    info = export_numbers(STRIPES, 0, 8);
    assert_int_equal(info.compact, 8);
    assert_int_equal(info.bytes, 7 * 7);
    info = export_numbers(NOTHING, 0, 3);
    assert_int_equal(info.bytes, 0);
    assert_non_null(strstr(exported.text, "t_act(const float *percept) {\n    (void)percept;\n"));
}

static void test_oblique_numbers(void **unused) {
    (void)unused;
    rlvc_export_info info = export_numbers(DIAGONAL, 0, 3);
    assert_int_equal(info.compact, 2);
    assert_int_equal(info.bytes, 12);
    assert_non_null(strstr(exported.text, "1: action 1\n"));
    assert_non_null(strstr(exported.text, "static const unsigned char t_other[1]"));
    assert_non_null(strstr(exported.text, "value = x[t_node[at][0]] + t_slope[at] * "
                                          "x[t_other[at]];"));
}

static void test_each_write_of_numbers_failing(void **unused) {
    (void)unused;
    (void)fail_each_write(make_of_numbers(DIAGONAL, 0, 3));
}

static int no_name(void *ctx, const void *feature, char *name, uint32_t room) {
    (void)ctx;
    (void)feature;
    (void)name;
    (void)room;
    return 1;
}

static void test_failing_name(void **unused) {
    (void)unused;
    rlvc_agent *agent = make_of_numbers(PARTS, 0, 3);
    agent->domain.name = no_name;
    memset(&exported, 0, sizeof exported);
    assert_int_equal(rlvc_export_c(agent, "t", keep, &exported, NULL), RLVC_E_CALLBACK);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_refusals),
        cmocka_unit_test(test_each_write_failing),
        cmocka_unit_test(test_reentering),
        cmocka_unit_test(test_vectors),
        cmocka_unit_test(test_vectors_that_do_not_matter),
        cmocka_unit_test(test_each_write_of_vectors_failing),
        cmocka_unit_test(test_bags),
        cmocka_unit_test(test_bags_that_do_not_matter),
        cmocka_unit_test(test_each_write_of_bags_failing),
        cmocka_unit_test(test_numbers),
        cmocka_unit_test(test_oblique_numbers),
        cmocka_unit_test(test_each_write_of_numbers_failing),
        cmocka_unit_test(test_failing_name),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
