// SPDX-License-Identifier: MIT
// What the learnt tree does in each cell of the maze, and how good that is.
#ifndef RUN_GRIDWORLD_POLICY_H
#define RUN_GRIDWORLD_POLICY_H

#include "optimum.h"

#include "rlvc/rlvc.h"

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

// A cell is seen as many percepts, with other distractors each time. What they do not agree upon is
// left empty; a cell is only as good as the worst of them.
struct CellPolicy {
    std::optional<uint32_t> class_id;
    std::optional<uint32_t> action;
    bool optimal = false;      // by Optimum::optimal
    bool near_optimal = false; // by Optimum::near_optimal
};

struct Policy {
    std::vector<CellPolicy> cells; // by cell; walls and exits are left as they are made
    uint32_t optimal = 0;          // number of cells
    uint32_t near_optimal = 0;
};

// What a learner makes of a percept of a cell: its class, or whatever else it tells apart, and action.
struct Decision {
    uint32_t class_id;
    uint32_t action;
};

using Decide = std::function<Decision(uint32_t cell, const unsigned char *percept)>;

Policy look_up_policy(const Decide &decide, const gridworld_maze &maze, uint32_t distractors,
                      const Optimum &optimum);

// That of an agent.
Policy look_up_policy(rlvc_agent *agent, const gridworld_maze &maze, uint32_t distractors,
                      const Optimum &optimum);

// The numbers of the bits that the tree tests, ascending.
std::vector<uint32_t> bits_used(const rlvc_agent *agent);

// Whether a bit is neither of x nor of y.
bool is_distractor(const gridworld_maze &maze, uint32_t distractors, uint32_t bit);

#endif
