// SPDX-License-Identifier: MIT
// The words and the JSON of the Tiled Gridworld.
#ifndef RUN_GRIDWORLD_TILED_REPORT_H
#define RUN_GRIDWORLD_TILED_REPORT_H

#include "learning.h"

// Figures 4 and 5 in words: the classes with the objects in each, and the tests with the object and
// the point where each feature was found.
std::string describe_classes(const gridworld_maze &maze, const Gallery &gallery,
                             const TiledRun &run);
std::string describe_tests(const Gallery &gallery, const TiledRun &run);

std::string runs_table_header();
std::string runs_table_row(const TiledRun &run);
std::string runs_table_end(const std::vector<TiledRun> &runs);

// The tree for Graphviz: each test is named after the place of its feature.
std::string make_dot(const Gallery &gallery, const TiledRun &run);

std::string make_tiled_report(const TiledOptions &options, const std::vector<std::string> &rows,
                              const gridworld_maze &maze, const Gallery &gallery,
                              const std::vector<TiledRun> &runs);

#endif
