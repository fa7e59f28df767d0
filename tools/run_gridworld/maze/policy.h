// SPDX-License-Identifier: MIT
// The learnt policy in each cell of the maze, compared with the optimum.
#ifndef RUN_GRIDWORLD_MAZE_POLICY_H
#define RUN_GRIDWORLD_MAZE_POLICY_H

#include "optimum.h"

#include "rlvc/rlvc.h"

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

// A cell is looked up with several percepts that differ in their distractors. A member is empty
// where they disagree; the cell counts as the worst of them.
struct CellPolicy {
    std::optional<uint32_t> class_id;
    std::optional<uint32_t> action;
    bool optimal = false;      // by Optimum::optimal
    bool near_optimal = false; // by Optimum::near_optimal
};

struct Policy {
    std::vector<CellPolicy> cells; // by cell; walls and exits have no policy
    uint32_t optimal = 0;          // number of cells
    uint32_t near_optimal = 0;
};

// The class and the action for a percept of a cell.
struct Decision {
    uint32_t class_id;
    uint32_t action;
};

using Decide = std::function<Decision(const unsigned char *percept)>;

Policy look_up_policy(const Decide &decide, const gridworld_maze &maze, uint32_t distractors,
                      const Optimum &optimum);

// The policy of an agent.
Policy look_up_policy(rlvc_agent *agent, const gridworld_maze &maze, uint32_t distractors,
                      const Optimum &optimum);

// The numbers of the bits that the tree tests, ascending.
std::vector<uint32_t> bits_used(const rlvc_agent *agent);

// Whether a bit is neither of x nor of y.
bool is_distractor(const gridworld_maze &maze, uint32_t distractors, uint32_t bit);

#endif
