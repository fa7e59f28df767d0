// SPDX-License-Identifier: MIT
// The true optimum of a maze: what a learner that knew every cell and every probability would do.
#ifndef RUN_GRIDWORLD_OPTIMUM_H
#define RUN_GRIDWORLD_OPTIMUM_H

#include "gridworld.h"

#include <array>
#include <cstdint>
#include <vector>

// Q*(cell, action), by value iteration over the cells in double precision:
//
//     Q(s, a) = (1 - slip) G(s, a) + slip / 3 * sum of G(s, b) over the directions b other than a
//     G(s, d) = 100 if the neighbour s' in direction d is an exit, else -1 + gamma max over a of
//     Q(s', a)
class Optimum {
  public:
    // Fails if the values have not settled after a bounded number of sweeps, which takes a gamma
    // very close to 1.
    Optimum(const gridworld_maze &maze, double gamma, double slip);

    // Whether an action is worth as much as the best one of that cell, to 1e-9.
    bool optimal(uint32_t cell, uint32_t action) const;

    // Whether it is worth as much to 1 % of the best one's value.
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
