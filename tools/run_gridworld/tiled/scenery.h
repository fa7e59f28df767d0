// SPDX-License-Identifier: MIT
// What is behind objects and before them: parts of other pictures, and covers.
#ifndef RUN_GRIDWORLD_TILED_SCENERY_H
#define RUN_GRIDWORLD_TILED_SCENERY_H

#include "options.h"

#include <opencv2/core.hpp>

#include <random>
#include <vector>

class Scenery {
  public:
    // Reads the folders of backgrounds. Throws Failure.
    explicit Scenery(const TiledOptions &options);

    // The picture as it is learnt from, or in the test. Draws nothing at random, and gives the
    // picture back, unless the options ask for a background or a cover.
    cv::Mat set(const cv::Mat &picture, bool test, std::mt19937 &random) const;

  private:
    struct Stage {
        std::vector<cv::Mat> backgrounds;
        float cover_least = 0.0f, cover_most = 0.0f; // share of a picture
    };

    Stage learning_, test_;
};

#endif
