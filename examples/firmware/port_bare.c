/* SPDX-License-Identifier: MIT */
/* Without an operating system, linked by picolibc's script.
 *
 * Arm's MPS2 boards: timer 0 counts down, once in 40 ns. Emulated with an instruction each 64 ns
 * (-icount shift=6), instructions = periods * 40 / 64.
 * RISC-V: minstret counts instructions (-icount shift=0).
 *
 * The stack grows down from __stack to the end of the static data. At the start what is below the
 * stack in use is painted; the lowest place that lost its paint tells the depth. */
#include "port.h"

extern uint32_t __bss_end[], __stack[]; /* of the linker script */

#define PAINT 0x5ac3965bu
#define MARGIN 128u /* bytes below the frame that paints */

#if defined(__arm__)
#define TIMER_CONTROL (*(volatile uint32_t *)0x40000000u)
#define TIMER_VALUE (*(volatile uint32_t *)0x40000004u)
#define TIMER_RELOAD (*(volatile uint32_t *)0x40000008u)

static void begin_count(void) {
    TIMER_RELOAD = UINT32_MAX;
    TIMER_VALUE = UINT32_MAX;
    TIMER_CONTROL = 1u;
}

uint32_t port_instructions(void) {
    static uint32_t before = UINT32_MAX;
    static uint64_t periods;
    uint32_t now = TIMER_VALUE;
    periods += before - now;
    before = now;
    return (uint32_t)(periods * 5u / 8u);
}
#else
static void begin_count(void) {
}

uint32_t port_instructions(void) {
    unsigned long count;
    __asm__ volatile(".option push\n.option arch, +zicsr\ncsrr %0, minstret\n.option pop"
                     : "=r"(count));
    return (uint32_t)count;
}
#endif

void port_begin(void) {
    uint32_t here;
    uintptr_t top = (uintptr_t)&here - MARGIN;
    for (volatile uint32_t *at = __bss_end; (uintptr_t)at < top; at++) {
        *at = PAINT;
    }
    begin_count();
}

uint32_t port_stack(void) {
    const uint32_t *at = __bss_end;
    while (at < __stack && *at == PAINT) {
        at++;
    }
    return (uint32_t)((uintptr_t)__stack - (uintptr_t)at);
}
