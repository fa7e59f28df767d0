// SPDX-License-Identifier: MIT
// One run of the Tiled Gridworld.
#ifndef RUN_GRIDWORLD_TILED_LEARNER_H
#define RUN_GRIDWORLD_TILED_LEARNER_H

#include "../maze/optimum.h"
#include "../maze/policy.h"
#include "gallery.h"

#include <optional>

// A test of the tree, as in figure 5.
struct Test {
    uint32_t split_class = 0, step = 0;
    float radius = 0.0f; // in units of the percept
    std::string name;
    const Place *place = nullptr;  // in the gallery;
    const Place *second = nullptr; // of a pair, of its second point
    std::optional<BagPlace> bag;   // of a bag, in place of these and the radius
};

struct TiledRun {
    uint32_t seed = 0;
    std::vector<uint32_t> object; // of each free cell
    double optimal_seen = 0.0, optimal_heldout = 0.0;
    uint32_t cells = 0, optimal_cells = 0; // cells whose pictures all get an optimal action
    uint32_t classes = 1, depth = 0;
    uint64_t interactions = 0;
    std::size_t memory_bytes = 0;
    double seconds = 0.0;                               // of learning, without collecting
    Policy policy;                                      // of the pictures learnt from
    std::vector<std::vector<uint32_t>> classes_of_cell; // of its pictures learnt from
    std::vector<Test> tests;
    std::string tree_json, tree_dot;
    std::string snapshot; // of the agent; see core/SPEC.md
};

using TiledListener = std::function<void(const std::string &)>;

// Throws Failure, Interrupted.
TiledRun learn_tiled(const TiledOptions &options, const gridworld_maze &maze,
                     const Optimum &optimum, Gallery &gallery, uint32_t seed,
                     const TiledListener &listener);

#endif
