// SPDX-License-Identifier: MIT
// The JSON report of `run_gridworld binary`. REPORT.md describes it.
#ifndef RUN_GRIDWORLD_REPORT_JSON_H
#define RUN_GRIDWORLD_REPORT_JSON_H

#include "../maze/learner.h"

#include <string>
#include <vector>

std::string make_report(const Options &options, const gridworld_maze &maze,
                        const std::vector<RunResult> &runs);

#endif
