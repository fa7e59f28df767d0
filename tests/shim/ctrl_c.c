/* SPDX-License-Identifier: MIT */
/* A trace function for test_interrupts.py: sends SIGINT before the bytecode of a number. It is C,
 * so that the interpreter itself decides where Python's handler runs, and not while the trace
 * function does. */
#include <signal.h>

static long left;

void ctrl_c_arm(long number) {
    left = number;
}

long ctrl_c_left(void) {
    return left;
}

void ctrl_c_trace(void *frame, void *event, void *argument) {
    (void)frame;
    (void)event;
    (void)argument;
    if (--left == 0)
        raise(SIGINT);
}
