// SPDX-License-Identifier: MIT
// Who can learn the maze: the library, by each of its solvers, and tabular peers to compare it
// with.
#ifndef RUN_GRIDWORLD_LEARNERS_H
#define RUN_GRIDWORLD_LEARNERS_H

#include <cstdint>
#include <string>
#include <vector>

enum class LearnerKind {
    own,             // the library; `solver` says by which solver
    fitted_q,        // the library's tree, grown anew again and again
    told_q_learning, // tables over the cells, whose numbers these learners are told
    told_sarsa,
    told_value_iteration,
    told_r_max,
    raw_q_learning, // a table over the percepts as they are, random bits and all
};

struct LearnerType {
    const char *name; // as --learner has it
    LearnerKind kind;
    uint8_t solver; // RLVC_SOLVER_*
};

// In the order in which tables show them; the first one is the default.
const std::vector<LearnerType> &learner_types();

// All names, as a list in words.
std::string learner_names();

// Reads "all", or names with commas between. Throws Failure.
std::vector<LearnerType> parse_learners(const std::string &text);

#endif
