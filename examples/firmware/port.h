/* SPDX-License-Identifier: MIT */
/* What depends on the machine: counting instructions, and the depth of the stack. */
#ifndef FIRMWARE_PORT_H
#define FIRMWARE_PORT_H

#include <stdint.h>

/* To be called first. O(stack). */
void port_begin(void);

/* Instructions since some moment, modulo 2^32, whose differences count; always 0 where they cannot
 * be counted. O(1). */
uint32_t port_instructions(void);

/* The most bytes of stack that were in use since port_begin; 0 where that is not known.
 * O(stack). */
uint32_t port_stack(void);

#endif
