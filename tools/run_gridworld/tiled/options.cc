// SPDX-License-Identifier: MIT
#include "options.h"

#include "../cli/arguments.h"
#include "../cli/failure.h"

#include "rlvc/rlvc.h"
#include "rlvc/vision.h"

#include <algorithm>

namespace {

// A wide window of SIFT separates objects better, at little loss between poses. A bag is many
// narrow ones, of which some are covered or foreign.
constexpr float sift_sigma = 6.0f, other_sigma = 2.5f;
constexpr uint32_t vector_points = 30, bag_points = 120;
constexpr uint32_t vector_candidates = 64, bag_candidates = 16;

const std::vector<Named> descriptors{{"sift-upright", RLVC_DESCRIPTOR_SIFT_UPRIGHT},
                                     {"sift", RLVC_DESCRIPTOR_SIFT},
                                     {"orb", RLVC_DESCRIPTOR_ORB},
                                     {"invariants", RLVC_DESCRIPTOR_INVARIANTS},
                                     {"sqrt-invariants", RLVC_DESCRIPTOR_SQRT_INVARIANTS}};

constexpr LearningTexts tiled_texts{
    "returns: interactions of each step (2000); residual: of the run (4500)",
    "learning steps (returns: 20; residual: 12)",
    "probability of exploring (returns: 0.8; residual: 1)",
    "bound on the probability of any test if there is nothing to learn (0.005)",
    "most classes of the tree (4 for each cell, and 16)",
    "make N runs with seeds from --seed on (1)",
    "write the tree of the first run for Graphviz",
};
constexpr Schedule returns_schedule{2000, 20, 0.8f}, residual_schedule{4500, 12, 1.0f};
constexpr float default_alpha = 0.005f;

// Adds an option for a number.
void add_number(CLI::App &app, const std::string &name, float &into, float low, float high,
                const char *text) {
    app.add_option(name, into, text)->type_name("X")->check(number(low, high));
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
                   const std::string one = list.substr(from, to - from);
                   const int angle = angle_of(name, one);
                   if (std::find(into.begin(), into.end(), angle) != into.end()) {
                       throw Failure(name + ": '" + one + "' is there already");
                   }
                   into.push_back(angle);
                   from = to + 1;
               }
           },
           text)
        ->type_name("A,B,...");
}

void add_world(CLI::App &app, TiledOptions &options) {
    app.add_option(
           "--images", options.images,
           "pictures of objects: files objN__ANGLE.*, as in COIL-100; or a file, or a folder "
           "of poses, for each (built-in objects)")
        ->type_name("DIR")
        ->check(file_name());
    add_whole(app, "--resize", options.side, 8, 4096,
              "scale pictures to N x N (no scaling; all must have the same size)");
    app.add_flag_callback(
           "--scale-depth", [&options] { options.reading.scale_depth = true; },
           "scale pictures of 16 bits a channel to 8")
        ->disable_flag_override();
    app.add_option("--maze", options.maze, "small (10 cells), sutton (46), or a file (sutton)")
        ->type_name("MAZE")
        ->check(file_name());
    add_angles(app, "--poses", options.poses,
               "angles in degrees from which objects are seen, such as 0,20,-20 (0)");
    add_angles(app, "--test-poses", options.test_poses,
               "angles for the test only (those of --poses, in other light)");
    add_number(app, "--light", options.light, 0, 0.99f, "vary the light by up to this share (0)");
    add_number(app, "--noise", options.noise, 0, 255,
               "noise: standard deviation in grey levels (0)");
    add_number(app, "--blur", options.blur, 0, 100, "blur: standard deviation in pixels (0)");
    add_whole(app, "--jpeg", options.jpeg, 1, 100, "compress with this quality (no compression)");
    app.add_option("--backgrounds", options.backgrounds,
                   "replace the plain background of objects by parts of these pictures (keep it)")
        ->type_name("DIR")
        ->check(file_name());
    app.add_option("--test-backgrounds", options.test_backgrounds,
                   "other backgrounds for the test (those of --backgrounds)")
        ->type_name("DIR")
        ->check(file_name());
    add_number(app, "--cover", options.cover, 0, 0.9f,
               "cover up to this share of each picture (0)");
    add_number(app, "--test-cover", options.test_cover, 0, 0.9f,
               "cover exactly this share in the test (as --cover)");
    add_whole(app, "--copies", options.copies, 1, 1000,
              "pictures of each view, if light, noise, background or cover varies (8)");
}

