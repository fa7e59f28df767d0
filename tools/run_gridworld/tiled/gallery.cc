// SPDX-License-Identifier: MIT
#include "gallery.h"

#include "../cli/check.h"
#include "../cli/interrupt.h"

#include "opencv_picture.h"
#include "scenery.h"

#include <algorithm>
#include <ctime>

namespace {

// `where` is the option whose value may be wrong, or empty.
void check_vision(rlvc_vision_status status, const rlvc_vision_error &error,
                  const std::string &where = "") {
    if (status != RLVC_VISION_OK) {
        throw Failure(where +
                      (error.text[0] != '\0' ? error.text : rlvc_vision_status_text(status)));
    }
}

bool is_invariants(uint32_t descriptor) {
    return descriptor == RLVC_DESCRIPTOR_INVARIANTS ||
           descriptor == RLVC_DESCRIPTOR_SQRT_INVARIANTS;
}

// The published vectors are compared by the Mahalanobis distance; their square roots by their
// change between views or copies, if there are several.
uint32_t kind_of_metric(const TiledOptions &options) {
    if (options.descriptor == RLVC_DESCRIPTOR_INVARIANTS) {
        return RLVC_METRIC_COVARIANCE;
    }
    const bool changes = options.poses.size() > 1 || options.light > 0.0f || options.noise > 0.0f;
    if (options.descriptor == RLVC_DESCRIPTOR_SQRT_INVARIANTS) {
        return changes ? RLVC_METRIC_CHANGE : RLVC_METRIC_COVARIANCE;
    }
    const bool sift = options.descriptor == RLVC_DESCRIPTOR_SIFT ||
                      options.descriptor == RLVC_DESCRIPTOR_SIFT_UPRIGHT;
    return sift && changes && options.axes > 0 ? RLVC_METRIC_DISCRIMINANT : RLVC_METRIC_PLAIN;
}

rlvc_vision_config make_config(const TiledOptions &options) {
    rlvc_vision_config config;
    check_vision(rlvc_vision_config_default(options.descriptor, &config), {});
    config.points = options.points;
    config.sigma = options.sigma;
    config.normalise = options.normalise;
    // SIFT and ORB lose nothing as bytes.
    config.axes = static_cast<uint8_t>(
        kind_of_metric(options) == RLVC_METRIC_DISCRIMINANT ? options.axes : 0);
    config.form = is_invariants(options.descriptor) ? RLVC_FORM_FLOAT : RLVC_FORM_INT8;
    // Displacements turn with the picture where vectors do.
    const bool turns =
        options.descriptor == RLVC_DESCRIPTOR_SIFT || options.descriptor == RLVC_DESCRIPTOR_ORB;
    config.places = !options.pairs ? RLVC_PLACES_NONE
                    : turns        ? RLVC_PLACES_DIRECTED
                                   : RLVC_PLACES_POINTS;
    return config;
}

using Fitter = std::unique_ptr<rlvc_fitter, void (*)(rlvc_fitter *)>;

// Adds the pictures to learn from, and no held-out picture.
void feed(rlvc_fitter *fitter, const TiledOptions &options, const std::vector<Object> &objects) {
    rlvc_vision_error error{};
    std::mt19937 random(options.seed);
    for (uint32_t i = 0; i < objects.size(); i++) {
        const cv::Mat &first = objects[i].views.at(options.poses.front());
        for (const int angle : options.poses) {
            const cv::Mat &view = objects[i].views.at(angle);
            const rlvc_picture a = picture_of(first), b = picture_of(view);
            check_vision(rlvc_fitter_add(fitter, &b, i, &error), error);
            if (angle != options.poses.front()) {
                check_vision(rlvc_fitter_pair(fitter, &a, &b, RLVC_PAIR_VIEWS, &error), error);
            }
        }
        if (options.light > 0.0f || options.noise > 0.0f) {
            const cv::Mat changed = disturb(first, options, random);
            const rlvc_picture a = picture_of(first), b = picture_of(changed);
            check_vision(rlvc_fitter_pair(fitter, &a, &b, RLVC_PAIR_COPIES, &error), error);
        }
    }
}

} // namespace

