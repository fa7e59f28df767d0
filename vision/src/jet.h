// SPDX-License-Identifier: MIT
// The local jet: value and gradient of each channel, Gaussian-smoothed, at one pixel.
//
// The taps are whole numbers, 2^20 to 1, and all sums are exact in 64 bits. So turning a picture by
// 90 degrees turns the gradients and changes nothing else, to the last bit.
#ifndef RLVC_VISION_JET_H
#define RLVC_VISION_JET_H

#include "picture.h"

#include <cstdint>
#include <vector>

namespace rlvc {

// Grey counts as three equal channels. In the order red, green, blue.
struct LocalJet {
    float value[3];
    float dx[3];
    float dy[3];
};

class Jet {
  public:
    explicit Jet(float sigma);

    // The jet at a pixel, x in [0, width) and y in [0, height).
    LocalJet at(const Picture &picture, int x, int y);

  private:
    template <int channels> void add_row(const uint8_t *row, size_t y);

    int radius_;
    std::vector<int32_t> smooth_; // [2 radius + 1]
    std::vector<int32_t> derive_;
    std::vector<int> column_; // where each column of the window lies in a row, in bytes
    struct Sums {
        int64_t value[3], dx[3], dy[3];
    } sums_;
};

} // namespace rlvc

#endif
