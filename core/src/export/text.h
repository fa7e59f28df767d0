/* SPDX-License-Identifier: MIT */
/* Writing text through a caller's callback, without stdio. After the first failure nothing more is
 * written. */
#ifndef RLVC_SRC_TEXT_H
#define RLVC_SRC_TEXT_H

#include "rlvc/agent.h"

typedef struct rlvc_text {
    rlvc_write write;
    void *ctx;
    rlvc_status status;
} rlvc_text;

/* A string. O(length). */
void rlvc_text_string(rlvc_text *text, const char *string);

/* A whole number in decimal. */
void rlvc_text_uint(rlvc_text *text, uint32_t number);

/* A finite number in decimal, as JSON has it, by the fewest significant digits that read back as
 * the same float, rounded to `digits` (1 to 9) if it takes more; it never takes more than nine. By
 * integers only, so that every target prints the same. O(1): at most 100 divisions. */
void rlvc_text_float(rlvc_text *text, float number, uint32_t digits);

#endif
