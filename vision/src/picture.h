// SPDX-License-Identifier: MIT
// A picture that has been checked, and what the whole of it says about light.
#ifndef RLVC_VISION_PICTURE_H
#define RLVC_VISION_PICTURE_H

#include "rlvc/vision.h"

#include <opencv2/core.hpp>

#include <cstddef>
#include <cstdint>

namespace rlvc {

struct Picture {
    const uint8_t *pixels;
    ptrdiff_t stride;
    int width;
    int height;
    int channels; // 1 or 3
    bool blue_first;

    const uint8_t *row(int y) const {
        return pixels + y * stride;
    }
};

// Throws Failure(RLVC_VISION_E_PICTURE) that names `what` if a field is out of range.
Picture checked(const rlvc_picture &picture, const char *what);

// The same pixels for OpenCV, unless it cannot address them: it knows no negative stride, and gets
// a copy then.
cv::Mat as_mat(const Picture &picture);

// What each channel, in the order of the bytes, is brought to: gain * c + offset.
struct Light {
    float gain[3];
    float offset[3];
};

// gain 1 and offset 0, or those that bring a channel to mean 128 and deviation 64. A channel that
// is the same everywhere becomes 128 everywhere.
Light light_of(const Picture &picture, bool normalise);

} // namespace rlvc

#endif
