// SPDX-License-Identifier: MIT
#include "options.h"

#include "arguments.h"
#include "failure.h"

#include "rlvc/rlvc.h"

#include <algorithm>

namespace {

// Good defaults, found by trial. The published criterion asks the same evidence of every feature. In a small
// maze without slip the residual criterion learns fast, from what fits into 36 KiB. Chance calls for more
// samples; and in a larger maze the ring must hold all that was seen, and the greedy action of a class
// that still holds half the maze would only push the walk into a corner. What follows an action is then
// left out: it takes several times as long, and the rewards alone come to tell as much apart. An incremental
// solver forgets what it is taught at its learning rate, so that it needs more interactions, and more of them
// where the policy leads.
struct Defaults {
    uint32_t interactions;
    uint32_t steps;
    float epsilon;
    float alpha;
    float alpha_known;
    int successors;
    uint32_t capacity;
};

constexpr Defaults returns_defaults{10000, 20, 0.8f, 0.05f, 0.0001f, 0, 0};
constexpr Defaults small_defaults{2500, 25, 0.9f, 0.01f, 1.0f, 1, 1200};
constexpr Defaults small_incremental_defaults{20000, 200, 0.3f, 0.01f, 1.0f, 1, 1200};
constexpr Defaults large_defaults{0, 60, 1.0f, 0.01f, 0.00001f, 0, 0};
constexpr uint32_t small_cells = 46;
constexpr uint32_t large_interactions_a_cell = 320;
constexpr uint32_t classes_min = 64, classes_max = 65535;

struct Named {
    const char *name; // on the command line
    uint8_t number;   // in the library
};

const std::vector<Named> solvers{{"value-iteration", RLVC_SOLVER_VALUE_ITERATION},
                                 {"policy-iteration", RLVC_SOLVER_POLICY_ITERATION},
                                 {"q-learning", RLVC_SOLVER_Q_LEARNING},
                                 {"sarsa", RLVC_SOLVER_SARSA}};
const std::vector<Named> scores{{"gain", RLVC_SCORE_GAIN}, {"ranks", RLVC_SCORE_RANKS}};

constexpr char defaults_table[] = R"(Defaults by criterion    interactions  steps  epsilon  alpha    known    successors  capacity
  returns                10000 each       20  0.8      0.05     0.0001   no          a step's
  residual, small maze   2500             25  0.9      0.01     1        yes         1200
  ... by increments      20000           200  0.3      0.01     1        yes         1200
  residual, any other    320 a cell       60  1        0.01     0.00001  no          all
A maze is small if it has at most 46 free cells, as Sutton's has, and no slip. Of the library's solvers
q-learning and sarsa work by increments; in any other maze, too, by epsilon 0.3.)";

Defaults defaults_for(const Options &options, const gridworld_maze &maze) {
    if (options.criterion == RLVC_CRITERION_RETURNS) {
        return returns_defaults;
    }
    const bool incremental =
        options.solver == RLVC_SOLVER_Q_LEARNING || options.solver == RLVC_SOLVER_SARSA;
    if (maze.free_cells <= small_cells && options.slip == 0.0f) {
        return incremental ? small_incremental_defaults : small_defaults;
    }
    Defaults large = large_defaults;
    large.epsilon = incremental ? small_incremental_defaults.epsilon : large.epsilon;
    large.interactions = large_interactions_a_cell * maze.free_cells;
    return large;
}

// An option that takes one of several names, the first of which is the default.
void add_named(CLI::App &binary, const std::string &option, const std::vector<Named> &all,
               uint8_t &into, const char *text) {
    std::vector<std::string> names;
    for (const Named &one : all) {
        names.emplace_back(one.name);
    }
    into = all.front().number;
    binary
        .add_option_function<std::string>(
            option,
            [&all, &into](const std::string &name) {
                into = std::find_if(all.begin(), all.end(), [&name](const Named &one) {
                           return name == one.name;
                       })->number;
            },
            text)
        ->type_name("NAME")
        ->check(one_of(names));
}

const char *name_of(const std::vector<Named> &all, uint8_t number) {
    const auto is = [number](const Named &one) { return one.number == number; };
    return std::find_if(all.begin(), all.end(), is)->name;
}

void add_learning(CLI::App &binary, Options &options) {
    add_criterion(binary, options.criterion);
    add_named(binary, "--solver", solvers, options.solver,
              "value-iteration (default), policy-iteration, q-learning or sarsa");
    add_named(binary, "--score", scores, options.score,
              "how a feature is judged: gain (default), information gain at its best cutpoint; or ranks, the "
              "rank-sum test");
    binary
        .add_option("--interactions", options.interactions,
                    "returns: fresh ones for each step; residual: those of the whole run")
        ->type_name("N")
        ->check(whole(1, 2147483647));
    binary
        .add_option("--steps", options.steps,
                    "learning steps; residual: spread evenly over the interactions")
        ->type_name("N")
        ->check(whole(1, 1000000));
    binary.add_option("--gamma", options.gamma, "discount of future rewards (0.9)")
        ->type_name("P")
        ->check(number(0, 1, Ends::open_above));
    binary.add_option("--epsilon", options.epsilon, "probability of exploring")
        ->type_name("P")
        ->check(number(0, 1));
    binary
        .add_option("--alpha", options.alpha,
                    "probability that a run with nothing to learn takes up a bit, at most; and")
        ->type_name("P")
        ->check(number(0, 1, Ends::open_below));
    binary
        .add_option("--alpha-known", options.alpha_known,
                    "a split by a bit that the tree tests already has a corrected p-value below this")
        ->type_name("P")
        ->check(number(0, 1, Ends::open_below));
    binary
        .add_option_function<std::string>(
            "--successors",
            [&options](const std::string &answer) { options.successors = answer == "yes"; },
            "yes or no: split a class, too, if what follows the same action differs (residual "
            "criterion)")
        ->type_name("ANSWER")
        ->check(one_of({"yes", "no"}));
    binary
        .add_option("--classes", options.classes,
                    "classes the tree may grow to (4 for 3 cells, at least 64)")
        ->type_name("N")
        ->check(whole(1, classes_max));
    binary
        .add_option("--capacity", options.capacity, "interactions kept in memory; the oldest leave")
        ->type_name("N")
        ->check(whole(1, 2147483647));
}

