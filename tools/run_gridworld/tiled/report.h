// SPDX-License-Identifier: MIT
// The text and the JSON report of the Tiled Gridworld.
#ifndef RUN_GRIDWORLD_TILED_REPORT_H
#define RUN_GRIDWORLD_TILED_REPORT_H

#include "learner.h"

// Figures 4 and 5 as text: the objects in each class, and the object and the point that each test's
// feature comes from.
std::string describe_classes(const gridworld_maze &maze, const Gallery &gallery,
                             const TiledRun &run);
std::string describe_tests(const Gallery &gallery, const TiledRun &run);

std::string runs_table_header();
std::string runs_table_row(const TiledRun &run);
std::string runs_table_end(const std::vector<TiledRun> &runs);

// The tree for Graphviz; each test is named by where its feature comes from.
std::string make_dot(const Gallery &gallery, const TiledRun &run);

std::string make_tiled_report(const TiledOptions &options, const gridworld_maze &maze,
                              const Gallery &gallery, const std::vector<TiledRun> &runs);

#endif
