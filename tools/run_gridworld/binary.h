// SPDX-License-Identifier: MIT
// The subcommand `binary`: the Binary Gridworld (section 6.1).
#ifndef RUN_GRIDWORLD_BINARY_H
#define RUN_GRIDWORLD_BINARY_H

// argv[0] is the subcommand. Throws Failure, Interrupted.
void run_binary(int argc, char **argv);

#endif
