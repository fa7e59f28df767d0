// SPDX-License-Identifier: MIT
// What became of one run, of any learner.
#ifndef RUN_GRIDWORLD_OUTCOME_H
#define RUN_GRIDWORLD_OUTCOME_H

#include "learners.h"

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

struct Outcome {
    uint32_t seed = 0;
    uint64_t interactions = 0;
    std::optional<uint64_t> interactions_to_optimal;       // all cells from then on to the end
    std::optional<uint64_t> interactions_to_first_optimal; // all cells for the first time
    uint32_t optimal_cells = 0;
    uint32_t near_optimal_cells = 0;
    uint64_t states = 0; // classes of the tree, or rows of the table
    double seconds = 0.0;
};

// The runs of one learner, a seed each.
struct LearnerRuns {
    LearnerType learner;
    std::vector<Outcome> runs;
};

// Called now and then, with how many interactions there were and how many cells are optimal.
using ProgressListener = std::function<void(uint64_t interactions, uint32_t optimal_cells)>;

#endif
