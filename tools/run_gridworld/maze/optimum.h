// SPDX-License-Identifier: MIT
// The optimal policy of a maze, from full knowledge of its cells and probabilities.
#ifndef RUN_GRIDWORLD_MAZE_OPTIMUM_H
#define RUN_GRIDWORLD_MAZE_OPTIMUM_H

#include "gridworld.h"

#include <array>
#include <cstdint>
#include <vector>

// Q*(cell, action), by value iteration over the cells: maze_values.h has the formula.
class Optimum {
  public:
    // Throws Failure if the values do not settle, as for a discount very close to 1.
    Optimum(const gridworld_maze &maze, double discount, double slip);

    // Whether the value of an action is within 1e-9 of that of the best one in the cell.
    bool optimal(uint32_t cell, uint32_t action) const;

    // Whether it is within 1 % of that of the best one.
    bool near_optimal(uint32_t cell, uint32_t action) const;

    double q(uint32_t cell, uint32_t action) const {
        return q_[cell][action];
    }

    double value(uint32_t cell) const;

  private:
    using Row = std::array<double, GRIDWORLD_ACTIONS>;

    std::vector<Row> q_; // by cell; 0 for walls and exits
};

#endif
