// SPDX-License-Identifier: MIT
#include "json_values.h"

#include "rlvc/rlvc.h"

#include <charconv>
#include <cstdlib>

namespace {

constexpr int report_version = 1;
constexpr const char *action_names[GRIDWORLD_ACTIONS] = {"up", "right", "down", "left"};

} // namespace

double shortest(float value) {
    char text[32];
    *std::to_chars(text, text + sizeof text - 1, value).ptr = '\0';
    return std::strtod(text, nullptr);
}

Json action_name(const std::optional<uint32_t> &action) {
    return action ? Json(action_names[*action]) : Json(nullptr);
}

Json begin_report(const char *subcommand) {
    return {{"version", report_version},
            {"kind", std::string("run_gridworld ") + subcommand},
            {"program", std::string("run_gridworld ") + rlvc_version()}};
}

void add_learning(Json &options, const LearningOptions &from) {
    options["criterion"] = criterion_name(from);
    options["interactions"] = from.interactions;
    options["steps"] = from.steps;
    options["discount"] = shortest(from.discount);
    options["epsilon"] = shortest(from.epsilon);
    options["alpha"] = shortest(from.alpha);
    options["classes"] = from.classes;
    options["seed"] = from.seed;
}

std::string text_of(const Json &report) {
    return report.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}
