/* SPDX-License-Identifier: MIT */
/* How long slices and ticks take, in instructions, and how often that is too long. Of the examples
 * with a control loop. */
#ifndef FIRMWARE_LOAD_H
#define FIRMWARE_LOAD_H

#include <stdint.h>

struct load {
    uint32_t slice_limit; /* set by whoever makes it; a tick in which either limit is exceeded */
    uint32_t tick_limit;  /* is an overrun */
    uint32_t slice;       /* the most instructions of a slice, */
    uint32_t tick;        /* and of a tick */
    uint32_t overruns;
};

/* Counts a tick, and the slice in it. O(1). */
void load_add(struct load *load, uint32_t slice, uint32_t tick);

/* Prints what the machine was asked for: memory, and instructions where they can be counted. */
void load_print(const struct load *load, uint32_t block_bytes);

#endif
