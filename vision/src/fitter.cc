// SPDX-License-Identifier: MIT
#include "fitter.h"

#include "failure.h"
#include "whitening.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <utility>

using namespace rlvc;

namespace {

constexpr size_t vectors_max = size_t{1} << 20;

// tau is looked for among this many features and pictures at most, evenly chosen.
constexpr size_t features_max = 1000;
constexpr size_t pictures_max = 200;

// Vectors that are all alike would make tau and the step 0.
constexpr float least_radius = 1e-6f;

// All but this share of the numbers fit into the int8 form; the rest saturate.
constexpr double beyond_step = 0.001;

float squared_distance(const float *a, const float *b, size_t n) {
    float sum = 0;
    for (size_t i = 0; i < n; i++)
        sum += (a[i] - b[i]) * (a[i] - b[i]);
    return sum;
}

// The nearest of `count` vectors for which allowed(i); count if there is none.
template <class Allowed>
size_t nearest(const float *v, const float *vectors, size_t count, size_t n, Allowed allowed) {
    size_t best = count;
    float least = std::numeric_limits<float>::infinity();
    for (size_t i = 0; i < count; i++) {
        if (!allowed(i))
            continue;
        const float distance = squared_distance(v, vectors + i * n, n);
        if (distance < least) {
            least = distance;
            best = i;
        }
    }
    return best;
}

float distance_to_nearest(const float *v, const std::vector<float> &vectors, size_t n) {
    const size_t count = vectors.size() / n;
    const size_t at = nearest(v, vectors.data(), count, n, [](size_t) { return true; });
    return at == count ? std::numeric_limits<float>::infinity()
                       : std::sqrt(squared_distance(v, &vectors[at * n], n));
}

// Of n numbers a vector; what comes out has as many as the metric keeps.
std::vector<float> whitened(const rlvc_metric &metric, const std::vector<float> &vectors,
                            size_t n) {
    const size_t kept = rlvc_vision_dimensions(&metric.config);
    std::vector<float> out(vectors.size() / n * kept);
    for (size_t i = 0; i < vectors.size() / n; i++)
        whiten(metric, &vectors[i * n], &out[i * kept]);
    return out;
}

float quantile(std::vector<float> &numbers, double share) {
    const auto rank = static_cast<size_t>(share * static_cast<double>(numbers.size() - 1));
    const auto at = numbers.begin() + static_cast<ptrdiff_t>(rank);
    std::nth_element(numbers.begin(), at, numbers.end());
    return *at;
}

// The i-th of `wanted` numbers evenly chosen from [0, count).
size_t even(size_t i, size_t wanted, size_t count) {
    return wanted >= count ? i : i * count / wanted;
}

[[noreturn]] void too_few(const std::string &text) {
    throw Failure(RLVC_VISION_E_FEW, text);
}

void require(size_t have, size_t need, const char *what) {
    if (have < need)
        too_few("there are " + std::to_string(have) + " " + what + ", but " + std::to_string(need) +
                " are needed");
}

} // namespace

rlvc_fitter::rlvc_fitter(const rlvc_vision_config &config)
    : eye_(config), n_(rlvc_descriptor_dimensions(config.descriptor)) {
}

void rlvc_fitter::take_room(size_t more) {
    if (held_ + more > vectors_max)
        throw Failure(RLVC_VISION_E_RANGE,
                      "more than " + std::to_string(vectors_max) + " vectors were added");
    held_ += more;
}

void rlvc_fitter::add(const Picture &picture, uint32_t object) {
    eye_.look(picture);
    take_room(eye_.points().size());
    seen_.push_back({object, eye_.vectors()});
}

void rlvc_fitter::pair(const Picture &before, const Picture &after, uint32_t how) {
    if (how != RLVC_PAIR_COPIES && how != RLVC_PAIR_VIEWS)
        throw Failure(RLVC_VISION_E_RANGE,
                      "how is " + std::to_string(how) + ", but must be copies (0) or views (1)");
    if (how == RLVC_PAIR_COPIES && (before.width != after.width || before.height != after.height))
        throw Failure(RLVC_VISION_E_PICTURE, "a picture and its copy are of different sizes");
    Views views;
    views.reach = static_cast<float>(std::max(before.width, before.height)) / 8;
    eye_.look(before);
    views.places[0] = eye_.points();
    views.vectors[0] = eye_.vectors();
    if (how == RLVC_PAIR_COPIES)
        eye_.look_at(after, views.places[0]);
    else
        eye_.look(after);
    views.places[1] = eye_.points();
    views.vectors[1] = eye_.vectors();
    take_room(views.places[0].size() + views.places[1].size());
    if (how == RLVC_PAIR_VIEWS) {
        views_.push_back(std::move(views));
        return;
    }
    std::transform(views.vectors[1].begin(), views.vectors[1].end(), views.vectors[0].begin(),
                   views.vectors[1].begin(), std::minus<float>());
    changes_.insert(changes_.end(), views.vectors[1].begin(), views.vectors[1].end());
}

std::vector<float> rlvc_fitter::all_vectors() const {
    std::vector<float> all;
    for (const Seen &seen : seen_)
        all.insert(all.end(), seen.vectors.begin(), seen.vectors.end());
    return all;
}

void rlvc_fitter::whiten_by_covariance(rlvc_metric &metric) const {
    const std::vector<float> all = all_vectors();
    require(all.size() / n_, n_ + 1, "vectors");
    metric.mean = mean_of(all, n_);
    metric.matrix = whitening_of(all, metric.mean, n_);
}

