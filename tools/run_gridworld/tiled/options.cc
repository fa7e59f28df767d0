// SPDX-License-Identifier: MIT
#include "options.h"

#include "../failure.h"

#include "rlvc/rlvc.h"
#include "rlvc/vision.h"

#include <CLI/CLI.hpp>

#include <algorithm>

namespace {

constexpr float sift_sigma = 6.0f; // a wide window: it loses poses less than it tells objects apart

int angle_of(const std::string &text) {
    std::size_t end = 0;
    long angle = 0;
    try {
        angle = std::stol(text, &end);
    } catch (const std::exception &) {
        end = 0;
    }
    if (end == 0 || end != text.size() || angle < -359 || angle > 359) {
        throw Failure("'" + text + "' is not an angle in whole degrees from -359 to 359");
    }
    return static_cast<int>((angle + 360) % 360);
}

void add_world(CLI::App &app, TiledOptions &options) {
    const auto angles = [](std::vector<int> &into) {
        return [&into](const std::string &list) {
            into.clear();
            std::size_t from = 0;
            while (from <= list.size()) {
                const std::size_t to = std::min(list.find(',', from), list.size());
                into.push_back(angle_of(list.substr(from, to - from)));
                from = to + 1;
            }
        };
    };
    app.add_option("--images", options.images,
                   "pictures objN__ANGLE.* as of COIL-100; any others: a file an object (built-in "
                   "objects)")
        ->type_name("DIR");
    app.add_option("--maze", options.maze, "small (10 cells), sutton (46), or a file (sutton)");
    app.add_option_function<std::string>("--poses", angles(options.poses),
                                         "degrees from which objects are seen: 0,20,-20 (0)")
        ->type_name("A,B,...");
    app.add_option_function<std::string>("--test-poses", angles(options.test_poses),
                                         "degrees held out (those of --poses, in other light)")
        ->type_name("A,B,...");
    app.add_option("--light", options.light, "light varies by +- this share (0)")
        ->check(CLI::Range(0.0, 0.99));
    app.add_option("--noise", options.noise, "standard deviation in grey levels (0)")
        ->check(CLI::Range(0.0, 255.0));
    app.add_option("--blur", options.blur, "standard deviation in pixels (0)")
        ->check(CLI::Range(0.0, 100.0));
    app.add_option("--jpeg", options.jpeg, "compress at this quality, 1 to 100 (not)")
        ->check(CLI::Range(1, 100));
    app.add_option("--copies", options.copies, "pictures of each view, if they differ (8)")
        ->check(CLI::Range(1, 1000));
}

void add_seeing(CLI::App &app, TiledOptions &options) {
    options.descriptor = RLVC_DESCRIPTOR_SIFT_UPRIGHT;
    app.add_option_function<std::string>(
           "--descriptor",
           [&options](const std::string &name) {
               if (rlvc_descriptor_named(name.c_str(), &options.descriptor) != RLVC_VISION_OK) {
                   throw Failure("--descriptor: '" + name +
                                 "' is none of invariants, sqrt-invariants, sift-upright, sift, "
                                 "orb");
               }
           },
           "invariants, sqrt-invariants, sift-upright, sift or orb (sift-upright)")
        ->type_name("NAME");
    app.add_option("--points", options.points, "points of a picture, at most (30)")
        ->check(CLI::Range(1u, RLVC_POINTS_MAX));
    app.add_option("--sigma", options.sigma, "scale of the vectors in pixels (by descriptor)")
        ->check(CLI::Range(0.5, 8.0));
    app.add_option("--axes", options.axes,
                   "discriminant axes of SIFT, where views or light differ; 0: SIFT as it is (16)")
        ->check(CLI::Range(0, 128));
    app.add_option("--share", options.share,
                   "of the other objects' pictures that have a feature at tau (0.035)")
        ->check(CLI::Range(0.001, 0.999));
    app.add_option("--margin", options.margin, "of the margin rule; 1: a fixed tau (1.8)")
        ->check(CLI::Range(1.0, 16.0));
    app.add_option("--candidates", options.candidates, "features looked at for a class (64)")
        ->check(CLI::Range(1, 65535));
    app.add_flag("!--raw-light", options.normalise, "leave the light of pictures as it is");
    app.add_option("--metric", options.metric, "use this metric instead of fitting one")
        ->type_name("FILE");
    app.add_option("--save-metric", options.save_metric, "keep the metric")->type_name("FILE");
}

void add_learning(CLI::App &app, TiledOptions &options) {
    options.criterion = RLVC_CRITERION_RESIDUAL;
    app.add_option_function<std::string>(
           "--criterion",
           [&options](const std::string &name) {
               if (name != "returns" && name != "residual") {
                   throw Failure("--criterion: '" + name + "' is neither returns nor residual");
               }
               options.criterion =
                   name == "returns" ? RLVC_CRITERION_RETURNS : RLVC_CRITERION_RESIDUAL;
           },
           "which classes are aliased: returns, as published, or residual (default)")
        ->type_name("NAME");
    app.add_option("--interactions", options.interactions,
                   "returns: of each step (2000); residual: of the run (4500)")
        ->check(CLI::Range(1, 1000000));
    app.add_option("--steps", options.steps, "learning steps (returns: 20; residual: 2)")
        ->check(CLI::Range(1, 10000));
    app.add_option("--gamma", options.gamma, "discount of future rewards (0.9)")
        ->check(CLI::Range(0.0, 0.999));
    app.add_option("--epsilon", options.epsilon, "probability of exploring (returns: 0.8, else 1)")
        ->check(CLI::Range(0.0, 1.0));
    app.add_option("--alpha", options.alpha, "a split's corrected p-value is below this (0.005)")
        ->check(CLI::Range(1e-30, 1.0));
    app.add_option("--classes", options.classes, "classes the tree may grow to (four a cell)")
        ->check(CLI::Range(1, 65535));
    app.add_option("--seed", options.seed, "of everything random (1)");
    app.add_option("--runs", options.runs, "runs with the seeds from --seed on (1)")
        ->check(CLI::Range(1, 100000));
    app.add_option("--json", options.json, "write a report")->type_name("FILE");
    app.add_option("--dot", options.dot, "write the first run's tree for Graphviz")
        ->type_name("FILE");
    app.add_option("--snapshot", options.snapshot, "write the first run's agent")
        ->type_name("FILE");
}

void settle(TiledOptions &options) {
    const bool returns = options.criterion == RLVC_CRITERION_RETURNS;
    if (options.interactions == 0) {
        options.interactions = returns ? 2000 : 4500;
    }
    if (options.steps == 0) {
        options.steps = returns ? 20 : 2;
    }
    if (!returns && options.steps > options.interactions) {
        throw Failure("--steps: at most one for each interaction");
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
    try {
        app.parse(argc, argv);
    } catch (const CLI::Success &asked) {
        app.exit(asked);
        return false;
    } catch (const CLI::ParseError &error) {
        throw Failure(error.what());
    }
    settle(options);
    return true;
}
