// SPDX-License-Identifier: MIT
#include "run.h"

#include "../failure.h"
#include "../interrupt.h"
#include "fitted.h"
#include "peer.h"
#include "../policy.h"

#include <algorithm>
#include <chrono>
#include <string>
#include <unordered_map>

namespace {

constexpr uint64_t look_every = 10, looks = 2000;

// Good settings, found by trial on Sutton's maze. Where nothing is left to chance, a model is known
// by one sample of each pair, and Q-learning need not remember what it thought before.
struct Defaults {
    uint32_t interactions_a_cell;
    double epsilon;
    double learning_rate;
};

constexpr double averaging = 0.1;
constexpr uint32_t known_sure = 1, known_slippery = 20; // R-max, without and with slip

Defaults defaults_for(LearnerKind kind) {
    switch (kind) {
    case LearnerKind::told_r_max:
        return {20, 0.0, averaging};
    case LearnerKind::told_value_iteration:
        return {100, 1.0, averaging};
    case LearnerKind::told_q_learning:
        return {500, 0.6, 1.0};
    case LearnerKind::raw_q_learning:
        return {20000, 0.6, 1.0};
    default: // Sarsa: the policy that explores, which it values, must be near the best one
        return {500, 0.3, averaging};
    }
}

PeerOptions options_of(const Options &options, LearnerKind kind, uint32_t seed) {
    const Defaults defaults = defaults_for(kind);
    const bool slippery = options.slip > 0.0f;
    return {kind,
            double{options.gamma},
            options.epsilon < 0.0f ? defaults.epsilon : double{options.epsilon},
            slippery ? averaging : defaults.learning_rate,
            slippery ? known_slippery : known_sure,
            seed};
}

uint64_t interactions_of(const Options &options, const gridworld_maze &maze, LearnerKind kind) {
    if (options.interactions == 0) {
        return uint64_t{defaults_for(kind).interactions_a_cell} * maze.free_cells;
    }
    const bool returns = options.criterion == RLVC_CRITERION_RETURNS;
    return uint64_t{options.interactions} * (returns && options.steps > 0 ? options.steps : 1);
}

std::unique_ptr<Peer> make(const Options &options, const gridworld_maze &maze, LearnerKind kind,
                           uint32_t seed) {
    if (kind == LearnerKind::fitted_q) {
        return std::make_unique<FittedPeer>(options, maze, seed);
    }
    return make_peer(options_of(options, kind, seed));
}

// The numbers of the states, as the peer sees them.
class States {
  public:
    States(bool told, std::size_t percept_bytes) : told_(told), percept_bytes_(percept_bytes) {
    }

    uint32_t number(uint32_t cell, const unsigned char *percept) {
        return told_ ? number_of(cells_, cell) : number_of(percepts_, text(percept));
    }

    // The number, or nothing if the state never came.
    std::optional<uint32_t> find(uint32_t cell, const unsigned char *percept) const {
        return told_ ? find_in(cells_, cell) : find_in(percepts_, text(percept));
    }

  private:
    template <class Key> using Numbers = std::unordered_map<Key, uint32_t>;

    std::string text(const unsigned char *percept) const {
        return std::string(percept, percept + percept_bytes_);
    }

    template <class Key> static uint32_t number_of(Numbers<Key> &numbers, const Key &key) {
        return numbers.emplace(key, static_cast<uint32_t>(numbers.size())).first->second;
    }

    template <class Key>
    static std::optional<uint32_t> find_in(const Numbers<Key> &numbers, const Key &key) {
        const auto found = numbers.find(key);
        return found == numbers.end() ? std::nullopt : std::optional<uint32_t>(found->second);
    }

    bool told_;
    std::size_t percept_bytes_;
    Numbers<uint32_t> cells_;
    Numbers<std::string> percepts_;
};

// The peer, the world, and the record of what happens.
class PeerRun {
  public:
    PeerRun(const Options &options, const gridworld_maze &maze, const Optimum &optimum,
            LearnerKind kind, uint32_t seed);

