// SPDX-License-Identifier: MIT
// What ends the program early: a failure with its one line for stderr (exit status 2), or a signal.
#ifndef RUN_GRIDWORLD_FAILURE_H
#define RUN_GRIDWORLD_FAILURE_H

#include <stdexcept>
#include <string>

// The message names the thing and the place: "maze.txt:3:7: ...", "--slip: ...".
class Failure : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

// The user's Ctrl-C, or a request to terminate. The message says what was done until then.
class Interrupted : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

#endif
