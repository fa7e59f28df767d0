// SPDX-License-Identifier: MIT
#include "interrupt.h"

#include "failure.h"

#include <csignal>
#include <string>

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

void need_all_runs(std::size_t finished, std::size_t wanted) {
    if (finished < wanted) {
        throw Interrupted(std::to_string(finished) + " of " + std::to_string(wanted) +
                          " runs, which were kept");
    }
}
