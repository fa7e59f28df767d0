// SPDX-License-Identifier: MIT
// The C ABI: checks pointers, catches all.
#include "config.h"
#include "extractor.h"
#include "failure.h"
#include "fitter.h"
#include "metric.h"
#include "picture.h"

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <new>

using namespace rlvc;

namespace {

void say(rlvc_vision_error *error, const char *text) noexcept {
    if (error != nullptr)
        std::snprintf(error->text, sizeof error->text, "%s", text);
}

rlvc_vision_status fail(rlvc_vision_error *error, rlvc_vision_status status,
                        const char *text) noexcept {
    say(error, text);
    return status;
}

// Runs f and turns whatever it throws into a status and a text.
template <class F> rlvc_vision_status guarded(rlvc_vision_error *error, F f) noexcept {
    try {
        f();
        say(error, "");
        return RLVC_VISION_OK;
    } catch (const Failure &failure) {
        return fail(error, failure.status(), failure.what());
    } catch (const std::bad_alloc &) {
        return fail(error, RLVC_VISION_E_MEMORY, "out of memory");
    } catch (const cv::Exception &exception) {
        return fail(error,
                    exception.code == cv::Error::StsNoMem ? RLVC_VISION_E_MEMORY
                                                          : RLVC_VISION_E_INTERNAL,
                    exception.what());
    } catch (const std::exception &exception) {
        return fail(error, RLVC_VISION_E_INTERNAL, exception.what());
    } catch (...) {
        return fail(error, RLVC_VISION_E_INTERNAL, "an exception of no known kind");
    }
}

void require(const void *pointer, const char *name) {
    if (pointer == nullptr)
        throw Failure(RLVC_VISION_E_NULL, std::string(name) + " is null");
}

} // namespace

rlvc_vision_status rlvc_vision_config_check(const rlvc_vision_config *config,
                                            rlvc_vision_error *error) {
    return guarded(error, [&] {
        require(config, "config");
        check(*config);
    });
}

float rlvc_metric_tau(const rlvc_metric *metric) {
    return metric != nullptr ? metric->tau : 0;
}

void rlvc_metric_config(const rlvc_metric *metric, rlvc_vision_config *config) {
    if (metric != nullptr && config != nullptr)
        *config = metric->config;
}

uint32_t rlvc_metric_kind(const rlvc_metric *metric) {
    return metric != nullptr ? metric->kind : RLVC_METRIC_PLAIN;
}

rlvc_vision_status rlvc_metric_save(const rlvc_metric *metric, const char *path,
                                    rlvc_vision_error *error) {
    return guarded(error, [&] {
        require(metric, "metric");
        require(path, "path");
        replace_file(path, text_of(*metric));
    });
}

rlvc_vision_status rlvc_metric_load(const char *path, rlvc_metric **metric,
                                    rlvc_vision_error *error) {
    return guarded(error, [&] {
        require(path, "path");
        require(metric, "metric");
        const std::string text = read_file(path);
        try {
            *metric = new rlvc_metric(metric_of(text.data(), text.size()));
        } catch (const Failure &failure) {
            throw Failure(failure.status(), std::string(path) + ": " + failure.what());
        }
    });
}

rlvc_vision_status rlvc_metric_write(const rlvc_metric *metric, char *text, size_t room,
                                     size_t *bytes, rlvc_vision_error *error) {
    return guarded(error, [&] {
        require(metric, "metric");
        require(bytes, "bytes");
        if (room > 0)
            require(text, "text");
        const std::string written = text_of(*metric);
        *bytes = written.size();
        if (written.size() > room)
            throw Failure(RLVC_VISION_E_ROOM, "room is " + std::to_string(room) +
                                                  ", but the text is " +
                                                  std::to_string(written.size()) + " bytes");
        std::copy(written.begin(), written.end(), text);
    });
}

rlvc_vision_status rlvc_metric_read(const char *text, size_t bytes, rlvc_metric **metric,
                                    rlvc_vision_error *error) {
    return guarded(error, [&] {
        require(text, "text");
        require(metric, "metric");
        *metric = new rlvc_metric(metric_of(text, bytes));
    });
}

void rlvc_metric_destroy(rlvc_metric *metric) {
    delete metric;
}

rlvc_vision_status rlvc_extractor_create(const rlvc_vision_config *config,
                                         const rlvc_metric *metric, rlvc_extractor **extractor,
                                         rlvc_vision_error *error) {
    return guarded(error, [&] {
        require(config, "config");
        require(extractor, "extractor");
        *extractor = new rlvc_extractor(*config, metric);
    });
}

rlvc_vision_status rlvc_extractor_extract(rlvc_extractor *extractor, const rlvc_picture *picture,
                                          void *percept, size_t percept_bytes, rlvc_point *points,
                                          rlvc_vision_error *error) {
    return guarded(error, [&] {
        require(extractor, "extractor");
        require(picture, "picture");
        require(percept, "percept");
        const size_t bytes = rlvc_vision_percept_bytes(&extractor->config());
        if (percept_bytes != bytes)
            throw Failure(RLVC_VISION_E_ROOM, "percept_bytes is " + std::to_string(percept_bytes) +
                                                  ", but the record is " + std::to_string(bytes));
        extractor->extract(checked(*picture, "picture"), percept, points);
    });
}

float rlvc_extractor_step(const rlvc_extractor *extractor) {
    return extractor != nullptr ? extractor->step() : 0;
}

void rlvc_extractor_destroy(rlvc_extractor *extractor) {
    delete extractor;
}

rlvc_vision_status rlvc_fitter_create(const rlvc_vision_config *config, rlvc_fitter **fitter,
                                      rlvc_vision_error *error) {
    return guarded(error, [&] {
        require(config, "config");
        require(fitter, "fitter");
        *fitter = new rlvc_fitter(*config);
    });
}

rlvc_vision_status rlvc_fitter_add(rlvc_fitter *fitter, const rlvc_picture *picture,
                                   uint32_t object, rlvc_vision_error *error) {
    return guarded(error, [&] {
        require(fitter, "fitter");
        require(picture, "picture");
        fitter->add(checked(*picture, "picture"), object);
    });
}

rlvc_vision_status rlvc_fitter_pair(rlvc_fitter *fitter, const rlvc_picture *before,
                                    const rlvc_picture *after, uint32_t how,
                                    rlvc_vision_error *error) {
    return guarded(error, [&] {
        require(fitter, "fitter");
        require(before, "before");
        require(after, "after");
        fitter->pair(checked(*before, "before"), checked(*after, "after"), how);
    });
}

rlvc_vision_status rlvc_fitter_fit(rlvc_fitter *fitter, uint32_t kind, float share,
                                   rlvc_metric **metric, rlvc_vision_error *error) {
    return guarded(error, [&] {
        require(fitter, "fitter");
        require(metric, "metric");
        *metric = new rlvc_metric(fitter->fit(kind, share));
    });
}

void rlvc_fitter_destroy(rlvc_fitter *fitter) {
    delete fitter;
}
