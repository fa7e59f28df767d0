// SPDX-License-Identifier: MIT
// The command line: what the user asked for, and what becomes of what he left open.
#ifndef RUN_GRIDWORLD_OPTIONS_H
#define RUN_GRIDWORLD_OPTIONS_H

#include "gridworld.h"

#include <cstdint>
#include <string>
#include <vector>

struct Options {
    uint8_t solver = 0;    // RLVC_SOLVER_*
    uint8_t criterion = 0; // RLVC_CRITERION_*
    uint8_t score = 0;     // RLVC_SCORE_*
    uint32_t interactions = 0; // returns: of each step; residual: of the whole run. 0: see settle()
    uint32_t steps = 0;        // learning steps; 0: see settle()
    float gamma = 0.9f;
    float epsilon = -1.0f;    // negative: see settle()
    float alpha = 0.0f;       // 0: see settle()
    float alpha_known = 0.0f; // likewise
    int successors = -1;      // negative: likewise
    uint32_t seed = 1;        // of the first run; each further run takes the next number
    uint32_t runs = 0;        // 0: one run, shown in full
    std::string maze;         // a file; empty: Sutton's maze
    float slip = 0.0f;
    uint32_t distractors = 11;
    uint32_t classes = 0;            // 0: see settle()
    uint32_t capacity = 0;           // 0: see settle()
    std::string json, dot, export_c; // files; empty: none
};

// Reads the command line. Throws Failure. What --help and --version ask for is printed here; the
// answer is then false: there is nothing to run.
bool read_options(int argc, char **argv, Options &options);

// Fills in what was left open, after the criterion and the size of the maze; checks what only the
// maze can tell. Throws Failure.
void settle(Options &options, const gridworld_maze &maze);

const char *solver_name(const Options &options);
const char *criterion_name(const Options &options);
const char *score_name(const Options &options);

#endif
