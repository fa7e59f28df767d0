// SPDX-License-Identifier: MIT
// What the library is compared with: learners of the textbook. Most have a table over states, which
// are numbers: of a cell, or of a percept, from 0 on in the order of their first coming.
#ifndef RUN_GRIDWORLD_PEERS_PEER_H
#define RUN_GRIDWORLD_PEERS_PEER_H

#include "../learners.h"

#include <array>
#include <cstdint>
#include <memory>
#include <random>
#include <vector>

using ActionValues = std::array<double, 4>; // of the four directions

// What is before a peer's eyes.
struct Seen {
    uint32_t state; // UINT32_MAX: one that never came before
    const unsigned char *percept;
};

class Peer {
  public:
    virtual ~Peer() = default;

    // The action to take next.
    virtual uint32_t act(const Seen &seen) = 0;

    // What came of it. `next` is not looked at if the episode is over.
    virtual void observe(const Seen &seen, uint32_t action, double reward, const Seen &next,
                         bool over) = 0;

    // Makes ready for questions about the policy.
    virtual void settle() {
    }

    // The policy so far; of actions that seem equally good, the lowest.
    virtual uint32_t greedy(const Seen &seen) const = 0;

    // Rows of its table, or classes.
    virtual uint64_t states() const = 0;
};

struct PeerOptions {
    LearnerKind kind;
    double discount;
    double epsilon;       // probability of an action at random
    double learning_rate; // of the tabular ones
    uint32_t known;       // R-max: samples after which a pair is known
    uint32_t seed;
};

// A peer that has a table.
std::unique_ptr<Peer> make_peer(const PeerOptions &options);

// Random numbers that are the same with every standard library.
class PeerRandom {
  public:
    explicit PeerRandom(uint32_t seed) : engine_(seed) {
    }

    bool chance(double probability) {
        return static_cast<double>(engine_()) < probability * 4294967296.0;
    }

    uint32_t below(uint32_t bound) {
        return static_cast<uint32_t>(uint64_t{engine_()} * bound >> 32);
    }

  private:
    std::mt19937 engine_;
};

#endif