    void interact();
    void look();
    void look_for_interrupt() const;
    Outcome outcome;

  private:
    Seen see();

    const Options &options_;
    const gridworld_maze &maze_;
    const Optimum &optimum_;
    std::unique_ptr<Peer> peer_;
    States states_;
    gridworld world_{};
    std::vector<unsigned char> percept_, percept_before_;
    Seen seen_; // percept_
};

PeerRun::PeerRun(const Options &options, const gridworld_maze &maze, const Optimum &optimum,
                 LearnerKind kind, uint32_t seed)
    : options_(options), maze_(maze), optimum_(optimum), peer_(make(options, maze, kind, seed)),
      states_(kind != LearnerKind::raw_q_learning,
              GRIDWORLD_PERCEPT_BYTES(gridworld_bits(&maze, options.distractors))),
      percept_(GRIDWORLD_PERCEPT_BYTES(gridworld_bits(&maze, options.distractors))) {
    if (gridworld_init(&world_, &maze, options.distractors, options.slip, seed) != 0) {
        throw Failure("gridworld_init: an argument is out of range");
    }
    percept_before_ = percept_;
    seen_ = see();
    outcome.seed = seed;
}

Seen PeerRun::see() {
    gridworld_percept(&world_, percept_.data());
    return {states_.number(world_.cell, percept_.data()), percept_.data()};
}

void PeerRun::interact() {
    float reward = 0.0f;
    const uint32_t action = peer_->act(seen_);
    const Seen before{seen_.state, percept_before_.data()};
    percept_before_ = percept_;
    const bool over = gridworld_step(&world_, action, &reward) == 1;
    if (over) {
        gridworld_reset(&world_);
    }
    seen_ = see();
    peer_->observe(before, action, double{reward}, seen_, over);
    outcome.interactions++;
}

void PeerRun::look() {
    peer_->settle();
    const auto decide = [this](uint32_t cell, const unsigned char *percept) {
        const uint32_t state = states_.find(cell, percept).value_or(UINT32_MAX);
        return Decision{state, peer_->greedy({state, percept})};
    };
    const Policy policy = look_up_policy(decide, maze_, options_.distractors, optimum_);
    const bool optimal = policy.optimal == maze_.free_cells;
    outcome.optimal_cells = policy.optimal;
    outcome.near_optimal_cells = policy.near_optimal;
    outcome.states = peer_->states();
    if (!optimal) {
        outcome.interactions_to_optimal.reset();
    } else if (!outcome.interactions_to_optimal) {
        outcome.interactions_to_optimal = outcome.interactions;
    }
    if (optimal && !outcome.interactions_to_first_optimal) {
        outcome.interactions_to_first_optimal = outcome.interactions;
    }
}

void PeerRun::look_for_interrupt() const {
    if (interrupt_signal() != 0) {
        throw Interrupted(std::to_string(outcome.interactions) +
                          " interactions of the run with seed " + std::to_string(outcome.seed));
    }
}

} // namespace

Outcome run_peer(const Options &options, const gridworld_maze &maze, const Optimum &optimum,
                 LearnerKind kind, uint32_t seed, const ProgressListener &listener) {
    using clock = std::chrono::steady_clock;
    const clock::time_point start = clock::now();
    const uint64_t all = interactions_of(options, maze, kind);
    const uint64_t every = std::max(look_every, (all + looks - 1) / looks);
    PeerRun run(options, maze, optimum, kind, seed);
    while (run.outcome.interactions < all) {
        const uint64_t until = std::min(all, run.outcome.interactions + every);
        run.look_for_interrupt();
        while (run.outcome.interactions < until) {
            run.interact();
        }
        run.look();
        listener(run.outcome.interactions, run.outcome.optimal_cells);
    }
    run.outcome.seconds = std::chrono::duration<double>(clock::now() - start).count();
    return run.outcome;
}