Gallery::Gallery(const TiledOptions &options, std::vector<Object> objects,
                 const std::function<void(const std::string &)> &progress)
    : objects_(std::move(objects)), config_(make_config(options)),
      metric_(nullptr, rlvc_metric_destroy), extractor_(nullptr, rlvc_extractor_destroy),
      bags_on_(options.bags), views_(options.poses.size()) {
    prepare(options);
    extract(options, progress);
}

void Gallery::prepare(const TiledOptions &options) {
    rlvc_vision_error error{};
    rlvc_metric *metric = nullptr;
    if (!options.metric.empty()) {
        check_vision(rlvc_metric_load(options.metric.c_str(), &metric, &error), error,
                     "--metric: ");
        metric_.reset(metric);
    } else {
        rlvc_fitter *made = nullptr;
        check_vision(rlvc_fitter_create(&config_, &made, &error), error);
        const Fitter fitter(made, rlvc_fitter_destroy);
        feed(fitter.get(), options, objects_);
        check_vision(
            rlvc_fitter_fit(fitter.get(), kind_of_metric(options), options.share, &metric, &error),
            error);
        metric_.reset(metric);
    }
    if (!options.save_metric.empty()) {
        check_vision(rlvc_metric_save(metric_.get(), options.save_metric.c_str(), &error), error,
                     "--save-metric: ");
    }
    rlvc_extractor *extractor = nullptr;
    check_vision(rlvc_extractor_create(&config_, metric_.get(), &extractor, &error), error,
                 options.metric.empty() ? "" : "--metric: ");
    extractor_.reset(extractor);
    tau_ = rlvc_metric_tau(metric_.get());
    make_domain(options);
}

void Gallery::make_domain(const TiledOptions &options) {
    const float radius = tau_ / rlvc_extractor_step(extractor_.get());
    const uint32_t dimensions = rlvc_vision_dimensions(&config_);
    const uint32_t form =
        config_.form == RLVC_FORM_INT8 ? RLVC_DESCRIPTORS_INT8 : RLVC_DESCRIPTORS_FLOAT;
    if (options.bags) {
        check(rlvc_bags_default(&bags_, config_.points, dimensions, form, radius),
              "rlvc_bags_default");
        bags_.vectors.candidates = options.candidates;
        return;
    }
    check(rlvc_spatial_default(&spatial_, config_.points, dimensions, form,
                               config_.places == RLVC_PLACES_DIRECTED, radius),
          "rlvc_spatial_default");
    spatial_.vectors.margin = options.margin;
    spatial_.vectors.candidates = options.candidates;
    spatial_.pairs = options.candidates;
}

Sight Gallery::look(uint32_t object, int angle, const cv::Mat &picture) {
    rlvc_vision_error error{};
    Sight sight{object, angle, std::vector<uint32_t>(rlvc_vision_percept_bytes(&config_) / 4),
                std::vector<rlvc_point>(config_.points)};
    const rlvc_picture seen = picture_of(picture);
    check_vision(rlvc_extractor_extract(extractor_.get(), &seen, sight.percept.data(),
                                        sight.percept.size() * 4, sight.points.data(), &error),
                 error);
    sight.points.resize(sight.percept.front());
    return sight;
}

void Gallery::index(const Sight &sight) {
    const std::size_t bytes =
        RLVC_DESCRIPTORS_VECTOR_BYTES(descriptors().dimensions, descriptors().form);
    const char *vector = reinterpret_cast<const char *>(sight.percept.data() + 1);
    for (const rlvc_point &point : sight.points) {
        places_.insert({std::string(vector, bytes), {sight.object, sight.angle, point}});
        vector += bytes;
    }
}

