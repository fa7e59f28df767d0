/* SPDX-License-Identifier: MIT */
/* Presence columns: strings of bits, one for each sample. */
#ifndef RLVC_SRC_POPCOUNT_H
#define RLVC_SRC_POPCOUNT_H

#include <stdint.h>

#define RLVC_POPCOUNT_WORDS 31u /* as many as rlvc_popcount takes */

/* How many bits are 1 in `words` <= RLVC_POPCOUNT_WORDS words. O(words). */
uint32_t rlvc_popcount(const uint64_t *word, uint32_t words);

/* How many bits are 1 in each of `words` words. O(words). */
void rlvc_popcount_each(const uint64_t *word, uint32_t words, uint8_t *count);

/* Makes bit i of a string of bits that is filled from bit 0 up: what is behind i in its word
 * becomes 0 when i is the first of it. O(1). */
void rlvc_bit_append(uint64_t *word, uint32_t i, int bit);

#endif
