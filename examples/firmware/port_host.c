/* SPDX-License-Identifier: MIT */
/* A workstation, where neither can be measured. */
#include "port.h"

void port_begin(void) {
}

uint32_t port_instructions(void) {
    return 0;
}

uint32_t port_stack(void) {
    return 0;
}
