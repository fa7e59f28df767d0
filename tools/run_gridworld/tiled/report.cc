// SPDX-License-Identifier: MIT
#include "report.h"

#include "../maze/maze_file.h"
#include "../report/json_values.h"

#include <algorithm>

namespace {

std::string percent(double share) {
    char text[32];
    std::snprintf(text, sizeof text, "%.2f %%", 100.0 * share);
    return text;
}

std::string fixed(double value, int digits) {
    char text[64];
    std::snprintf(text, sizeof text, "%.*f", digits, value);
    return text;
}

std::string padded(const std::string &text, std::size_t width) {
    return std::string(width - std::min(width, text.size()), ' ') + text;
}

std::string point_text(const rlvc_point &point) {
    return "(" + fixed(double{point.x}, 0) + ", " + fixed(double{point.y}, 0) + ")";
}

std::string place_text(const Gallery &gallery, const Test &test) {
    if (test.bag) {
        return gallery.objects()[test.bag->object].name + " at " + std::to_string(test.bag->angle) +
               " deg, " + std::to_string(test.bag->points.size()) + " of " +
               std::to_string(test.bag->count) + " vectors, " + fixed(test.bag->needed, 1) +
               " needed";
    }
    if (!test.place) {
        return "an unknown picture";
    }
    return gallery.objects()[test.place->object].name + " at " + std::to_string(test.place->angle) +
           " deg, " + point_text(test.place->point) +
           (test.second ? " with " + point_text(test.second->point) : "");
}

Json describe_options(const TiledOptions &options) {
    Json json{{"images", options.images.empty() ? Json(nullptr) : Json(options.images)},
              {"maze", options.maze},
              {"poses", options.poses},
              {"test_poses", options.test_poses},
              {"light", shortest(options.light)},
              {"noise", shortest(options.noise)},
              {"blur", shortest(options.blur)},
              {"jpeg", options.jpeg},
              {"copies", options.copies},
              {"backgrounds", options.backgrounds},
              {"test_backgrounds", options.test_backgrounds},
              {"cover", shortest(options.cover)},
              {"test_cover", shortest(std::max(options.test_cover, 0.0f))},
              {"descriptor", rlvc_descriptor_name(options.descriptor)},
              {"points", options.points},
              {"axes", options.axes},
              {"sigma", shortest(options.sigma)},
              {"share", shortest(options.share)},
              {"margin", shortest(options.margin)},
              {"candidates", options.candidates},
              {"normalise", options.normalise},
              {"pairs", options.pairs},
              {"bags", options.bags}};
    add_learning(json, options);
    return json;
}

Json describe_objects(const Gallery &gallery) {
    Json objects = Json::array();
    for (uint32_t i = 0; i < gallery.objects().size(); i++) {
        const Sight &first = gallery.seen(i).front();
        Json points = Json::array();
        for (const rlvc_point &point : first.points) {
            points.push_back({shortest(point.x), shortest(point.y), shortest(point.response)});
        }
        objects.push_back({{"name", gallery.objects()[i].name},
                           {"angle", first.angle},
                           {"points", std::move(points)}});
    }
    return objects;
}

Json describe_cells(const gridworld_maze &maze, const TiledRun &run) {
    Json cells = Json::array();
    for (uint32_t cell = 0; cell < run.object.size(); cell++) {
        if (maze.cells[cell] == GRIDWORLD_FREE) {
            const CellPolicy &policy = run.policy.cells[cell];
            cells.push_back({{"x", cell % maze.width},
                             {"y", cell / maze.width},
                             {"object", run.object[cell]},
                             {"classes", run.classes_of_cell[cell]},
                             {"action", action_name(policy.action)},
                             {"optimal", policy.optimal}});
        }
    }
    return cells;
}

Json describe_bag(const BagPlace &bag) {
    Json points = Json::array();
    for (const rlvc_point &point : bag.points) {
        points.push_back({{"x", shortest(point.x)}, {"y", shortest(point.y)}});
    }
    return {{"count", bag.count}, {"needed", bag.needed}, {"points", std::move(points)}};
}

// A bag is seen in several pictures: object and angle are those of the one that has most of it.
Json describe_test(const Test &test) {
    Json one{{"name", test.name}, {"class", test.split_class},
             {"step", test.step}, {"radius", nullptr},
             {"object", nullptr}, {"angle", nullptr},
             {"x", nullptr},      {"y", nullptr},
             {"second", nullptr}, {"bag", nullptr}};
    if (test.bag) {
        one["object"] = test.bag->object;
        one["angle"] = test.bag->angle;
        one["bag"] = describe_bag(*test.bag);
        return one;
    }
    one["radius"] = shortest(test.radius);
    if (test.place) {
        one["object"] = test.place->object;
        one["angle"] = test.place->angle;
        one["x"] = shortest(test.place->point.x);
        one["y"] = shortest(test.place->point.y);
    }
    if (test.second) {
        one["second"] = {{"x", shortest(test.second->point.x)},
                         {"y", shortest(test.second->point.y)}};
    }
    return one;
}

Json describe_run(const gridworld_maze &maze, const TiledRun &run) {
    Json tests = Json::array();
    for (const Test &test : run.tests) {
        tests.push_back(describe_test(test));
    }
    return {{"seed", run.seed},
            {"optimal_seen", run.optimal_seen},
            {"optimal_heldout", run.optimal_heldout},
            {"cells", run.cells},
            {"optimal_cells", run.optimal_cells},
            {"classes", run.classes},
            {"depth", run.depth},
            {"interactions", run.interactions},
            {"memory_bytes", run.memory_bytes},
            {"seconds", run.seconds},
            {"cell", describe_cells(maze, run)},
            {"tests", std::move(tests)},
            {"tree", Json::parse(run.tree_json)}};
}

Json describe_features(const rlvc_descriptors &of) {
    return {{"form", of.form == RLVC_DESCRIPTORS_INT8 ? "int8" : "float"},
            {"dimensions", of.dimensions},
            {"radius", shortest(of.radius)},
            {"margin", shortest(of.margin)},
            {"draws", of.draws},
            {"candidates", of.candidates}};
}

} // namespace

