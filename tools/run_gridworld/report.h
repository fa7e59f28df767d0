// SPDX-License-Identifier: MIT
// The report as JSON. REPORT.md gives its form.
#ifndef RUN_GRIDWORLD_REPORT_H
#define RUN_GRIDWORLD_REPORT_H

#include "learner.h"
#include "outcome.h"

#include <string>
#include <vector>

std::string make_report(const Options &options, const gridworld_maze &maze,
                        const std::vector<std::string> &rows, const std::vector<RunResult> &runs);

std::string make_comparison_report(const Options &options, const gridworld_maze &maze,
                                   const std::vector<std::string> &rows,
                                   const std::vector<LearnerRuns> &learners);

#endif
