// SPDX-License-Identifier: MIT
// What needs no object: texts of statuses, names and sizes of descriptors, the config's defaults
// and ranges.
#include "config.h"

#include "failure.h"

#include <cstring>
#include <sstream>

namespace rlvc {
namespace {

struct Descriptor {
    const char *name;
    uint32_t dimensions;
    float sigma;
};

// In the order of RLVC_DESCRIPTOR_*.
constexpr Descriptor known[RLVC_DESCRIPTORS] = {
    {"invariants", RLVC_DIMENSIONS_INVARIANTS, 2.5f},
    {"sqrt-invariants", RLVC_DIMENSIONS_INVARIANTS, 2.5f},
    {"sift-upright", RLVC_DIMENSIONS_SIFT, 6},
    {"sift", RLVC_DIMENSIONS_SIFT, 6},
    {"orb", RLVC_DIMENSIONS_ORB, 5},
    {"quarters", RLVC_DIMENSIONS_QUARTERS, 2.5f},
};

template <class Value, class Low, class High>
[[noreturn]] void refuse(const char *field, Value value, Low low, const char *to, High high,
                         const char *unit) {
    std::ostringstream text;
    text << "config." << field << " is " << value << ", but must be " << low << to << high << unit;
    throw Failure(RLVC_VISION_E_CONFIG, text.str());
}

void check_count(const char *field, uint32_t value, uint32_t low, uint32_t high,
                 const char *unit = "") {
    if (value < low || value > high)
        refuse(field, value, low, " to ", high, unit);
}

// These refuse a NaN too.
void check_scale(const char *field, float value, float low, float high) {
    if (!(value >= low && value <= high))
        refuse(field, value, low, " to ", high, " pixels");
}

void check_share(const char *field, float value, float below) {
    if (!(value >= 0 && value < below))
        refuse(field, value, 0, " or more, and less than ", below, "");
}

void check_noise(float value) {
    if (!(value >= 0 && value <= 64))
        refuse("noise", value, 0, " to ", 64, " grey levels");
}

} // namespace

void check(const rlvc_vision_config &config) {
    check_count("descriptor", config.descriptor, 0, RLVC_DESCRIPTORS - 1);
    check_count("points", config.points, 1, RLVC_POINTS_MAX);
    check_count("radius", config.radius, 1, 31, " pixels");
    check_count("form", config.form, RLVC_FORM_FLOAT, RLVC_FORM_INT8);
    check_count("normalise", config.normalise, 0, 1);
    check_count("axes", config.axes, 0, known[config.descriptor].dimensions);
    check_count("places", config.places, RLVC_PLACES_NONE, RLVC_PLACES_DIRECTED);
    check_scale("sd", config.sd, 0.5f, 4);
    check_scale("si", config.si, 0.5f, 8);
    check_share("k", config.k, 0.25f);
    check_share("threshold", config.threshold, 1);
    const bool sift = config.descriptor == RLVC_DESCRIPTOR_SIFT ||
                      config.descriptor == RLVC_DESCRIPTOR_SIFT_UPRIGHT;
    check_scale("sigma", config.sigma, sift ? 1 : 0.5f, 8);
    check_noise(config.noise);
}

} // namespace rlvc

using namespace rlvc;

const char *rlvc_vision_status_text(rlvc_vision_status status) {
    switch (status) {
    case RLVC_VISION_OK:
        return "ok";
    case RLVC_VISION_E_NULL:
        return "a pointer that must not be null is null";
    case RLVC_VISION_E_CONFIG:
        return "a field of the config is out of range";
    case RLVC_VISION_E_PICTURE:
        return "a field of the picture is out of range";
    case RLVC_VISION_E_ROOM:
        return "the room given is not the size needed, or too small";
    case RLVC_VISION_E_RANGE:
        return "an argument is out of range";
    case RLVC_VISION_E_FEW:
        return "too few pictures, vectors or pairs to fit a metric";
    case RLVC_VISION_E_FILE:
        return "a file cannot be read or written";
    case RLVC_VISION_E_FORMAT:
        return "the text is not a metric of a version that is known";
    case RLVC_VISION_E_DESCRIPTOR:
        return "the metric belongs to other vectors";
    case RLVC_VISION_E_METRIC:
        return "this config needs a metric and there is none";
    case RLVC_VISION_E_MEMORY:
        return "out of memory";
    case RLVC_VISION_E_INTERNAL:
        return "OpenCV failed where it should not";
    }
    return "unknown status";
}

rlvc_vision_status rlvc_vision_config_default(uint32_t descriptor, rlvc_vision_config *config) {
    if (config == nullptr)
        return RLVC_VISION_E_NULL;
    if (descriptor >= RLVC_DESCRIPTORS)
        return RLVC_VISION_E_RANGE;
    *config = rlvc_vision_config{};
    config->descriptor = descriptor;
    config->points = descriptor == RLVC_DESCRIPTOR_QUARTERS ? 1 : 30;
    config->radius = 3;
    config->form = RLVC_FORM_FLOAT;
    config->normalise = 0;
    config->sd = 1;
    config->si = 2;
    config->k = 0.04f;
    config->threshold = 0.001f;
    config->sigma = known[descriptor].sigma;
    config->noise = 3;
    return RLVC_VISION_OK;
}

const char *rlvc_descriptor_name(uint32_t descriptor) {
    return descriptor < RLVC_DESCRIPTORS ? known[descriptor].name : nullptr;
}

rlvc_vision_status rlvc_descriptor_named(const char *name, uint32_t *descriptor) {
    if (name == nullptr || descriptor == nullptr)
        return RLVC_VISION_E_NULL;
    for (uint32_t i = 0; i < RLVC_DESCRIPTORS; i++) {
        if (std::strcmp(name, known[i].name) == 0) {
            *descriptor = i;
            return RLVC_VISION_OK;
        }
    }
    return RLVC_VISION_E_RANGE;
}

uint32_t rlvc_descriptor_dimensions(uint32_t descriptor) {
    return descriptor < RLVC_DESCRIPTORS ? known[descriptor].dimensions : 0;
}

uint32_t rlvc_vision_dimensions(const rlvc_vision_config *config) {
    const uint32_t all = config != nullptr ? rlvc_descriptor_dimensions(config->descriptor) : 0;
    return all == 0 || config->axes > all ? 0 : config->axes > 0 ? config->axes : all;
}

uint32_t rlvc_vision_percept_bytes(const rlvc_vision_config *config) {
    const uint32_t dimensions = rlvc_vision_dimensions(config);
    if (dimensions == 0 || config->points < 1 || config->points > RLVC_POINTS_MAX ||
        config->form > RLVC_FORM_INT8 || config->places > RLVC_PLACES_DIRECTED)
        return 0;
    const uint32_t places = RLVC_PERCEPT_BYTES_PLACES(config->points, config->places);
    return places + (config->form == RLVC_FORM_FLOAT
                         ? RLVC_PERCEPT_BYTES_FLOAT(config->points, dimensions)
                         : RLVC_PERCEPT_BYTES_INT8(config->points, dimensions));
}
