// SPDX-License-Identifier: MIT
#include "screen.h"

#include "failure.h"

#include <cerrno>
#include <cstdio>
#include <cstring>

#include <unistd.h>

namespace {

void put(const std::string &text) {
    errno = 0;
    if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size() || std::fflush(stdout)) {
        if (errno == EPIPE) {
            throw ReaderGone("standard output");
        }
        throw Failure(std::string("cannot write to standard output: ") + std::strerror(errno));
    }
}

} // namespace

Screen::Screen() : terminal_(isatty(STDOUT_FILENO) == 1) {
}

Screen::~Screen() {
    try {
        clear();
    } catch (const std::runtime_error &) {
        // print() reports it.
    }
}

void Screen::clear() {
    if (refreshed_) {
        refreshed_ = false;
        put("\r\033[K");
    }
}

void Screen::print(const std::string &text) {
    clear();
    put(text);
}

void Screen::refresh(const std::string &line) {
    put("\r\033[K" + line);
    refreshed_ = true;
}
