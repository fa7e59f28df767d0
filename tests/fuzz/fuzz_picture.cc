// SPDX-License-Identifier: MIT
// libFuzzer: any config and any picture through the C ABI. The picture's memory is exactly as large
// as its fields say, so that one byte read beyond it is seen. What is accepted must be a percept.
#include "rlvc/vision.h"

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <vector>

namespace {

class Bytes {
  public:
    Bytes(const uint8_t *data, size_t size) : data_(data), size_(size) {
    }
    // The next byte; zeros follow the last.
    uint8_t next() {
        return at_ < size_ ? data_[at_++] : 0;
    }
    float real() {
        uint8_t four[4] = {next(), next(), next(), next()};
        float value;
        std::memcpy(&value, four, sizeof value);
        return value;
    }
    // A number within the range, or now and then any at all.
    float real(float low, float high) {
        const uint8_t byte = next();
        return byte == 255 ? real() : low + (high - low) * static_cast<float>(byte) / 254;
    }
    // A whole number of [low, high], or now and then one of [0, 255].
    uint8_t whole(unsigned low, unsigned high) {
        const uint8_t byte = next();
        return byte == 255 ? next() : static_cast<uint8_t>(low + byte % (high - low + 1));
    }
    // The rest over and over again.
    void fill(uint8_t *to, size_t count) {
        const size_t left = size_ - at_;
        for (size_t i = 0; i < count; i++)
            to[i] = left > 0 ? data_[at_ + i % left] : 0;
    }

  private:
    const uint8_t *data_;
    size_t size_;
    size_t at_ = 0;
};

void require(bool holds) {
    if (!holds)
        std::abort();
}

rlvc_vision_config config_from(Bytes &bytes) {
    rlvc_vision_config config{};
    config.descriptor = bytes.whole(0, RLVC_DESCRIPTORS - 1);
    config.points = bytes.whole(1, 60);
    config.radius = bytes.whole(1, 10);
    config.form = bytes.whole(0, 1);
    config.normalise = bytes.whole(0, 1);
    config.sd = bytes.real(0.5f, 4);
    config.si = bytes.real(0.5f, 8);
    config.k = bytes.real(0, 0.2f);
    config.threshold = bytes.real(0, 0.9f);
    config.sigma = bytes.real(0.5f, 8);
    return config;
}

void check(const std::vector<uint32_t> &record, const rlvc_vision_config &config,
           const std::vector<rlvc_point> &points, const rlvc_picture &picture) {
    const uint32_t count = record[0];
    require(count <= config.points);
    for (uint32_t i = 0; i < count; i++) {
        require(points[i].x >= 0 && points[i].x < static_cast<float>(picture.width));
        require(points[i].y >= 0 && points[i].y < static_cast<float>(picture.height));
        require(points[i].response > 0 && std::isfinite(points[i].response));
    }
    if (config.form != RLVC_FORM_FLOAT)
        return;
    const size_t used = 1 + size_t{count} * rlvc_descriptor_dimensions(config.descriptor);
    for (size_t i = 1; i < record.size(); i++) {
        float number;
        std::memcpy(&number, &record[i], sizeof number);
        require(std::isfinite(number) && (i < used || record[i] == 0));
    }
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    Bytes bytes(data, size);
    const rlvc_vision_config config = config_from(bytes);
    rlvc_vision_error error;
    rlvc_extractor *extractor = nullptr;
    const rlvc_vision_status made = rlvc_extractor_create(&config, nullptr, &extractor, &error);
    require((made == RLVC_VISION_OK) == (extractor != nullptr));
    if (extractor == nullptr)
        return 0;
    std::vector<uint32_t> record(rlvc_vision_percept_bytes(&config) / 4);
    std::vector<rlvc_point> points(config.points);
    // Two pictures, as the second meets what the first left behind.
    for (int i = 0; i < 2; i++) {
        rlvc_picture picture{};
        picture.width = bytes.whole(1, 80);
        picture.height = bytes.whole(1, 80);
        picture.format = bytes.whole(0, 2);
        const size_t row = picture.width * (picture.format == RLVC_PICTURE_GREY ? 1u : 3u);
        const size_t stride = row + bytes.next() % 8u;
        const bool bottom_up = bytes.next() % 2 != 0;
        const size_t last = picture.height > 0 ? (picture.height - 1) * stride : 0;
        const std::unique_ptr<uint8_t[]> pixels(new uint8_t[last + row]);
        bytes.fill(pixels.get(), last + row);
        picture.stride = static_cast<ptrdiff_t>(bottom_up ? 0 - stride : stride);
        picture.pixels = pixels.get() + (bottom_up ? last : 0);
        const rlvc_vision_status status = rlvc_extractor_extract(
            extractor, &picture, record.data(), 4 * record.size(), points.data(), &error);
        require(status == RLVC_VISION_OK || status == RLVC_VISION_E_PICTURE);
        if (status == RLVC_VISION_OK)
            check(record, config, points, picture);
    }
    rlvc_extractor_destroy(extractor);
    return 0;
}
