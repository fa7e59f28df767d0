/* SPDX-License-Identifier: MIT */
/* The tree as text, DOT and JSON: as in tests/golden (written anew by `test_print --write`), and
 * nothing changed when a write or a name fails. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "player.h"

#define FORMATS 3u
static const char *const golden_names[FORMATS] = {"tree.txt", "tree.dot", "tree.json"};

static player p;
static player_result printed, golden;
static int writing; /* the golden files */

/* Four classes, with values of all sizes. */
static void make(void) {
    rlvc_rng rng;
    rlvc_rng_seed(&rng, 3);
    player_enter_world(&p, BATCH);
    p.config.actions = 2;
    p.config.capacity = 500;
    player_init(&p);
    for (int i = 0; i < 500; i++) {
        unsigned char percept = (unsigned char)rlvc_rng_next(&rng);
        const rlvc_choice choice = {(uint8_t)rlvc_rng_below(&rng, 2), 0};
        float reward = percept & 1 ? -0.0123456789f : percept & 4 ? 1e10f : 100.0f;
        reward += percept & 8 && choice.action ? 3.0f : 0.0f;
        assert_int_equal(rlvc_begin(p.agent, &percept), RLVC_OK);
        assert_int_equal(rlvc_observe(p.agent, choice, reward, NULL, RLVC_TERMINATED), RLVC_OK);
    }
    player_learn(&p, RLVC_BUDGET_UNBOUNDED, NULL);
    player_save(&p);
}

static void print(uint32_t format) {
    memset(&printed, 0, sizeof printed);
    assert_int_equal(rlvc_print(p.agent, format, player_append, &printed), RLVC_OK);
    player_unchanged(&p, "printing");
}

static void test_golden_files(void **state) {
    (void)state;
    make();
    for (uint32_t format = 0; format < FORMATS; format++) {
        char path[1024];
        snprintf(path, sizeof path, "%s/%s", RLVC_GOLDEN_DIR, golden_names[format]);
        print(format);
        FILE *file = fopen(path, writing ? "wb" : "rb");
        assert_non_null(file);
        if (writing) {
            assert_int_equal(fwrite(printed.text, 1, printed.bytes, file), printed.bytes);
        } else {
            memset(&golden, 0, sizeof golden);
            golden.bytes = fread(golden.text, 1, sizeof golden.text - 1u, file);
            assert_string_equal(printed.text, golden.text);
        }
        fclose(file);
    }
}

/* A tree of one class has nothing but a leaf. */
static void test_single_class(void **state) {
    (void)state;
    const char *const expected[FORMATS] = {
        "class 0: action 0, value 0, 0 interactions\n",
        "digraph rlvc {\n  node [fontname=\"sans-serif\"];\n"
        "  n0 [shape=box, label=\"class 0\\naction 0\\nvalue 0\"];\n}\n",
        "{\"classes\": 1, \"actions\": 1, \"step\": 0, \"nodes\": [\n"
        "  {\"node\": 0, \"class\": 0, \"action\": 0, \"value\": 0, \"q\": [0], \"samples\": [0]}\n"
        "]}\n",
    };
    player_enter_world(&p, BATCH);
    p.config.actions = 1;
    player_init(&p);
    player_save(&p);
    for (uint32_t format = 0; format < FORMATS; format++) {
        print(format);
        assert_string_equal(printed.text, expected[format]);
    }
}

static void test_each_name_fails(void **state) {
    (void)state;
    make();
    for (uint32_t format = 0; format < FORMATS; format++) {
        player_restore(&p);
        print(format);
        uint64_t names = p.faulty.calls;
        assert_int_equal(names, player_stats(&p).classes - 1u);
        memcpy(&golden, &printed, sizeof golden);
        for (uint64_t n = 1; n <= names; n++) {
            player_restore(&p);
            p.faulty.fail_at = n;
            memset(&printed, 0, sizeof printed);
            assert_int_equal(rlvc_print(p.agent, format, player_append, &printed), RLVC_E_CALLBACK);
            assert_int_equal(p.faulty.calls, n);
            assert_true(printed.bytes < golden.bytes);
            assert_memory_equal(printed.text, golden.text, printed.bytes);
            player_unchanged(&p, "a name failed");
        }
        player_restore(&p);
        p.faulty.agent = p.agent;
        print(format);
        p.faulty.agent = NULL;
        assert_memory_equal(&printed, &golden, sizeof golden);
    }
}

typedef struct failing_write {
    player_result result;
    uint32_t calls;
    uint32_t fail_at;
} failing_write;

static int write_until(void *ctx, const char *text, size_t bytes) {
    failing_write *w = (failing_write *)ctx;
    assert_true(w->fail_at == 0 || w->calls < w->fail_at); /* nothing after a failure */
    return ++w->calls == w->fail_at ? -1 : player_append(&w->result, text, bytes);
}

static void test_each_write_fails(void **state) {
    (void)state;
    static failing_write w;
    make();
    for (uint32_t format = 0; format < FORMATS; format++) {
        memset(&w, 0, sizeof w);
        assert_int_equal(rlvc_print(p.agent, format, write_until, &w), RLVC_OK);
        memcpy(&golden, &w.result, sizeof golden);
        uint32_t writes = w.calls;
        for (uint32_t n = 1; n <= writes; n++) {
            memset(&w, 0, sizeof w);
            w.fail_at = n;
            assert_int_equal(rlvc_print(p.agent, format, write_until, &w), RLVC_E_CALLBACK);
            assert_int_equal(w.calls, n);
            assert_memory_equal(w.result.text, golden.text, w.result.bytes);
            player_unchanged(&p, "a write failed");
        }
    }
}

/* A name that fills its room is cut, not read beyond. */
static int long_name(void *ctx, const void *feature, char *text, uint32_t room) {
    (void)ctx;
    (void)feature;
    memset(text, 'x', room);
    return 0;
}

static void test_long_name(void **state) {
    (void)state;
    make();
    p.faulty.inner.name = long_name;
    print(RLVC_PRINT_TEXT);
    assert_int_equal(strspn(printed.text, "x"), RLVC_NAME_BYTES - 1u);
}

static void test_arguments(void **state) {
    (void)state;
    make();
    assert_int_equal(rlvc_print(NULL, RLVC_PRINT_TEXT, player_append, &printed), RLVC_E_NULL);
    assert_int_equal(rlvc_print(p.agent, RLVC_PRINT_TEXT, NULL, NULL), RLVC_E_NULL);
    assert_int_equal(rlvc_print(p.agent, 3, player_append, &printed), RLVC_E_RANGE);
    assert_int_equal(rlvc_print(p.agent, UINT32_MAX, player_append, &printed), RLVC_E_RANGE);
    player_unchanged(&p, "a refused print");
}

int main(int count, char **arguments) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_golden_files),    cmocka_unit_test(test_single_class),
        cmocka_unit_test(test_each_name_fails), cmocka_unit_test(test_each_write_fails),
        cmocka_unit_test(test_long_name),       cmocka_unit_test(test_arguments),
    };
    writing = count == 2 && strcmp(arguments[1], "--write") == 0;
    return cmocka_run_group_tests(tests, NULL, NULL);
}
