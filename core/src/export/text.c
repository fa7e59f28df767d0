/* SPDX-License-Identifier: MIT */
/* Strings and numbers as text: see text.h. */
#include "rlvc/float_rules.h"

#include "text.h"

#include "../base/float_math.h"
#include <string.h>

static void put(rlvc_text *text, const char *bytes, size_t count) {
    if (text->status == RLVC_OK && count > 0 && text->write(text->ctx, bytes, count) != 0)
        text->status = RLVC_E_CALLBACK;
}

void rlvc_text_string(rlvc_text *text, const char *string) {
    put(text, string, strlen(string));
}

void rlvc_text_uint(rlvc_text *text, uint32_t number) {
    char digits[10];
    uint32_t at = sizeof digits;
    do {
        digits[--at] = (char)('0' + number % 10u);
        number /= 10u;
    } while (number > 0);
    put(text, digits + at, sizeof digits - at);
}

/* A positive number as mantissa * 2^exponent, with a mantissa of 64 bits, the highest set. */
typedef struct wide {
    uint64_t mantissa;
    int32_t exponent;
} wide;

static void normalize(wide *x) {
    //@ loop unroll 6;
    for (uint32_t shift = 32; shift > 0; shift /= 2u)
        if (x->mantissa < UINT64_C(1) << (64u - shift)) {
            x->mantissa <<= shift;
            x->exponent -= (int32_t)shift;
        }
}

static wide widen(uint32_t bits) {
    wide x;
    uint32_t biased = bits >> 23 & 0xffu;
    x.mantissa = (bits & 0x7fffffu) | (biased > 0 ? 0x800000u : 0u);
    x.exponent = (int32_t)(biased > 0 ? biased : 1u) - 150;
    normalize(&x);
    return x;
}

/* The integer part of x, or the highest number if x is 2^63 or more. */
static uint64_t truncated(const wide *x) {
    if (x->exponent > -1)
        return UINT64_MAX;
    return x->exponent > -64 ? x->mantissa >> -x->exponent : 0;
}

#define EXACT_DIGITS 16u
static const uint64_t exact_low = 1000000000000000u; /* the least number of so many digits */

/* The highest float takes so many divisions by ten, and the lowest so many products, to have them
 * before its point. */
#define DIVISIONS_MAX 23u
#define PRODUCTS_MAX 60u

/* The decimal digits of a positive float: an integer of EXACT_DIGITS digits, of which the first
 * stands for 10^*power. Scaling by ten loses less than 2^-60 a time, so that the result is within
 * 2^-54 of the float, or two units: far nearer than a ninth digit. */
static uint64_t decimal(uint32_t bits, int32_t *power) {
    wide x = widen(bits);
    *power = (int32_t)EXACT_DIGITS - 1;
    //@ loop unroll DIVISIONS_MAX;
    for (uint32_t i = 0; i < DIVISIONS_MAX; i++)
        if (truncated(&x) >= exact_low * 10u) {
            x.mantissa /= 10u;
            normalize(&x);
            (*power)++;
        }
    //@ loop unroll PRODUCTS_MAX;
    for (uint32_t i = 0; i < PRODUCTS_MAX; i++)
        if (truncated(&x) < exact_low) {
            x.mantissa = (x.mantissa >> 4) * 10u;
            x.exponent += 4;
            normalize(&x);
            (*power)--;
        }
    x.exponent++; /* to round by the bit after the point */
    return (truncated(&x) + 1u) / 2u;
}

/* Rounds these digits to the fewest that read back as the float, or to `digits`: returns an integer
 * of *count digits. They read back if they are nearer than half the step to the next float, which
 * is half as long below a power of two. */
static uint64_t fewest(uint64_t exact, uint32_t bits, uint32_t digits, uint32_t *count) {
    const uint32_t fraction = bits & 0x7fffffu;
    const uint32_t mantissa = fraction + (bits >> 23 > 0 ? 0x800000u : 0u);
    const uint64_t half = exact / (fraction > 0 ? 2u * mantissa : 4u * 0x800000u) - 8u;
    uint64_t unit = exact_low * 10u, rounded, off;
    *count = 0;
    //@ loop unroll 9;
    do {
        unit /= 10u;
        (*count)++;
        rounded = (exact + unit / 2u) / unit * unit;
        off = rounded > exact ? rounded - exact : exact - rounded;
    } while (*count < digits && off >= half);
    return rounded / unit;
}

static uint64_t ten_to(uint32_t power) {
    uint64_t ten = 1;
    for (; power > 0; power--)
        ten *= 10u;
    return ten;
}

/* The digits of `whole`, which has `count`, without the zeros at its end; returns their number. */
static uint32_t spell(uint64_t whole, uint32_t count, char *digit) {
    //@ loop unroll 9;
    for (; count > 1 && whole % 10u == 0; whole /= 10u)
        count--;
    //@ loop unroll 9;
    for (uint32_t i = count; i > 0; whole /= 10u)
        digit[--i] = (char)('0' + (int)(whole % 10u));
    return count;
}

static void put_zeros(rlvc_text *text, int32_t count) {
    for (; count > 0; count--)
        put(text, "0", 1);
}

/* 0.00ddd, d.ddd or ddd00, where the decimal point is not far off. */
static void put_fixed(rlvc_text *text, const char *digit, uint32_t count, int32_t power) {
    if (power < 0) {
        put(text, "0.", 2);
        put_zeros(text, -power - 1);
        put(text, digit, count);
        return;
    }
    uint32_t before = (uint32_t)power + 1u;
    uint32_t shown = before < count ? before : count;
    put(text, digit, shown);
    put_zeros(text, (int32_t)(before - shown));
    if (count > before) {
        put(text, ".", 1);
        put(text, digit + before, count - before);
    }
}

void rlvc_text_float(rlvc_text *text, float number, uint32_t digits) {
    uint32_t bits = rlvc_bits_of(number);
    if (!(bits & 0x7fffffffu)) {
        put(text, "0", 1);
        return;
    }
    if (bits & 0x80000000u)
        put(text, "-", 1);
    char digit[9];
    int32_t power = 0;
    uint32_t count;
    uint64_t exact = decimal(bits & 0x7fffffffu, &power);
    uint64_t whole = fewest(exact, bits & 0x7fffffffu, digits, &count);
    if (whole == ten_to(count)) { /* 99.96 is 100 by three digits */
        whole = 1;
        count = 1;
        power++;
    }
    count = spell(whole, count, digit);
    if (power >= -5 && power < 9) {
        put_fixed(text, digit, count, power);
        return;
    }
    put_fixed(text, digit, count, 0);
    put(text, power < 0 ? "e-" : "e+", 2);
    rlvc_text_uint(text, (uint32_t)(power < 0 ? -power : power));
}

/* Room for the characters of a name, the final 0 not counted. */
typedef struct spelling {
    char *text;
    uint32_t room;
    uint32_t count;
} spelling;

static int keep(void *ctx, const char *bytes, size_t count) {
    spelling *kept = (spelling *)ctx;
    for (size_t i = 0; i < count && kept->count < kept->room; i++)
        kept->text[kept->count++] = bytes[i];
    return 0;
}

uint32_t rlvc_spell(float number, uint32_t digits, char *text, uint32_t room) {
    if (text == NULL || room == 0)
        return 0;
    spelling kept = {text, room - 1u, 0};
    rlvc_text to = {keep, &kept, RLVC_OK};
    rlvc_text_float(&to, number, digits);
    text[kept.count] = '\0';
    return kept.count;
}
