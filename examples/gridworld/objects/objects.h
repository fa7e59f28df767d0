// SPDX-License-Identifier: MIT
// The objects that lie in the cells of the Tiled Gridworld (section 6.2), each seen from some
// angles: the photographs of a folder, or rendered ones, so that the experiment runs on a bare
// machine. Needs OpenCV.
#ifndef GRIDWORLD_OBJECTS_H
#define GRIDWORLD_OBJECTS_H

#include <opencv2/core.hpp>

#include <cstdint>
#include <map>
#include <string>
#include <vector>

struct Object {
    std::string name;
    std::map<int, cv::Mat> views; // by angle; BGR or grey, 8 bits
};

// What is done to pictures that are read, if anything.
struct Reading {
    int width = 0, height = 0; // scaled to this size; 0: left as they are
    bool scale_depth = false;  // 16 bits a channel are scaled to 8; false: refused
};

// The objects of a folder, in the order of their numbers (or names), of which a picture from every
// angle is there. The folder holds one of these:
//
// - objN__ANGLE.* as of COIL-100, in it or in folders below it;
// - any other pictures, which are then objects seen from angle 0;
// - a folder for each object; its pictures are "angles" 0, 1, ... in the order of their names.
//
// Without a folder ("") as many rendered ones as are wanted. All pictures are of one size. Throws
// std::runtime_error: fewer than `wanted`, or what is no picture that can be used.
std::vector<Object> find_objects(const std::string &folder, const std::vector<int> &angles,
                                 std::size_t wanted, const Reading &reading = {});

// The pictures of a folder and of those below it, of any sizes. Throws std::runtime_error: there is
// none, or one that cannot be used.
std::vector<cv::Mat> find_pictures(const std::string &folder);

// A rendered object: a body of revolution with a painted surface, seen by an angle about its axis.
cv::Mat render_object(uint32_t number, int angle);

#endif
