// SPDX-License-Identifier: MIT
#include "pictures.h"

#include "../cli/failure.h"

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

std::vector<Object> find_objects(const TiledOptions &options, uint32_t wanted) {
    std::vector<int> angles = options.poses;
    angles.insert(angles.end(), options.test_poses.begin(), options.test_poses.end());
    try {
        return find_objects(options.images, angles, wanted, options.reading);
    } catch (const std::runtime_error &error) {
        throw Failure(std::string("--images: ") + error.what());
    }
}

cv::Mat disturb(const cv::Mat &picture, const TiledOptions &options, std::mt19937 &random) {
    cv::Mat changed;
    std::uniform_real_distribution<double> light(1.0 - double{options.light},
                                                 1.0 + double{options.light});
    picture.convertTo(changed, CV_32F, options.light > 0.0f ? light(random) : 1.0);
    if (options.blur > 0.0f) {
        cv::GaussianBlur(changed, changed, cv::Size(), double{options.blur});
    }
    if (options.noise > 0.0f) {
        cv::Mat noise(changed.size(), changed.type());
        cv::RNG generator(random());
        generator.fill(noise, cv::RNG::NORMAL, 0.0, double{options.noise});
        changed += noise;
    }
    changed.convertTo(changed, CV_8U);
    if (options.jpeg > 0) {
        std::vector<uchar> bytes;
        cv::imencode(".jpg", changed, bytes,
                     {cv::IMWRITE_JPEG_QUALITY, static_cast<int>(options.jpeg)});
        changed = cv::imdecode(bytes, cv::IMREAD_UNCHANGED);
    }
    return changed;
}
