// SPDX-License-Identifier: MIT
// SIGINT, SIGTERM and SIGHUP only set a flag, which the run looks at between slices of work: so the
// stack unwinds and unfinished files are removed. SIGPIPE is ignored; the failed write is noticed.
#ifndef RUN_GRIDWORLD_INTERRUPT_H
#define RUN_GRIDWORLD_INTERRUPT_H

void watch_for_interrupts();

// The signal that came, or 0.
int interrupt_signal();

#endif
