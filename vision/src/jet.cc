// SPDX-License-Identifier: MIT
#include "jet.h"

#include "gauss.h"

#include <cmath>

namespace rlvc {
namespace {

constexpr int one = 1 << 20;

int32_t fixed(float tap) {
    return static_cast<int32_t>(std::lround(static_cast<double>(tap) * one));
}

} // namespace

Jet::Jet(float sigma) : radius_(static_cast<int>(std::ceil(3 * sigma))), sums_() {
    const Gauss gauss(sigma, radius_);
    const size_t taps = 2 * static_cast<size_t>(radius_) + 1;
    smooth_.resize(taps);
    derive_.resize(taps);
    column_.resize(taps);
    int32_t sum = 0;
    for (int j = -radius_; j <= radius_; j++) {
        const size_t tap = static_cast<size_t>(j + radius_);
        const size_t half = static_cast<size_t>(std::abs(j));
        smooth_[tap] = fixed(gauss.smooth[half]);
        derive_[tap] = j < 0 ? -fixed(gauss.derive[half]) : fixed(gauss.derive[half]);
        sum += smooth_[tap];
    }
    smooth_[static_cast<size_t>(radius_)] += one - sum;
}

template <int channels> void Jet::add_row(const uint8_t *row, size_t y) {
    // At most 255 * 2^20 times a small sum of taps: 32 bits hold it.
    int32_t smoothed[channels] = {};
    int32_t derived[channels] = {};
    for (size_t i = 0; i < column_.size(); i++) {
        const uint8_t *pixel = row + column_[i];
        for (int c = 0; c < channels; c++) {
            smoothed[c] += smooth_[i] * pixel[c];
            derived[c] += derive_[i] * pixel[c];
        }
    }
    for (int c = 0; c < channels; c++) {
        sums_.value[c] += static_cast<int64_t>(smooth_[y]) * smoothed[c];
        sums_.dx[c] += static_cast<int64_t>(smooth_[y]) * derived[c];
        sums_.dy[c] += static_cast<int64_t>(derive_[y]) * smoothed[c];
    }
}

LocalJet Jet::at(const Picture &picture, int x, int y) {
    for (int j = -radius_; j <= radius_; j++)
        column_[static_cast<size_t>(j + radius_)] = mirror(x + j, picture.width) * picture.channels;
    sums_ = Sums{};
    for (int j = -radius_; j <= radius_; j++) {
        const uint8_t *row = picture.row(mirror(y + j, picture.height));
        const size_t tap = static_cast<size_t>(j + radius_);
        if (picture.channels == 1)
            add_row<1>(row, tap);
        else
            add_row<3>(row, tap);
    }
    LocalJet jet;
    for (int c = 0; c < 3; c++) {
        const int from = picture.channels == 1 ? 0 : picture.blue_first ? 2 - c : c;
        constexpr double scale = 1.0 / (static_cast<double>(one) * one);
        jet.value[c] = static_cast<float>(static_cast<double>(sums_.value[from]) * scale);
        jet.dx[c] = static_cast<float>(static_cast<double>(sums_.dx[from]) * scale);
        jet.dy[c] = static_cast<float>(static_cast<double>(sums_.dy[from]) * scale);
    }
    return jet;
}

} // namespace rlvc
