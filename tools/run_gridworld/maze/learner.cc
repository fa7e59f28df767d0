// SPDX-License-Identifier: MIT
#include "learner.h"

#include "../cli/interrupt.h"
#include "agent.h"

#include <chrono>

namespace {

constexpr uint32_t look_every = 1u << 16; // interactions between two looks for an interrupt

rlvc_domain make_domain(const Options &options, const gridworld_maze &maze) {
    rlvc_domain domain;
    check(rlvc_bits_domain(gridworld_bits(&maze, options.distractors), &domain),
          "rlvc_bits_domain");
    return domain;
}

rlvc_config make_config(const Options &options, const rlvc_domain &domain, uint32_t seed) {
    rlvc_config config = ::make_config(static_cast<const LearningOptions &>(options), domain, seed);
    config.capacity = options.capacity;
    config.classes = options.classes;
    config.solver = options.solver;
    config.score = options.score;
    config.alpha_known = options.alpha_known;
    config.successors = options.successors > 0;
    config.smallest_effect = options.smallest_effect;
    return config;
}

// The agent, the world, and the record of the run.
class Learner {
  public:
    Learner(const Options &options, const gridworld_maze &maze, const Optimum &optimum,
            uint32_t seed);

    void collect(uint64_t count);
    StepRecord learn();
    RunResult result();

  private:
    const void *see();
    void look_for_interrupt() const;
    void record(const StepRecord &step);

    const Options &options_;
    const gridworld_maze &maze_;
    const Optimum &optimum_;
    const rlvc_domain domain_;
    Agent agent_;
    gridworld world_{};
    std::vector<unsigned char> percept_;
    uint64_t interactions_ = 0;
    RunResult result_;
};

Learner::Learner(const Options &options, const gridworld_maze &maze, const Optimum &optimum,
                 uint32_t seed)
    : options_(options), maze_(maze), optimum_(optimum), domain_(make_domain(options, maze)),
      agent_(make_config(options, domain_, seed), domain_), percept_(domain_.percept_bytes) {
    if (gridworld_init(&world_, &maze, options.distractors, options.slip, seed) != 0) {
        throw Failure("gridworld_init: an argument is out of range");
    }
    agent_.begin([this] { return see(); });
    result_.seed = seed;
    result_.cells = maze.free_cells;
    result_.memory_bytes = agent_.bytes();
}

const void *Learner::see() {
    gridworld_percept(&world_, percept_.data());
    return percept_.data();
}

void Learner::collect(uint64_t count) {
    for (uint64_t i = 0; i < count; i++) {
        if (i % look_every == 0) {
            look_for_interrupt();
        }
        agent_.interact(world_, [this] { return see(); });
        interactions_++;
    }
}

StepRecord Learner::learn() {
    StepRecord step;
    step.step = static_cast<uint32_t>(result_.history.size());
    step.splits = agent_.learn([this] { look_for_interrupt(); },
                               "at step " + std::to_string(step.step) + " of the run with seed " +
                                   std::to_string(result_.seed));
    result_.policy = look_up_policy(agent_.get(), maze_, options_.distractors, optimum_);
    step.interactions = interactions_;
    step.classes = agent_.statistics().classes;
    step.optimal_cells = result_.policy.optimal;
    record(step);
    return step;
}

void Learner::record(const StepRecord &step) {
    result_.history.push_back(step);
    if (!result_.optimal()) {
        result_.interactions_to_optimal.reset();
        return;
    }
    if (!result_.interactions_to_optimal) {
        result_.interactions_to_optimal = step.interactions;
    }
    if (!result_.interactions_to_first_optimal) {
        result_.interactions_to_first_optimal = step.interactions;
    }
}

void Learner::look_for_interrupt() const {
    if (interrupt_signal() != 0) {
        throw Interrupted(std::to_string(interactions_) + " interactions and " +
                          std::to_string(result_.history.size()) + " of " +
                          std::to_string(options_.steps) + " learning steps of the run with seed " +
                          std::to_string(result_.seed) + "; nothing was written");
    }
}

RunResult Learner::result() {
    RunResult result = result_;
    const rlvc_statistics statistics = agent_.statistics();
    result.interactions = interactions_;
    result.classes = statistics.classes;
    result.depth = statistics.depth;
    result.last_split_step = statistics.last_split;
    result.solution = statistics.solution;
    result.bits_used = bits_used(agent_.get());
    for (const uint32_t bit : result.bits_used) {
        result.distractors_used += is_distractor(maze_, options_.distractors, bit);
    }
    result.tree_json = agent_.print(RLVC_PRINT_JSON);
    result.tree_dot = agent_.print(RLVC_PRINT_DOT);
    // A minimal policy is made for the percepts in memory, and a step by returns leaves none there:
    // collect those of one more step.
    if (options_.returns()) {
        collect(options_.interactions);
    }
    result.compaction = compact(agent_.get(), maze_, options_.distractors, optimum_);
    result.fewest = fewest_leaves(agent_.get(), maze_, optimum_);
    return result;
}

} // namespace

RunResult learn_maze(const Options &options, const gridworld_maze &maze, const Optimum &optimum,
                     uint32_t seed, const StepListener &listener) {
    using clock = std::chrono::steady_clock;
    const clock::time_point start = clock::now();
    Learner learner(options, maze, optimum, seed);
    uint64_t collected = 0;
    for (uint32_t k = 0; k < options.steps; k++) {
        const uint64_t wanted = interactions_until(options, k);
        learner.collect(wanted - collected);
        collected = wanted;
        listener(learner.learn());
    }
    const clock::time_point end = clock::now();
    RunResult result = learner.result();
    result.seconds = std::chrono::duration<double>(end - start).count();
    return result;
}

std::size_t learner_bytes(const Options &options, const gridworld_maze &maze) {
    const rlvc_domain domain = make_domain(options, maze);
    return agent_bytes(make_config(options, domain, options.seed), domain);
}
