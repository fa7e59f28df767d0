// SPDX-License-Identifier: MIT
// Value iteration on a made class-level process: 4 transitions a pair to random classes.
//
//     solve/<pairs of a class and an action>
#include "core.h"
#include "data.h"

#include <benchmark/benchmark.h>

namespace bench {
namespace {

constexpr uint32_t transitions_a_pair = 4;

// The tables of the core, filled.
struct Process {
    rlvc_config config = {};
    std::vector<uint64_t> block;
    rlvc_values values;
    std::vector<rlvc_transition> transitions;

    Process(uint32_t classes, uint32_t actions) {
        config.classes = classes;
        config.actions = actions;
        rlvc_arena arena = {nullptr, 0};
        rlvc_values_carve(&values, &arena, &config);
        block.resize(arena.used / sizeof(uint64_t));
        arena = {reinterpret_cast<unsigned char *>(block.data()), 0};
        rlvc_values_carve(&values, &arena, &config);

        Random random(1);
        const uint32_t pairs = classes * actions;
        for (uint32_t pair = 0; pair < pairs; pair++) {
            values.begin.transition[pair] = pair * transitions_a_pair;
            values.tried[pair] = 2 * transitions_a_pair;
            values.pair.reward[pair] = static_cast<float>(random() % 100) - 50;
            for (uint32_t i = 0; i < transitions_a_pair; i++)
                transitions.push_back({static_cast<uint32_t>(random() % classes), 2});
        }
        values.begin.transition[pairs] = pairs * transitions_a_pair;
    }

    // All values from 0; returns the sweeps.
    uint32_t solve() {
        std::fill(values.value, values.value + config.classes, 0.0F);
        const rlvc_solver_input input = {transitions.data(), config.classes, 10000, 0.9F, 0.01F};
        rlvc_solver_cursor solver;
        rlvc_solver_begin(&solver, RLVC_SOLVER_VALUE_ITERATION);
        while (!solver.done)
            rlvc_solver_step(&solver, &input, &values, RLVC_BUDGET_UNBOUNDED);
        return solver.sweeps;
    }
};

void run_solve(benchmark::State &state) {
    const auto pairs = static_cast<uint32_t>(state.range(0));
    const uint32_t actions = pairs > 200000 ? 20 : 4; // there are at most 65,535 classes
    Process process(pairs / actions, actions);
    int64_t sweeps = 0;
    for (auto _ : state)
        sweeps += process.solve();
    const int64_t transitions = sweeps * pairs * transitions_a_pair;
    state.SetBytesProcessed(transitions * static_cast<int64_t>(sizeof(rlvc_transition)));
    state.counters["a_transition"] =
        benchmark::Counter(static_cast<double>(transitions),
                           benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
    state.counters["sweeps"] =
        static_cast<double>(sweeps) / static_cast<double>(state.iterations());
}

BENCHMARK(run_solve)
    ->Name("solve")
    ->Unit(benchmark::kMillisecond)
    ->Arg(1000)
    ->Arg(100000)
    ->Arg(1000000);

} // namespace
} // namespace bench
