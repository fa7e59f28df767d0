/* SPDX-License-Identifier: MIT */
/* Arrays in the caller's block: sizes, and the zones between them that builds for tests have. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "base/arena.h"

#include <string.h>

static uint64_t block[128];

static void test_sizes(void **state) {
    static const struct {
        uint32_t count, size, rounded;
    } arrays[] = {{0, 4, 0}, {1, 1, 8}, {3, 3, 16}, {4, 4, 16}, {1, 33, 40}};
    rlvc_arena counted = {NULL, 0}, placed = {(unsigned char *)block, 0};
    uint32_t expected = 0;
    (void)state;
    for (size_t i = 0; i < sizeof arrays / sizeof arrays[0]; i++) {
        assert_null(rlvc_arena_carve(&counted, arrays[i].count, arrays[i].size));
        unsigned char *array = rlvc_arena_carve(&placed, arrays[i].count, arrays[i].size);
        assert_ptr_equal(array, (unsigned char *)block + expected);
        memset(array, 1, (size_t)arrays[i].count * arrays[i].size);
        expected += arrays[i].rounded + RLVC_RED_ZONE_BYTES;
        assert_int_equal(counted.used, expected);
        assert_int_equal(placed.used, expected);
    }
    RLVC_UNPOISON(block, sizeof block);
}

static void test_no_size_wraps(void **state) {
    rlvc_arena arena = {NULL, 0};
    (void)state;
    for (uint32_t i = 0; i < 40u; i++)
        (void)rlvc_arena_carve(&arena, (uint64_t)1 << 31, 1u << 20);
    assert_true(arena.used >= (uint64_t)40u << 51);
}

/* Not one byte behind an array may be touched, nor one of what pads it; each byte of it may. */
static void test_zones(void **state) {
    (void)state;
#ifdef RLVC_RED_ZONES
    for (uint32_t bytes = 0; bytes < 40u; bytes++) {
        rlvc_arena arena = {(unsigned char *)block, 0};
        for (uint32_t i = 0; i < 3; i++) {
            unsigned char *array = rlvc_arena_carve(&arena, 1, bytes);
            for (uint32_t k = 0; k < bytes; k++)
                assert_false(__asan_address_is_poisoned(array + k));
            for (unsigned char *at = array + bytes; at < arena.base + arena.used; at++)
                assert_true(__asan_address_is_poisoned(at));
        }
        RLVC_UNPOISON(block, sizeof block);
    }
#else
    skip();
#endif
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_sizes),
        cmocka_unit_test(test_no_size_wraps),
        cmocka_unit_test(test_zones),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
