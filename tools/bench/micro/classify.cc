// SPDX-License-Identifier: MIT
// Classifying percepts of bits with a balanced tree that tests another bit on each level.
//
//     classify/<depth>
#include "core.h"
#include "data.h"

#include <benchmark/benchmark.h>

namespace bench {
namespace {

constexpr uint32_t percepts = 1024;

struct Tree {
    std::vector<uint64_t> block;
    rlvc_tree tree;

    explicit Tree(uint32_t depth) {
        const uint32_t classes = 1U << depth;
        rlvc_arena arena = {nullptr, 0};
        rlvc_tree_carve(&tree, &arena, classes, RLVC_BITS_FEATURE_BYTES);
        block.resize(arena.used / sizeof(uint64_t));
        arena = {reinterpret_cast<unsigned char *>(block.data()), 0};
        rlvc_tree_carve(&tree, &arena, classes, RLVC_BITS_FEATURE_BYTES);
        rlvc_tree_clear(&tree);
        for (uint32_t level = 0; level < depth; level++) {
            const unsigned char feature[RLVC_BITS_FEATURE_BYTES] = {
                static_cast<unsigned char>(level), 0};
            for (uint32_t c = 0, grown = tree.classes; c < grown; c++) {
                const rlvc_split about = {c, 0, 0, 0, 0.0F, 0.0F, 0.0F};
                rlvc_tree_grow(&tree, rlvc_tree_leaf(&tree, c), &about, feature);
            }
        }
    }
};

void run_classify(benchmark::State &state) {
    const auto depth = static_cast<uint32_t>(state.range(0));
    const Tree tree(depth);
    rlvc_domain domain;
    rlvc_bits_domain(32, &domain);
    Random random(1);
    std::vector<uint32_t> percept(percepts);
    for (uint32_t &bits : percept)
        bits = static_cast<uint32_t>(random() >> 32);
    for (auto _ : state) {
        uint32_t sum = 0;
        for (const uint32_t &bits : percept) {
            uint32_t class_id = 0;
            rlvc_tree_classify(&tree.tree, &domain, &bits, &class_id);
            sum += class_id;
        }
        benchmark::DoNotOptimize(sum);
    }
    state.SetBytesProcessed(state.iterations() * percepts * static_cast<int64_t>(sizeof(uint32_t)));
    state.counters["a_percept"] = benchmark::Counter(
        percepts, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
    state.counters["a_test"] =
        benchmark::Counter(percepts * depth, benchmark::Counter::kIsIterationInvariantRate |
                                                 benchmark::Counter::kInvert);
}

BENCHMARK(run_classify)->Name("classify")->Arg(3)->Arg(6)->Arg(12);

} // namespace
} // namespace bench
