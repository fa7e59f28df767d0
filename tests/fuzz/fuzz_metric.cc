// SPDX-License-Identifier: MIT
// libFuzzer: any text as a metric. What is accepted is written and read again as the same, and
// makes the extractor of its own config.
#include "rlvc/vision.h"

#include <cstdlib>
#include <string>

namespace {

void require(bool holds) {
    if (!holds)
        std::abort();
}

std::string text_of(const rlvc_metric *metric) {
    size_t bytes = 0;
    rlvc_metric_write(metric, nullptr, 0, &bytes, nullptr);
    std::string text(bytes, '\0');
    require(rlvc_metric_write(metric, text.data(), bytes, &bytes, nullptr) == RLVC_VISION_OK);
    return text;
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    rlvc_metric *metric = nullptr, *again = nullptr;
    const char *text = size > 0 ? reinterpret_cast<const char *>(data) : "";
    if (rlvc_metric_read(text, size, &metric, nullptr) != RLVC_VISION_OK) {
        require(metric == nullptr);
        return 0;
    }
    const std::string written = text_of(metric);
    require(rlvc_metric_read(written.data(), written.size(), &again, nullptr) == RLVC_VISION_OK);
    require(text_of(again) == written);
    rlvc_vision_config config;
    rlvc_metric_config(metric, &config);
    rlvc_extractor *extractor = nullptr;
    require(rlvc_extractor_create(&config, metric, &extractor, nullptr) == RLVC_VISION_OK);
    rlvc_extractor_destroy(extractor);
    rlvc_metric_destroy(again);
    rlvc_metric_destroy(metric);
    return 0;
}
