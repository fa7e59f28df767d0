// SPDX-License-Identifier: MIT
// Sampled Gaussians and their derivatives, and where a picture goes on beyond its edge.
#ifndef RLVC_VISION_GAUSS_H
#define RLVC_VISION_GAUSS_H

#include <vector>

namespace rlvc {

// The right half of a Gaussian of scale s, cut at `radius`, and of its derivative. The taps are
// scaled so that smoothing keeps a constant and deriving gives a ramp of slope 1 the value 1:
// w[0] + 2 sum w[j] = 1 and 2 sum j d[j] = 1. d[0] = 0, and d[-j] = -d[j].
struct Gauss {
    Gauss(float scale, int radius);
    std::vector<float> smooth;
    std::vector<float> derive;
    int radius;
};

// The index inside [0, n) that stands for any index: mirrored at the first and the last, neither of
// which is repeated.
int mirror(int i, int n);

} // namespace rlvc

#endif
