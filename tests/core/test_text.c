/* SPDX-License-Identifier: MIT */
/* Numbers as text: floats come back bit by bit, from the fewest digits that can; where fewer are
 * asked for these are the nearest ones. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "base/float_math.h"
#include "base/rng.h"
#include "export/text.h"

#define ROOM 128u

typedef struct sink {
    char text[ROOM];
    size_t bytes;
    uint32_t calls;
    uint32_t fail_at; /* call, from 1; 0: none */
} sink;

static int take(void *ctx, const char *text, size_t bytes) {
    sink *s = (sink *)ctx;
    assert_true(bytes > 0 && s->bytes + bytes < ROOM);
    if (++s->calls == s->fail_at)
        return 1;
    memcpy(s->text + s->bytes, text, bytes);
    s->bytes += bytes;
    return 0;
}

static const char *spelled(sink *s, float number, uint32_t digits) {
    memset(s, 0, sizeof *s);
    rlvc_text text = {take, s, RLVC_OK};
    rlvc_text_float(&text, number, digits);
    assert_int_equal(text.status, RLVC_OK);
    return s->text;
}

/* A number in JSON: no sign but -, no leading zero, no bare point. */
static int is_json(const char *text) {
    text += *text == '-';
    size_t whole = strspn(text, "0123456789");
    if (whole == 0 || (whole > 1 && *text == '0'))
        return 0;
    text += whole;
    if (*text == '.') {
        size_t fraction = strspn(text + 1, "0123456789");
        if (fraction == 0 || text[fraction] == '0')
            return 0;
        text += fraction + 1;
    }
    if (*text == 'e')
        return (text[1] == '+' || text[1] == '-') &&
               strspn(text + 2, "0123456789") == strlen(text + 2);
    return *text == '\0';
}

static uint32_t digits_of(const char *text) {
    uint32_t count = 0, zeros = 0, begun = 0;
    for (; *text != '\0' && *text != 'e'; text++) {
        if (*text == '0' && begun)
            zeros++;
        else if (*text >= '1' && *text <= '9') {
            begun = 1;
            count += zeros + 1u;
            zeros = 0;
        }
    }
    return count;
}

/* No fewer digits come back, unless they are at the very edge; but a power of two, to which the
 * next float below is nearer, may get one more. */
static void check_fewest(uint32_t bits, float number, const char *text) {
    const int count = (int)digits_of(text);
    char fewer[ROOM];
    if (count < 2 || (bits & 0x7fffffu) == 0)
        return;
    snprintf(fewer, sizeof fewer, "%.*e", count - 2, (double)number);
    const double off = fabs(strtod(fewer, NULL) - (double)number);
    const double step = fabs((double)rlvc_float_of(bits - 1u) - (double)number);
    if (off < 0.4999999 * step)
        fail_msg("%08x is %s, and %s would do", bits, text, fewer);
}

static void check_round_trip(uint32_t bits) {
    sink s;
    float number = rlvc_float_of(bits);
    if (number - number != 0.0f)
        return;
    const char *text = spelled(&s, number, 9);
    float back = strtof(text, NULL);
    if (!is_json(text) || (back != number))
        fail_msg("%08x is %.9g, not %s", bits, (double)number, text);
    check_fewest(bits, number, text);
    for (uint32_t digits = 1; digits < 9u; digits += 1u + bits % 3u) {
        double printed = strtod(spelled(&s, number, digits), NULL);
        double unit = pow(10.0, floor(log10(fabs((double)number))) - (double)digits + 1.0);
        if (number != 0.0f && (float)printed != number &&
            fabs(printed - (double)number) > 0.5000001 * unit)
            fail_msg("%08x, %.9g, by %u digits is not %s", bits, (double)number, digits, s.text);
    }
}

static void test_round_trips(void **state) {
    (void)state;
    rlvc_rng rng;
    rlvc_rng_seed(&rng, 5);
    for (uint32_t i = 0; i < 100000u; i++)
        check_round_trip(rlvc_rng_next(&rng));
    for (uint32_t exponent = 0; exponent < 255u; exponent++)
        for (uint32_t i = 0; i < 8u; i++) { /* around powers of two */
            check_round_trip((exponent << 23) + i);
            check_round_trip((exponent << 23) - i);
        }
    for (int power = -45; power < 39; power++)
        for (uint32_t i = 0; i < 8u; i++) { /* around powers of ten */
            check_round_trip(rlvc_bits_of((float)pow(10.0, power)) + i);
            check_round_trip(rlvc_bits_of((float)pow(10.0, power)) - i);
        }
}

