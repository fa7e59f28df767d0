// SPDX-License-Identifier: MIT
#include "agent.h"

#include "../cli/append.h"

#include <new>

namespace {

constexpr uint32_t slice = 1u << 20; // budget of learning between two calls of `between`

} // namespace

rlvc_config make_config(const LearningOptions &options, const rlvc_domain &domain, uint32_t seed) {
    rlvc_config config;
    check(rlvc_config_default(&config, &domain, GRIDWORLD_ACTIONS), "rlvc_config_default");
    config.seed = seed;
    config.criterion = options.criterion;
    if (options.returns()) {   // as published:
        config.continuing = 1; // the return runs on through the teleport
        config.explore = RLVC_EXPLORE_UNIFORM;
    }
    config.discount = options.discount;
    config.epsilon = options.epsilon;
    config.alpha = options.alpha;
    return config;
}

std::size_t agent_bytes(const rlvc_config &config, const rlvc_domain &domain) {
    const char *why = nullptr;
    std::size_t bytes = 0;
    if (rlvc_config_check(&config, &domain, &why) != RLVC_OK) {
        throw Failure(std::string("impossible options: ") + why);
    }
    check(rlvc_agent_size(&config, &domain, &bytes), "rlvc_agent_size");
    return bytes;
}

uint64_t interactions_until(const LearningOptions &options, uint32_t k) {
    const uint64_t all = uint64_t{options.interactions} * (uint64_t{k} + 1);
    return options.returns() ? all : all / options.steps;
}

Agent::Agent(const rlvc_config &config, const rlvc_domain &domain)
    : bytes_(agent_bytes(config, domain)) {
    static_assert(alignof(uint64_t) >= RLVC_ALIGNMENT, "the block would not be aligned");
    memory_.reset(new (std::nothrow) uint64_t[bytes_ / sizeof(uint64_t) + 1]);
    if (!memory_) {
        throw Failure("no memory for an agent of " + std::to_string(bytes_) +
                      " bytes: use fewer interactions (--capacity, --interactions) or --classes");
    }
    check(rlvc_agent_init(&config, &domain, memory_.get(), bytes_, &agent_), "rlvc_agent_init");
}

uint32_t Agent::learn(const std::function<void()> &between, const std::string &where) {
    rlvc_progress progress;
    do {
        between();
        check(rlvc_learn(agent_, slice, &progress), "rlvc_learn");
    } while (!progress.done);
    const rlvc_statistics now = statistics();
    if (now.refused > 0) {
        throw Failure("the tree is full: it needs more than " + std::to_string(now.classes) +
                      " classes " + where + ": raise --classes");
    }
    return progress.splits;
}

rlvc_statistics Agent::statistics() const {
    rlvc_statistics statistics;
    check(rlvc_stats(agent_, &statistics), "rlvc_stats");
    return statistics;
}

std::string Agent::print(uint32_t format) const {
    std::string all;
    check(rlvc_print(agent_, format, append, &all), "rlvc_print");
    return all;
}
