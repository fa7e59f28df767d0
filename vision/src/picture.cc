// SPDX-License-Identifier: MIT
#include "picture.h"

#include "failure.h"

#include <algorithm>
#include <cstdint>
#include <string>

namespace rlvc {
namespace {

[[noreturn]] void refuse_picture(const std::string &text) {
    throw Failure(RLVC_VISION_E_PICTURE, text);
}

void check_side(uint32_t side, const std::string &name) {
    if (side < 1 || side > RLVC_PICTURE_SIDE_MAX)
        refuse_picture(name + " is " + std::to_string(side) + ", but must be 1 to " +
                       std::to_string(RLVC_PICTURE_SIDE_MAX) + " pixels");
}

} // namespace

Picture checked(const rlvc_picture &picture, const char *what) {
    const std::string name = what;
    if (picture.pixels == nullptr)
        throw Failure(RLVC_VISION_E_NULL, name + ".pixels is null");
    check_side(picture.width, name + ".width");
    check_side(picture.height, name + ".height");
    if (picture.format > RLVC_PICTURE_RGB)
        refuse_picture(name + ".format is " + std::to_string(picture.format) +
                       ", but must be grey (0), BGR (1) or RGB (2)");
    const int channels = picture.format == RLVC_PICTURE_GREY ? 1 : 3;
    const ptrdiff_t row = static_cast<ptrdiff_t>(picture.width) * channels;
    if (picture.height > 1 && picture.stride < row && picture.stride > -row)
        refuse_picture(name + ".stride is " + std::to_string(picture.stride) + ", but a row is " +
                       std::to_string(row) + " bytes");
    const ptrdiff_t most = PTRDIFF_MAX / static_cast<ptrdiff_t>(picture.height);
    if (picture.height > 1 && (picture.stride > most || picture.stride < -most))
        refuse_picture(name + ".stride is " + std::to_string(picture.stride) +
                       ", which no memory can hold so many rows of");
    return {picture.pixels,
            picture.height > 1 ? picture.stride : row,
            static_cast<int>(picture.width),
            static_cast<int>(picture.height),
            channels,
            picture.format == RLVC_PICTURE_BGR};
}

cv::Mat as_mat(const Picture &picture) {
    const int type = picture.channels == 1 ? CV_8UC1 : CV_8UC3;
    if (picture.stride > 0)
        return cv::Mat(picture.height, picture.width, type, const_cast<uint8_t *>(picture.pixels),
                       static_cast<size_t>(picture.stride));
    cv::Mat copy(picture.height, picture.width, type);
    for (int y = 0; y < picture.height; y++)
        std::copy_n(picture.row(y), copy.elemSize() * static_cast<size_t>(copy.cols), copy.ptr(y));
    return copy;
}

Light light_of(const Picture &picture, bool normalise) {
    Light light = {{1, 1, 1}, {0, 0, 0}};
    if (!normalise)
        return light;
    cv::Scalar mean, deviation;
    cv::meanStdDev(as_mat(picture), mean, deviation);
    for (int c = 0; c < picture.channels; c++) {
        const double gain = deviation[c] > 0 ? 64 / deviation[c] : 0;
        light.gain[c] = static_cast<float>(gain);
        light.offset[c] = static_cast<float>(128 - gain * mean[c]);
    }
    return light;
}

} // namespace rlvc