std::string describe_classes(const gridworld_maze &maze, const Gallery &gallery,
                             const TiledRun &run) {
    std::map<uint32_t, std::string> members;
    for (uint32_t cell = 0; cell < run.object.size(); cell++) {
        if (maze.cells[cell] == GRIDWORLD_FREE) {
            for (const uint32_t class_id : run.classes_of_cell[cell]) {
                members[class_id] += " " + gallery.objects()[run.object[cell]].name;
            }
        }
    }
    std::string text = "Objects by class\n";
    for (const auto &one : members) {
        text += padded(std::to_string(one.first), 5) + " " + one.second + "\n";
    }
    return text;
}

std::string describe_tests(const Gallery &gallery, const TiledRun &run) {
    std::string text = "Tests, in the order in which they were made\n";
    for (std::size_t j = 0; j < run.tests.size(); j++) {
        text += padded(std::to_string(j), 5) + "  class " +
                padded(std::to_string(run.tests[j].split_class), 3) + "  " + run.tests[j].name +
                ": " + place_text(gallery, run.tests[j]) + "\n";
    }
    return text;
}

std::string runs_table_header() {
    return "\n      seed  optimal seen  held out  cells optimal  classes  depth  seconds\n";
}

std::string runs_table_row(const TiledRun &run) {
    return padded(std::to_string(run.seed), 10) + padded(percent(run.optimal_seen), 14) +
           padded(percent(run.optimal_heldout), 10) +
           padded(std::to_string(run.optimal_cells) + " of " + std::to_string(run.cells), 15) +
           padded(std::to_string(run.classes), 9) + padded(std::to_string(run.depth), 7) +
           padded(fixed(run.seconds, 2), 9) + "\n";
}

std::string runs_table_end(const std::vector<TiledRun> &runs) {
    double seen = 0.0, held = 0.0, seconds = 0.0, classes = 0.0;
    uint32_t most = 0, whole = 0;
    for (const TiledRun &run : runs) {
        seen += run.optimal_seen;
        held += run.optimal_heldout;
        seconds += run.seconds;
        classes += run.classes;
        most = std::max(most, run.classes);
        whole += run.optimal_cells == run.cells;
    }
    const double n = static_cast<double>(runs.size());
    return "      mean" + padded(percent(seen / n), 14) + padded(percent(held / n), 10) +
           padded("", 15) + padded(fixed(classes / n, 1), 9) + padded("", 7) +
           padded(fixed(seconds / n, 2), 9) + "\n\n  all cells optimal in " +
           std::to_string(whole) + " of " + std::to_string(runs.size()) + " runs; at most " +
           std::to_string(most) + " classes\n";
}

std::string make_dot(const Gallery &gallery, const TiledRun &run) {
    std::string dot = run.tree_dot;
    for (const Test &test : run.tests) {
        const std::string place = place_text(gallery, test);
        const std::size_t at = dot.find(test.name);
        if (at != std::string::npos) {
            dot.replace(at, test.name.size(), place);
        }
    }
    return dot;
}

std::string make_tiled_report(const TiledOptions &options, const gridworld_maze &maze,
                              const Gallery &gallery, const std::vector<TiledRun> &runs) {
    double seen = 0.0, held = 0.0;
    for (const TiledRun &run : runs) {
        seen += run.optimal_seen;
        held += run.optimal_heldout;
    }
    const auto count = static_cast<double>(runs.size());
    Json json = begin_report("tiled");
    json["options"] = describe_options(options);
    json["maze"] = rows_of(maze);
    json["tau"] = gallery.tau();
    json["features"] = describe_features(gallery.descriptors());
    json["milliseconds_a_picture"] = gallery.milliseconds();
    json["optimal_seen"] = seen / count;
    json["optimal_heldout"] = held / count;
    json["objects"] = describe_objects(gallery);
    json["runs"] = Json::array();
    for (const TiledRun &run : runs) {
        json["runs"].push_back(describe_run(maze, run));
    }
    return text_of(json);
}
