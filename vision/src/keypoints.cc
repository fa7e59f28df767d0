// SPDX-License-Identifier: MIT
#include "keypoints.h"

#include "failure.h"

#include <opencv2/imgproc.hpp>

#include <algorithm>

namespace rlvc {
namespace {

// ORB drops points whose window leaves the picture, so the picture is mirrored beyond its edge for
// it.
constexpr int orb_edge = 31;
constexpr int orb_border = orb_edge + 1;

// OpenCV's SIFT clips its window to the picture and then, if less than 6 pixels are left of its
// radius, writes past the end of a buffer (seen in 4.6): so it gets no picture smaller than this,
// and check() no smaller scale than 1.
constexpr int sift_side_min = 8;

// Who OpenCV hands back in what order is its own affair, so each point carries its number.
size_t number_of(const cv::KeyPoint &keypoint) {
    return static_cast<size_t>(keypoint.class_id);
}

void expect_all(size_t described, size_t points) {
    if (described != points)
        throw Failure(RLVC_VISION_E_INTERNAL, "OpenCV described " + std::to_string(described) +
                                                  " of " + std::to_string(points) + " points");
}

} // namespace

Keypoints::Keypoints(const rlvc_vision_config &config)
    : size_(2 * config.sigma), upright_(config.descriptor == RLVC_DESCRIPTOR_SIFT_UPRIGHT) {
    if (config.descriptor == RLVC_DESCRIPTOR_ORB)
        orb_ = cv::ORB::create(static_cast<int>(config.points), 1.2f, 1, orb_edge);
    else if (config.descriptor == RLVC_DESCRIPTOR_SIFT ||
             config.descriptor == RLVC_DESCRIPTOR_SIFT_UPRIGHT)
        sift_ = cv::SIFT::create(0, 1);
}

void Keypoints::describe(const Picture &picture, const std::vector<rlvc_point> &points,
                         const std::vector<float> &directions, float *vectors) {
    cv::Mat grey = as_mat(picture);
    if (picture.channels == 3) {
        cv::Mat converted;
        cv::cvtColor(grey, converted, picture.blue_first ? cv::COLOR_BGR2GRAY : cv::COLOR_RGB2GRAY);
        grey = converted;
    }
    keypoints_.clear();
    for (size_t i = 0; i < points.size(); i++)
        keypoints_.emplace_back(points[i].x, points[i].y, size_, upright_ ? 0 : directions[i],
                                points[i].response, 0, static_cast<int>(i));
    if (sift_)
        describe_by_sift(grey, vectors);
    else
        describe_by_orb(grey, vectors);
}

// The picture mirrored beyond its edge. The points move with it.
cv::Mat Keypoints::with_border(const cv::Mat &grey, int border) {
    cv::Mat bordered;
    cv::copyMakeBorder(grey, bordered, border, border, border, border, cv::BORDER_REFLECT_101);
    for (cv::KeyPoint &keypoint : keypoints_)
        keypoint.pt += cv::Point2f(static_cast<float>(border), static_cast<float>(border));
    return bordered;
}

// SIFT's numbers are whole, 0 to 255, and the vector is 512 long.
void Keypoints::describe_by_sift(const cv::Mat &grey, float *vectors) {
    const size_t count = keypoints_.size();
    cv::Mat bordered = grey, described;
    if (std::min(grey.cols, grey.rows) < sift_side_min)
        bordered = with_border(grey, sift_side_min);
    sift_->compute(bordered, keypoints_, described);
    expect_all(keypoints_.size(), count);
    for (size_t i = 0; i < count; i++) {
        const float *row = described.ptr<float>(static_cast<int>(i));
        float *out = vectors + number_of(keypoints_[i]) * RLVC_DIMENSIONS_SIFT;
        for (size_t j = 0; j < RLVC_DIMENSIONS_SIFT; j++)
            out[j] = row[j] / 512;
    }
}

void Keypoints::describe_by_orb(const cv::Mat &grey, float *vectors) {
    const size_t count = keypoints_.size();
    cv::Mat described;
    orb_->compute(with_border(grey, orb_border), keypoints_, described);
    expect_all(keypoints_.size(), count);
    for (size_t i = 0; i < count; i++) {
        const uint8_t *row = described.ptr<uint8_t>(static_cast<int>(i));
        float *out = vectors + number_of(keypoints_[i]) * RLVC_DIMENSIONS_ORB;
        for (size_t bit = 0; bit < RLVC_DIMENSIONS_ORB; bit++)
            out[bit] = (row[bit / 8] >> bit % 8 & 1) != 0 ? 0.0625f : -0.0625f;
    }
}

} // namespace rlvc
