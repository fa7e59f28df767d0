// SPDX-License-Identifier: MIT
// The maze's directed exploration, in place of the library's even one, for the residual criterion.
#ifndef RUN_GRIDWORLD_EXPLORATION_H
#define RUN_GRIDWORLD_EXPLORATION_H

#include "explorer.h"

#include "rlvc/rlvc.h"

#include <cstdint>
#include <memory>

class Explorer {
  public:
    Explorer(uint32_t classes, uint32_t seed);

    // Puts another action into a choice of rlvc_act that explores; counts the choice.
    void direct(rlvc_agent *agent, const unsigned char *percept, rlvc_choice &choice);

    // To be called after each learning step: the agent then knows the numbers so far itself.
    void forget();

    std::size_t bytes() const;

  private:
    std::unique_ptr<uint8_t[][GRIDWORLD_ACTIONS]> tried_;
    gridworld_explorer explorer_; // its table is tried_
};

#endif
