// SPDX-License-Identifier: MIT
// The pictures of the objects that lie in the maze's cells.
#ifndef RUN_GRIDWORLD_TILED_PICTURES_H
#define RUN_GRIDWORLD_TILED_PICTURES_H

#include "options.h"

#include <opencv2/core.hpp>

#include <map>
#include <random>
#include <string>
#include <vector>

struct Object {
    std::string name;
    std::map<int, cv::Mat> views; // by angle; BGR or grey, 8 bits
};

// The objects of a folder of which every view asked for is there, in the order of their numbers (or
// names); or as many rendered ones as are wanted. Throws Failure: fewer than `wanted`, or what is no
// picture that can be used.
std::vector<Object> find_objects(const TiledOptions &options, uint32_t wanted);

// A rendered object: a body of revolution with a painted surface, seen by an angle about its axis.
cv::Mat render_object(uint32_t number, int angle);

// The picture in other light, with noise, blurred and compressed, as the options say.
cv::Mat disturb(const cv::Mat &picture, const TiledOptions &options, std::mt19937 &random);

#endif
