/* SPDX-License-Identifier: MIT */
/* Counting the bits of presence columns. */
#ifndef RLVC_SRC_POPCOUNT_H
#define RLVC_SRC_POPCOUNT_H

#include <stdint.h>

#define RLVC_ONES_WORDS 31u /* as many as rlvc_ones takes */

/* How many bits are 1 in `words` <= RLVC_ONES_WORDS words. O(words). */
uint32_t rlvc_ones(const uint64_t *word, uint32_t words);

#endif
