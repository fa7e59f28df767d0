/* SPDX-License-Identifier: MIT */
/* Exact sums: see exact_sum.h. The integer is in two's complement, lowest word first. */
#include "rlvc/float_rules.h"

#include "exact_sum.h"

#include "float_math.h"

#define WORDS RLVC_EXACT_SUM_WORDS

/* Adds (or subtracts) a word at place `at`, and carries. Beyond the last word a carry is the
 * sign's, and is dropped. */
static void add_word(rlvc_exact_sum *sum, uint32_t at, uint64_t word, int negative) {
    for (uint32_t i = at; i < WORDS && word != 0; i++) {
        uint64_t before = sum->word[i];
        sum->word[i] = negative ? before - word : before + word;
        word = negative ? sum->word[i] > before : sum->word[i] < before;
    }
}

void rlvc_exact_sum_add(rlvc_exact_sum *sum, float x, uint64_t count) {
    if (sum == NULL)
        return;
    uint32_t bits = rlvc_bits_of(x);
    uint32_t exponent = bits >> 23 & 255u;
    uint64_t mantissa = bits & 0x007fffffu;
    if (exponent > 0) {
        mantissa |= 0x00800000u;
        exponent--;
    }
    /* By halves of the count, so that no product is beyond 56 bits, moved by up to 31. */
    for (uint32_t half = 0; half < 2u; half++) {
        uint64_t product = mantissa * (count >> 32u * half & 0xffffffffu);
        uint32_t place = exponent + 32u * half, shift = place % 64u;
        add_word(sum, place / 64u, product << shift, bits >> 31 != 0);
        if (shift != 0)
            add_word(sum, place / 64u + 1u, product >> (64u - shift), bits >> 31 != 0);
    }
}

void rlvc_exact_sum_join(rlvc_exact_sum *sum, const rlvc_exact_sum *other) {
    if (sum == NULL || other == NULL)
        return;
    for (uint32_t i = 0; i < WORDS; i++)
        add_word(sum, i, other->word[i], 0);
}

/* The highest 64 bits that are not 0, the lowest of which also stands for all below; *place is
 * where they begin. */
static uint64_t leading(const rlvc_exact_sum *sum, uint32_t *place) {
    uint32_t top = WORDS - 1u, shift = 0;
    while (top > 0 && sum->word[top] == 0)
        top--;
    uint64_t bits = sum->word[top];
    *place = 64u * top;
    if (top == 0)
        return bits;
    while (bits >> 63 == 0) {
        bits <<= 1;
        shift++;
    }
    uint64_t below = sum->word[top - 1u];
    uint64_t lost = shift == 0 ? below : below << shift;
    bits |= shift == 0 ? 0 : below >> (64u - shift);
    *place -= shift;
    for (uint32_t i = 0; i + 1u < top; i++)
        lost |= sum->word[i];
    return bits | (lost != 0);
}

float rlvc_exact_sum_float(const rlvc_exact_sum *sum) {
    static const rlvc_exact_sum nothing = {{0}};
    rlvc_exact_sum size = *sum;
    int negative = sum->word[WORDS - 1u] >> 63 != 0;
    if (negative) {
        size = nothing;
        for (uint32_t i = 0; i < WORDS; i++)
            add_word(&size, i, sum->word[i], 1);
    }
    uint32_t place;
    uint64_t bits = leading(&size, &place);
    /* Less than 2^24 units a float holds exactly, and what is more is a normal number: no power of
     * two below rounds. */
    float x = (float)bits;
    int32_t e = (int32_t)place - 149;
    for (; e <= -32; e += 32)
        x *= 1.0f / 4294967296.0f;
    for (; e > 0; e--)
        x *= 2.0f;
    for (; e < 0; e++)
        x *= 0.5f;
    return negative ? -x : x;
}
