// SPDX-License-Identifier: MIT
#include "learner.h"

#include "check.h"
#include "interrupt.h"

#include "rlvc/rlvc.h"

#include <chrono>
#include <memory>
#include <new>

namespace {

constexpr uint32_t slice = 1u << 20;      // of learning, between two looks at interrupt_signal()
constexpr uint32_t look_every = 1u << 16; // interactions, likewise

rlvc_domain make_domain(const Options &options, const gridworld_maze &maze) {
    rlvc_domain domain;
    check(rlvc_bits_domain(gridworld_bits(&maze, options.distractors), &domain),
          "rlvc_bits_domain");
    return domain;
}

rlvc_config make_config(const Options &options, const rlvc_domain &domain, uint32_t seed) {
    rlvc_config config;
    check(rlvc_config_default(&config, &domain, GRIDWORLD_ACTIONS), "rlvc_config_default");
    config.capacity = options.capacity;
    config.classes = options.classes;
    config.seed = seed;
    config.criterion = options.criterion;
    config.score = options.score;
    if (options.criterion == RLVC_CRITERION_RETURNS) { // as published
        config.continuing = 1;                         // through the teleport
        config.explore = RLVC_EXPLORE_UNIFORM;
    }
    config.solver = options.solver;
    config.discount = options.gamma;
    config.epsilon = options.epsilon;
    config.alpha = options.alpha;
    config.alpha_known = options.alpha_known;
    config.successors = options.successors > 0;
    return config;
}

std::size_t size_of_agent(const rlvc_config &config, const rlvc_domain &domain) {
    const char *why = nullptr;
    std::size_t bytes = 0;
    if (rlvc_config_check(&config, &domain, &why) != RLVC_OK) {
        throw Failure(std::string("impossible options: ") + why);
    }
    check(rlvc_agent_size(&config, &domain, &bytes), "rlvc_agent_size");
    return bytes;
}

// The agent in its block, the world, and the record of what happens.
class Learner {
  public:
    Learner(const Options &options, const gridworld_maze &maze, const Optimum &optimum,
            uint32_t seed);

    void collect(uint64_t count);
    StepRecord learn();
    RunResult result();

  private:
    void interact();
    void look_for_interrupt() const;
    void record(const StepRecord &step);
    std::string print(uint32_t format) const;

