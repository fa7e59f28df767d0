// SPDX-License-Identifier: MIT
// The inside of the vision module against plain OpenCV calls in double: the response and its
// maxima, the jet, both compilations of the row passes, and extractors that work at the same time.
#include "eye.h"
#include "harris.h"
#include "jet.h"
#include "pictures.h"
#include "rows.h"

#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>
#include <random>
#include <thread>
#include <vector>

// Last: it defines names such as `fail`.
#include <csetjmp>
#include <cstdarg>
#include <cstddef>
#include <cstdint>
extern "C" {
#include <cmocka.h>
}

namespace rlvc {
extern const RowPasses rows_base;
}

namespace {

using namespace rlvc;

cv::Mat1d row_of(const std::vector<float> &half, bool odd) {
    const int radius = static_cast<int>(half.size()) - 1;
    cv::Mat1d row(1, 2 * radius + 1);
    for (int j = -radius; j <= radius; j++) {
        const float tap = half[static_cast<size_t>(std::abs(j))];
        row(radius + j) = static_cast<double>(odd && j < 0 ? -tap : tap);
    }
    return row;
}

cv::Mat1d filtered(const cv::Mat &image, const cv::Mat1d &along, const cv::Mat1d &down) {
    cv::Mat1d out;
    cv::sepFilter2D(image, out, CV_64F, along, down, cv::Point(-1, -1), 0, cv::BORDER_REFLECT_101);
    return out;
}

// H, one OpenCV call after another.
cv::Mat1d reference_response(const cv::Mat &image, const rlvc_vision_config &config) {
    const Gauss sd(config.sd, static_cast<int>(std::ceil(3 * config.sd)));
    const Gauss si(config.si, static_cast<int>(std::ceil(3 * config.si)));
    const cv::Mat1d smooth = row_of(sd.smooth, false), derive = row_of(sd.derive, true);
    std::vector<cv::Mat> channels;
    cv::split(image, channels);
    cv::Mat1d tensor[3];
    for (cv::Mat1d &part : tensor)
        part = cv::Mat1d(image.rows, image.cols, 0.0);
    for (const cv::Mat &channel : channels) {
        const cv::Mat1d dx = filtered(channel, derive, smooth),
                        dy = filtered(channel, smooth, derive);
        tensor[0] += dx.mul(dx);
        tensor[1] += dx.mul(dy);
        tensor[2] += dy.mul(dy);
    }
    for (cv::Mat1d &part : tensor)
        part = filtered(part, row_of(si.smooth, false), row_of(si.smooth, false));
    cv::Mat1d h(image.rows, image.cols);
    for (int y = 0; y < h.rows; y++)
        for (int x = 0; x < h.cols; x++) {
            const double xx = tensor[0](y, x), xy = tensor[1](y, x), yy = tensor[2](y, x);
            h(y, x) = xx * yy - xy * xy - static_cast<double>(config.k) * (xx + yy) * (xx + yy);
        }
    return h;
}

Picture seen(const test_picture &made) {
    return checked(made.picture, "picture");
}

void check_points(const rlvc_vision_config &config, uint32_t width, uint32_t height,
                  uint32_t seed) {
    test_picture made = test_picture_make(width, height, RLVC_PICTURE_BGR, seed);
    const Picture picture = seen(made);
    const cv::Mat1d h = reference_response(as_mat(picture), config);
    cv::Mat1d highest;
    const int side = 2 * static_cast<int>(config.radius) + 1;
    cv::dilate(h, highest, cv::Mat::ones(side, side, CV_8U));
    const double largest = *std::max_element(h.begin(), h.end());
    const double slack = 1e-5 * largest;

    Harris harris(config);
    const float gain[3] = {1, 1, 1};
    const std::vector<rlvc_point> points = harris.find(picture, gain);
    cv::Mat1b found(h.size(), uint8_t{0});
    for (const rlvc_point &p : points) {
        const int x = static_cast<int>(p.x), y = static_cast<int>(p.y);
        found(y, x) = 1;
        if (!(std::fabs(static_cast<double>(p.response) - h(y, x)) <= slack))
            fail_msg("seed %u: H at %d %d is %g, not %g", seed, x, y,
                     static_cast<double>(p.response), h(y, x));
        if (!(h(y, x) >= highest(y, x) - slack))
            fail_msg("seed %u: %d %d is no maximum", seed, x, y);
    }
    // Whatever is clearly a maximum and clearly above the threshold is found.
    int clear = 0;
    for (int y = 0; y < h.rows; y++)
        for (int x = 0; x < h.cols; x++) {
            if (h(y, x) < highest(y, x) ||
                h(y, x) < static_cast<double>(config.threshold) * largest + slack)
                continue;
            clear++;
            if (found(y, x) == 0)
                fail_msg("seed %u: the maximum at %d %d is not found", seed, x, y);
        }
    if (!(static_cast<int>(points.size()) <= clear + 2))
        fail_msg("seed %u: %zu points for %d maxima", seed, points.size(), clear);
    test_picture_free(&made);
}

void test_points_agree(void **) {
    rlvc_vision_config config;
    rlvc_vision_config_default(RLVC_DESCRIPTOR_INVARIANTS, &config);
    config.points = RLVC_POINTS_MAX;
    for (uint32_t seed = 0; seed < 6; seed++)
        check_points(config, 131 - 17 * seed, 60 + 11 * seed, seed);
    check_points(config, 7, 90, 8);
    check_points(config, 90, 7, 9);
    check_points(config, 5, 5, 10);
    config.sd = 0.6f;
    config.si = 0.7f;
    config.radius = 1;
    check_points(config, 80, 60, 11);
    config.sd = 4;
    config.si = 8;
    config.radius = 31;
    config.threshold = 0;
    check_points(config, 100, 70, 12);
    check_points(config, 13, 11, 13);
}

void test_jet_agrees(void **) {
    test_picture made = test_picture_make(60, 50, RLVC_PICTURE_RGB, 3);
    const Picture picture = seen(made);
    std::vector<cv::Mat> channels;
    cv::split(as_mat(picture), channels);
    for (const float sigma : {0.5f, 2.5f, 8.0f}) {
        const Gauss gauss(sigma, static_cast<int>(std::ceil(3 * sigma)));
        const cv::Mat1d smooth = row_of(gauss.smooth, false), derive = row_of(gauss.derive, true);
        Jet jet(sigma);
        for (size_t c = 0; c < 3; c++) {
            const cv::Mat1d value = filtered(channels[c], smooth, smooth);
            const cv::Mat1d dx = filtered(channels[c], derive, smooth);
            const cv::Mat1d dy = filtered(channels[c], smooth, derive);
            for (int y = 0; y < 50; y += 7)
                for (int x = 0; x < 60; x++) {
                    const LocalJet at = jet.at(picture, x, y);
                    assert_true(std::fabs(static_cast<double>(at.value[c]) - value(y, x)) < 2e-3);
                    assert_true(std::fabs(static_cast<double>(at.dx[c]) - dx(y, x)) < 1e-3);
                    assert_true(std::fabs(static_cast<double>(at.dy[c]) - dy(y, x)) < 1e-3);
                }
        }
    }
    test_picture_free(&made);
}

void test_taps(void **) {
    for (const float scale : {0.5f, 1.0f, 2.5f, 8.0f}) {
        const Gauss gauss(scale, static_cast<int>(std::ceil(3 * scale)));
        double sum = static_cast<double>(gauss.smooth[0]), slope = 0;
        for (size_t j = 1; j < gauss.smooth.size(); j++) {
            sum += 2 * static_cast<double>(gauss.smooth[j]);
            slope += 2 * static_cast<double>(j) * static_cast<double>(gauss.derive[j]);
        }
        assert_true(std::fabs(sum - 1) < 1e-6 && std::fabs(slope - 1) < 1e-6);
    }
    const int expected[] = {2, 1, 0, 1, 2, 3, 2, 1, 0, 1};
    for (int i = 0; i < 10; i++)
        assert_int_equal(mirror(i - 2, 4), expected[i]);
    assert_int_equal(mirror(-7, 1), 0);
    assert_int_equal(mirror(5, 2), 1);
}

// The passes that this machine chose give what those for any machine give, to the last bit.
void test_passes_agree(void **) {
    const RowPasses &mine = row_passes();
    const Gauss gauss(2, 6);
    const Taps taps = {gauss.smooth.data(), gauss.derive.data(), gauss.radius};
    std::mt19937 random(1);
    std::vector<std::vector<float>> rows(13, std::vector<float>(256));
    std::vector<uint8_t> bytes(256);
    for (std::vector<float> &row : rows)
        for (float &number : row)
            number = static_cast<float>(random() % 2000) / 7 - 100;
    for (uint8_t &byte : bytes)
        byte = static_cast<uint8_t>(random());
    std::vector<const float *> from;
    for (const std::vector<float> &row : rows)
        from.push_back(row.data());
    const float weight[3] = {1, 0.5f, 3};

    std::vector<std::vector<float>> out[2];
    std::vector<uint32_t> at[2];
    for (int i = 0; i < 2; i++) {
        const RowPasses &passes = i == 0 ? rows_base : mine;
        out[i].assign(8, std::vector<float>(256, 0.0f));
        at[i].assign(256, 0);
        passes.widen(bytes.data(), 192, out[i][0].data());
        passes.down(from.data(), taps, 192, out[i][1].data(), out[i][2].data());
        passes.tensor(from.data(), from.data() + 3, weight, 3, taps, 192, out[i][3].data(),
                      out[i][4].data(), out[i][5].data());
        passes.blur(from.data(), taps, 192, out[i][6].data());
        passes.response(from[0], from[1], from[2], taps, 0.04f, 192, out[i][7].data());
        at[i].resize(passes.peaks(from[0] + 1, from[1] + 1, from[2] + 1, 0, 192, at[i].data()));
    }
    assert_true(out[0] == out[1]);
    assert_true(at[0] == at[1] && at[0].size() > 5);
}

void test_distinct_extractors_work_at_once(void **) {
    constexpr int threads = 4, pictures = 12;
    const auto work = [](std::vector<std::vector<float>> *results) {
        for (uint32_t descriptor = 0; descriptor < RLVC_DESCRIPTORS; descriptor++) {
            rlvc_vision_config config;
            rlvc_vision_config_default(descriptor, &config);
            Eye eye(config);
            for (uint32_t seed = 0; seed < pictures; seed++) {
                test_picture made = test_picture_make(64, 48, RLVC_PICTURE_BGR, seed);
                eye.look(seen(made));
                results->push_back(eye.vectors());
                test_picture_free(&made);
            }
        }
    };
    std::vector<std::vector<float>> alone, together[threads];
    work(&alone);
    std::vector<std::thread> running;
    for (std::vector<std::vector<float>> &results : together)
        running.emplace_back(work, &results);
    for (std::thread &thread : running)
        thread.join();
    for (const std::vector<std::vector<float>> &results : together)
        assert_true(results == alone);
}

} // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test(test_points_agree),
        cmocka_unit_test(test_jet_agrees),
        cmocka_unit_test(test_taps),
        cmocka_unit_test(test_passes_agree),
        cmocka_unit_test(test_distinct_extractors_work_at_once),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
