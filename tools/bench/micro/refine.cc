// SPDX-License-Identifier: MIT
// Class refinement on percepts of descriptors: one learning step that takes a single class apart.
//
//     refine/<interactions>    a_refinement: the time of the step by the splits that it made
//
// As many made-up objects as Sutton's maze has cells, each of 30 vectors of 16 bytes; every percept
// shows them with noise, without a few. What an action earns depends on the object.
#include "core.h"
#include "data.h"

#include <benchmark/benchmark.h>

#include <cstring>
#include <stdexcept>

namespace bench {
namespace {

constexpr uint32_t objects = 46, points = 30, dimensions = 16, actions = 4;
constexpr int noise = 3;        // of a number, at most
constexpr uint32_t missing = 5; // vectors of an object that a percept does without
constexpr float radius = 24.0F;

void check(rlvc_status status) {
    if (status != RLVC_OK)
        throw std::runtime_error(rlvc_status_text(status));
}

class Objects {
  public:
    explicit Objects(Random &random) : numbers_(objects * points * dimensions) {
        for (int8_t &number : numbers_)
            number = static_cast<int8_t>(static_cast<int>(random() % 101) - 50);
    }

    std::vector<unsigned char> percept(uint32_t object, Random &random) const {
        std::vector<unsigned char> record(
            RLVC_DESCRIPTORS_PERCEPT_BYTES(points, dimensions, RLVC_DESCRIPTORS_INT8));
        const uint32_t count = points - missing;
        std::memcpy(record.data(), &count, sizeof count);
        const auto first = static_cast<uint32_t>(random() % points);
        for (uint32_t i = 0; i < count; i++) {
            const int8_t *from =
                numbers_.data() + (object * points + (first + i) % points) * dimensions;
            for (uint32_t k = 0; k < dimensions; k++) {
                const int moved = from[k] + static_cast<int>(random() % (2 * noise + 1)) - noise;
                record[sizeof count + i * dimensions + k] =
                    static_cast<unsigned char>(static_cast<int8_t>(moved));
            }
        }
        return record;
    }

  private:
    std::vector<int8_t> numbers_;
};

// An agent that has seen `interactions` of them and learnt nothing yet.
struct Learner {
    rlvc_descriptors descriptors;
    rlvc_domain domain;
    rlvc_config config;
    std::vector<uint64_t> block;
    rlvc_agent *agent = nullptr;

    explicit Learner(uint32_t interactions) {
        check(rlvc_descriptors_default(&descriptors, points, dimensions, RLVC_DESCRIPTORS_INT8,
                                       radius));
        check(rlvc_descriptors_domain(&descriptors, &domain));
        check(rlvc_config_default(&config, &domain, actions));
        config.capacity = interactions;
        config.classes = 4 * objects;
        size_t bytes = 0;
        check(rlvc_agent_size(&config, &domain, &bytes));
        block.resize((bytes + 7) / 8);
        check(rlvc_agent_init(&config, &domain, block.data(), bytes, &agent));
        Random random(1);
        const Objects all(random);
        for (uint32_t i = 0; i < interactions; i++) {
            const auto object = static_cast<uint32_t>(random() % objects);
            const rlvc_choice choice = {static_cast<uint8_t>(random() % actions), 0};
            const float reward = static_cast<float>(object * (choice.action + 1U) % objects);
            check(rlvc_begin(agent, all.percept(object, random).data()));
            check(rlvc_observe(agent, choice, reward, nullptr, RLVC_TERMINATED));
        }
    }
};

void run_refine(benchmark::State &state) {
    int64_t splits = 0;
    for (auto _ : state) {
        state.PauseTiming();
        Learner learner(static_cast<uint32_t>(state.range(0)));
        state.ResumeTiming();
        rlvc_progress progress;
        check(rlvc_learn(learner.agent, RLVC_BUDGET_UNBOUNDED, &progress));
        splits += progress.splits;
    }
    state.counters["refinements"] =
        static_cast<double>(splits) / static_cast<double>(state.iterations());
    state.counters["a_refinement"] = benchmark::Counter(
        static_cast<double>(splits), benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

BENCHMARK(run_refine)->Name("refine")->Unit(benchmark::kMillisecond)->Arg(1500)->Arg(4500);

} // namespace
} // namespace bench
