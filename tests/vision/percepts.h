/* SPDX-License-Identifier: MIT */
/* Percepts for the tests, with room for any config. */
#ifndef RLVC_TEST_PERCEPTS_H
#define RLVC_TEST_PERCEPTS_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <string.h>

#include "pictures.h"

#define PERCEPT_BYTES_MAX RLVC_PERCEPT_BYTES_FLOAT(200u, RLVC_DIMENSIONS_MAX)

typedef struct seen {
    uint32_t count;
    union {
        float real[PERCEPT_BYTES_MAX / 4 - 1];
        int8_t whole[PERCEPT_BYTES_MAX - 4];
    } vector;
    rlvc_point points[200];
} seen;

/* Fails the test with the error's text unless the status is RLVC_VISION_OK. */
#define assert_ok(call)                                                                            \
    do {                                                                                           \
        rlvc_vision_status status_ = (call);                                                       \
        if (status_ != RLVC_VISION_OK)                                                             \
            fail_msg("%s: %s", rlvc_vision_status_text(status_), error.text);                      \
    } while (0)

static inline rlvc_vision_config config_of(uint32_t descriptor) {
    rlvc_vision_config config;
    assert_int_equal(rlvc_vision_config_default(descriptor, &config), RLVC_VISION_OK);
    return config;
}

static inline rlvc_extractor *extractor_of(const rlvc_vision_config *config,
                                           const rlvc_metric *metric) {
    rlvc_vision_error error;
    rlvc_extractor *extractor = NULL;
    assert_ok(rlvc_extractor_create(config, metric, &extractor, &error));
    return extractor;
}

static inline void look(rlvc_extractor *extractor, const rlvc_vision_config *config,
                        const rlvc_picture *picture, seen *out) {
    rlvc_vision_error error;
    memset(out, 0xa5, sizeof *out);
    assert_ok(rlvc_extractor_extract(extractor, picture, out, rlvc_vision_percept_bytes(config),
                                     out->points, &error));
    assert_true(out->count <= config->points);
}

/* With an extractor of its own. */
static inline void look_once(const rlvc_vision_config *config, const rlvc_metric *metric,
                             const rlvc_picture *picture, seen *out) {
    rlvc_extractor *extractor = extractor_of(config, metric);
    look(extractor, config, picture, out);
    rlvc_extractor_destroy(extractor);
}

#endif
