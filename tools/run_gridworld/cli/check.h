// SPDX-License-Identifier: MIT
// For statuses of the library that no input of the user can cause.
#ifndef RUN_GRIDWORLD_CLI_CHECK_H
#define RUN_GRIDWORLD_CLI_CHECK_H

#include "failure.h"

#include "rlvc/status.h"

inline void check(rlvc_status status, const char *function) {
    if (status != RLVC_OK) {
        throw Failure(std::string(function) + ": " + rlvc_status_text(status));
    }
}

#endif
