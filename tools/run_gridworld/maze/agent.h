// SPDX-License-Identifier: MIT
// An agent of the library in a block of memory of its own, and how it plays and learns.
#ifndef RUN_GRIDWORLD_MAZE_AGENT_H
#define RUN_GRIDWORLD_MAZE_AGENT_H

#include "../cli/check.h"
#include "../cli/learning_options.h"

#include "gridworld.h"
#include "rlvc/rlvc.h"

#include <cstddef>
#include <functional>
#include <memory>
#include <string>

// The configuration that both subcommands share. Capacity and classes are left to the caller.
rlvc_config make_config(const LearningOptions &options, const rlvc_domain &domain, uint32_t seed);

// Bytes of the agent's block. Throws Failure if the options contradict each other.
std::size_t agent_bytes(const rlvc_config &config, const rlvc_domain &domain);

// Interactions before the end of learning step k (section 4.2.1). By returns each step collects
// fresh interactions; by residuals they are spread evenly over the steps.
uint64_t interactions_until(const LearningOptions &options, uint32_t k);

class Agent {
  public:
    // Throws Failure: impossible options, or no memory.
    Agent(const rlvc_config &config, const rlvc_domain &domain);

    rlvc_agent *get() const {
        return agent_;
    }
    std::size_t bytes() const {
        return bytes_;
    }

    // Starts an episode. `see` returns the percept of the world's current cell.
    template <class See> void begin(const See &see) {
        check(rlvc_begin(agent_, see()), "rlvc_begin");
    }

    // Acts once, and starts a new episode if that ends one.
    template <class See> void interact(gridworld &world, const See &see) {
        rlvc_choice choice;
        float reward = 0.0f;
        check(rlvc_act(agent_, &choice), "rlvc_act");
        const bool over = gridworld_step(&world, choice.action, &reward) == 1;
        if (!over) {
            check(rlvc_observe(agent_, choice, reward, see(), RLVC_GOES_ON), "rlvc_observe");
            return;
        }
        check(rlvc_observe(agent_, choice, reward, nullptr, RLVC_TERMINATED), "rlvc_observe");
        gridworld_reset(&world);
        begin(see);
    }

    // Does a learning step, and calls `between` every few milliseconds. Returns the number of
    // splits. Throws Failure, which `where` ends, if the tree is full.
    uint32_t learn(const std::function<void()> &between, const std::string &where);

    rlvc_statistics statistics() const;
    std::string print(uint32_t format) const; // RLVC_PRINT_*

  private:
    std::size_t bytes_;
    std::unique_ptr<uint64_t[]> memory_;
    rlvc_agent *agent_ = nullptr; // in memory_
};

#endif
