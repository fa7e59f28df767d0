/* SPDX-License-Identifier: MIT */
/* Agents whose policies are exported: learnt anew, alike, by the program that exports and by the one that
 * checks. */
#ifndef RLVC_TESTS_EXPORT_CASES_H
#define RLVC_TESTS_EXPORT_CASES_H

#include "rlvc/rlvc.h"

/* maze    Sutton's maze: 18 bits, a table of actions
 * single  nothing to learn: one class
 * bytes   40 bits, of which many matter: a table of nodes in bytes
 * wide    300 bits: a table of nodes in words
 * many    so many leaves that the table of nodes is in words */
#define CASE_NAMES {"maze", "single", "bytes", "wide", "many"}
#define CASES 5u

typedef struct learnt {
    rlvc_agent *agent;
    uint32_t bits;
} learnt;

/* Learns case i; the memory is static, so that the last case learnt is the one there is. Ends the program
 * with a message if anything fails. */
learnt learn_case(uint32_t i);

#endif
