// SPDX-License-Identifier: MIT
// The options that both subcommands have: how to learn, how often, and where to write.
#ifndef RUN_GRIDWORLD_CLI_LEARNING_OPTIONS_H
#define RUN_GRIDWORLD_CLI_LEARNING_OPTIONS_H

#include <cstdint>
#include <string>

namespace CLI {
class App;
}

struct LearningOptions {
    uint8_t criterion = 0;     // RLVC_CRITERION_*
    uint32_t interactions = 0; // returns: of each step; residual: of the whole run. 0: see Schedule
    uint32_t steps = 0;        // learning steps. 0: see Schedule
    float discount = 0.9f;
    float epsilon = -1.0f; // negative: see Schedule
    float alpha = 0.0f;    // 0: a default of the subcommand
    uint32_t classes = 0;  // likewise
    uint32_t seed = 1;     // of the first run; each further run takes the next number
    uint32_t runs = 0;     // 0: one run, shown in full
    std::string json, dot; // files; empty: none

    bool returns() const;
};

// Defaults of what the user left open.
struct Schedule {
    uint32_t interactions;
    uint32_t steps;
    float epsilon;
};

// What the help says of the options whose defaults differ.
struct LearningTexts {
    const char *interactions, *steps, *epsilon, *alpha, *classes, *runs, *dot;
};

void add_learning_options(CLI::App &app, LearningOptions &options, const LearningTexts &texts);

// Fills in what was left open. Throws Failure if there are more steps than interactions.
void settle_schedule(LearningOptions &options, const Schedule &defaults);

const char *criterion_name(const LearningOptions &options);

#endif
