// SPDX-License-Identifier: MIT
// What comes before the columns can be searched: sorting the samples by target, and detecting the
// features in that order; and all of it together.
//
//     sort/<N>, detect/<N>/<F>, whole/<N>/<F>
#include "search_stages.h"

#include <benchmark/benchmark.h>

namespace bench {
namespace {

// The time of one of `units` in each iteration.
benchmark::Counter time_of_one(double units) {
    return benchmark::Counter(units, benchmark::Counter::kIsIterationInvariantRate |
                                         benchmark::Counter::kInvert);
}

void report(benchmark::State &state, uint32_t count, uint32_t features, size_t bytes) {
    state.SetBytesProcessed(static_cast<int64_t>(state.iterations()) * static_cast<int64_t>(bytes));
    state.counters["a_sample"] = time_of_one(count);
    if (features > 0)
        state.counters["a_bit"] = time_of_one(static_cast<double>(count) * features);
}

void run_sort(benchmark::State &state) {
    const auto count = static_cast<uint32_t>(state.range(0));
    const std::vector<rlvc_sample> unsorted = samples_of(make_raw(count, 8).target);
    std::vector<rlvc_sample> samples;
    for (auto _ : state) {
        state.PauseTiming();
        samples = unsorted;
        state.ResumeTiming();
        sort(samples);
    }
    report(state, count, 0, samples.size() * sizeof(rlvc_sample));
}

void run_detect(benchmark::State &state) {
    const auto count = static_cast<uint32_t>(state.range(0));
    const auto features = static_cast<uint32_t>(state.range(1));
    const Raw raw = make_raw(count, features);
    std::vector<rlvc_sample> samples = samples_of(raw.target);
    sort(samples);
    const rlvc_samples view = {raw.percepts.data(), samples.data(), raw.percept_bytes, count};
    std::vector<uint64_t> columns;
    rlvc_domain domain;
    rlvc_bits_domain(features, &domain);
    for (auto _ : state)
        for (uint32_t first = 0; first < features; first += RLVC_DETECT_FEATURES)
            detect(domain, view, first, (count + 63) / 64 | 1, columns);
    report(state, count, features, raw.percepts.size());
}

void run_whole(benchmark::State &state) {
    const auto count = static_cast<uint32_t>(state.range(0));
    const auto features = static_cast<uint32_t>(state.range(1));
    const Raw raw = make_raw(count, features);
    for (auto _ : state)
        benchmark::DoNotOptimize(search(raw.target, raw.percepts, raw.percept_bytes, features));
    report(state, count, features, raw.percepts.size() + count * sizeof(rlvc_sample));
}

BENCHMARK(run_sort)->Name("sort")->Unit(benchmark::kMillisecond)->Arg(100000)->Arg(1000000);
BENCHMARK(run_detect)
    ->Name("detect")
    ->Unit(benchmark::kMillisecond)
    ->ArgsProduct({{100000, 1000000}, {18, 64, 1024}});
BENCHMARK(run_whole)
    ->Name("whole")
    ->Unit(benchmark::kMillisecond)
    ->ArgsProduct({{100000, 1000000}, {18, 64, 1024}});

} // namespace
} // namespace bench
