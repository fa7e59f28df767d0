// SPDX-License-Identifier: MIT
#include "fitted.h"

#include "../check.h"
#include "../interrupt.h"

namespace {

constexpr uint32_t iterations = 10;

rlvc_config make_config(const Options &options, const rlvc_domain &domain) {
    rlvc_config config;
    check(rlvc_config_default(&config, &domain, GRIDWORLD_ACTIONS), "rlvc_config_default");
    config.capacity = options.capacity;
    config.classes = options.classes;
    config.alpha = options.alpha;
    config.alpha_known = options.alpha_known;
    config.score = options.score;
    config.gate = options.gate;
    config.discount = 0.0f;
    config.successors = 0; // nothing follows
    return config;
}

uint64_t interactions_a_step(const Options &options) {
    return options.criterion == RLVC_CRITERION_RETURNS ? options.interactions
                                                       : options.interactions / options.steps;
}

} // namespace

FittedPeer::FittedPeer(const Options &options, const gridworld_maze &maze, uint32_t seed)
    : seed_(seed), learn_every_(interactions_a_step(options)), discount_(options.gamma),
      epsilon_(options.epsilon), random_(seed) {
    check(rlvc_bits_domain(gridworld_bits(&maze, options.distractors), &domain_),
          "rlvc_bits_domain");
    config_ = make_config(options, domain_);
    check(rlvc_agent_size(&config_, &domain_, &bytes_), "rlvc_agent_size");
    memory_.reset(new uint64_t[bytes_ / sizeof(uint64_t) + 1]);
}

uint32_t FittedPeer::act(const Seen &seen) {
    return random_.chance(double{epsilon_}) ? random_.below(GRIDWORLD_ACTIONS) : greedy(seen);
}

void FittedPeer::observe(const Seen &seen, uint32_t action, double reward, const Seen &next,
                         bool over) {
    const auto copy = [this](const unsigned char *percept) {
        return Percept(percept, percept + domain_.percept_bytes);
    };
    if (database_.size() == config_.capacity) {
        database_.pop_front();
    }
    database_.push_back({copy(seen.percept), action, static_cast<float>(reward),
                         over ? Percept() : copy(next.percept)});
    if (++interactions_ % learn_every_ == 0) {
        learn();
    }
}

void FittedPeer::learn() {
    for (uint32_t i = 0; i < iterations && interrupt_signal() == 0; i++) {
        std::vector<float> targets;
        for (const Interaction &interaction : database_) {
            targets.push_back(target_of(interaction));
        }
        fit(targets);
    }
}

float FittedPeer::target_of(const Interaction &interaction) const {
    float value = 0.0f;
    if (agent_ && !interaction.next.empty()) {
        uint32_t class_id = 0;
        check(rlvc_predict(agent_, interaction.next.data(), &class_id, nullptr), "rlvc_predict");
        check(rlvc_value(agent_, class_id, &value, nullptr), "rlvc_value");
    }
    return interaction.reward + discount_ * value;
}

void FittedPeer::fit(const std::vector<float> &targets) {
    check(rlvc_agent_init(&config_, &domain_, memory_.get(), bytes_, &agent_), "rlvc_agent_init");
    for (std::size_t i = 0; i < targets.size(); i++) {
        const rlvc_choice choice{static_cast<uint8_t>(database_[i].action), 0};
        check(rlvc_begin(agent_, database_[i].percept.data()), "rlvc_begin");
        check(rlvc_observe(agent_, choice, targets[i], nullptr, RLVC_TERMINATED), "rlvc_observe");
    }
    rlvc_progress progress;
    check(rlvc_learn(agent_, RLVC_BUDGET_UNBOUNDED, &progress), "rlvc_learn");
    rlvc_statistics statistics;
    check(rlvc_stats(agent_, &statistics), "rlvc_stats");
    if (statistics.refused > 0) {
        throw Failure("the tree is full: its " + std::to_string(statistics.classes) +
                      " classes did not suffice in the run with seed " + std::to_string(seed_) +
                      ": allow more with --classes");
    }
}

uint32_t FittedPeer::greedy(const Seen &seen) const {
    uint32_t action = 0;
    if (agent_) {
        check(rlvc_predict(agent_, seen.percept, nullptr, &action), "rlvc_predict");
    }
    return action;
}

uint64_t FittedPeer::states() const {
    rlvc_statistics statistics{};
    if (agent_) {
        check(rlvc_stats(agent_, &statistics), "rlvc_stats");
    }
    return statistics.classes;
}
