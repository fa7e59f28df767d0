// SPDX-License-Identifier: MIT
// Value iteration on a decision process in a file, for solvers.py.
//
//     bench_solve FILE DISCOUNT TOLERANCE REPEATS START
//
// FILE, of little-endian numbers of 4 bytes: states, actions, transitions; where the transitions of
// each pair begin (states * actions + 1); the mean reward of each pair (float); of each transition
// the state that follows and a count. A state of 2^32 - 1 ends. All values are START at first.
// Prints the median of seconds of processor time, the sweeps, and the values.
extern "C" {
#include "samples/replay.h"
#include "solve/value_iteration.h"
}

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <vector>

namespace {

template <class T> std::vector<T> read(std::ifstream &file, std::size_t count) {
    std::vector<T> items(count);
    file.read(reinterpret_cast<char *>(items.data()),
              static_cast<std::streamsize>(count * sizeof(T)));
    return items;
}

} // namespace

int main(int count, char **arguments) {
    if (count != 6) {
        return 2;
    }
    std::ifstream file(arguments[1], std::ios::binary);
    const std::vector<uint32_t> head = read<uint32_t>(file, 3);
    const std::size_t states = head[0], actions = head[1], transitions = head[2],
                      pairs = states * actions;
    std::vector<uint32_t> begin = read<uint32_t>(file, pairs + 1);
    std::vector<float> reward = read<float>(file, pairs);
    std::vector<rlvc_transition> transition = read<rlvc_transition>(file, transitions);
    for (rlvc_transition &to : transition) {
        to.next = to.next == UINT32_MAX ? RLVC_NO_CLASS : to.next;
    }
    std::vector<float> q(pairs), value(states);
    std::vector<uint32_t> tried(pairs, 1);
    std::vector<uint8_t> policy(states), trial(states);
    rlvc_values values{};
    values.pair.reward = reward.data();
    values.begin.transition = begin.data();
    values.q = q.data();
    values.value = value.data();
    values.tried = tried.data();
    values.policy = policy.data();
    values.trial = trial.data();
    values.actions = static_cast<uint32_t>(actions);
    const rlvc_solver_input input = {transition.data(), static_cast<uint32_t>(states), 1000000,
                                     std::strtof(arguments[2], nullptr),
                                     std::strtof(arguments[3], nullptr)};
    std::vector<double> seconds;
    rlvc_solver_cursor solver{};
    for (int i = 0; i < std::atoi(arguments[4]); i++) {
        std::fill(value.begin(), value.end(), std::strtof(arguments[5], nullptr));
        const std::clock_t start = std::clock();
        rlvc_solver_begin(&solver, RLVC_SOLVER_VALUE_ITERATION);
        while (!solver.done) {
            rlvc_solver_step(&solver, &input, &values, UINT32_MAX);
        }
        seconds.push_back(static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
    }
    std::sort(seconds.begin(), seconds.end());
    std::printf("%.9f %u\n", seconds[seconds.size() / 2], solver.sweeps);
    for (const float v : value) {
        std::printf("%.9g\n", static_cast<double>(v));
    }
    return 0;
}
