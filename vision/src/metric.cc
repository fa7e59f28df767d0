// SPDX-License-Identifier: MIT
#include "metric.h"

#include "failure.h"

#include <string>

namespace rlvc {
namespace {

[[noreturn]] void refuse(const std::string &metric, const std::string &extractor) {
    throw Failure(RLVC_VISION_E_DESCRIPTOR,
                  "the metric was fitted to " + metric + ", but the extractor has " + extractor);
}

} // namespace

void whiten(const rlvc_metric &metric, const float *v, float *out) {
    const size_t n = rlvc_descriptor_dimensions(metric.config.descriptor);
    if (metric.matrix.empty()) {
        for (size_t i = 0; i < n; i++)
            out[i] = v[i];
        return;
    }
    float centred[RLVC_DIMENSIONS_MAX];
    for (size_t i = 0; i < n; i++)
        centred[i] = v[i] - metric.mean[i];
    const size_t rows = metric.matrix.size() / n;
    for (size_t i = 0; i < rows; i++) {
        const float *row = &metric.matrix[i * n];
        float sum = 0;
        for (size_t j = 0; j < n; j++)
            sum += row[j] * centred[j];
        out[i] = sum;
    }
}

void check_fits(const rlvc_metric &metric, const rlvc_vision_config &config) {
    const rlvc_vision_config &fitted = metric.config;
    if (fitted.descriptor != config.descriptor)
        refuse(rlvc_descriptor_name(fitted.descriptor), rlvc_descriptor_name(config.descriptor));
    if (fitted.sigma < config.sigma || fitted.sigma > config.sigma)
        refuse("sigma " + std::to_string(fitted.sigma), std::to_string(config.sigma));
    if (fitted.normalise != config.normalise)
        refuse("normalise " + std::to_string(fitted.normalise), std::to_string(config.normalise));
    if (fitted.axes != config.axes)
        refuse("axes " + std::to_string(fitted.axes), std::to_string(config.axes));
}

Native native(uint32_t descriptor) {
    switch (descriptor) {
    case RLVC_DESCRIPTOR_SIFT_UPRIGHT:
    case RLVC_DESCRIPTOR_SIFT:
        return {1.0f / 512, 0.25f};
    case RLVC_DESCRIPTOR_ORB:
        return {1.0f / 16, 0};
    case RLVC_DESCRIPTOR_QUARTERS:
        return {1, 128};
    default:
        return {0, 0};
    }
}

} // namespace rlvc
