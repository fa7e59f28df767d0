// SPDX-License-Identifier: MIT
// Whitening: W (v - m), and the text that keeps it.
//
// The text is a JSON object: "rlvc_metric" (the version, 1), the config that it was fitted with,
// "kind", "tau", "step", and unless the kind is plain, "mean" (D numbers) and "matrix" (D numbers
// for each number of a percept's vector, W row by row). Whatever is read is checked: every key is
// there, every number finite and in its range.
#ifndef RLVC_VISION_METRIC_H
#define RLVC_VISION_METRIC_H

#include "rlvc/vision.h"

#include <cstdint>
#include <string>
#include <vector>

struct rlvc_metric {
    rlvc_vision_config config;
    uint32_t kind;
    float tau;
    float step;
    std::vector<float> mean;   // [D], empty if plain
    std::vector<float> matrix; // [rlvc_vision_dimensions][D], empty if plain
};

namespace rlvc {

// No number of a mean or a matrix is larger: so that whitened vectors are finite.
constexpr float metric_number_max = 1e12f;

// out [rlvc_vision_dimensions] = W (v - m), or v if the metric is plain.
void whiten(const rlvc_metric &metric, const float *v, float *out);

// Throws Failure(RLVC_VISION_E_DESCRIPTOR) that says what differs, unless the metric was fitted to
// what this config makes of a point.
void check_fits(const rlvc_metric &metric, const rlvc_vision_config &config);

// How vectors that no metric whitens stand in the int8 form: round((number - centre) / step). A
// step of 0 says that only a metric can tell.
struct Native {
    float step;
    float centre;
};
Native native(uint32_t descriptor);

std::string text_of(const rlvc_metric &metric);
// Throws Failure(RLVC_VISION_E_FORMAT) that names the key.
rlvc_metric metric_of(const char *text, size_t bytes);

// Throw Failure(RLVC_VISION_E_FILE) that names the file and the cause.
std::string read_file(const char *path);
void replace_file(const char *path, const std::string &text);

} // namespace rlvc

#endif
