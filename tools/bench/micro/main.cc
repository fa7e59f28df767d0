// SPDX-License-Identifier: MIT
// All benchmarks; --benchmark_filter=REGEX chooses, --help lists the options. First how fast the
// machine copies, as a measure of the bytes per second of the others.
#include <benchmark/benchmark.h>
#include <cstring>
#include <vector>

namespace {

constexpr size_t copied_bytes = size_t{256} << 20;

void run_copy(benchmark::State &state) {
    std::vector<char> from(copied_bytes, 1);
    std::vector<char> to(copied_bytes, 2);
    for (auto _ : state) {
        std::memcpy(to.data(), from.data(), copied_bytes);
        benchmark::ClobberMemory();
    }
    state.SetBytesProcessed(static_cast<int64_t>(state.iterations()) *
                            static_cast<int64_t>(copied_bytes));
}

BENCHMARK(run_copy)->Name("copy")->Unit(benchmark::kMillisecond);

} // namespace

BENCHMARK_MAIN();