void Gallery::extract(const TiledOptions &options,
                      const std::function<void(const std::string &)> &progress) {
    const Scenery scenery(options);
    const std::vector<int> &held = options.test_poses.empty() ? options.poses : options.test_poses;
    std::mt19937 random(options.seed);
    double seconds = 0.0;
    std::size_t pictures = 0;
    const auto see = [&](uint32_t object, int angle, bool test) {
        const cv::Mat picture =
            disturb(scenery.set(objects_[object].views.at(angle), test, random), options, random);
        const std::clock_t start = std::clock();
        Sight sight = look(object, angle, picture);
        seconds += static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
        pictures++;
        return sight;
    };
    seen_.resize(objects_.size());
    held_out_.resize(objects_.size());
    for (uint32_t i = 0; i < objects_.size(); i++) {
        if (interrupt_signal() != 0) {
            throw Interrupted("the pictures of " + std::to_string(i) + " objects");
        }
        progress("looking at object " + std::to_string(i + 1) + " of " +
                 std::to_string(objects_.size()));
        for (uint32_t copy = 0; copy < options.copies; copy++) {
            for (const int angle : options.poses) {
                seen_[i].push_back(see(i, angle, false));
                index(seen_[i].back());
            }
            for (const int angle : held) {
                held_out_[i].push_back(see(i, angle, true));
            }
        }
    }
    milliseconds_ = 1000.0 * seconds / static_cast<double>(std::max<std::size_t>(pictures, 1));
}

rlvc_domain Gallery::domain() {
    rlvc_domain domain;
    if (bags()) {
        check(rlvc_bags_domain(&bags_, &domain), "rlvc_bags_domain");
    } else if (spatial()) {
        check(rlvc_spatial_domain(&spatial_, &domain), "rlvc_spatial_domain");
    } else {
        check(rlvc_descriptors_domain(&spatial_.vectors, &domain), "rlvc_descriptors_domain");
    }
    return domain;
}

const Place *Gallery::find_vector(const void *vector) const {
    const std::size_t bytes =
        RLVC_DESCRIPTORS_VECTOR_BYTES(descriptors().dimensions, descriptors().form);
    const auto found = places_.find(std::string(static_cast<const char *>(vector), bytes));
    return found == places_.end() ? nullptr : &found->second;
}

// Where a feature's first vector lies in its record.
const char *Gallery::first_vector(const void *feature) const {
    return static_cast<const char *>(feature) + (spatial() ? 16 : 4);
}

const Place *Gallery::find(const void *feature) const {
    return bags() ? nullptr : find_vector(first_vector(feature));
}

const Place *Gallery::find_second(const void *feature) const {
    if (!spatial() || !rlvc_spatial_is_pair(&spatial_, feature)) {
        return nullptr;
    }
    return find_vector(first_vector(feature) +
                       RLVC_DESCRIPTORS_VECTOR_BYTES(descriptors().dimensions, descriptors().form));
}

// How much of a bag a picture has, in vectors that are found exactly; adds the points that count.
double Gallery::score(const Sight &sight, const void *feature,
                      std::vector<rlvc_point> &points) const {
    const double limit = double{bags_.vectors.radius} * double{bags_.vectors.radius};
    double sum = 0.0;
    for (uint32_t i = 0; i < rlvc_bags_count(feature); i++) {
        uint32_t point = 0;
        float squared = 0.0f;
        if (rlvc_bags_nearest(&bags_, sight.percept.data(), feature, i, &point, &squared) ==
                RLVC_OK &&
            double{squared} < limit) {
            sum += 1.0 - double{squared} / limit;
            points.push_back(sight.points[point]);
        }
    }
    return sum;
}

BagPlace Gallery::find_bag(const void *feature) const {
    const double limit = double{bags_.vectors.radius} * double{bags_.vectors.radius};
    BagPlace best;
    double most = -1.0;
    best.count = rlvc_bags_count(feature);
    best.needed = double{rlvc_bags_needed(feature)} / limit;
    for (uint32_t i = 0; i < seen_.size(); i++) {
        for (std::size_t view = 0; view < views_; view++) {
            std::vector<rlvc_point> points;
            const double found = score(seen_[i][view], feature, points);
            if (found > most) {
                most = found;
                best.object = i;
                best.angle = seen_[i][view].angle;
                best.points = std::move(points);
            }
        }
    }
    return best;
}
