// SPDX-License-Identifier: MIT
// Rendered objects, so that the experiment runs on a bare machine. An object is a body of
// revolution about an upright axis: its outline is one of a few shapes, its surface is painted with
// a texture of patches, stripes and rings in colours of its own, and a light from the upper left
// shades it. Turning it by an angle brings other parts of the surface into view, as a turntable
// does.
#include "objects.h"

#include <opencv2/imgproc.hpp>

#include <cmath>

namespace {

constexpr int side_pixels = 128;
constexpr int texture_width = 720, texture_height = 256;
constexpr double pi = 3.14159265358979323846;

cv::Scalar colour(cv::RNG &random) {
    return {random.uniform(20.0, 240.0), random.uniform(20.0, 240.0), random.uniform(20.0, 240.0)};
}

void paint_patch(cv::Mat &texture, cv::RNG &random) {
    const cv::Point at(random.uniform(0, texture_width), random.uniform(0, texture_height));
    const int size = random.uniform(10, 34);
    const cv::Scalar paint = colour(random);
    std::vector<cv::Point> corners;
    const int count = random.uniform(3, 7);
    for (int i = 0; i < count; i++) {
        const double angle = 2.0 * pi * i / count + random.uniform(-0.4, 0.4);
        corners.emplace_back(at.x + static_cast<int>(size * std::cos(angle)),
                             at.y + static_cast<int>(size * std::sin(angle)));
    }
    if (random.uniform(0, 3) == 0) {
        cv::circle(texture, at, size * 2 / 3, paint, cv::FILLED, cv::LINE_AA);
    } else {
        cv::fillConvexPoly(texture, corners, paint, cv::LINE_AA);
    }
}

cv::Mat paint_texture(cv::RNG &random) {
    cv::Mat texture(texture_height, texture_width, CV_8UC3, colour(random));
    if (random.uniform(0, 2) == 0) {
        const int step = random.uniform(24, 80);
        const cv::Scalar paint = colour(random);
        for (int x = 0; x < texture_width; x += step) {
            cv::line(texture, {x, 0}, {x + random.uniform(0, 2) * step, texture_height}, paint,
                     step / 4, cv::LINE_AA);
        }
    }
    const int rings = random.uniform(0, 3);
    for (int i = 0; i < rings; i++) {
        const int y = random.uniform(0, texture_height);
        cv::line(texture, {0, y}, {texture_width, y}, colour(random), random.uniform(6, 24));
    }
    const int patches = random.uniform(25, 50);
    for (int i = 0; i < patches; i++) {
        paint_patch(texture, random);
    }
    return texture;
}

// Half the width of the outline at height t in [0, 1] from the top, as a share of the picture's
// side.
double outline(int shape, double t) {
    switch (shape) {
    case 0:
        return 0.34; // a can
    case 1:
        return 0.42 * std::sqrt(std::max(0.0, 1.0 - (2.0 * t - 1.0) * (2.0 * t - 1.0))); // a ball
    case 2:
        return 0.08 + 0.34 * t; // a cone
    case 3:
        return 0.26 + 0.14 * std::sin(2.0 * pi * t); // a vase
    default:
        return t < 0.35 ? 0.14 : 0.36; // a bottle
    }
}

} // namespace

cv::Mat render_object(uint32_t number, int angle) {
    cv::RNG random(0x9e3779b97f4a7c15u + number);
    const cv::Mat texture = paint_texture(random);
    const int shape = random.uniform(0, 5);
    const double top = random.uniform(0.04, 0.2), height = random.uniform(0.7, 0.95) - top;
    cv::Mat map_x(side_pixels, side_pixels, CV_32F, cv::Scalar(-1.0)),
        map_y(side_pixels, side_pixels, CV_32F, cv::Scalar(-1.0));
    cv::Mat shade(side_pixels, side_pixels, CV_32F, cv::Scalar(0.0));
    for (int y = 0; y < side_pixels; y++) {
        const double t = (static_cast<double>(y) / side_pixels - top) / height;
        const double radius = t >= 0.0 && t <= 1.0 ? side_pixels * outline(shape, t) : 0.0;
        for (int x = 0; x < side_pixels; x++) {
            const double s = radius > 0.0 ? (x - side_pixels / 2.0) / radius : 2.0;
            if (std::abs(s) < 1.0) {
                const double turn = std::asin(s) / (2.0 * pi) + angle / 360.0;
                map_x.at<float>(y, x) =
                    static_cast<float>((turn - std::floor(turn)) * (texture_width - 1));
                map_y.at<float>(y, x) = static_cast<float>(t * (texture_height - 1));
                const double facing = std::sqrt(1.0 - s * s);
                shade.at<float>(y, x) = static_cast<float>(0.55 + 0.35 * facing - 0.15 * s);
            }
        }
    }
    cv::Mat seen, picture(side_pixels, side_pixels, CV_8UC3, cv::Scalar::all(25.0));
    cv::remap(texture, seen, map_x, map_y, cv::INTER_LINEAR, cv::BORDER_REPLICATE);
    for (int y = 0; y < side_pixels; y++) {
        for (int x = 0; x < side_pixels; x++) {
            const float light = shade.at<float>(y, x);
            if (light > 0.0f) {
                const cv::Vec3b paint = seen.at<cv::Vec3b>(y, x);
                for (int c = 0; c < 3; c++) {
                    picture.at<cv::Vec3b>(y, x)[c] =
                        cv::saturate_cast<uchar>(light * static_cast<float>(paint[c]));
                }
            }
        }
    }
    cv::GaussianBlur(picture, picture, cv::Size(), 0.7);
    return picture;
}
