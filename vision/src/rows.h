// SPDX-License-Identifier: MIT
// The inner loops of the Harris response, one row at a time. rows_body.h is compiled once for the
// machine that the build is for and once more for AVX2 where there may be one; both give the same
// numbers bit for bit, as neither contracts a product and a sum and both add in the same order.
//
// A Gaussian of scale s is the taps w[0..r], w[j] = w[-j]; its derivative is d[1..r], d[-j] =
// -d[j].
#ifndef RLVC_VISION_ROWS_H
#define RLVC_VISION_ROWS_H

#include <cstddef>
#include <cstdint>

namespace rlvc {

// Loops run over whole blocks: a row has room for its length rounded up to this.
constexpr size_t row_block = 16;

constexpr int channels_max = 3;

struct Taps {
    const float *smooth; // [radius + 1]
    const float *derive; // [radius + 1], derive[0] = 0
    int radius;
};

struct RowPasses {
    void (*widen)(const uint8_t *bytes, size_t n, float *out);
    // Across 2 radius + 1 rows: *smoothed and *derived, n numbers each.
    void (*down)(const float *const *rows, const Taps &taps, size_t n, float *smoothed,
                 float *derived);
    // Along rows of smoothed and derived numbers, which begin radius before the first: the tensor's
    // three rows, sum over channels of weight (I_x^2, I_x I_y, I_y^2).
    void (*tensor)(const float *const *smoothed, const float *const *derived, const float *weight,
                   int channels, const Taps &taps, size_t n, float *xx, float *xy, float *yy);
    // Across 2 radius + 1 rows, smoothing alone.
    void (*blur)(const float *const *rows, const Taps &taps, size_t n, float *out);
    // Along the three rows of the blurred tensor: H = det M - k (trace M)^2.
    void (*response)(const float *xx, const float *xy, const float *yy, const Taps &taps, float k,
                     size_t n, float *h);
    // Writes down, ascending, each x where the middle row exceeds `above` and no neighbour of the
    // eight exceeds it; says how many. Each row can be read from -1 to n.
    size_t (*peaks)(const float *up, const float *middle, const float *low, float above, size_t n,
                    uint32_t *at);
};

// The fastest that this machine runs.
const RowPasses &row_passes();

} // namespace rlvc

#endif
