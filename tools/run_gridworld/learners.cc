// SPDX-License-Identifier: MIT
#include "learners.h"

#include "failure.h"

#include "rlvc/rlvc.h"

#include <algorithm>
#include <sstream>

namespace {

LearnerType parse_learner(const std::string &name) {
    for (const LearnerType &type : learner_types()) {
        if (name == type.name) {
            return type;
        }
    }
    throw Failure("--learner: '" + name + "' is none of all, " + learner_names());
}

} // namespace

const std::vector<LearnerType> &learner_types() {
    static const std::vector<LearnerType> types{
        {"value-iteration", LearnerKind::own, RLVC_SOLVER_VALUE_ITERATION},
        {"policy-iteration", LearnerKind::own, RLVC_SOLVER_POLICY_ITERATION},
        {"prioritized-sweeping", LearnerKind::own, RLVC_SOLVER_PRIORITIZED},
        {"q-learning", LearnerKind::own, RLVC_SOLVER_Q_LEARNING},
        {"sarsa", LearnerKind::own, RLVC_SOLVER_SARSA},
        {"fitted-q", LearnerKind::fitted_q, 0},
        {"told-r-max", LearnerKind::told_r_max, 0},
        {"told-value-iteration", LearnerKind::told_value_iteration, 0},
        {"told-q-learning", LearnerKind::told_q_learning, 0},
        {"told-sarsa", LearnerKind::told_sarsa, 0},
        {"raw-q-learning", LearnerKind::raw_q_learning, 0},
    };
    return types;
}

std::string learner_names() {
    std::string names;
    for (const LearnerType &type : learner_types()) {
        names += (names.empty() ? "" : ", ") + std::string(type.name);
    }
    return names;
}

std::vector<LearnerType> parse_learners(const std::string &text) {
    if (text == "all") {
        return learner_types();
    }
    std::vector<LearnerType> learners;
    std::istringstream names(text + ",");
    for (std::string name; std::getline(names, name, ',');) {
        const LearnerType learner = parse_learner(name);
        for (const LearnerType &other : learners) {
            if (name == other.name) {
                throw Failure("--learner: '" + name + "' is named twice");
            }
        }
        learners.push_back(learner);
    }
    return learners;
}
