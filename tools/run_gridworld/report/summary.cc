// SPDX-License-Identifier: MIT
#include "summary.h"

#include <algorithm>
#include <cstdarg>
#include <cstdio>
#include <limits>

namespace {

constexpr std::size_t cells_listed = 8;
constexpr uint64_t never = std::numeric_limits<uint64_t>::max();

__attribute__((format(printf, 1, 2))) std::string format(const char *pattern, ...) {
    char text[512];
    va_list arguments;
    va_start(arguments, pattern);
    std::vsnprintf(text, sizeof text, pattern, arguments);
    va_end(arguments);
    return text;
}

// 39120 becomes "39,120".
std::string grouped(uint64_t number) {
    std::string text = std::to_string(number);
    for (std::size_t at = text.size(); at > 3; at -= 3) {
        text.insert(at - 3, ",");
    }
    return text;
}

std::string count_or_never(uint64_t count) {
    return count == never ? "never" : grouped(count);
}

std::string range(uint32_t first, uint32_t count) {
    if (count == 0) {
        return "none";
    }
    return count == 1 ? std::to_string(first)
                      : std::to_string(first) + "-" + std::to_string(first + count - 1);
}

// The bits of x and of y, which say where the agent is.
std::vector<uint32_t> place_bits(const Options &options, const gridworld_maze &maze) {
    std::vector<uint32_t> bits;
    for (uint32_t bit = 0; bit < gridworld_bits(&maze, options.distractors); bit++) {
        if (!is_distractor(maze, options.distractors, bit)) {
            bits.push_back(bit);
        }
    }
    return bits;
}

std::string list(const std::vector<uint32_t> &bits) {
    std::string text;
    for (const uint32_t bit : bits) {
        text += (text.empty() ? "" : " ") + std::to_string(bit);
    }
    return text.empty() ? "none" : text;
}

// A list of a few cells; for many, the pictures show more.
std::string not_optimal_cells(const gridworld_maze &maze, const RunResult &run) {
    if (run.cells - run.policy.optimal > cells_listed) {
        return "";
    }
    std::string text = "; not in";
    for (uint32_t cell = 0; cell < run.policy.cells.size(); cell++) {
        if (maze.cells[cell] == GRIDWORLD_FREE && !run.policy.cells[cell].optimal) {
            text += format(" (%u,%u)", cell % maze.width, cell / maze.width);
        }
    }
    return text;
}

std::string leaves_of(uint32_t leaves) {
    return grouped(leaves) + (leaves == 1 ? " leaf" : " leaves");
}

std::string describe_fewest(const Fewest &fewest) {
    return "the smallest optimal tree has " + leaves_of(fewest.leaves) +
           (fewest.exact ? "" : " or fewer");
}

std::string describe_policy(const RunResult &run) {
    return leaves_of(run.compaction.info.leaves) +
           format(", optimal in %u of %u cells, value %.4g (before compaction %.4g); ",
                  run.compaction.optimal, run.cells, double{run.compaction.info.value_after},
                  double{run.compaction.info.value_before}) +
           describe_fewest(run.fewest);
}

const char *describe_solution(uint32_t solution) {
    return solution == RLVC_SOLUTION_ENDLESS
               ? "endless: from some classes no end is known, and the discount is 1"
               : "not converged: the last solution took as many sweeps as it may";
}

std::string row(const char *name, const std::string &value) {
    return format("  %-16s", name) + value + "\n";
}

std::string seconds(double value) {
    return format("%.*f", value < 9.995 ? 2 : 1, value);
}

std::string describe_world(const Options &options, const gridworld_maze &maze) {
    const uint32_t x = gridworld_x_bits(&maze), y = gridworld_y_bits(&maze);
    const uint32_t d = options.distractors;
    std::string text = "Maze      " + (options.maze.empty() ? "Sutton's" : options.maze) +
                       format(", %u x %u, %u free cells", maze.width, maze.height, maze.free_cells);
    if (options.slip > 0.0f) {
        text += format("; a move slips with probability %g", double{options.slip});
    }
    text += format("\nPercepts  %u bits: x %s, random %s, y %s\n", x + y + d, range(0, x).c_str(),
                   range(x, d).c_str(), range(x + d, y).c_str());
    return text;
}

} // namespace

std::string describe_task(const Options &options, const gridworld_maze &maze) {
    std::string text = describe_world(options, maze);
    text += format(
        "Learning  %s criterion, %s; %s steps of %s interactions%s\n", criterion_name(options),
        solver_name(options), grouped(options.steps).c_str(),
        grouped(options.returns() ? options.interactions : options.interactions / options.steps)
            .c_str(),
        options.returns() ? ", fresh ones for each" : "");
    text +=
        format("          discount %g, epsilon %g, alpha %g, alpha-known %g%s, score %s, seed %u\n",
               double{options.discount}, double{options.epsilon}, double{options.alpha},
               double{options.alpha_known}, options.successors > 0 ? ", successors" : "",
               score_name(options), options.seed);
    text += format("Memory    %s bytes: %s interactions, %s classes\n",
                   grouped(learner_bytes(options, maze)).c_str(), grouped(options.capacity).c_str(),
                   grouped(options.classes).c_str());
    return text;
}

std::string steps_header() {
    return "\n   k  interactions  splits  classes  optimal cells\n";
}

std::string step_row(const StepRecord &step, uint32_t cells) {
    return format("%4u  %12s  %6u  %7u  %6u of %u\n", step.step, grouped(step.interactions).c_str(),
                  step.splits, step.classes, step.optimal_cells, cells);
}

