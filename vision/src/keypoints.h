// SPDX-License-Identifier: MIT
// OpenCV's SIFT and ORB at given points: the "more powerful visual features" of section 7.
#ifndef RLVC_VISION_KEYPOINTS_H
#define RLVC_VISION_KEYPOINTS_H

#include "picture.h"

#include <opencv2/features2d.hpp>

#include <vector>

namespace rlvc {

class Keypoints {
  public:
    // Idle if the config's descriptor is neither.
    explicit Keypoints(const rlvc_vision_config &config);

    // Writes the vectors of the points, of which there is one at least. Directions are in degrees,
    // clockwise on the screen.
    void describe(const Picture &picture, const std::vector<rlvc_point> &points,
                  const std::vector<float> &directions, float *vectors);

  private:
    cv::Mat with_border(const cv::Mat &grey, int border);
    void describe_by_sift(const cv::Mat &grey, float *vectors);
    void describe_by_orb(const cv::Mat &grey, float *vectors);

    float size_;
    bool upright_; // directions are of no meaning
    cv::Ptr<cv::Feature2D> sift_;
    cv::Ptr<cv::Feature2D> orb_;
    std::vector<cv::KeyPoint> keypoints_;
};

} // namespace rlvc

#endif
