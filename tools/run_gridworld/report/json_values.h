// SPDX-License-Identifier: MIT
// What the JSON reports of both subcommands share.
#ifndef RUN_GRIDWORLD_REPORT_JSON_VALUES_H
#define RUN_GRIDWORLD_REPORT_JSON_VALUES_H

#include "../cli/learning_options.h"

#include "gridworld.h"

#include <nlohmann/json.hpp>

#include <optional>
#include <string>

using Json = nlohmann::ordered_json; // members keep the order of REPORT.md

// The shortest decimal that stands for a binary32: 0.9, not 0.899999976.
double shortest(float value);

template <class T> Json or_null(const std::optional<T> &value) {
    return value ? Json(*value) : Json(nullptr);
}

// "up", "right", "down" or "left".
Json action_name(const std::optional<uint32_t> &action);

// The members that begin a report: version, kind, program.
Json begin_report(const char *subcommand);

// The members of `options` that both subcommands have.
void add_learning(Json &options, const LearningOptions &from);

// The text of a report. Bytes that are not UTF-8, as a file name may have, are replaced.
std::string text_of(const Json &report);

#endif
