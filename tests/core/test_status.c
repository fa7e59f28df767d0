/* SPDX-License-Identifier: MIT */
/* Statuses: pinned values, a sentence each; and the version. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "rlvc/rlvc.h"

static void test_each_status_has_its_sentence(void **state) {
    (void)state;
    const rlvc_status statuses[] = {
        RLVC_OK,         RLVC_E_NULL,      RLVC_E_CONFIG,   RLVC_E_MEMORY,
        RLVC_E_ORDER,    RLVC_E_RANGE,     RLVC_E_REWARD,   RLVC_E_BUSY,
        RLVC_E_CALLBACK, RLVC_E_REENTERED, RLVC_E_STORE,    RLVC_E_EMPTY,
        RLVC_E_DAMAGED,  RLVC_E_VERSION,   RLVC_E_MISMATCH, RLVC_E_PERCEPT};
    const int count = (int)(sizeof statuses / sizeof statuses[0]);
    for (int i = 0; i < count; i++) {
        assert_int_equal(statuses[i], -i);
        assert_true(strlen(rlvc_status_text(statuses[i])) >= 2u);
        for (int j = 0; j < i; j++)
            assert_string_not_equal(rlvc_status_text(statuses[i]), rlvc_status_text(statuses[j]));
    }
    /* All of them: the next number is none. */
    assert_string_equal(rlvc_status_text((rlvc_status)-count), "not a status of rlvc");
}

static void test_no_status(void **state) {
    (void)state;
    const int numbers[] = {1, -1000, 1000};
    for (int i = 0; i < 3; i++)
        assert_string_equal(rlvc_status_text((rlvc_status)numbers[i]), "not a status of rlvc");
}

static void test_version(void **state) {
    (void)state;
    char text[32];
    snprintf(text, sizeof text, "%d.%d.%d", RLVC_VERSION_MAJOR, RLVC_VERSION_MINOR,
             RLVC_VERSION_PATCH);
    assert_string_equal(rlvc_version(), text);
    assert_string_equal(rlvc_version(), RLVC_VERSION);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_each_status_has_its_sentence),
        cmocka_unit_test(test_no_status),
        cmocka_unit_test(test_version),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
