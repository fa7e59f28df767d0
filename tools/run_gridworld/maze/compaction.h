// SPDX-License-Identifier: MIT
// The minimal policy: the smallest tree that acts as the agent does; and the smallest optimal tree.
#ifndef RUN_GRIDWORLD_MAZE_COMPACTION_H
#define RUN_GRIDWORLD_MAZE_COMPACTION_H

#include "policy.h"

#include <cstdint>
#include <string>

// Leaves of the smallest tree over the bits of x and y that acts optimally in every cell. No other
// bit can help. It is searched for as long as the agent's policy is.
struct Fewest {
    uint32_t leaves = 0;
    bool exact = false; // if not, the maze is too large to search, and there may be a smaller one
};

// Throws Failure: there is no memory.
Fewest fewest_leaves(const rlvc_agent *agent, const gridworld_maze &maze, const Optimum &optimum);

// The agent's policy as a minimal tree (rlvc/policy.h).
struct Compaction {
    rlvc_policy_info info{};
    uint32_t optimal = 0; // cells, as in Policy
    uint32_t near_optimal = 0;
    std::string tree_json, policy_c;
};

// Throws Failure: there is no memory.
Compaction compact(rlvc_agent *agent, const gridworld_maze &maze, uint32_t distractors,
                   const Optimum &optimum);

#endif
