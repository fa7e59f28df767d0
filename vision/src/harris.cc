// SPDX-License-Identifier: MIT
#include "harris.h"

#include <opencv2/core/hal/hal.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace rlvc {
namespace {

constexpr float nothing = -std::numeric_limits<float>::infinity();
constexpr size_t left = 1; // of response rows

// A Gaussian is cut at three times its scale, where it has fallen to a hundredth.
int reach(float scale) {
    return static_cast<int>(std::ceil(3 * scale));
}

size_t round_up(size_t n) {
    return (n + row_block - 1) / row_block * row_block;
}

// Fills the `border` numbers on both sides of the width in the middle of a row.
void mirror_ends(float *row, int width, int border) {
    for (int i = 1; i <= border; i++) {
        row[border - i] = row[border + mirror(-i, width)];
        row[border + width - 1 + i] = row[border + mirror(width - 1 + i, width)];
    }
}

// The rows of a ring that stand for y - radius to y + radius.
void window(Ring &ring, int y, int radius, int height, const float **rows) {
    for (int j = -radius; j <= radius; j++)
        *rows++ = ring.row(mirror(y + j, height));
}

bool stronger(const rlvc_point &a, const rlvc_point &b) {
    if (a.response != b.response)
        return a.response > b.response;
    return a.y != b.y ? a.y < b.y : a.x < b.x;
}

Taps taps_of(const Gauss &gauss) {
    return {gauss.smooth.data(), gauss.derive.data(), gauss.radius};
}

constexpr int rows_max = 2 * 24 + 1; // three times the largest si, on both sides

} // namespace

void Ring::reset(int count, size_t pitch) {
    count_ = count;
    pitch_ = pitch;
    data_.resize(static_cast<size_t>(count) * pitch);
}

Harris::Harris(const rlvc_vision_config &config)
    : config_(config), passes_(row_passes()), derivative_(config.sd, reach(config.sd)),
      integration_(config.si, reach(config.si)) {
}

void Harris::start(const Picture &picture, const float *gain) {
    picture_ = picture;
    const size_t width = static_cast<size_t>(picture.width);
    const size_t border = static_cast<size_t>(std::max(derivative_.radius, integration_.radius));
    block_width_ = round_up(width);
    // Passes over a mirrored row round its length up, and those along rows read on from there.
    const size_t pitch = round_up(width + 2 * border) + row_block + 2 * border;
    for (int c = 0; c < picture.channels; c++) {
        // Grey stands for three equal channels.
        weight_[c] = gain[c] * gain[c] * (picture.channels == 1 ? 3.0f : 1.0f);
        channel_[c].reset(2 * derivative_.radius + 1, pitch);
    }
    for (Ring &tensor : tensor_)
        tensor.reset(2 * integration_.radius + 1, pitch);
    response_.reset(2 * static_cast<int>(config_.radius) + 1, pitch);
    bytes_.resize(channels_max * (block_width_ + row_block) + 1);
    down_.resize(2 * channels_max * pitch);
    blurred_.resize(3 * pitch);
    outside_.assign(pitch, nothing);
    at_.resize(block_width_);
    points_.clear();
    read_ = 0;
    tensor_rows_ = 0;
    strongest_ = 0;
}

void Harris::read_until(int y) {
    for (; read_ <= y; read_++) {
        // split8u writes past the caches where its targets are aligned, but they are read at once:
        // hence the odd byte.
        uint8_t *plane[channels_max];
        for (size_t c = 0; c < channels_max; c++)
            plane[c] = &bytes_[c * (block_width_ + row_block) + 1];
        if (picture_.channels == 1)
            std::copy_n(picture_.row(read_), picture_.width, plane[0]);
        else
            cv::hal::split8u(picture_.row(read_), plane, picture_.width, picture_.channels);
        for (int c = 0; c < picture_.channels; c++) {
            float *row = channel_[c].row(read_);
            passes_.widen(plane[c], block_width_, row + derivative_.radius);
            mirror_ends(row, picture_.width, derivative_.radius);
        }
    }
}

void Harris::make_tensor_until(int y) {
    const int radius = derivative_.radius;
    const Taps taps = taps_of(derivative_);
    const size_t mirrored = static_cast<size_t>(picture_.width + 2 * radius);
    const size_t pitch = down_.size() / (2 * channels_max);
    for (; tensor_rows_ <= y; tensor_rows_++) {
        read_until(std::min(tensor_rows_ + radius, picture_.height - 1));
        const float *smoothed[channels_max];
        const float *derived[channels_max];
        for (int c = 0; c < picture_.channels; c++) {
            const float *rows[rows_max];
            window(channel_[c], tensor_rows_, radius, picture_.height, rows);
            float *s = &down_[static_cast<size_t>(2 * c) * pitch];
            float *d = s + pitch;
            passes_.down(rows, taps, round_up(mirrored), s, d);
            smoothed[c] = s;
            derived[c] = d;
        }
        float *out[3];
        for (int i = 0; i < 3; i++)
            out[i] = tensor_[i].row(tensor_rows_);
        const int border = integration_.radius;
        passes_.tensor(smoothed, derived, weight_, picture_.channels, taps, block_width_,
                       out[0] + border, out[1] + border, out[2] + border);
        for (float *row : out)
            mirror_ends(row, picture_.width, border);
    }
}

