// SPDX-License-Identifier: MIT
#include "extractor.h"

#include "failure.h"

#include <algorithm>
#include <cmath>
#include <cstring>

using namespace rlvc;

namespace {

constexpr size_t head_bytes = sizeof(uint32_t);

} // namespace

rlvc_extractor::rlvc_extractor(const rlvc_vision_config &config, const rlvc_metric *metric)
    : eye_(config) {
    if (metric != nullptr) {
        check_fits(*metric, config);
        metric_ = *metric;
    } else if (config.axes > 0) {
        throw Failure(RLVC_VISION_E_METRIC, "config.axes is not 0, which needs a metric");
    }
    if (config.form == RLVC_FORM_FLOAT)
        return;
    const Native own = native(config.descriptor);
    if (metric == nullptr && !(own.step > 0))
        throw Failure(RLVC_VISION_E_METRIC, std::string("the int8 form of ") +
                                                rlvc_descriptor_name(config.descriptor) +
                                                " needs a metric");
    step_ = metric != nullptr ? metric->step : own.step;
    if (metric == nullptr || metric->kind == RLVC_METRIC_PLAIN)
        centre_ = own.centre;
}

void rlvc_extractor::quantise(const float *numbers, size_t count, int8_t *out) const {
    for (size_t i = 0; i < count; i++) {
        const float steps = std::nearbyint((numbers[i] - centre_) / step_);
        out[i] = static_cast<int8_t>(std::clamp(steps, -127.0f, 127.0f));
    }
}

// For all P points, so that directions have their place behind.
void rlvc_extractor::put_places(unsigned char *out) const {
    constexpr size_t place_bytes = 2 * sizeof(int16_t);
    constexpr float unit = 127, radians = 0.017453293f;
    int8_t *direction = reinterpret_cast<int8_t *>(out + config().points * place_bytes);
    for (size_t i = 0; i < eye_.points().size(); i++) {
        const int place[2] = {static_cast<int>(eye_.points()[i].x),
                              static_cast<int>(eye_.points()[i].y)};
        for (size_t k = 0; k < place_bytes; k++)
            out[i * place_bytes + k] = static_cast<unsigned char>(place[k / 2] >> 8 * (k % 2));
        if (config().places != RLVC_PLACES_DIRECTED)
            continue;
        const float angle = eye_.directions()[i] * radians;
        direction[2 * i] = static_cast<int8_t>(std::nearbyint(unit * std::cos(angle)));
        direction[2 * i + 1] = static_cast<int8_t>(std::nearbyint(unit * std::sin(angle)));
    }
}

void rlvc_extractor::extract(const Picture &picture, void *percept, rlvc_point *points) {
    eye_.look(picture);
    const size_t n = eye_.dimensions();
    const size_t kept = rlvc_vision_dimensions(&config());
    const size_t numbers = eye_.points().size() * kept;
    const float *vectors = eye_.vectors().data();
    if (metric_) {
        whitened_.resize(numbers);
        for (size_t i = 0; i < eye_.points().size(); i++)
            whiten(*metric_, vectors + i * n, &whitened_[i * kept]);
        vectors = whitened_.data();
    }

    // Nothing below fails.
    auto *record = static_cast<unsigned char *>(percept);
    const auto count = static_cast<uint32_t>(eye_.points().size());
    std::memset(record, 0, rlvc_vision_percept_bytes(&config()));
    std::memcpy(record, &count, head_bytes);
    if (config().form == RLVC_FORM_FLOAT)
        std::copy_n(reinterpret_cast<const unsigned char *>(vectors), numbers * sizeof(float),
                    record + head_bytes);
    else
        quantise(vectors, numbers, reinterpret_cast<int8_t *>(record + head_bytes));
    if (config().places != RLVC_PLACES_NONE)
        put_places(record + rlvc_vision_percept_bytes(&config()) -
                   RLVC_PERCEPT_BYTES_PLACES(config().points, config().places));
    if (points != nullptr)
        std::copy(eye_.points().begin(), eye_.points().end(), points);
}