static void test_known_numbers(void **state) {
    (void)state;
    const struct {
        float number;
        uint32_t digits;
        const char *text;
    } cases[] = {
        {0.0f, 9, "0"},
        {-0.0f, 9, "0"},
        {1.0f, 9, "1"},
        {-1.0f, 1, "-1"},
        {0.1f, 9, "0.1"},
        {0.3f, 9, "0.3"},
        {0.1f + 0.2f, 9, "0.3"},
        {1.0f / 3.0f, 9, "0.33333334"},
        {16777215.0f, 9, "16777215"},
        {16777216.0f, 9, "16777216"},
        {0.1f, 6, "0.1"},
        {100.0f, 4, "100"},
        {123456789.0f, 9, "123456790"},
        {1e9f, 9, "1e+9"},
        {1e12f, 9, "1e+12"},
        {1e12f, 6, "1e+12"},
        {0.5f, 1, "0.5"},
        {0.00001f, 6, "0.00001"},
        {0.000001f, 6, "1e-6"},
        {9.5f, 1, "10"}, /* a half goes up */
        {0.25f, 1, "0.3"},
        {99.96f, 3, "100"}, /* one more digit before the point */
        {1.17549435e-38f, 9, "1.17549435e-38"},
        {1e-45f, 9, "1e-45"},
        {3.40282347e38f, 9, "3.4028235e+38"},
        {-12.5f, 6, "-12.5"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        sink s;
        assert_string_equal(spelled(&s, cases[i].number, cases[i].digits), cases[i].text);
    }
}

static void test_whole_numbers_and_strings(void **state) {
    (void)state;
    const uint32_t numbers[] = {0, 9, 10, 99, 12345, UINT32_MAX};
    for (size_t i = 0; i < sizeof numbers / sizeof numbers[0]; i++) {
        sink s;
        char expected[ROOM];
        memset(&s, 0, sizeof s);
        rlvc_text text = {take, &s, RLVC_OK};
        rlvc_text_string(&text, "n = ");
        rlvc_text_string(&text, "");
        rlvc_text_uint(&text, numbers[i]);
        snprintf(expected, sizeof expected, "n = %u", numbers[i]);
        assert_string_equal(s.text, expected);
        assert_int_equal(s.calls, 2);
    }
}

/* For names: the same digits, as far as there is room. */
static void test_spelling(void **state) {
    const char *const whole = "-12345.679";
    (void)state;
    for (uint32_t room = 1; room < 20u; room++) {
        char text[32];
        memset(text, '#', sizeof text);
        const uint32_t length = rlvc_spell(-12345.6789f, 9, text, room);
        assert_int_equal(length, room - 1u < strlen(whole) ? room - 1u : strlen(whole));
        assert_memory_equal(text, whole, length);
        assert_int_equal(text[length], '\0');
        assert_int_equal(text[length + 1u], '#');
    }
    char one = '#';
    assert_int_equal(rlvc_spell(1.0f, 9, &one, 0), 0);
    assert_int_equal(rlvc_spell(1.0f, 9, NULL, 8), 0);
    assert_int_equal(one, '#');
}

/* The first failure sticks, and nothing is written after it. */
static void test_failure(void **state) {
    (void)state;
    for (uint32_t fail_at = 1; fail_at < 12u; fail_at++) {
        sink s;
        memset(&s, 0, sizeof s);
        s.fail_at = fail_at;
        rlvc_text text = {take, &s, RLVC_OK};
        rlvc_text_float(&text, -1.5e-20f, 9);
        rlvc_text_string(&text, "!");
        assert_int_equal(text.status, s.calls < fail_at ? RLVC_OK : RLVC_E_CALLBACK);
        assert_in_range(s.calls, 1, fail_at);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_round_trips),
        cmocka_unit_test(test_known_numbers),
        cmocka_unit_test(test_whole_numbers_and_strings),
        cmocka_unit_test(test_spelling),
        cmocka_unit_test(test_failure),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
