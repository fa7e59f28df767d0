// SPDX-License-Identifier: MIT
#include "options.h"

#include "arguments.h"
#include "failure.h"

#include "maze_defaults.h"
#include "rlvc/rlvc.h"

namespace {

constexpr uint32_t capacity_max = 2147483647;

const std::vector<Named> solvers{{"value-iteration", RLVC_SOLVER_VALUE_ITERATION},
                                 {"policy-iteration", RLVC_SOLVER_POLICY_ITERATION},
                                 {"q-learning", RLVC_SOLVER_Q_LEARNING},
                                 {"sarsa", RLVC_SOLVER_SARSA}};
const std::vector<Named> scores{{"gain", RLVC_SCORE_GAIN}, {"ranks", RLVC_SCORE_RANKS}};

constexpr LearningTexts binary_texts{
    "returns: interactions of each step; residual: of the whole run",
    "learning steps; residual: spread evenly over the interactions",
    "probability of exploring",
    "bound on the probability of any test if there is nothing to learn",
    "most classes of the tree (default: 1 for 8 interactions, at least 64)",
    "make N runs with seeds from --seed on, and print a table",
    "write the tree for Graphviz; not with --runs",
};

constexpr char defaults_table[] =
    R"(Defaults                    interactions   steps              epsilon  alpha  alpha-known  successors
  returns                   10000 a step   20                 0.8      0.05   0.0001       no
  residual                  5000           1 for 100, <= 100  0.9      0.01   0.1          yes
    with q-learning, sarsa  20000          1 for 100, <= 100  0.3      0.01   0.1          yes
They are the same for every maze.)";

gridworld_defaults defaults_for(const Options &options) {
    const bool incremental =
        options.solver == RLVC_SOLVER_Q_LEARNING || options.solver == RLVC_SOLVER_SARSA;
    const gridworld_learner learner{options.returns(), incremental, options.interactions};
    return gridworld_defaults_for(&learner);
}

void add_learning(CLI::App &app, Options &options) {
    add_learning_options(app, options, binary_texts);
    add_named(app, "--solver", solvers, options.solver,
              "value-iteration (default), policy-iteration, q-learning or sarsa");
    add_named(app, "--score", scores, options.score,
              "how a feature is tested: gain (default), or ranks, the rank-sum test");
    app.add_option("--alpha-known", options.alpha_known,
                   "largest corrected p-value of a bit that the tree tests already")
        ->type_name("P")
        ->check(number(0, 1, Interval::open_low));
    app.add_option("--smallest-effect", options.smallest_effect,
                   "smallest difference of return that is worth a split (default 0: any)")
        ->type_name("RETURN")
        ->check(number(0, RLVC_REWARD_MAX));
    app.add_option_function<std::string>(
           "--successors",
           [&options](const std::string &answer) { options.successors = answer == "yes"; },
           "yes or no: also split a class by what follows an action (residual only)")
        ->type_name("ANSWER")
        ->check(one_of({"yes", "no"}));
    add_whole(app, "--capacity", options.capacity, 1, capacity_max,
              "most interactions in memory (default: all); the oldest are overwritten");
}

void add_world(CLI::App &app, Options &options) {
    add_file(app, "--maze", options.maze,
             "'#' wall, '.' free, '*' exit; at most 256 x 256; -: standard input (default: "
             "Sutton's, 9 x 6)");
    app.add_option("--legend", options.legend,
                   "signs of --maze, such as wall=#,free=.,exit=* (default: those of its dialect)")
        ->type_name("SIGNS");
    app.add_option("--slip", options.slip,
                   "probability that a move goes in another direction (default 0)")
        ->type_name("P")
        ->check(number(0, 1));
    add_whole(app, "--distractors", options.distractors, 0, GRIDWORLD_BITS_MAX,
              "irrelevant random bits in each percept (default 11)");
    add_output(app, "--export-c", options.export_c,
               "write the minimal policy as a C header; not with --runs");
}

void check_combination(const Options &options) {
    const NamedFile dot{"--dot", options.dot}, export_c{"--export-c", options.export_c};
    for (const NamedFile &tree : {dot, export_c}) {
        if (!tree.file.empty() && options.runs > 0) {
            throw Failure(tree.option + ": cannot be combined with --runs: it writes the tree of a "
                                        "single run");
        }
    }
    if (!options.legend.empty() && options.maze.empty()) {
        throw Failure("--legend: tells of the signs of --maze, which is missing");
    }
    check_files_differ({{"--json", options.json}, dot, export_c});
}

// Throws Failure if the percept has no room for so many bits.
void check_percept(const Options &options, const gridworld_maze &maze) {
    const uint32_t place = gridworld_bits(&maze, 0);
    if (gridworld_bits(&maze, options.distractors) > GRIDWORLD_BITS_MAX) {
        throw Failure("--distractors: at most " + std::to_string(GRIDWORLD_BITS_MAX - place) +
                      " fit into a percept of this maze");
    }
}

template <class T> void set_if_open(T &value, bool open, T by_default) {
    if (open) {
        value = by_default;
    }
}

} // namespace

bool read_options(int argc, char **argv, Options &options) {
    CLI::App app("Learns a maze whose cells are seen as bits (the Binary Gridworld, section 6.1), "
                 "and prints the\nclasses and the policy.",
                 "run_gridworld binary");
    add_learning(app, options);
    add_world(app, options);
    app.footer(defaults_table);
    if (!parse(app, argc, argv)) {
        return false;
    }
    check_combination(options);
    return true;
}

void settle(Options &options, const gridworld_maze &maze) {
    check_percept(options, maze);
    const gridworld_defaults defaults = defaults_for(options);
    settle_schedule(options, {defaults.interactions, defaults.steps, defaults.epsilon});
    set_if_open(options.alpha, options.alpha == 0.0f, defaults.alpha);
    set_if_open(options.alpha_known, options.alpha_known == 0.0f, defaults.alpha_known);
    set_if_open(options.successors, options.successors < 0, defaults.successors);
    set_if_open(options.classes, options.classes == 0, defaults.classes);
    set_if_open(options.capacity, options.capacity == 0, options.interactions);
}

const char *solver_name(const Options &options) {
    return name_of(solvers, options.solver);
}

const char *score_name(const Options &options) {
    return name_of(scores, options.score);
}