// Partners are sought under the covariance of all vectors, but for SIFT, ORB and the quarters,
// whose distance means something by itself.
std::vector<float> rlvc_fitter::all_changes(const rlvc_vision_config &config) const {
    rlvc_metric seeking{};
    seeking.config = config;
    seeking.config.axes = 0;
    if (!(native(config.descriptor).step > 0))
        whiten_by_covariance(seeking);
    std::vector<float> all = changes_;
    for (const Views &views : views_) {
        const std::vector<float> more = changes(views, seeking);
        all.insert(all.end(), more.begin(), more.end());
    }
    return all;
}

void rlvc_fitter::whiten_by_change(rlvc_metric &metric) const {
    const std::vector<float> all = all_changes(metric.config);
    require(all.size() / n_, metric.kind == RLVC_METRIC_CHANGE ? n_ + 1 : 1,
            "points with a partner");
    const std::vector<float> vectors = all_vectors();
    require(vectors.size() / n_, 1, "vectors");
    metric.mean = mean_of(vectors, n_);
    if (metric.kind == RLVC_METRIC_DISCRIMINANT) {
        metric.matrix =
            discriminants_of(all, vectors, metric.mean, n_, rlvc_vision_dimensions(&metric.config));
        return;
    }
    // A change has no preferred sign, so its spread is taken about 0.
    metric.matrix = whitening_of(all, std::vector<float>(n_, 0.0f), n_);
}

// The changes of the points that are each other's nearest within reach.
std::vector<float> rlvc_fitter::changes(const Views &views, const rlvc_metric &metric) const {
    const std::vector<float> seen[2] = {whitened(metric, views.vectors[0], n_),
                                        whitened(metric, views.vectors[1], n_)};
    const size_t count[2] = {views.places[0].size(), views.places[1].size()};
    const auto near = [&views](size_t i, size_t j) {
        const rlvc_point &a = views.places[0][i];
        const rlvc_point &b = views.places[1][j];
        return std::hypot(a.x - b.x, a.y - b.y) <= views.reach;
    };
    std::vector<float> found;
    for (size_t i = 0; i < count[0]; i++) {
        const size_t j = nearest(&seen[0][i * n_], seen[1].data(), count[1], n_,
                                 [&](size_t k) { return near(i, k); });
        if (j == count[1])
            continue;
        const size_t back = nearest(&seen[1][j * n_], seen[0].data(), count[0], n_,
                                    [&](size_t k) { return near(k, j); });
        if (back != i)
            continue;
        for (size_t d = 0; d < n_; d++)
            found.push_back(views.vectors[1][j * n_ + d] - views.vectors[0][i * n_ + d]);
    }
    return found;
}

// tau is the wanted quantile of the distances from a feature to the nearest vector of each picture
// of another object.
void rlvc_fitter::choose_tau_and_step(rlvc_metric &metric, float share) const {
    const size_t pictures = std::min(seen_.size(), pictures_max);
    const size_t kept = rlvc_vision_dimensions(&metric.config);
    std::vector<std::vector<float>> sought;
    for (size_t j = 0; j < pictures; j++)
        sought.push_back(whitened(metric, seen_[even(j, pictures, seen_.size())].vectors, n_));

    std::vector<float> distances, numbers;
    size_t total = 0; // vectors so far, of which every `apart`-th is a feature
    const size_t apart = std::max<size_t>(all_vectors().size() / n_ / features_max, 1);
    for (const Seen &own : seen_) {
        const std::vector<float> vectors = whitened(metric, own.vectors, n_);
        for (size_t i = 0; i < vectors.size(); i += kept) {
            if (total++ % apart != 0)
                continue;
            for (size_t d = 0; d < kept; d++)
                numbers.push_back(std::fabs(vectors[i + d]));
            for (size_t j = 0; j < pictures; j++)
                if (seen_[even(j, pictures, seen_.size())].object != own.object)
                    distances.push_back(distance_to_nearest(&vectors[i], sought[j], kept));
        }
    }
    if (distances.empty())
        too_few("tau needs vectors, and pictures of two objects at least");
    metric.tau = quantile(distances, static_cast<double>(share));
    if (!std::isfinite(metric.tau))
        too_few("too many pictures have no point for so large a share");
    metric.tau = std::max(metric.tau, least_radius);
    metric.step = std::max(quantile(numbers, 1 - beyond_step) / 127, least_radius);
    const float own_step = native(metric.config.descriptor).step;
    if (metric.kind == RLVC_METRIC_PLAIN && own_step > 0)
        metric.step = own_step;
}

rlvc_metric rlvc_fitter::fit(uint32_t kind, float share) const {
    if (kind > RLVC_METRIC_DISCRIMINANT)
        throw Failure(
            RLVC_VISION_E_RANGE,
            "kind is " + std::to_string(kind) +
                ", but must be plain (0), covariance (1), change (2) or discriminant (3)");
    if (eye_.config().axes > 0 && kind != RLVC_METRIC_DISCRIMINANT)
        throw Failure(RLVC_VISION_E_RANGE, "kind is " + std::to_string(kind) +
                                               ", but config.axes is " +
                                               std::to_string(eye_.config().axes) +
                                               ", which only the kind discriminant (3) allows");
    if (!(share > 0 && share < 1))
        throw Failure(RLVC_VISION_E_RANGE,
                      "share is " + std::to_string(share) + ", but must be between 0 and 1");
    rlvc_metric metric{};
    metric.config = eye_.config();
    metric.kind = kind;
    if (kind == RLVC_METRIC_COVARIANCE)
        whiten_by_covariance(metric);
    else if (kind != RLVC_METRIC_PLAIN)
        whiten_by_change(metric);
    choose_tau_and_step(metric, share);
    return metric;
}
