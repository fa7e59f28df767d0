/* SPDX-License-Identifier: MIT */
/* Counting the bits of presence columns. */
#ifndef RLVC_SRC_POPCOUNT_H
#define RLVC_SRC_POPCOUNT_H

#include <stdint.h>

#define RLVC_POPCOUNT_WORDS 31u /* as many as rlvc_popcount takes */

/* How many bits are 1 in `words` <= RLVC_POPCOUNT_WORDS words. O(words). */
uint32_t rlvc_popcount(const uint64_t *word, uint32_t words);

#endif
