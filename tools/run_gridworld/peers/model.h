// SPDX-License-Identifier: MIT
// Learners of a model: counts of what followed each state and action, and value iteration over
// them,
//
//     Q(s, a) = mean of r + gamma V(s'),    V(s) = max_a Q(s, a) over the actions that count.
//
// The policy in question is that of the actions tried so far. Value iteration alone explores at
// random. R-max (Brafman and Tennenholtz, 2002) plans over other values, V+, by which it acts: a
// pair that is not known, for it was tried fewer than `known` times, is worth 100, the most that a
// return can be here. So it goes where it knows least, and acts optimally once nothing is worth
// finding out.
#ifndef RUN_GRIDWORLD_PEERS_MODEL_H
#define RUN_GRIDWORLD_PEERS_MODEL_H

#include "peer.h"

class ModelPeer : public Peer {
  public:
    explicit ModelPeer(const PeerOptions &options);

    uint32_t act(const Seen &seen) override;
    void observe(const Seen &seen, uint32_t action, double reward, const Seen &next,
                 bool over) override;
    void settle() override;
    uint32_t greedy(const Seen &seen) const override;
    uint64_t states() const override;

  private:
    struct Transition {
        uint32_t next;
        uint32_t count;
    };

    // Of a state and action.
    struct Pair {
        std::vector<Transition> transitions; // but those that ended an episode
        double reward = 0.0;                 // sum
        uint32_t tried = 0;
    };

    using Row = std::array<Pair, 4>;

    double q(const Pair &pair, const std::vector<double> &value) const;
    ActionValues values_of(uint32_t state, bool optimistic) const;
    void solve(std::vector<double> &value, bool optimistic) const;
    uint32_t best_of(uint32_t state, bool optimistic) const;
    void make_room(uint32_t state);

    PeerOptions options_;
    PeerRandom random_;
    std::vector<Row> model_;             // by state
    std::vector<double> value_, bright_; // V, V+
    bool learnt_ = true; // V+ is to be solved for: anew, as a pair has become known, or at first
};

#endif
