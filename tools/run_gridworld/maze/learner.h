// SPDX-License-Identifier: MIT
// One run of the Binary Gridworld: an agent learns the maze step by step (section 4.2.1).
//
//     returns:   each step collects fresh interactions and learns from these alone
//     residual:  each step learns from all interactions that the memory still holds
#ifndef RUN_GRIDWORLD_MAZE_LEARNER_H
#define RUN_GRIDWORLD_MAZE_LEARNER_H

#include "../cli/options.h"
#include "compaction.h"
#include "optimum.h"
#include "policy.h"

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

// The state after a learning step.
struct StepRecord {
    uint32_t step = 0; // k
    uint64_t interactions = 0;
    uint32_t classes = 1;
    uint32_t splits = 0; // made in this step
    uint32_t optimal_cells = 0;
};

struct RunResult {
    uint32_t seed = 0;
    uint32_t cells = 0;
    uint64_t interactions = 0;
    std::optional<uint64_t> interactions_to_optimal;       // until all cells stayed optimal
    std::optional<uint64_t> interactions_to_first_optimal; // until all cells first were
    uint32_t classes = 1;
    uint32_t depth = 0;
    std::vector<uint32_t> bits_used;
    uint32_t distractors_used = 0; // of these bits
    uint32_t last_split_step = 0;
    uint32_t solution = RLVC_SOLUTION_CONVERGED;
    std::size_t memory_bytes = 0;
    double seconds = 0.0;
    Policy policy;
    Compaction compaction;
    Fewest fewest; // of any optimal policy
    std::string tree_json, tree_dot;
    std::vector<StepRecord> history;

    bool optimal() const {
        return policy.optimal == cells;
    }
};

using StepListener = std::function<void(const StepRecord &)>;

// Throws Failure: the tree is full, or there is no memory; Interrupted.
RunResult learn_maze(const Options &options, const gridworld_maze &maze, const Optimum &optimum,
                     uint32_t seed, const StepListener &listener);

// The memory that an agent with these options needs. Throws Failure.
std::size_t learner_bytes(const Options &options, const gridworld_maze &maze);

#endif
