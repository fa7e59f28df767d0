// SPDX-License-Identifier: MIT
#include "scenery.h"

#include "../cli/failure.h"

#include "objects/objects.h"

#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>

namespace {

constexpr double plain_range = 14.0; // grey levels by which a plain background may vary

double uniform(std::mt19937 &random, double low, double high) {
    return low + (high - low) * static_cast<double>(random()) / 4294967296.0;
}

int below(std::mt19937 &random, int bound) {
    return static_cast<int>(random() % static_cast<uint32_t>(bound));
}

std::vector<cv::Mat> read_backgrounds(const char *option, const std::string &folder) {
    if (folder.empty()) {
        return {};
    }
    try {
        return find_pictures(folder);
    } catch (const std::runtime_error &error) {
        throw Failure(std::string(option) + ": " + error.what());
    }
}

// A random part of a random picture, in the size and the channels of another one.
cv::Mat part_of(const std::vector<cv::Mat> &pictures, const cv::Mat &like, cv::Size size,
                std::mt19937 &random) {
    cv::Mat whole = pictures[random() % pictures.size()];
    const double scale = std::max({1.0, static_cast<double>(size.width) / whole.cols,
                                   static_cast<double>(size.height) / whole.rows});
    if (scale > 1.0) {
        cv::resize(whole, whole,
                   cv::Size(static_cast<int>(std::ceil(whole.cols * scale)),
                            static_cast<int>(std::ceil(whole.rows * scale))));
    }
    const cv::Point at(below(random, whole.cols - size.width + 1),
                       below(random, whole.rows - size.height + 1));
    cv::Mat part = whole(cv::Rect(at, size)).clone();
    if (part.channels() != like.channels()) {
        cv::cvtColor(part, part, like.channels() == 1 ? cv::COLOR_BGR2GRAY : cv::COLOR_GRAY2BGR);
    }
    return part;
}

// Which pixels are the object: those that are not joined to the picture's corners by one colour.
cv::Mat cut_out(const cv::Mat &picture) {
    cv::Mat flooded = cv::Mat::zeros(picture.rows + 2, picture.cols + 2, CV_8U);
    const cv::Point corners[] = {
        {0, 0}, {picture.cols - 1, 0}, {0, picture.rows - 1}, {picture.cols - 1, picture.rows - 1}};
    cv::Mat copy = picture.clone();
    for (const cv::Point &corner : corners) {
        cv::floodFill(copy, flooded, corner, cv::Scalar(), nullptr, cv::Scalar::all(plain_range),
                      cv::Scalar::all(plain_range),
                      4 | cv::FLOODFILL_FIXED_RANGE | cv::FLOODFILL_MASK_ONLY | 255 << 8);
    }
    cv::Mat object = flooded(cv::Rect(1, 1, picture.cols, picture.rows)) == 0;
    cv::erode(object, object, cv::Mat()); // its rim has something of the background's colour
    return object;
}

// Covers a share of the picture by a rectangle of one colour, or of a background.
void cover(cv::Mat &picture, double share, const std::vector<cv::Mat> &backgrounds,
           std::mt19937 &random) {
    const double shape = std::exp(uniform(random, -0.7, 0.7)); // width to height
    const double area = share * picture.cols * picture.rows;
    const int width = std::clamp(static_cast<int>(std::sqrt(area * shape)), 1, picture.cols);
    const int height = std::clamp(static_cast<int>(area / width), 1, picture.rows);
    const cv::Rect place(below(random, picture.cols - width + 1),
                         below(random, picture.rows - height + 1), width, height);
    if (backgrounds.empty()) {
        const double blue = uniform(random, 0, 256), green = uniform(random, 0, 256);
        picture(place).setTo(cv::Scalar(blue, green, uniform(random, 0, 256)));
    } else {
        part_of(backgrounds, picture, place.size(), random).copyTo(picture(place));
    }
}

} // namespace

Scenery::Scenery(const TiledOptions &options) {
    learning_.backgrounds = read_backgrounds("--backgrounds", options.backgrounds);
    test_.backgrounds = options.test_backgrounds == options.backgrounds
                            ? learning_.backgrounds
                            : read_backgrounds("--test-backgrounds", options.test_backgrounds);
    learning_.cover_most = test_.cover_most = options.cover;
    if (options.test_cover >= 0.0f) {
        test_.cover_least = test_.cover_most = options.test_cover;
    }
}

cv::Mat Scenery::set(const cv::Mat &picture, bool test, std::mt19937 &random) const {
    const Stage &stage = test ? test_ : learning_;
    if (stage.backgrounds.empty() && stage.cover_most <= 0.0f) {
        return picture;
    }
    cv::Mat made = picture.clone();
    if (!stage.backgrounds.empty()) {
        made = part_of(stage.backgrounds, picture, picture.size(), random);
        picture.copyTo(made, cut_out(picture));
    }
    if (stage.cover_most > 0.0f) {
        cover(made, uniform(random, double{stage.cover_least}, double{stage.cover_most}),
              stage.backgrounds, random);
    }
    return made;
}
