// SPDX-License-Identifier: MIT
// From a picture to the percept's record: what the eye sees, whitened, and in the wanted form.
#ifndef RLVC_VISION_EXTRACTOR_H
#define RLVC_VISION_EXTRACTOR_H

#include "eye.h"
#include "metric.h"

#include <optional>

struct rlvc_extractor {
  public:
    rlvc_extractor(const rlvc_vision_config &config, const rlvc_metric *metric);

    // percept is a record of rlvc_vision_percept_bytes; points may be null.
    void extract(const rlvc::Picture &picture, void *percept, rlvc_point *points);

    const rlvc_vision_config &config() const {
        return eye_.config();
    }
    float step() const {
        return step_;
    }

  private:
    void quantise(const float *numbers, size_t count, int8_t *out) const;
    void put_places(unsigned char *out) const;

    rlvc::Eye eye_;
    std::optional<rlvc_metric> metric_;
    float step_ = 1;
    float centre_ = 0;
    std::vector<float> whitened_;
};

#endif
