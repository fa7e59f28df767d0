// SPDX-License-Identifier: MIT
#include "whitening.h"

#include <opencv2/core.hpp>

#include <algorithm>
#include <cmath>

namespace rlvc {
namespace {

constexpr double least_eigenvalue = 1e-3;
constexpr double ridge = 0.1; // of the mean diagonal number

cv::Mat1d spread_of(const std::vector<float> &vectors, const std::vector<float> &centre, int n) {
    cv::Mat1d spread(n, n, 0.0);
    const auto count = static_cast<int>(vectors.size() / centre.size());
    cv::Mat1d v(1, n);
    for (int k = 0; k < count; k++) {
        const float *from = &vectors[static_cast<size_t>(k) * centre.size()];
        for (int i = 0; i < n; i++)
            v(i) =
                static_cast<double>(from[i]) - static_cast<double>(centre[static_cast<size_t>(i)]);
        for (int i = 0; i < n; i++)
            for (int j = 0; j <= i; j++)
                spread(i, j) += v(i) * v(j);
    }
    cv::completeSymm(spread, true);
    spread *= 1.0 / count;
    return spread;
}

} // namespace

std::vector<float> mean_of(const std::vector<float> &vectors, size_t n) {
    std::vector<double> sum(n, 0.0);
    for (size_t i = 0; i < vectors.size(); i++)
        sum[i % n] += static_cast<double>(vectors[i]);
    std::vector<float> mean;
    for (double s : sum)
        mean.push_back(
            static_cast<float>(s * static_cast<double>(n) / static_cast<double>(vectors.size())));
    return mean;
}

std::vector<float> whitening_of(const std::vector<float> &vectors, const std::vector<float> &centre,
                                size_t dimensions) {
    const auto n = static_cast<int>(dimensions);
    cv::Mat1d spread = spread_of(vectors, centre, n);
    std::vector<double> scale(dimensions);
    for (int i = 0; i < n; i++) {
        const double deviation = std::sqrt(spread(i, i));
        scale[static_cast<size_t>(i)] = deviation > 0 ? deviation : 1;
        if (!(deviation > 0))
            spread(i, i) = 1;
    }
    for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++)
            spread(i, j) /= scale[static_cast<size_t>(i)] * scale[static_cast<size_t>(j)];

    cv::Mat1d values, axes;
    cv::eigen(spread, values, axes);
    std::vector<float> matrix;
    for (int i = 0; i < n; i++) {
        const double root = std::sqrt(std::max(values(i), least_eigenvalue));
        for (int j = 0; j < n; j++)
            matrix.push_back(static_cast<float>(axes(i, j) / root / scale[static_cast<size_t>(j)]));
    }
    return matrix;
}

std::vector<float> discriminants_of(const std::vector<float> &changes,
                                    const std::vector<float> &vectors,
                                    const std::vector<float> &centre, size_t n, size_t kept) {
    const auto size = static_cast<int>(n);
    cv::Mat1d within = spread_of(changes, std::vector<float>(n, 0.0f), size);
    const double mean = cv::trace(within)[0] / size;
    within += (mean > 0 ? ridge * mean : 1) * cv::Mat1d::eye(size, size);
    cv::Mat1d values, whitening, axes;
    cv::eigen(within, values, whitening);
    for (int i = 0; i < size; i++)
        whitening.row(i) *= 1 / std::sqrt(values(i));
    cv::Mat1d among;
    cv::gemm(whitening * spread_of(vectors, centre, size), whitening, 1, cv::noArray(), 0, among,
             cv::GEMM_2_T);
    cv::eigen(among, values, axes);
    cv::Mat1d all;
    cv::gemm(axes, whitening, 1, cv::noArray(), 0, all);
    return {all.begin(), all.begin() + static_cast<ptrdiff_t>(kept * n)};
}

} // namespace rlvc
