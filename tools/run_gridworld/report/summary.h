// SPDX-License-Identifier: MIT
// The text and the tables around the pictures.
#ifndef RUN_GRIDWORLD_REPORT_SUMMARY_H
#define RUN_GRIDWORLD_REPORT_SUMMARY_H

#include "../maze/learner.h"

#include <string>
#include <vector>

// The task, the method and the memory; printed before learning.
std::string describe_task(const Options &options, const gridworld_maze &maze);

// The table of one run's learning steps, for a pipe; and the newest step as one line, for a
// terminal.
std::string steps_header();
std::string step_row(const StepRecord &step, uint32_t cells);
std::string step_line(const StepRecord &step, uint32_t cells, uint32_t steps);

// The results of a single run.
std::string describe_run(const Options &options, const gridworld_maze &maze, const RunResult &run);

// The table of several runs: a row for each, and a summary.
std::string runs_header();
std::string run_row(const RunResult &run);
std::string describe_runs(const Options &options, const gridworld_maze &maze,
                          const std::vector<RunResult> &runs);

#endif
