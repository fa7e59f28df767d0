// SPDX-License-Identifier: MIT
// The subcommand `tiled`: the Tiled Gridworld (section 6.2), if the vision module was built.
#ifndef RUN_GRIDWORLD_TILED_TILED_H
#define RUN_GRIDWORLD_TILED_TILED_H

// argv[0] is the subcommand. Throws Failure, Interrupted.
void run_tiled(int argc, char **argv);

#endif
