// SPDX-License-Identifier: MIT
// SIGINT, SIGTERM and SIGHUP only set a flag. A run checks it between slices of work and throws
// Interrupted, so that unfinished files are removed. SIGPIPE and SIGXFSZ are ignored: the write
// fails instead (ReaderGone; a Failure).
#ifndef RUN_GRIDWORLD_CLI_INTERRUPT_H
#define RUN_GRIDWORLD_CLI_INTERRUPT_H

#include <cstddef>

void watch_for_interrupts();

// The signal that came, or 0.
int interrupt_signal();

// While one lives, a signal also ends a call that waits, such as open() of a pipe that nobody
// reads: it fails with EINTR. Only one lives at a time.
class InterruptibleWait {
  public:
    InterruptibleWait();
    ~InterruptibleWait();
    InterruptibleWait(const InterruptibleWait &) = delete;
    InterruptibleWait &operator=(const InterruptibleWait &) = delete;

    // Throws Interrupted if a signal came.
    static void check();
};

// Once everything is written: throws Interrupted if fewer runs were finished than wanted.
void need_all_runs(std::size_t finished, std::size_t wanted);

#endif
