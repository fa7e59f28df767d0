// SPDX-License-Identifier: MIT
// Fits metrics to the vectors of many pictures.
#ifndef RLVC_VISION_FITTER_H
#define RLVC_VISION_FITTER_H

#include "eye.h"
#include "metric.h"

#include <cstdint>
#include <vector>

struct rlvc_fitter {
  public:
    explicit rlvc_fitter(const rlvc_vision_config &config);

    void add(const rlvc::Picture &picture, uint32_t object);
    void pair(const rlvc::Picture &before, const rlvc::Picture &after, uint32_t how);
    rlvc_metric fit(uint32_t kind, float share) const;

  private:
    // What was seen in one picture.
    struct Seen {
        uint32_t object;
        std::vector<float> vectors;
    };
    struct Views {
        std::vector<rlvc_point> places[2];
        std::vector<float> vectors[2];
        float reach;
    };

    void take_room(size_t more);
    void whiten_by_covariance(rlvc_metric &metric) const;
    void whiten_by_change(rlvc_metric &metric) const;
    std::vector<float> all_changes(const rlvc_vision_config &config) const;
    std::vector<float> changes(const Views &views, const rlvc_metric &metric) const;
    std::vector<float> all_vectors() const;
    void choose_tau_and_step(rlvc_metric &metric, float share) const;

    rlvc::Eye eye_;
    size_t n_;        // D
    size_t held_ = 0; // vectors in all
    std::vector<Seen> seen_;
    std::vector<Views> views_;
    std::vector<float> changes_; // of copies
};

#endif
