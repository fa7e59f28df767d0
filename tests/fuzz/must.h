/* SPDX-License-Identifier: MIT */
/* What must hold in a fuzz target. */
#ifndef RLVC_TESTS_MUST_H
#define RLVC_TESTS_MUST_H

#include <stdio.h>
#include <stdlib.h>

/* Says where before it aborts: inlining hides it from the trace. */
#define must(condition) ((condition) ? (void)0 : wrong(#condition, __FILE__, __LINE__))
static inline void wrong(const char *condition, const char *file, int line) {
    fprintf(stderr, "%s:%d: must hold: %s\n", file, line, condition);
    abort();
}

#endif
