/* SPDX-License-Identifier: MIT */
/* Each word's bits are counted in its own eight bytes, all at once: in pairs of bits, in fours, in
 * eights. A byte of the sum over 31 words is at most 31 * 8 = 248 and does not overflow. This form
 * needs neither an instruction nor a library function for it, and compilers make vector code of it;
 * for that they want the loop in a function by itself, hence the file by itself. */
#include "rlvc/float_rules.h"

#include "popcount.h"

#include "assert.h"

uint32_t rlvc_popcount(const uint64_t *word, uint32_t words) {
    const uint64_t pairs = 0x5555555555555555u;
    const uint64_t fours = 0x3333333333333333u;
    const uint64_t eights = 0x0f0f0f0f0f0f0f0fu;
    const uint64_t halves = 0x00ff00ff00ff00ffu;
    uint64_t sum = 0;
    RLVC_ASSERT(words <= RLVC_POPCOUNT_WORDS);
    for (uint32_t i = 0; i < words; i++) {
        uint64_t v = word[i];
        v -= (v >> 1) & pairs;
        v = (v & fours) + ((v >> 2) & fours);
        sum += (v + (v >> 4)) & eights;
    }
    sum = (sum & halves) + ((sum >> 8) & halves);
    return (uint32_t)((sum * 0x0001000100010001u) >> 48);
}

void rlvc_popcount_each(const uint64_t *word, uint32_t words, uint8_t *count) {
    const uint64_t pairs = 0x5555555555555555u;
    const uint64_t fours = 0x3333333333333333u;
    const uint64_t eights = 0x0f0f0f0f0f0f0f0fu;
    for (uint32_t i = 0; i < words; i++) {
        uint64_t v = word[i];
        v -= (v >> 1) & pairs;
        v = (v & fours) + ((v >> 2) & fours);
        v = (v + (v >> 4)) & eights;
        v += v >> 8;
        v += v >> 16;
        v += v >> 32;
        count[i] = (uint8_t)(v & 127u);
    }
}

void rlvc_bit_append(uint64_t *word, uint32_t i, int bit) {
    uint64_t before = i % 64u == 0 ? 0 : word[i / 64u];
    word[i / 64u] = before | (uint64_t)(bit != 0) << i % 64u;
}