    const Options &options_;
    const gridworld_maze &maze_;
    const Optimum &optimum_;
    std::unique_ptr<uint64_t[]> memory_;
    rlvc_agent *agent_ = nullptr; // in memory_
    gridworld world_{};
    std::vector<unsigned char> percept_;
    uint64_t interactions_ = 0;
    RunResult result_;
};

Learner::Learner(const Options &options, const gridworld_maze &maze, const Optimum &optimum,
                 uint32_t seed)
    : options_(options), maze_(maze), optimum_(optimum) {
    const rlvc_domain domain = make_domain(options, maze);
    const rlvc_config config = make_config(options, domain, seed);
    const std::size_t bytes = size_of_agent(config, domain);
    static_assert(alignof(uint64_t) >= RLVC_ALIGNMENT, "the block would not be aligned");
    memory_.reset(new (std::nothrow) uint64_t[bytes / sizeof(uint64_t) + 1]);
    if (!memory_) {
        throw Failure("no memory for an agent of " + std::to_string(bytes) +
                      " bytes: allow fewer with --capacity or --classes");
    }
    check(rlvc_agent_init(&config, &domain, memory_.get(), bytes, &agent_), "rlvc_agent_init");
    if (gridworld_init(&world_, &maze, options.distractors, options.slip, seed) != 0) {
        throw Failure("gridworld_init: an argument is out of range");
    }
    percept_.resize(domain.percept_bytes);
    gridworld_percept(&world_, percept_.data());
    check(rlvc_begin(agent_, percept_.data()), "rlvc_begin");
    result_.seed = seed;
    result_.cells = maze.free_cells;
    result_.memory_bytes = bytes;
}

void Learner::interact() {
    rlvc_choice choice;
    float reward = 0.0f;
    check(rlvc_act(agent_, &choice), "rlvc_act");
    const bool over = gridworld_step(&world_, choice.action, &reward) == 1;
    if (over) {
        check(rlvc_observe(agent_, choice, reward, nullptr, RLVC_TERMINATED), "rlvc_observe");
        gridworld_reset(&world_);
    }
    gridworld_percept(&world_, percept_.data());
    if (over) {
        check(rlvc_begin(agent_, percept_.data()), "rlvc_begin");
    } else {
        check(rlvc_observe(agent_, choice, reward, percept_.data(), RLVC_GOES_ON), "rlvc_observe");
    }
    interactions_++;
}

void Learner::collect(uint64_t count) {
    for (uint64_t i = 0; i < count; i++) {
        if (i % look_every == 0) {
            look_for_interrupt();
        }
        interact();
    }
}

StepRecord Learner::learn() {
    rlvc_progress progress;
    do {
        look_for_interrupt();
        check(rlvc_learn(agent_, slice, &progress), "rlvc_learn");
    } while (!progress.done);
    rlvc_statistics statistics;
    check(rlvc_stats(agent_, &statistics), "rlvc_stats");
    if (statistics.refused > 0) {
        throw Failure("the tree is full: its " + std::to_string(statistics.classes) +
                      " classes did not suffice at step " + std::to_string(result_.history.size()) +
                      " of the run with seed " + std::to_string(result_.seed) +
                      ": allow more with --classes");
    }
    result_.policy = look_up_policy(agent_, maze_, options_.distractors, optimum_);
    StepRecord step;
    step.step = static_cast<uint32_t>(result_.history.size());
    step.interactions = interactions_;
    step.classes = statistics.classes;
    step.splits = progress.splits;
    step.optimal_cells = result_.policy.optimal;
    record(step);
    return step;
}

void Learner::record(const StepRecord &step) {
    result_.history.push_back(step);
    if (!result_.optimal()) {
        result_.interactions_to_optimal.reset();
    } else if (!result_.interactions_to_optimal) {
        result_.interactions_to_optimal = step.interactions;
    }
    if (result_.optimal() && !result_.interactions_to_first_optimal) {
        result_.interactions_to_first_optimal = step.interactions;
    }
}

void Learner::look_for_interrupt() const {
    if (interrupt_signal() != 0) {
        throw Interrupted(std::to_string(interactions_) + " interactions and " +
                          std::to_string(result_.history.size()) + " of " +
                          std::to_string(options_.steps) + " learning steps of the run with seed " +
                          std::to_string(result_.seed));
    }
}

int append(void *ctx, const char *text, std::size_t bytes) {
    static_cast<std::string *>(ctx)->append(text, bytes);
    return 0;
}

std::string Learner::print(uint32_t format) const {
    std::string all;
    check(rlvc_print(agent_, format, append, &all), "rlvc_print");
    return all;
}

RunResult Learner::result() {
    RunResult result = result_;
    rlvc_statistics statistics;
    check(rlvc_stats(agent_, &statistics), "rlvc_stats");
    result.interactions = interactions_;
    result.classes = statistics.classes;
    result.depth = statistics.depth;
    result.last_split_step = statistics.last_split;
    result.bits_used = bits_used(agent_);
    for (const uint32_t bit : result.bits_used) {
        result.distractors_used += is_distractor(maze_, options_.distractors, bit);
    }
    result.tree_json = print(RLVC_PRINT_JSON);
    result.tree_dot = print(RLVC_PRINT_DOT);
    // By returns a step leaves an empty ring, and a policy is made for the percepts in it: those of one more.
    if (options_.criterion == RLVC_CRITERION_RETURNS) {
        collect(options_.interactions);
    }
    result.compaction = compact(agent_, maze_, options_.distractors, optimum_);
    result.fewest = fewest_leaves(maze_, optimum_);
    return result;
}

// How many interactions are there before learning step k.
uint64_t interactions_before(const Options &options, uint32_t k) {
    if (options.criterion == RLVC_CRITERION_RETURNS) {
        return uint64_t{options.interactions} * (uint64_t{k} + 1);
    }
    return uint64_t{options.interactions} * (uint64_t{k} + 1) / options.steps;
}

} // namespace

RunResult learn_maze(const Options &options, const gridworld_maze &maze, const Optimum &optimum,
                     uint32_t seed, const StepListener &listener) {
    using clock = std::chrono::steady_clock;
    const clock::time_point start = clock::now();
    Learner learner(options, maze, optimum, seed);
    uint64_t collected = 0;
    for (uint32_t k = 0; k < options.steps; k++) {
        const uint64_t wanted = interactions_before(options, k);
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
    return size_of_agent(make_config(options, domain, options.seed), domain);
}
