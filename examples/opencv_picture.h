// SPDX-License-Identifier: MIT
// A cv::Mat as the vision module takes pictures: 8 bits, one channel (grey) or three (BGR, as
// cv::imread gives them). The result points to the pixels of `mat`.
#ifndef OPENCV_PICTURE_H
#define OPENCV_PICTURE_H

#include "rlvc/vision.h"

#include <opencv2/core.hpp>

inline rlvc_picture picture_of(const cv::Mat &mat) {
    rlvc_picture picture{};
    picture.pixels = mat.data;
    picture.stride = static_cast<std::ptrdiff_t>(mat.step);
    picture.width = static_cast<uint32_t>(mat.cols);
    picture.height = static_cast<uint32_t>(mat.rows);
    picture.format = mat.channels() == 1 ? RLVC_PICTURE_GREY : RLVC_PICTURE_BGR;
    return picture;
}

#endif
