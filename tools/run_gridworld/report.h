// SPDX-License-Identifier: MIT
// The report as JSON. REPORT.md gives its form.
#ifndef RUN_GRIDWORLD_REPORT_H
#define RUN_GRIDWORLD_REPORT_H

#include "learner.h"

#include <string>
#include <vector>

std::string make_report(const Options &options, const gridworld_maze &maze,
                        const std::vector<std::string> &rows, const std::vector<RunResult> &runs);

#endif
