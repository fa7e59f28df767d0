// SPDX-License-Identifier: MIT
#include "learning_options.h"

#include "arguments.h"
#include "failure.h"

#include "rlvc/rlvc.h"

#include <algorithm>

namespace {

constexpr uint32_t interactions_max = 2147483647, steps_max = 1000000, runs_max = 1000000;
constexpr uint32_t classes_max = 65535;

const std::vector<Named> criteria{{"residual", RLVC_CRITERION_RESIDUAL},
                                  {"returns", RLVC_CRITERION_RETURNS}};

} // namespace

bool LearningOptions::returns() const {
    return criterion == RLVC_CRITERION_RETURNS;
}

void add_learning_options(CLI::App &app, LearningOptions &options, const LearningTexts &texts) {
    add_named(app, "--criterion", criteria, options.criterion,
              "what splits a class: residual (default), or returns, as published");
    add_whole(app, "--interactions", options.interactions, 1, interactions_max, texts.interactions);
    add_whole(app, "--steps", options.steps, 1, steps_max, texts.steps);
    app.add_option("--discount", options.discount, "discount of future rewards (default 0.9)")
        ->type_name("P")
        ->check(number(0, 1, Interval::open_high));
    app.add_option("--epsilon", options.epsilon, texts.epsilon)
        ->type_name("P")
        ->check(number(0, 1));
    app.add_option("--alpha", options.alpha, texts.alpha)
        ->type_name("P")
        ->check(number(0, 1, Interval::open_low));
    add_whole(app, "--classes", options.classes, 1, classes_max, texts.classes);
    add_whole(app, "--seed", options.seed, 0, UINT32_MAX, "seed of all random numbers (default 1)");
    add_whole(app, "--runs", options.runs, 1, runs_max, texts.runs);
    add_output(app, "--json", options.json, "write a report (see tools/run_gridworld/REPORT.md)");
    add_output(app, "--dot", options.dot, texts.dot);
}

void settle_schedule(LearningOptions &options, const Schedule &defaults) {
    if (options.interactions == 0) {
        options.interactions = defaults.interactions;
    }
    if (!options.returns() && options.steps > options.interactions) {
        throw Failure("--steps: there are only " + std::to_string(options.interactions) +
                      " interactions, and each step needs one");
    }
    if (options.steps == 0) {
        options.steps =
            options.returns() ? defaults.steps : std::min(options.interactions, defaults.steps);
    }
    if (options.epsilon < 0.0f) {
        options.epsilon = defaults.epsilon;
    }
}

const char *criterion_name(const LearningOptions &options) {
    return name_of(criteria, options.criterion);
}
