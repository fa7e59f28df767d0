// SPDX-License-Identifier: MIT
// The command line of `run_gridworld tiled`.
#ifndef RUN_GRIDWORLD_TILED_OPTIONS_H
#define RUN_GRIDWORLD_TILED_OPTIONS_H

#include "../cli/learning_options.h"

#include "objects/objects.h"

#include <string>
#include <vector>

struct TiledOptions : LearningOptions {
    // The world.
    std::string images; // a folder; empty: the built-in objects
    uint32_t side = 0;  // to which they are scaled; 0: as they are
    Reading reading;    // of these
    std::string maze = "sutton";
    std::vector<int> poses{0}, test_poses;     // degrees, [0, 360)
    float light = 0.0f;                        // a picture's light varies by +- this share
    float noise = 0.0f;                        // standard deviation, in grey levels
    float blur = 0.0f;                         // standard deviation, in pixels
    uint32_t jpeg = 0;                         // quality; 0: not compressed
    uint32_t copies = 8;                       // pictures of each view, if they differ at all
    std::string backgrounds, test_backgrounds; // folders; empty: pictures as they are
    float cover = 0.0f, test_cover = -1.0f;    // share of a picture; below 0: as in learning

    // Seeing.
    uint8_t descriptor = 0; // RLVC_DESCRIPTOR_*
    uint32_t points = 0;    // 0: the default of such features
    uint32_t axes = 16;     // of SIFT that a metric keeps; 0: SIFT as it is
    float sigma = 0.0f;     // 0: the default of descriptor and features
    float share = 0.035f;   // of the other objects' pictures that exhibit a feature at tau
    float margin = 1.8f;
    uint32_t candidates = 0; // 0: the default of such features
    bool normalise = true;
    bool pairs = false;              // features of two points, too
    bool bags = false;               // features are bags of vectors; not together with pairs
    std::string metric, save_metric; // files

    std::string snapshot; // a file; empty: none
};

// Reads the command line; argv[0] is "tiled". Returns false if it asked for --help or --version,
// which is printed then. Throws Failure.
bool read_tiled_options(int argc, char **argv, TiledOptions &options);

#endif