void add_seeing(CLI::App &app, TiledOptions &options) {
    add_named(app, "--descriptor", descriptors, options.descriptor,
              "sift-upright (default), sift, orb, invariants or sqrt-invariants");
    add_whole(app, "--points", options.points, 1, RLVC_POINTS_MAX,
              "maximum number of points in a picture (30; bags: 120)");
    add_number(app, "--sigma", options.sigma, 0.5f, 8,
               "scale of the vectors in pixels (SIFT: 6; others, and bags: 2.5)");
    add_whole(
        app, "--axes", options.axes, 0, 128,
        "discriminant axes that SIFT is reduced to if views or light differ; 0: plain SIFT (16)");
    add_number(app, "--share", options.share, 0.001f, 0.999f,
               "share of the other objects' pictures that exhibit a feature at tau (0.035)");
    add_number(app, "--margin", options.margin, 1, 16,
               "radius of a feature, [tau / X, tau * X]; 1: always tau (1.8)");
    add_whole(app, "--candidates", options.candidates, 1, 65535,
              "features tried for each class (64; bags: 16)");
    app.add_flag_callback(
           "--raw-light", [&options] { options.normalise = false; },
           "do not normalise the light of pictures")
        ->disable_flag_override();
    app.add_flag_callback(
           "--pairs", [&options] { options.pairs = true; },
           "also try as many features of two points; not with --bags")
        ->disable_flag_override();
    app.add_flag_callback(
           "--bags", [&options] { options.bags = true; },
           "features are bags of vectors of which a part is enough")
        ->disable_flag_override();
    add_file(app, "--metric", options.metric, "use this metric instead of fitting one");
    add_output(app, "--save-metric", options.save_metric, "write the metric");
}

void settle_seeing(TiledOptions &options) {
    const bool sift = options.descriptor == RLVC_DESCRIPTOR_SIFT ||
                      options.descriptor == RLVC_DESCRIPTOR_SIFT_UPRIGHT;
    if (options.sigma == 0.0f) {
        options.sigma = sift && !options.bags ? sift_sigma : other_sigma;
    }
    if (options.points == 0) {
        options.points = options.bags ? bag_points : vector_points;
    }
    if (options.candidates == 0) {
        options.candidates = options.bags ? bag_candidates : vector_candidates;
    }
}

void settle(TiledOptions &options) {
    settle_schedule(options, options.returns() ? returns_schedule : residual_schedule);
    options.runs = std::max(options.runs, 1u);
    options.reading.width = options.reading.height = static_cast<int>(options.side);
    if (options.alpha == 0.0f) {
        options.alpha = default_alpha;
    }
    settle_seeing(options);
    if (options.test_backgrounds.empty()) {
        options.test_backgrounds = options.backgrounds;
    }
    const bool scenery =
        !options.test_backgrounds.empty() || options.cover > 0.0f || options.test_cover > 0.0f;
    if (options.light == 0.0f && options.noise == 0.0f && !scenery) {
        options.copies = 1; // they would all be the same
    }
}

} // namespace

bool read_tiled_options(int argc, char **argv, TiledOptions &options) {
    CLI::App app("Learns a maze whose cells are seen as pictures of objects (the Tiled Gridworld, "
                 "section 6.2).\nDefaults are in parentheses.",
                 "run_gridworld tiled");
    add_learning_options(app, options, tiled_texts);
    add_world(app, options);
    add_seeing(app, options);
    add_output(app, "--snapshot", options.snapshot, "write the agent of the first run");
    if (!parse(app, argc, argv)) {
        return false;
    }
    if (options.pairs && options.bags) {
        throw Failure("--bags: cannot be combined with --pairs");
    }
    check_files_differ({{"--save-metric", options.save_metric},
                        {"--json", options.json},
                        {"--dot", options.dot},
                        {"--snapshot", options.snapshot}});
    settle(options);
    return true;
}
