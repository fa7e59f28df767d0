// SPDX-License-Identifier: MIT
#include "eye.h"

#include "config.h"
#include "quarters.h"

#include <cmath>

namespace rlvc {
namespace {

float signed_root(float term) {
    return std::copysign(std::sqrt(std::fabs(term)), term);
}

// The invariants of a jet after each channel is brought into the light's gain c + offset.
void invariants(const LocalJet &jet, const float *gain, const float *offset, bool rooted,
                float *v) {
    float dx[3], dy[3];
    for (int c = 0; c < 3; c++) {
        dx[c] = gain[c] * jet.dx[c];
        dy[c] = gain[c] * jet.dy[c];
        v[2 * c] = gain[c] * jet.value[c] + offset[c];
        v[2 * c + 1] = dx[c] * dx[c] + dy[c] * dy[c];
    }
    v[6] = dx[0] * dx[1] + dy[0] * dy[1];
    v[7] = dx[0] * dx[2] + dy[0] * dy[2];
    if (rooted)
        for (int i : {1, 3, 5, 6, 7})
            v[i] = signed_root(v[i]);
}

// The direction of the gradient of grey, clockwise on the screen, in degrees in [0, 360].
float direction(const LocalJet &jet) {
    constexpr float red = 0.299f, green = 0.587f, blue = 0.114f;
    const float dx = red * jet.dx[0] + green * jet.dx[1] + blue * jet.dx[2];
    const float dy = red * jet.dy[0] + green * jet.dy[1] + blue * jet.dy[2];
    const float degrees = std::atan2(dy, dx) * 57.29578f;
    return degrees < 0 ? degrees + 360 : degrees;
}

const rlvc_vision_config &checked(const rlvc_vision_config &config) {
    check(config);
    return config;
}

} // namespace

Eye::Eye(const rlvc_vision_config &config)
    : config_(checked(config)), dimensions_(rlvc_descriptor_dimensions(config.descriptor)),
      harris_(config), jet_(config.sigma), keypoints_(config) {
}

void Eye::look(const Picture &picture) {
    if (config_.descriptor == RLVC_DESCRIPTOR_QUARTERS) {
        look_at_whole(picture);
        return;
    }
    const Light light = light_of(picture, config_.normalise != 0);
    points_ = harris_.find(picture, light.gain);
    describe(picture, light);
}

void Eye::look_at(const Picture &picture, const std::vector<rlvc_point> &points) {
    if (config_.descriptor == RLVC_DESCRIPTOR_QUARTERS) {
        look_at_whole(picture);
        return;
    }
    points_ = points;
    describe(picture, light_of(picture, config_.normalise != 0));
}

void Eye::look_at_whole(const Picture &picture) {
    points_ = {{static_cast<float>(picture.width / 2), static_cast<float>(picture.height / 2), 1}};
    directions_ = {0};
    vectors_.resize(dimensions_);
    quarters(picture, vectors_.data());
}

void Eye::describe(const Picture &picture, const Light &light) {
    const bool coloured = config_.descriptor == RLVC_DESCRIPTOR_INVARIANTS ||
                          config_.descriptor == RLVC_DESCRIPTOR_SQRT_INVARIANTS;
    const bool directed = config_.descriptor == RLVC_DESCRIPTOR_SIFT ||
                          config_.descriptor == RLVC_DESCRIPTOR_ORB ||
                          config_.places == RLVC_PLACES_DIRECTED;
    vectors_.resize(points_.size() * dimensions_);
    directions_.assign(points_.size(), 0);
    if (coloured)
        describe_by_jets(picture, light);
    for (size_t i = 0; directed && i < points_.size(); i++)
        directions_[i] = direction(
            jet_.at(picture, static_cast<int>(points_[i].x), static_cast<int>(points_[i].y)));
    if (!coloured && !points_.empty())
        keypoints_.describe(picture, points_, directions_, vectors_.data());
}

void Eye::describe_by_jets(const Picture &picture, const Light &light) {
    float gain[3], offset[3];
    for (int c = 0; c < 3; c++) {
        const int from = picture.channels == 1 ? 0 : picture.blue_first ? 2 - c : c;
        gain[c] = light.gain[from];
        offset[c] = light.offset[from];
    }
    for (size_t i = 0; i < points_.size(); i++)
        invariants(jet_.at(picture, static_cast<int>(points_[i].x), static_cast<int>(points_[i].y)),
                   gain, offset, config_.descriptor == RLVC_DESCRIPTOR_SQRT_INVARIANTS,
                   &vectors_[i * dimensions_]);
}

} // namespace rlvc
