// SPDX-License-Identifier: MIT
// Fitted Q iteration (Ernst, Geurts and Wehenkel, 2005) with the library's tree:
//
//     targets  t_i := r_i + gamma max_a Q(class of s'_i, a), r_i alone after the end
//     Q        := a tree grown anew from <s_i, a_i, t_i>, and the means of its classes
//
// ten times at each learning step, from the Q of before. Learning from rewards without a discount
// is the learning of a decision tree (section 7), so that each regression is an agent of the
// library's that is told the target as reward of an episode of one interaction. What differs from
// the library's own way, which solves for the values of all classes and keeps its splits: no split
// lives longer than the targets that it was made for, and values travel one interaction an
// iteration.
#ifndef RUN_GRIDWORLD_PEERS_FITTED_H
#define RUN_GRIDWORLD_PEERS_FITTED_H

#include "../options.h"
#include "peer.h"

#include "rlvc/rlvc.h"

#include <deque>

class FittedPeer : public Peer {
  public:
    // The options are settled as for the library. Throws Failure.
    FittedPeer(const Options &options, const gridworld_maze &maze, uint32_t seed);

    uint32_t act(const Seen &seen) override;
    void observe(const Seen &seen, uint32_t action, double reward, const Seen &next,
                 bool over) override;
    uint32_t greedy(const Seen &seen) const override;
    uint64_t states() const override;

  private:
    using Percept = std::vector<unsigned char>;

    struct Interaction {
        Percept percept;
        uint32_t action;
        float reward;
        Percept next; // empty: the episode was over
    };

    void learn();
    float target_of(const Interaction &interaction) const;
    void fit(const std::vector<float> &targets);

    uint32_t seed_;
    uint64_t learn_every_;
    float discount_, epsilon_;
    PeerRandom random_;
    rlvc_domain domain_;
    rlvc_config config_;
    std::size_t bytes_ = 0;
    std::unique_ptr<uint64_t[]> memory_;
    rlvc_agent *agent_ = nullptr; // in memory_; null before the first regression
    std::deque<Interaction> database_;
    uint64_t interactions_ = 0;
};

#endif
