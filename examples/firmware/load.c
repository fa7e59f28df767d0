/* SPDX-License-Identifier: MIT */
/* The load of a control loop: see load.h. */
#include "load.h"

#include "port.h"
#include <stdio.h>

void load_add(struct load *load, uint32_t slice, uint32_t tick) {
    load->slice = slice > load->slice ? slice : load->slice;
    load->tick = tick > load->tick ? tick : load->tick;
    load->overruns += tick > load->tick_limit || slice > load->slice_limit;
}

void load_print(const struct load *load, uint32_t block_bytes) {
    printf("  overruns      %u\n\n", (unsigned)load->overruns);
    printf("On this machine\n  block         %u bytes\n", (unsigned)block_bytes);
    if (port_stack() > 0) {
        printf("  stack         %u bytes\n", (unsigned)port_stack());
        printf("  longest slice %u instructions of %u\n", (unsigned)load->slice,
               (unsigned)load->slice_limit);
        printf("  longest tick  %u instructions of %u\n", (unsigned)load->tick,
               (unsigned)load->tick_limit);
    }
}
