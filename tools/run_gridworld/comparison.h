// SPDX-License-Identifier: MIT
// Several learners on one maze, with the same seeds, and the table of how soon each is optimal.
#ifndef RUN_GRIDWORLD_COMPARISON_H
#define RUN_GRIDWORLD_COMPARISON_H

#include "optimum.h"
#include "options.h"
#include "outcome.h"
#include "screen.h"

#include <string>
#include <vector>

// The options of each of options.learners in turn: what is left open is settled for it alone.
// Throws Failure.
std::vector<Options> settle_each(const Options &options, const gridworld_maze &maze);

// Lets each learner learn, options.runs times, and prints a row of it when it is done. Throws
// Failure, Interrupted.
std::vector<LearnerRuns> compare(const std::vector<Options> &each, const gridworld_maze &maze,
                                 const Optimum &optimum, Screen &screen);

#endif
