// SPDX-License-Identifier: MIT
#include "binary.h"

#include "cli/failure.h"
#include "cli/interrupt.h"
#include "cli/output_file.h"
#include "cli/screen.h"
#include "maze/maze_file.h"
#include "report/json.h"
#include "report/picture.h"
#include "report/summary.h"

namespace {

RunResult run_one(const Options &options, const gridworld_maze &maze, const Optimum &optimum,
                  Screen &screen) {
    if (!screen.terminal()) {
        screen.print(steps_header());
    }
    const auto show = [&](const StepRecord &step) {
        if (screen.terminal()) {
            screen.refresh(step_line(step, maze.free_cells, options.steps));
        } else {
            screen.print(step_row(step, maze.free_cells));
        }
    };
    RunResult run = learn_maze(options, maze, optimum, options.seed, show);
    screen.print("\n" + draw_pictures(maze, run.policy, locale_has_utf8()) + "\n");
    screen.print(describe_run(options, maze, run));
    return run;
}

std::vector<RunResult> run_many(const Options &options, const gridworld_maze &maze,
                                const Optimum &optimum, Screen &screen) {
    std::vector<RunResult> runs;
    screen.print(runs_header());
    for (uint32_t i = 0; i < options.runs; i++) {
        const auto show = [&](const StepRecord &step) {
            if (screen.terminal()) {
                screen.refresh("run " + std::to_string(i + 1) + " of " +
                               std::to_string(options.runs) + ", " +
                               step_line(step, maze.free_cells, options.steps));
            }
        };
        try {
            runs.push_back(learn_maze(options, maze, optimum, options.seed + i, show));
        } catch (const Interrupted &) {
            if (runs.empty()) {
                throw;
            }
            break; // the finished runs are kept
        }
        screen.print(run_row(runs.back()));
    }
    screen.print(describe_runs(options, maze, runs));
    return runs;
}

} // namespace

void run_binary(int argc, char **argv) {
    Options options;
    if (!read_options(argc, argv, options)) {
        return;
    }
    const Maze maze(options.maze, options.legend);
    settle(options, maze.get());
    const std::string task = describe_task(options, maze.get());
    OutputFile json("--json", options.json);
    OutputFile dot("--dot", options.dot);
    OutputFile export_c("--export-c", options.export_c);
    const Optimum optimum(maze.get(), double{options.discount}, double{options.slip});
    Screen screen;
    screen.print(task);
    std::vector<RunResult> runs;
    if (options.runs == 0) {
        runs.push_back(run_one(options, maze.get(), optimum, screen));
    } else {
        runs = run_many(options, maze.get(), optimum, screen);
    }
    dot.write(runs.front().tree_dot);
    export_c.write(runs.front().compaction.policy_c);
    json.write(make_report(options, maze.get(), runs));
    need_all_runs(runs.size(), options.runs);
}
