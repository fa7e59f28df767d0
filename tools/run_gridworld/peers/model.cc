// SPDX-License-Identifier: MIT
#include "model.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace {

constexpr double highest_return = 100.0;
constexpr double settled = 1e-9; // largest change of the last sweep

} // namespace

ModelPeer::ModelPeer(const PeerOptions &options) : options_(options), random_(options.seed) {
}

void ModelPeer::make_room(uint32_t state) {
    if (state >= model_.size()) {
        model_.resize(state + 1);
        value_.resize(state + 1, 0.0);
        bright_.resize(state + 1, highest_return);
    }
}

double ModelPeer::q(const Pair &pair, const std::vector<double> &value) const {
    double sum = pair.reward;
    for (const Transition &transition : pair.transitions) {
        sum += options_.discount * transition.count * value[transition.next];
    }
    return sum / pair.tried;
}

// What does not count is worth minus infinity.
ActionValues ModelPeer::values_of(uint32_t state, bool optimistic) const {
    ActionValues values;
    for (std::size_t a = 0; a < values.size(); a++) {
        const Pair &pair = model_[state][a];
        if (optimistic && pair.tried < options_.known) {
            values[a] = highest_return;
        } else {
            values[a] = pair.tried > 0 ? q(pair, optimistic ? bright_ : value_)
                                       : -std::numeric_limits<double>::infinity();
        }
    }
    return values;
}

// The values of before are a good start: few of them change.
void ModelPeer::solve(std::vector<double> &value, bool optimistic) const {
    double change = 1.0;
    while (change > settled) {
        change = 0.0;
        for (uint32_t state = 0; state < model_.size(); state++) {
            const ActionValues values = values_of(state, optimistic);
            const double best = *std::max_element(values.begin(), values.end());
            if (std::isfinite(best)) {
                change = std::max(change, std::fabs(best - value[state]));
                value[state] = best;
            }
        }
    }
}

uint32_t ModelPeer::best_of(uint32_t state, bool optimistic) const {
    const ActionValues values = values_of(state, optimistic);
    return static_cast<uint32_t>(std::max_element(values.begin(), values.end()) - values.begin());
}

uint32_t ModelPeer::act(const Seen &seen) {
    make_room(seen.state);
    if (random_.chance(options_.epsilon)) {
        return random_.below(4);
    }
    if (options_.kind != LearnerKind::told_r_max) {
        settle();
        return greedy(seen);
    }
    if (learnt_) {
        solve(bright_, true);
        learnt_ = false;
    }
    return best_of(seen.state, true);
}

void ModelPeer::observe(const Seen &seen, uint32_t action, double reward, const Seen &next,
                        bool over) {
    Pair &pair = model_[seen.state][action];
    pair.reward += reward;
    pair.tried++;
    learnt_ = learnt_ || pair.tried == options_.known;
    if (over) {
        return;
    }
    make_room(next.state);
    auto &all = model_[seen.state][action].transitions;
    const auto same = [&next](const Transition &t) { return t.next == next.state; };
    const auto found = std::find_if(all.begin(), all.end(), same);
    if (found == all.end()) {
        all.push_back({next.state, 1});
    } else {
        found->count++;
    }
}

void ModelPeer::settle() {
    solve(value_, false);
}

uint32_t ModelPeer::greedy(const Seen &seen) const {
    return seen.state < model_.size() ? best_of(seen.state, false) : 0;
}

uint64_t ModelPeer::states() const {
    return model_.size();
}