void Harris::make_response(int y) {
    const int radius = integration_.radius;
    make_tensor_until(std::min(y + radius, picture_.height - 1));
    const Taps taps = taps_of(integration_);
    const size_t mirrored = static_cast<size_t>(picture_.width + 2 * radius);
    const size_t pitch = blurred_.size() / 3;
    for (size_t i = 0; i < 3; i++) {
        const float *rows[rows_max];
        window(tensor_[i], y, radius, picture_.height, rows);
        passes_.blur(rows, taps, round_up(mirrored), &blurred_[i * pitch]);
    }
    float *h = response_.row(y);
    passes_.response(&blurred_[0], &blurred_[pitch], &blurred_[2 * pitch], taps, config_.k,
                     block_width_, h + left);
    h[0] = nothing;
    std::fill(h + left + picture_.width, h + left + block_width_ + 1, nothing);
}

// Whether no H of the square around (x, y) exceeds that in the middle. Of equal ones the first
// stands.
bool Harris::is_peak(int x, int y) {
    const int radius = static_cast<int>(config_.radius);
    const float h = response_.row(y)[left + static_cast<size_t>(x)];
    const int x_end = std::min(x + radius, picture_.width - 1);
    const int y_end = std::min(y + radius, picture_.height - 1);
    for (int v = std::max(y - radius, 0); v <= y_end; v++) {
        const float *row = response_.row(v) + left;
        for (int u = std::max(x - radius, 0); u <= x_end; u++) {
            const bool before = v < y || (v == y && u < x);
            if (row[u] > h || (before && row[u] == h))
                return false;
        }
    }
    return true;
}

void Harris::collect_peaks(int y) {
    const float *up = y > 0 ? response_.row(y - 1) : outside_.data();
    const float *low = y + 1 < picture_.height ? response_.row(y + 1) : outside_.data();
    const size_t count = passes_.peaks(up + left, response_.row(y) + left, low + left,
                                       config_.threshold * strongest_, block_width_, at_.data());
    for (size_t i = 0; i < count; i++) {
        const int x = static_cast<int>(at_[i]);
        if (!is_peak(x, y))
            continue;
        const float h = response_.row(y)[left + at_[i]];
        strongest_ = std::max(strongest_, h);
        points_.push_back({static_cast<float>(x), static_cast<float>(y), h});
    }
    // What a very large picture has too many of goes on the way.
    if (points_.size() > 4096 + 2 * static_cast<size_t>(config_.points))
        keep_strongest(config_.points);
}

void Harris::keep_strongest(size_t count) {
    if (points_.size() <= count)
        return;
    std::nth_element(points_.begin(), points_.begin() + static_cast<ptrdiff_t>(count),
                     points_.end(), stronger);
    points_.resize(count);
}

// Above nearly all responses of noise of deviation config_.noise. The tensor of noise is about
// W S noise^2 times the unit matrix, where W is the channels' weight and S what a derivative makes
// of unit noise; it varies about that, and so does H, whose mean is (1 - 4 k) times the square.
float Harris::noise_response() const {
    constexpr float spread = 8;
    float smooth = 0, derive = 0, weight = 0;
    for (int j = -derivative_.radius; j <= derivative_.radius; j++) {
        const auto at = static_cast<size_t>(std::abs(j));
        smooth += derivative_.smooth[at] * derivative_.smooth[at];
        derive += derivative_.derive[at] * derivative_.derive[at];
    }
    for (int c = 0; c < picture_.channels; c++)
        weight += weight_[c];
    const float tensor = weight * smooth * derive * config_.noise * config_.noise;
    return spread * (1 - 4 * config_.k) * tensor * tensor;
}

const std::vector<rlvc_point> &Harris::find(const Picture &picture, const float *gain) {
    start(picture, gain);
    const int radius = static_cast<int>(config_.radius);
    for (int y = 0; y < picture.height + radius; y++) {
        if (y < picture.height)
            make_response(y);
        if (y >= radius)
            collect_peaks(y - radius);
    }
    const float least = std::max(config_.threshold * strongest_, noise_response());
    points_.erase(std::remove_if(points_.begin(), points_.end(),
                                 [least](const rlvc_point &p) { return p.response <= least; }),
                  points_.end());
    keep_strongest(config_.points);
    std::sort(points_.begin(), points_.end(), stronger);
    return points_;
}

} // namespace rlvc
