// SPDX-License-Identifier: MIT
// Tabular Q-learning and Sarsa, epsilon-greedy, after Watkins (1989) and Rummery and Niranjan
// (1994):
//
//     Q(s, a) := Q(s, a) + alpha (r + gamma Q(s', a') - Q(s, a)),    Q = 0 at first
//
// with the best a' for Q-learning, the one that will be taken for Sarsa, and r alone after the end.
// Of actions that are equally good a random one is taken.
#ifndef RUN_GRIDWORLD_PEERS_TABULAR_H
#define RUN_GRIDWORLD_PEERS_TABULAR_H

#include "peer.h"

#include <optional>

class TabularPeer : public Peer {
  public:
    explicit TabularPeer(const PeerOptions &options);

    uint32_t act(const Seen &seen) override;
    void observe(const Seen &seen, uint32_t action, double reward, const Seen &next,
                 bool over) override;
    uint32_t greedy(const Seen &seen) const override;
    uint64_t states() const override;

  private:
    ActionValues &row(uint32_t state);
    uint32_t choose(uint32_t state);

    PeerOptions options_;
    PeerRandom random_;
    std::vector<ActionValues> q_;
    std::optional<uint32_t> chosen_; // a', by Sarsa, for the state that came last
};

#endif