std::string step_line(const StepRecord &step, uint32_t cells, uint32_t steps) {
    return format("step %u of %u: %s interactions, %u classes, %u of %u cells optimal",
                  step.step + 1, steps, grouped(step.interactions).c_str(), step.classes,
                  step.optimal_cells, cells);
}

std::string describe_run(const Options &options, const gridworld_maze &maze, const RunResult &run) {
    std::string optimal = format("%u of %u cells", run.policy.optimal, run.cells);
    if (run.interactions_to_optimal) {
        optimal += ", after " + grouped(*run.interactions_to_optimal) + " interactions";
    } else {
        optimal += format(" (%u within 1 %% of the optimal value)", run.policy.near_optimal) +
                   not_optimal_cells(maze, run);
    }
    std::string bits = list(run.bits_used);
    if (run.bits_used == place_bits(options, maze)) {
        bits += " (exactly those of x and y)";
    } else {
        bits += run.distractors_used == 0 ? " (no random bit)"
                                          : format(" (%u random)", run.distractors_used);
    }
    return row("optimal", optimal) + row("bits used", bits) +
           row("classes", format("%u, depth %u, last split at step %u", run.classes, run.depth,
                                 run.last_split_step)) +
           (run.solution == RLVC_SOLUTION_CONVERGED
                ? ""
                : row("values", describe_solution(run.solution))) +
           row("minimal policy", describe_policy(run)) +
           row("interactions", grouped(run.interactions)) +
           row("memory", grouped(run.memory_bytes) + " bytes") +
           row("time", seconds(run.seconds) + " s");
}

// ------------------------------------------------------------------------------ several runs

namespace {

constexpr const char *row_pattern = "%10s  %13s  %10s  %10s  %7s  %10s  %6s  %s\n";

// Median, minimum and maximum of one column.
struct Spread {
    uint64_t median, min, max;
};

// The median of an even number of values is the greater of the two in the middle.
Spread spread(std::vector<uint64_t> values) {
    std::sort(values.begin(), values.end());
    return {values[values.size() / 2], values.front(), values.back()};
}

template <class Column> Spread spread_of(const std::vector<RunResult> &runs, Column column) {
    std::vector<uint64_t> values;
    for (const RunResult &run : runs) {
        values.push_back(column(run));
    }
    return spread(values);
}

uint64_t to_optimal(const RunResult &run) {
    return run.interactions_to_optimal.value_or(never);
}

} // namespace

std::string runs_header() {
    return "\n" + format(row_pattern, "seed", "optimal cells", "within 1 %", "to optimal",
                         "classes", "last split", "time", "bits used");
}

std::string run_row(const RunResult &run) {
    return format(row_pattern, std::to_string(run.seed).c_str(),
                  format("%u of %u", run.policy.optimal, run.cells).c_str(),
                  std::to_string(run.policy.near_optimal).c_str(),
                  count_or_never(to_optimal(run)).c_str(), std::to_string(run.classes).c_str(),
                  std::to_string(run.last_split_step).c_str(), seconds(run.seconds).c_str(),
                  list(run.bits_used).c_str());
}

std::string describe_runs(const Options &options, const gridworld_maze &maze,
                          const std::vector<RunResult> &runs) {
    const Spread cells = spread_of(runs, [](const RunResult &r) { return r.policy.optimal; });
    const Spread near = spread_of(runs, [](const RunResult &r) { return r.policy.near_optimal; });
    const Spread optimal = spread_of(runs, to_optimal);
    const Spread classes = spread_of(runs, [](const RunResult &r) { return r.classes; });
    const Spread leaves =
        spread_of(runs, [](const RunResult &r) { return r.compaction.info.leaves; });
    const Spread split = spread_of(runs, [](const RunResult &r) { return r.last_split_step; });
    const Spread ms = spread_of(
        runs, [](const RunResult &r) { return static_cast<uint64_t>(r.seconds * 1000.0); });
    const auto line = [&](const char *name, uint64_t Spread::*of) {
        return format(row_pattern, name, std::to_string(cells.*of).c_str(),
                      std::to_string(near.*of).c_str(), count_or_never(optimal.*of).c_str(),
                      std::to_string(classes.*of).c_str(), std::to_string(split.*of).c_str(),
                      seconds(static_cast<double>(ms.*of) / 1000.0).c_str(), "");
    };
    const auto place = place_bits(options, maze);
    const auto total = static_cast<unsigned>(runs.size());
    const auto count = [&](auto holds) {
        return static_cast<unsigned>(std::count_if(runs.begin(), runs.end(), holds));
    };
    return line("median", &Spread::median) + line("min", &Spread::min) + line("max", &Spread::max) +
           "\n" +
           row("optimal",
               format("all cells in %u of %u runs; all within 1 %% of the optimal value in %u",
                      count([](const RunResult &r) { return r.optimal(); }), total,
                      count([](const RunResult &r) { return r.policy.near_optimal == r.cells; }))) +
           row("bits used",
               format("exactly those of x and y in %u of %u runs; no random bit in %u",
                      count([&](const RunResult &r) { return r.bits_used == place; }), total,
                      count([](const RunResult &r) { return r.distractors_used == 0; }))) +
           row("minimal policy",
               format("%u to %u leaves, median %u; ", static_cast<unsigned>(leaves.min),
                      static_cast<unsigned>(leaves.max), static_cast<unsigned>(leaves.median)) +
                   describe_fewest(runs.front().fewest)) +
           row("last split", format("at step %u or before", static_cast<unsigned>(split.max))) +
           row("memory", grouped(runs.front().memory_bytes) + " bytes a run");
}