void add_world(CLI::App &binary, Options &options) {
    binary
        .add_option("--maze", options.maze,
                    "text: '#' wall, '.' free, '*' exit, at most 256 x 256 (Sutton's 9 x 6)")
        ->type_name("FILE")
        ->check(file_name());
    binary.add_option("--slip", options.slip, "probability that a move goes astray (0)")
        ->type_name("P")
        ->check(number(0, 1));
    binary.add_option("--distractors", options.distractors, "random bits in each percept (11)")
        ->type_name("N")
        ->check(whole(0, GRIDWORLD_BITS_MAX));
    binary.add_option("--seed", options.seed, "of everything random (1)")
        ->type_name("N")
        ->check(whole(0, 4294967295));
    binary
        .add_option("--runs", options.runs,
                    "several runs with the seeds from --seed on, shown as a table")
        ->type_name("N")
        ->check(whole(1, 1000000));
}

void add_files(CLI::App &binary, Options &options) {
    binary.add_option("--json", options.json, "write a report (its form: REPORT.md)")
        ->type_name("FILE")
        ->check(file_name());
    binary.add_option("--dot", options.dot, "write the tree for Graphviz; not with --runs")
        ->type_name("FILE")
        ->check(file_name());
    binary
        .add_option("--export-c", options.export_c,
                    "write the policy, made small, as a C header for controllers; not with --runs")
        ->type_name("FILE")
        ->check(file_name());
}

void check_combination(const Options &options) {
    const std::vector<NamedFile> trees{{"--dot", options.dot}, {"--export-c", options.export_c}};
    for (const NamedFile &tree : trees) {
        if (tree.file.empty()) {
            continue;
        }
        if (options.runs > 0) {
            throw Failure(tree.option +
                          ": writes one tree, and --runs makes several: leave one of them out");
        }
    }
    check_files_differ({{"--json", options.json}, trees[0], trees[1]});
}

// Throws Failure if so many bits do not fit.
void check_percept(const Options &options, const gridworld_maze &maze) {
    const uint32_t place = gridworld_bits(&maze, 0);
    if (gridworld_bits(&maze, options.distractors) > GRIDWORLD_BITS_MAX) {
        throw Failure("--distractors: at most " + std::to_string(GRIDWORLD_BITS_MAX - place) +
                      " fit into a percept of this maze");
    }
}

} // namespace

bool read_options(int argc, char **argv, Options &options) {
    const std::string version = std::string("run_gridworld ") + rlvc_version();
    CLI::App app("Learns a maze from rewards alone and shows the classes and the policy it found.",
                 "run_gridworld");
    app.set_version_flag("--version", version, "Print the version and exit");
    app.require_subcommand(1);
    CLI::App &binary = *app.add_subcommand(
        "binary", "The Binary Gridworld (section 6.1): a cell is seen as a string of bits");
    app.footer("Another subcommand, tiled, has a help of its own: run_gridworld tiled --help");
    binary.set_version_flag("--version", version, "Print the version and exit");
    add_learning(binary, options);
    add_world(binary, options);
    add_files(binary, options);
    binary.footer(defaults_table);
    try {
        if (!parse(app, argc, argv)) {
            return false;
        }
    } catch (const CLI::RequiredError &) {
        throw Failure(argc > 1 ? std::string(argv[1]) +
                                     ": not a subcommand; there are 'binary' and 'tiled'"
                               : "a subcommand is wanted: 'binary' or 'tiled' (see --help)");
    }
    check_combination(options);
    return true;
}

void settle(Options &options, const gridworld_maze &maze) {
    const bool returns = options.criterion == RLVC_CRITERION_RETURNS;
    check_percept(options, maze);
    const Defaults defaults = defaults_for(options, maze);
    if (options.interactions == 0) {
        options.interactions = defaults.interactions;
    }
    if (options.epsilon < 0.0f) {
        options.epsilon = defaults.epsilon;
    }
    if (options.alpha == 0.0f) {
        options.alpha = defaults.alpha;
    }
    if (options.alpha_known == 0.0f) {
        options.alpha_known = defaults.alpha_known;
    }
    if (options.successors < 0) {
        // All bits must fit into one block of columns.
        const bool fits = gridworld_bits(&maze, options.distractors) <= RLVC_DETECT_FEATURES;
        options.successors = defaults.successors && fits;
    }
    if (options.classes == 0) {
        options.classes = std::clamp(maze.free_cells / 3 * 4 + 4, classes_min, classes_max);
    }
    if (options.capacity == 0) {
        options.capacity = defaults.capacity == 0
                               ? options.interactions
                               : std::min(options.interactions, defaults.capacity);
    }
    if (!returns && options.steps > options.interactions) {
        throw Failure("--steps: at most one for each of the " +
                      std::to_string(options.interactions) + " interactions");
    }
    if (options.steps == 0) {
        options.steps = returns ? defaults.steps : std::min(options.interactions, defaults.steps);
    }
}

const char *criterion_name(const Options &options) {
    return options.criterion == RLVC_CRITERION_RETURNS ? "returns" : "residual";
}

const char *solver_name(const Options &options) {
    return name_of(solvers, options.solver);
}

const char *score_name(const Options &options) {
    return name_of(scores, options.score);
}
