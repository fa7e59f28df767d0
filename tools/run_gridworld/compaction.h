// SPDX-License-Identifier: MIT
// How small the learnt policy can be made, and how small any optimal one could be.
#ifndef RUN_GRIDWORLD_COMPACTION_H
#define RUN_GRIDWORLD_COMPACTION_H

#include "policy.h"

#include <cstdint>
#include <string>

// The leaves of the smallest tree over the bits of x and y that acts optimally in every cell. Others
// bits cannot help.
struct Fewest {
    uint32_t leaves = 0;
    bool exact = false; // else there may be a smaller one: the maze is too large to know
};

// Throws Failure: there is no memory.
Fewest fewest_leaves(const gridworld_maze &maze, const Optimum &optimum);

// The agent's policy by itself, made as small as can be (rlvc/policy.h).
struct Compaction {
    rlvc_policy_info info{};
    uint32_t optimal = 0; // cells, by Optimum::optimal, as those of Policy
    uint32_t near_optimal = 0;
    std::string tree_json, policy_c;
};

// Throws Failure: there is no memory.
Compaction compact(rlvc_agent *agent, const gridworld_maze &maze, uint32_t distractors,
                   const Optimum &optimum);

#endif
