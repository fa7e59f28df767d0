// SPDX-License-Identifier: MIT
#include "optimum.h"

#include "../cli/failure.h"

#include <algorithm>
#include <cmath>

namespace {

constexpr double exit_reward = 100.0;
constexpr double move_reward = -1.0;
constexpr double settled = 1e-12; // largest change of the last sweep
constexpr int max_sweeps = 100000;
constexpr double equal = 1e-9;
constexpr double near = 0.01;

using Values = std::array<double, GRIDWORLD_ACTIONS>;

Values backup(const gridworld_maze &maze, const std::vector<double> &v, uint32_t cell,
              double discount, double slip) {
    Values gain{};
    double sum = 0.0;
    for (uint32_t d = 0; d < GRIDWORLD_ACTIONS; d++) {
        const uint32_t next = gridworld_neighbour(&maze, cell, d);
        gain[d] =
            maze.cells[next] == GRIDWORLD_EXIT ? exit_reward : move_reward + discount * v[next];
        sum += gain[d];
    }
    Values q{};
    for (uint32_t a = 0; a < GRIDWORLD_ACTIONS; a++) {
        q[a] = (1.0 - slip) * gain[a] + slip / 3.0 * (sum - gain[a]);
    }
    return q;
}

double best(const Values &q) {
    return *std::max_element(q.begin(), q.end());
}

// One sweep in place. The direction alternates, because values spread from the exit to all sides.
double sweep(const gridworld_maze &maze, std::vector<double> &v, double discount, double slip,
             bool backwards) {
    const uint32_t count = maze.width * maze.height;
    double change = 0.0;
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t cell = backwards ? count - 1 - i : i;
        if (maze.cells[cell] == GRIDWORLD_FREE) {
            const double value = best(backup(maze, v, cell, discount, slip));
            change = std::max(change, std::fabs(value - v[cell]));
            v[cell] = value;
        }
    }
    return change;
}

} // namespace

Optimum::Optimum(const gridworld_maze &maze, double discount, double slip)
    : q_(std::size_t{maze.width} * maze.height) {
    std::vector<double> v(q_.size(), 0.0);
    int sweeps = 0;
    while (sweep(maze, v, discount, slip, sweeps % 2 == 1) > settled) {
        if (++sweeps == max_sweeps) {
            throw Failure(
                "--discount: too close to 1: the optimal values of this maze do not settle");
        }
    }
    for (uint32_t cell = 0; cell < q_.size(); cell++) {
        if (maze.cells[cell] == GRIDWORLD_FREE) {
            q_[cell] = backup(maze, v, cell, discount, slip);
        }
    }
}

double Optimum::value(uint32_t cell) const {
    return best(q_[cell]);
}

bool Optimum::optimal(uint32_t cell, uint32_t action) const {
    return q(cell, action) >= value(cell) - equal;
}

bool Optimum::near_optimal(uint32_t cell, uint32_t action) const {
    return q(cell, action) >= value(cell) - std::max(equal, near * std::fabs(value(cell)));
}
