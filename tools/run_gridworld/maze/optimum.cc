// SPDX-License-Identifier: MIT
#include "optimum.h"

#include "../cli/failure.h"

#include "maze_values.h"

#include <algorithm>
#include <cmath>

namespace {

constexpr double settled = 1e-12; // largest change of the last sweep
constexpr double equal = 1e-9;
constexpr double near_share = 0.01;

} // namespace

Optimum::Optimum(const gridworld_maze &maze, double discount, double slip)
    : q_(std::size_t{maze.width} * maze.height) {
    std::vector<double> v(q_.size());
    if (gridworld_values(&maze, nullptr, discount, slip, settled, v.data()) != 0) {
        throw Failure("--discount: too close to 1: the optimal values of this maze do not settle");
    }
    for (uint32_t cell = 0; cell < q_.size(); cell++) {
        if (maze.cells[cell] == GRIDWORLD_FREE) {
            gridworld_backup(&maze, v.data(), cell, discount, slip, q_[cell].data());
        }
    }
}

double Optimum::value(uint32_t cell) const {
    return *std::max_element(q_[cell].begin(), q_[cell].end());
}

bool Optimum::optimal(uint32_t cell, uint32_t action) const {
    return q(cell, action) >= value(cell) - equal;
}

bool Optimum::near_optimal(uint32_t cell, uint32_t action) const {
    return q(cell, action) >= value(cell) - std::max(equal, near_share * std::fabs(value(cell)));
}
