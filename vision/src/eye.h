// SPDX-License-Identifier: MIT
// A picture's interest points and their vectors as the descriptor has them, before any metric.
#ifndef RLVC_VISION_EYE_H
#define RLVC_VISION_EYE_H

#include "harris.h"
#include "jet.h"
#include "keypoints.h"

#include <vector>

namespace rlvc {

class Eye {
  public:
    // Checks the config.
    explicit Eye(const rlvc_vision_config &config);

    const rlvc_vision_config &config() const {
        return config_;
    }
    uint32_t dimensions() const {
        return dimensions_;
    }

    // Finds the points of a picture and describes them: points() and vectors().
    void look(const Picture &picture);
    // Describes given points of a picture.
    void look_at(const Picture &picture, const std::vector<rlvc_point> &points);

    const std::vector<rlvc_point> &points() const {
        return points_;
    }
    // One vector after another, dimensions() numbers each.
    const std::vector<float> &vectors() const {
        return vectors_;
    }
    // Of each point, in degrees in [0, 360], clockwise on the screen; 0 if neither the descriptor
    // nor config().places asks for them.
    const std::vector<float> &directions() const {
        return directions_;
    }

  private:
    void look_at_whole(const Picture &picture);
    void describe(const Picture &picture, const Light &light);
    void describe_by_jets(const Picture &picture, const Light &light);

    rlvc_vision_config config_;
    uint32_t dimensions_;
    Harris harris_;
    Jet jet_;
    Keypoints keypoints_;
    std::vector<rlvc_point> points_;
    std::vector<float> vectors_;
    std::vector<float> directions_;
};

} // namespace rlvc

#endif
