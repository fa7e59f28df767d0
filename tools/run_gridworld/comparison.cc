// SPDX-License-Identifier: MIT
#include "comparison.h"

#include "failure.h"
#include "learner.h"
#include "peers/run.h"
#include "summary.h"

#include <algorithm>

namespace {

constexpr uint32_t fitted_interactions_a_cell = 90, fitted_steps = 40;

Outcome run_own(const Options &options, const gridworld_maze &maze, const Optimum &optimum,
                uint32_t seed, const ProgressListener &listener) {
    const auto show = [&](const StepRecord &step) {
        listener(step.interactions, step.optimal_cells);
    };
    const RunResult run = learn_maze(options, maze, optimum, seed, show);
    Outcome outcome;
    outcome.seed = seed;
    outcome.interactions = run.interactions;
    outcome.interactions_to_optimal = run.interactions_to_optimal;
    outcome.interactions_to_first_optimal = run.interactions_to_first_optimal;
    outcome.optimal_cells = run.policy.optimal;
    outcome.near_optimal_cells = run.policy.near_optimal;
    outcome.states = run.classes;
    outcome.seconds = run.seconds;
    return outcome;
}

Outcome run_learner(const LearnerType &learner, const Options &options, const gridworld_maze &maze,
                    const Optimum &optimum, uint32_t seed, const ProgressListener &listener) {
    try {
        return learner.kind == LearnerKind::own
                   ? run_own(options, maze, optimum, seed, listener)
                   : run_peer(options, maze, optimum, learner.kind, seed, listener);
    } catch (const Interrupted &interrupted) {
        throw Interrupted(std::string(interrupted.what()) + " of " + learner.name);
    } catch (const Failure &failure) {
        throw Failure(std::string(learner.name) + ": " + failure.what());
    }
}

// Fitted Q iteration takes the library's settings, but more interactions, and remembers them all.
void settle_fitted(Options &options, const gridworld_maze &maze) {
    if (options.interactions == 0) {
        options.interactions = fitted_interactions_a_cell * maze.free_cells;
        options.steps = options.steps == 0 ? fitted_steps : options.steps;
    }
    if (options.capacity == 0) {
        options.capacity = options.interactions;
    }
    settle(options, maze);
}

} // namespace

std::vector<Options> settle_each(const Options &options, const gridworld_maze &maze) {
    std::vector<Options> each;
    for (const LearnerType &learner : options.learners) {
        each.push_back(options);
        each.back().learners = {learner};
        if (learner.kind == LearnerKind::own) {
            each.back().solver = learner.solver;
            settle(each.back(), maze);
            learner_bytes(each.back(), maze); // says what is impossible
        } else if (learner.kind == LearnerKind::fitted_q) {
            settle_fitted(each.back(), maze);
            learner_bytes(each.back(), maze);
        } else {
            check_percept(options, maze);
        }
    }
    return each;
}

std::vector<LearnerRuns> compare(const std::vector<Options> &each, const gridworld_maze &maze,
                                 const Optimum &optimum, Screen &screen) {
    std::vector<LearnerRuns> all;
    screen.print(comparison_header());
    for (const Options &options : each) {
        const LearnerType &learner = options.learners.front();
        const uint32_t runs = std::max(options.runs, 1u);
        LearnerRuns made{learner, {}};
        for (uint32_t i = 0; i < runs; i++) {
            const auto show = [&](uint64_t interactions, uint32_t optimal_cells) {
                if (screen.terminal()) {
                    screen.refresh(comparison_line(learner, i, runs, interactions, optimal_cells));
                }
            };
            made.runs.push_back(
                run_learner(learner, options, maze, optimum, options.seed + i, show));
        }
        screen.print(comparison_row(made));
        all.push_back(std::move(made));
    }
    screen.print(comparison_footer());
    return all;
}
