// SPDX-License-Identifier: MIT
#include "json.h"

#include "../maze/maze_file.h"
#include "json_values.h"

namespace {

Json bit_range(uint32_t first, uint32_t count) {
    Json bits = Json::array();
    for (uint32_t i = 0; i < count; i++) {
        bits.push_back(first + i);
    }
    return bits;
}

Json describe_options(const Options &options) {
    Json json;
    json["solver"] = solver_name(options);
    json["score"] = score_name(options);
    add_learning(json, options);
    json["alpha_known"] = shortest(options.alpha_known);
    json["smallest_effect"] = shortest(options.smallest_effect);
    json["successors"] = options.successors > 0 ? "yes" : "no";
    json["capacity"] = options.capacity;
    json["maze"] = options.maze.empty() ? Json(nullptr) : Json(options.maze);
    json["slip"] = shortest(options.slip);
    json["distractors"] = options.distractors;
    return json;
}

// One value for each cell, in rows.
template <class Value> Json by_cell(const gridworld_maze &maze, const Policy &policy, Value value) {
    Json rows = Json::array();
    for (uint32_t y = 0; y < maze.height; y++) {
        Json row = Json::array();
        for (uint32_t x = 0; x < maze.width; x++) {
            row.push_back(value(policy.cells[std::size_t{y} * maze.width + x]));
        }
        rows.push_back(std::move(row));
    }
    return rows;
}

Json describe_history(const std::vector<StepRecord> &history) {
    Json all = Json::array();
    for (const StepRecord &step : history) {
        all.push_back({{"step", step.step},
                       {"interactions", step.interactions},
                       {"splits", step.splits},
                       {"classes", step.classes},
                       {"optimal_cells", step.optimal_cells}});
    }
    return all;
}

void add_run(Json &json, const gridworld_maze &maze, const RunResult &run) {
    json["seed"] = run.seed;
    json["cells"] = run.cells;
    json["optimal_cells"] = run.policy.optimal;
    json["near_optimal_cells"] = run.policy.near_optimal;
    json["interactions"] = run.interactions;
    json["interactions_to_optimal"] = or_null(run.interactions_to_optimal);
    json["interactions_to_first_optimal"] = or_null(run.interactions_to_first_optimal);
    json["classes"] = run.classes;
    json["depth"] = run.depth;
    json["bits_used"] = run.bits_used;
    json["distractors_used"] = run.distractors_used;
    json["policy_leaves"] = run.compaction.info.leaves;
    json["policy_exact"] = run.compaction.info.exact == 1;
    json["value_before"] = run.compaction.info.value_before;
    json["value_after"] = run.compaction.info.value_after;
    json["policy_optimal_cells"] = run.compaction.optimal;
    json["policy_near_optimal_cells"] = run.compaction.near_optimal;
    json["fewest_leaves"] = run.fewest.leaves;
    json["fewest_exact"] = run.fewest.exact;
    json["last_split_step"] = run.last_split_step;
    json["converged"] = run.solution == RLVC_SOLUTION_CONVERGED;
    json["memory_bytes"] = run.memory_bytes;
    json["seconds"] = run.seconds;
    json["maze"] = rows_of(maze);
    json["cell_classes"] =
        by_cell(maze, run.policy, [](const CellPolicy &cell) { return or_null(cell.class_id); });
    json["cell_actions"] =
        by_cell(maze, run.policy, [](const CellPolicy &cell) { return action_name(cell.action); });
    json["history"] = describe_history(run.history);
    json["tree"] = Json::parse(run.tree_json);
    json["policy"] = Json::parse(run.compaction.tree_json);
}

Json describe_percept(const Options &options, const gridworld_maze &maze) {
    const uint32_t x = gridworld_x_bits(&maze), y = gridworld_y_bits(&maze);
    return {{"bits", x + y + options.distractors},
            {"x_bits", bit_range(0, x)},
            {"distractor_bits", bit_range(x, options.distractors)},
            {"y_bits", bit_range(x + options.distractors, y)}};
}

} // namespace

std::string make_report(const Options &options, const gridworld_maze &maze,
                        const std::vector<RunResult> &runs) {
    Json json = begin_report("binary");
    json["options"] = describe_options(options);
    json["percept"] = describe_percept(options, maze);
    if (options.runs == 0) {
        add_run(json, maze, runs.front());
    } else {
        json["runs"] = Json::array();
        for (const RunResult &run : runs) {
            Json one;
            add_run(one, maze, run);
            json["runs"].push_back(std::move(one));
        }
    }
    return text_of(json);
}
