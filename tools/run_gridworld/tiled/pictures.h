// SPDX-License-Identifier: MIT
// The pictures of the objects in the maze's cells.
#ifndef RUN_GRIDWORLD_TILED_PICTURES_H
#define RUN_GRIDWORLD_TILED_PICTURES_H

#include "options.h"

#include "objects/objects.h"

#include <random>

// At least `wanted` objects: one for each cell. Throws Failure.
std::vector<Object> find_objects(const TiledOptions &options, uint32_t wanted);

// The picture with its light, noise, blur and compression changed as the options say.
cv::Mat disturb(const cv::Mat &picture, const TiledOptions &options, std::mt19937 &random);

#endif
