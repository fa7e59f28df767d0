// SPDX-License-Identifier: MIT
// The search for the best split on prepared columns, and beside it the plain sweep.
//
//     sweep/... and search/<N>/<F>/<targets>/<columns>
//
// A unit of work is a table: one feature at one cutpoint. Bytes are those of the columns. The
// search shows how many times as fast as the sweep of the same run it is, and fails if the two
// disagree.
#include "sweep.h"

#include <benchmark/benchmark.h>
#include <cstring>
#include <ctime>
#include <memory>
#include <string>

namespace bench {
namespace {

struct Case {
    uint32_t count;
    uint32_t features;
    Targets targets;
    Columns columns;
    std::shared_ptr<const Prepared> data; // while its two benchmarks run
    double sweep_seconds = 0;
    Winner winner = {};

    std::string name() const {
        return std::to_string(count) + '/' + std::to_string(features) +
               (targets == Targets::few ? "/few" : "/distinct") +
               (columns == Columns::signal ? "/signal" : "/noise");
    }
};

// Of the processor, so that whatever else runs on the machine does not count.
double seconds() {
    return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

void report(benchmark::State &state, const Prepared &data) {
    uint64_t cutpoints = 0;
    for (uint64_t word : data.cuts)
        cutpoints += static_cast<uint64_t>(__builtin_popcountll(word));
    state.SetBytesProcessed(static_cast<int64_t>(state.iterations()) *
                            static_cast<int64_t>(data.bytes()));
    state.counters["a_table"] = benchmark::Counter(static_cast<double>(cutpoints * data.features),
                                                   benchmark::Counter::kIsIterationInvariantRate |
                                                       benchmark::Counter::kInvert);
}

void run_sweep(benchmark::State &state, const std::shared_ptr<Case> &c) {
    c->data = std::make_shared<Prepared>(prepare(c->count, c->features, c->targets, c->columns));
    for (auto _ : state) {
        double start = seconds();
        c->winner = sweep(*c->data);
        c->sweep_seconds = seconds() - start;
    }
    report(state, *c->data);
}

bool same(const Winner &a, const Winner &b) {
    return a.feature == b.feature && std::memcmp(&a.cut, &b.cut, sizeof a.cut) == 0;
}

void run_search(benchmark::State &state, const std::shared_ptr<Case> &c) {
    if (!c->data) {
        state.SkipWithError("runs only after the sweep of the same name");
        return;
    }
    double start = seconds();
    for (auto _ : state) {
        Winner found = search(*c->data);
        if (!same(found, c->winner)) {
            state.SkipWithError("is not the split that the sweep finds");
            return;
        }
    }
    double each = (seconds() - start) / static_cast<double>(state.iterations());
    report(state, *c->data);
    state.counters["times_sweep"] = c->sweep_seconds / each;
    c->data.reset();
}

bool register_all() {
    for (uint32_t count : {100000U, 1000000U})
        for (uint32_t features : {18U, 64U, 1024U})
            for (Targets targets : {Targets::distinct, Targets::few})
                for (Columns columns : {Columns::noise, Columns::signal}) {
                    auto c = std::make_shared<Case>();
                    c->count = count;
                    c->features = features;
                    c->targets = targets;
                    c->columns = columns;
                    benchmark::RegisterBenchmark(("sweep/" + c->name()).c_str(), run_sweep, c)
                        ->Unit(benchmark::kMillisecond)
                        ->Iterations(1);
                    benchmark::RegisterBenchmark(("search/" + c->name()).c_str(), run_search, c)
                        ->Unit(benchmark::kMillisecond)
                        ->Iterations(5);
                }
    return true;
}

const bool registered = register_all();

} // namespace
} // namespace bench
