// SPDX-License-Identifier: MIT
// Colour Harris points (section 6.2; Montesinos, Gouet and Deriche): with Gaussian derivatives of
// scale sd of each channel and integration over scale si,
//
//     M = G_si * sum over channels of w [I_x^2, I_x I_y; I_x I_y, I_y^2],
//     H = det M - k (trace M)^2,
//
// and a point is a local maximum of H that is positive.
//
// The picture is gone through once. Row by row, its bytes become the derivatives' smoothed rows,
// those the tensor's, those the response's, and only as many rows of each are kept as the next step
// reaches, so that they stay in the nearest cache. Pictures go on beyond their edge as mirrored,
// the tensor likewise.
#ifndef RLVC_VISION_HARRIS_H
#define RLVC_VISION_HARRIS_H

#include "gauss.h"
#include "picture.h"
#include "rows.h"
#include "rlvc/vision.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace rlvc {

// The last `count` of a picture's rows of floats.
class Ring {
  public:
    void reset(int count, size_t pitch);
    float *row(int y) {
        return &data_[static_cast<size_t>(y % count_) * pitch_];
    }

  private:
    std::vector<float> data_;
    int count_ = 1;
    size_t pitch_ = 0;
};

class Harris {
  public:
    explicit Harris(const rlvc_vision_config &config);

    // The at most config.points strongest points, strongest first, equal ones by y and then x.
    // gain[c] is what channel c is multiplied with beforehand.
    const std::vector<rlvc_point> &find(const Picture &picture, const float *gain);

  private:
    void start(const Picture &picture, const float *gain);
    void read_until(int y);
    void make_tensor_until(int y);
    void make_response(int y);
    void collect_peaks(int y);
    bool is_peak(int x, int y);
    void keep_strongest(size_t count);
    float noise_response() const;

    rlvc_vision_config config_;
    const RowPasses &passes_;
    Gauss derivative_;
    Gauss integration_;

    Picture picture_{};
    float weight_[channels_max] = {};
    int read_ = 0;        // rows of the picture read,
    int tensor_rows_ = 0; // and of the tensor made, so far
    size_t block_width_ = 0;

    std::vector<uint8_t> bytes_; // a row, channel after channel
    Ring channel_[channels_max]; // mirrored by derivative_.radius on both sides
    std::vector<float> down_;    // rows smoothed and derived downwards, likewise
    Ring tensor_[3];             // xx, xy, yy, mirrored by integration_.radius
    std::vector<float> blurred_; // the same, blurred downwards
    Ring response_;              // H, with one -infinity at the left and some at the right
    std::vector<float> outside_; // a row of -infinity
    std::vector<uint32_t> at_;
    std::vector<rlvc_point> points_;
    float strongest_ = 0;
};

} // namespace rlvc

#endif
