// SPDX-License-Identifier: MIT
// What ends the program early: a failure, a closed pipe or a signal.
#ifndef RUN_GRIDWORLD_CLI_FAILURE_H
#define RUN_GRIDWORLD_CLI_FAILURE_H

#include <stdexcept>
#include <string>

// One line on stderr, exit status 2. It begins with what is wrong, and where: "maze.txt:3:7: ...",
// "--slip: ...".
class Failure : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

// Whoever reads standard output has gone, as after `| head`: no message.
class ReaderGone : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

// Ctrl-C, or another signal to terminate. The message says how much was done, and what is kept of
// it.
class Interrupted : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

#endif
