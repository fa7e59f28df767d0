// SPDX-License-Identifier: MIT
#include "interrupt.h"

#include <csignal>

namespace {

volatile std::sig_atomic_t came = 0;

void note(int signal) {
    came = signal;
}

} // namespace

void watch_for_interrupts() {
    std::signal(SIGINT, note);
    std::signal(SIGTERM, note);
    std::signal(SIGHUP, note);
    std::signal(SIGPIPE, SIG_IGN);
}

int interrupt_signal() {
    return came;
}
