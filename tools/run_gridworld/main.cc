// SPDX-License-Identifier: MIT
// run_gridworld: learns a maze from rewards alone, by the public interface of the library.
//
//     options      what the user asked for          arguments    how what was typed is checked
//     maze_file    the maze                         optimum      what would be best
//     learner      one run: interactions and learning
//     policy       what the tree does in each cell, compared with the optimum
//     compaction   the policy made small, and the smallest that an optimal one could be
//     picture, summary, screen                      what is shown
//     report, output_file                           what is written
//     tiled                                         the other subcommand, in a folder of its own
//
// Exit status: 0; 2 after a failure, with one line on stderr; 128 + n after signal n.
#include "failure.h"
#include "interrupt.h"
#include "learner.h"
#include "maze_file.h"
#include "options.h"
#include "output_file.h"
#include "picture.h"
#include "report.h"
#include "screen.h"
#include "summary.h"
#include "tiled.h"

#include <cstdio>
#include <cstring>
#include <new>

namespace {

constexpr int exit_failure = 2;
constexpr int exit_signal = 128;

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
        runs.push_back(learn_maze(options, maze, optimum, options.seed + i, show));
        screen.print(run_row(runs.back()));
    }
    screen.print(describe_runs(options, maze, runs));
    return runs;
}

void run(int argc, char **argv) {
    Options options;
    if (!read_options(argc, argv, options)) {
        return;
    }
    const Maze maze(options.maze);
    settle(options, maze.get());
    const std::string task = describe_task(options, maze.get());
    OutputFile json("--json", options.json);
    OutputFile dot("--dot", options.dot);
    OutputFile export_c("--export-c", options.export_c);
    const Optimum optimum(maze.get(), double{options.gamma}, double{options.slip});
    Screen screen;
    screen.print(task);
    std::vector<RunResult> runs;
    if (options.runs == 0) {
        runs.push_back(run_one(options, maze.get(), optimum, screen));
    } else {
        runs = run_many(options, maze.get(), optimum, screen);
    }
    if (!options.dot.empty()) {
        dot.write(runs.front().tree_dot);
    }
    if (!options.export_c.empty()) {
        export_c.write(runs.front().compaction.policy_c);
    }
    if (!options.json.empty()) {
        json.write(make_report(options, maze.get(), maze.rows(), runs));
    }
}

int complain(const std::string &message) {
    std::fprintf(stderr, "run_gridworld: %s\n", message.c_str());
    return exit_failure;
}

} // namespace

int main(int argc, char **argv) {
    watch_for_interrupts();
    try {
        if (argc > 1 && std::strcmp(argv[1], "tiled") == 0) {
            run_tiled(argc - 1, argv + 1);
        } else {
            run(argc, argv);
        }
        return 0;
    } catch (const Interrupted &interrupted) {
        complain(std::string("interrupted after ") + interrupted.what() + "; nothing was written");
        return exit_signal + interrupt_signal();
    } catch (const Failure &failure) {
        return complain(failure.what());
    } catch (const std::bad_alloc &) {
        return complain("out of memory");
    }
}
