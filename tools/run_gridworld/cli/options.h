// SPDX-License-Identifier: MIT
// The command line of `run_gridworld binary`.
#ifndef RUN_GRIDWORLD_CLI_OPTIONS_H
#define RUN_GRIDWORLD_CLI_OPTIONS_H

#include "learning_options.h"

#include "gridworld.h"

struct Options : LearningOptions {
    uint8_t solver = 0;       // RLVC_SOLVER_*
    uint8_t score = 0;        // RLVC_SCORE_*
    float alpha_known = 0.0f; // 0: see settle()
    int successors = -1;      // negative: see settle()
    float smallest_effect = 0.0f;
    uint32_t capacity = 0; // 0: see settle()
    std::string maze;      // a file; empty: Sutton's maze
    std::string legend;    // signs of the maze; empty: those of its dialect
    float slip = 0.0f;
    uint32_t distractors = 11;
    std::string export_c; // a file; empty: none
};

// Reads the command line; argv[0] is "binary". Returns false if it asked for --help or --version,
// which is printed then. Throws Failure.
bool read_options(int argc, char **argv, Options &options);

// Fills in what was left open, by the criterion and the solver, and checks what depends
// on the maze. Throws Failure.
void settle(Options &options, const gridworld_maze &maze);

const char *solver_name(const Options &options);
const char *score_name(const Options &options);

#endif
