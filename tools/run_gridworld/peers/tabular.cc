// SPDX-License-Identifier: MIT
#include "tabular.h"

#include <algorithm>

TabularPeer::TabularPeer(const PeerOptions &options) : options_(options), random_(options.seed) {
}

ActionValues &TabularPeer::row(uint32_t state) {
    if (state >= q_.size()) {
        q_.resize(state + 1, ActionValues{});
    }
    return q_[state];
}

uint32_t TabularPeer::choose(uint32_t state) {
    const ActionValues &q = row(state);
    const auto actions = static_cast<uint32_t>(q.size());
    if (random_.chance(options_.epsilon)) {
        return random_.below(actions);
    }
    const double best = *std::max_element(q.begin(), q.end());
    auto left = random_.below(static_cast<uint32_t>(std::count(q.begin(), q.end(), best)));
    uint32_t action = 0;
    while (q[action] < best || left-- > 0) {
        action++;
    }
    return action;
}

uint32_t TabularPeer::act(const Seen &seen) {
    const uint32_t action = chosen_ ? *chosen_ : choose(seen.state);
    chosen_.reset();
    return action;
}

void TabularPeer::observe(const Seen &seen, uint32_t action, double reward, const Seen &next,
                          bool over) {
    double target = reward;
    if (!over && options_.kind == LearnerKind::told_sarsa) {
        chosen_ = choose(next.state);
        target += options_.discount * row(next.state)[*chosen_];
    } else if (!over) {
        const ActionValues &q = row(next.state);
        target += options_.discount * *std::max_element(q.begin(), q.end());
    }
    double &q = row(seen.state)[action];
    q += options_.learning_rate * (target - q);
}

uint32_t TabularPeer::greedy(const Seen &seen) const {
    if (seen.state >= q_.size()) {
        return 0;
    }
    const ActionValues &q = q_[seen.state];
    return static_cast<uint32_t>(std::max_element(q.begin(), q.end()) - q.begin());
}

uint64_t TabularPeer::states() const {
    return q_.size();
}
