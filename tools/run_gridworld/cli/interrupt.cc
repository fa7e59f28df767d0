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

// Sets the flag at a signal. With SA_RESTART a call that waits goes on, with 0 it fails with EINTR.
void watch(int flags) {
    struct sigaction action {};
    action.sa_handler = note;
    action.sa_flags = flags;
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
        sigaction(signal, &action, nullptr);
    }
}

} // namespace

void watch_for_interrupts() {
    watch(SA_RESTART);
    for (const int signal : {SIGPIPE, SIGXFSZ}) {
        std::signal(signal, SIG_IGN);
    }
}

int interrupt_signal() {
    return came;
}

InterruptibleWait::InterruptibleWait() {
    watch(0);
}

InterruptibleWait::~InterruptibleWait() {
    watch(SA_RESTART);
}

void InterruptibleWait::check() {
    if (came != 0) {
        throw Interrupted("0 interactions");
    }
}

void need_all_runs(std::size_t finished, std::size_t wanted) {
    if (finished < wanted) {
        throw Interrupted(std::to_string(finished) + " of " + std::to_string(wanted) +
                          " runs, which were kept");
    }
}
