// SPDX-License-Identifier: MIT
// What the library writes, at the end of a string.
#ifndef RUN_GRIDWORLD_CLI_APPEND_H
#define RUN_GRIDWORLD_CLI_APPEND_H

#include <string>

inline int append(void *string, const char *text, std::size_t bytes) {
    static_cast<std::string *>(string)->append(text, bytes);
    return 0;
}

#endif
