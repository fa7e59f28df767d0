// SPDX-License-Identifier: MIT
#include "options.h"

#include "../arguments.h"
#include "../failure.h"

#include "rlvc/rlvc.h"
#include "rlvc/vision.h"

#include <algorithm>
#include <sstream>

namespace {

constexpr float sift_sigma = 6.0f; // a wide window: it loses poses less than it tells objects apart

// Adds an option for a number, a whole number or a file. Its range stands in the help.
void add(CLI::App &app, const std::string &name, float &into, float low, float high,
         const char *text) {
    std::ostringstream range;
    range << low << ".." << high;
    app.add_option(name, into, text)->type_name(range.str())->check(number(low, high));
}

void add(CLI::App &app, const std::string &name, uint32_t &into, uint32_t low, uint32_t high,
         const char *text) {
    app.add_option(name, into, text)
        ->type_name(std::to_string(low) + ".." + std::to_string(high))
        ->check(whole(low, high));
}

void add(CLI::App &app, const std::string &name, std::string &into, const char *text) {
    app.add_option(name, into, text)->type_name("FILE")->check(file_name());
}

int angle_of(const std::string &option, const std::string &text) {
    std::size_t end = 0;
    long angle = 0;
    try {
        angle = std::stol(text, &end);
    } catch (const std::exception &) {
        end = 0;
    }
    if (end == 0 || end != text.size() || angle < -359 || angle > 359) {
        throw Failure(option + ": '" + text +
                      "' is not an angle in whole degrees from -359 to 359");
    }
    return static_cast<int>((angle + 360) % 360);
}

void add_angles(CLI::App &app, const std::string &name, std::vector<int> &into, const char *text) {
    app.add_option_function<std::string>(
           name,
           [name, &into](const std::string &list) {
               into.clear();
               std::size_t from = 0;
               while (from <= list.size()) {
                   const std::size_t to = std::min(list.find(',', from), list.size());
                   into.push_back(angle_of(name, list.substr(from, to - from)));
                   from = to + 1;
               }
           },
           text)
        ->type_name("A,B,...");
}

void add_world(CLI::App &app, TiledOptions &options) {
    app.add_option("--images", options.images,
                   "pictures objN__ANGLE.* as of COIL-100; any others: a file an object (built-in "
                   "objects)")
        ->type_name("DIR")
        ->check(file_name());
    app.add_option("--maze", options.maze, "small (10 cells), sutton (46), or a file (sutton)")
        ->type_name("MAZE")
        ->check(file_name());
    add_angles(app, "--poses", options.poses, "degrees from which objects are seen: 0,20,-20 (0)");
    add_angles(app, "--test-poses", options.test_poses,
               "degrees held out (those of --poses, in other light)");
    add(app, "--light", options.light, 0, 0.99f, "light varies by +- this share (0)");
    add(app, "--noise", options.noise, 0, 255, "standard deviation in grey levels (0)");
    add(app, "--blur", options.blur, 0, 100, "standard deviation in pixels (0)");
    add(app, "--jpeg", options.jpeg, 1, 100, "compress at this quality (not)");
    add(app, "--copies", options.copies, 1, 1000, "pictures of each view, if they differ (8)");
}

void add_seeing(CLI::App &app, TiledOptions &options) {
    options.descriptor = RLVC_DESCRIPTOR_SIFT_UPRIGHT;
    app.add_option_function<std::string>(
           "--descriptor",
           [&options](const std::string &name) {
               rlvc_descriptor_named(name.c_str(), &options.descriptor);
           },
           "invariants, sqrt-invariants, sift-upright, sift or orb (sift-upright)")
        ->type_name("NAME")
        ->check(one_of({"invariants", "sqrt-invariants", "sift-upright", "sift", "orb"}));
    add(app, "--points", options.points, 1, RLVC_POINTS_MAX, "points of a picture, at most (30)");
    add(app, "--sigma", options.sigma, 0.5f, 8, "scale of the vectors in pixels (by descriptor)");
    add(app, "--axes", options.axes, 0, 128,
        "discriminant axes of SIFT, where views or light differ; 0: SIFT as it is (16)");
    add(app, "--share", options.share, 0.001f, 0.999f,
        "of the other objects' pictures that have a feature at tau (0.035)");
    add(app, "--margin", options.margin, 1, 16, "of the margin rule; 1: a fixed tau (1.8)");
    add(app, "--candidates", options.candidates, 1, 65535, "features looked at for a class (64)");
    app.add_flag_callback(
           "--raw-light", [&options] { options.normalise = false; },
           "leave the light of pictures as it is")
        ->disable_flag_override();
    add(app, "--metric", options.metric, "use this metric instead of fitting one");
    add(app, "--save-metric", options.save_metric, "keep the metric");
}

void add_learning(CLI::App &app, TiledOptions &options) {
    add_criterion(app, options.criterion);
    add(app, "--interactions", options.interactions, 1, 1000000,
        "returns: of each step (2000); residual: of the run (4500)");
    add(app, "--steps", options.steps, 1, 10000, "learning steps (returns: 20; residual: 12)");
    add(app, "--gamma", options.gamma, 0, 0.999f, "discount of future rewards (0.9)");
    add(app, "--epsilon", options.epsilon, 0, 1, "probability of exploring (returns: 0.8, else 1)");
    add(app, "--alpha", options.alpha, 1e-30f, 1,
        "probability that a run with nothing to learn takes up a feature, at most (0.005)");
    add(app, "--classes", options.classes, 1, 65535, "classes the tree may grow to (four a cell)");
    add(app, "--seed", options.seed, 0, UINT32_MAX, "of everything random (1)");
    add(app, "--runs", options.runs, 1, 100000, "runs with the seeds from --seed on (1)");
    add(app, "--json", options.json, "write a report");
    add(app, "--dot", options.dot, "write the first run's tree for Graphviz");
    add(app, "--snapshot", options.snapshot, "write the first run's agent");
}

void settle(TiledOptions &options) {
    const bool returns = options.criterion == RLVC_CRITERION_RETURNS;
    if (options.interactions == 0) {
        options.interactions = returns ? 2000 : 4500;
    }
    if (options.steps == 0) {
        options.steps = returns ? 20 : std::min(12U, options.interactions);
    }
    if (!returns && options.steps > options.interactions) {
        throw Failure("--steps: at most one for each of the " +
                      std::to_string(options.interactions) + " interactions");
    }
    if (options.epsilon < 0.0f) {
        options.epsilon = returns ? 0.8f : 1.0f;
    }
    if (options.sigma == 0.0f) {
        const bool sift = options.descriptor == RLVC_DESCRIPTOR_SIFT ||
                          options.descriptor == RLVC_DESCRIPTOR_SIFT_UPRIGHT;
        options.sigma = sift ? sift_sigma : 2.5f;
    }
    if (options.light == 0.0f && options.noise == 0.0f) {
        options.copies = 1; // they would all be alike
    }
}

} // namespace

bool read_tiled_options(int argc, char **argv, TiledOptions &options) {
    CLI::App app("The Tiled Gridworld (section 6.2): a cell is seen as pictures of an object",
                 "run_gridworld tiled");
    add_world(app, options);
    add_seeing(app, options);
    add_learning(app, options);
    if (!parse(app, argc, argv)) {
        return false;
    }
    check_files_differ({{"--save-metric", options.save_metric},
                        {"--json", options.json},
                        {"--dot", options.dot},
                        {"--snapshot", options.snapshot}});
    settle(options);
    return true;
}
