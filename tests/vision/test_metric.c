/* SPDX-License-Identifier: MIT */
/* Metrics: fitted, kept as text, refused. */
#define _POSIX_C_SOURCE 200809L /* mkfifo, symlink */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include <sys/stat.h>
#include <unistd.h>

#include "percepts.h"

#define OBJECTS 12u
#define SHARE 0.2f

static seen a, b;

static rlvc_fitter *fitter_of(const rlvc_vision_config *config) {
    rlvc_vision_error error;
    rlvc_fitter *fitter = NULL;
    assert_ok(rlvc_fitter_create(config, &fitter, &error));
    return fitter;
}

/* A fitter that has seen OBJECTS pictures, each with a noisy copy, as `how`. */
static rlvc_fitter *fed(const rlvc_vision_config *config, uint32_t how) {
    rlvc_vision_error error;
    rlvc_fitter *fitter = fitter_of(config);
    for (uint32_t i = 0; i < OBJECTS; i++) {
        test_picture made = test_picture_make(96, 96, RLVC_PICTURE_BGR, i);
        test_picture noisy = test_picture_noisy(&made, 4, i);
        assert_ok(rlvc_fitter_add(fitter, &made.picture, i, &error));
        assert_ok(rlvc_fitter_pair(fitter, &made.picture, &noisy.picture, how, &error));
        test_picture_free(&noisy);
        test_picture_free(&made);
    }
    return fitter;
}

static rlvc_metric *fit(rlvc_fitter *fitter, uint32_t kind, float share) {
    rlvc_vision_error error;
    rlvc_metric *metric = NULL;
    assert_ok(rlvc_fitter_fit(fitter, kind, share, &metric, &error));
    assert_int_equal(rlvc_metric_kind(metric), kind);
    assert_true(rlvc_metric_tau(metric) > 0.0f);
    return metric;
}

static rlvc_metric *fitted(const rlvc_vision_config *config, uint32_t kind) {
    rlvc_fitter *fitter = fed(config, RLVC_PAIR_COPIES);
    rlvc_metric *metric = fit(fitter, kind, SHARE);
    rlvc_fitter_destroy(fitter);
    return metric;
}

/* ------------------------------------------------------------------------- what is fitted */

static void test_covariance_becomes_one(void **state) {
    (void)state;
    rlvc_vision_config config = config_of(RLVC_DESCRIPTOR_SQRT_INVARIANTS);
    rlvc_metric *metric = fitted(&config, RLVC_METRIC_COVARIANCE);
    rlvc_extractor *extractor = extractor_of(&config, metric);
    double sum[8] = {0}, square[8][8] = {{0}};
    uint32_t count = 0;
    for (uint32_t i = 0; i < OBJECTS; i++) {
        test_picture made = test_picture_make(96, 96, RLVC_PICTURE_BGR, i);
        look(extractor, &config, &made.picture, &a);
        for (uint32_t p = 0; p < a.count; p++, count++)
            for (uint32_t j = 0; j < 8; j++) {
                sum[j] += (double)a.vector.real[p * 8 + j];
                for (uint32_t k = 0; k < 8; k++)
                    square[j][k] +=
                        (double)a.vector.real[p * 8 + j] * (double)a.vector.real[p * 8 + k];
            }
        test_picture_free(&made);
    }
    assert_true(count > 100);
    for (uint32_t j = 0; j < 8; j++) {
        assert_true(fabs(sum[j] / count) < 1e-3);
        for (uint32_t k = 0; k < 8; k++)
            assert_true(fabs(square[j][k] / count - (j == k)) < 1e-2);
    }
    rlvc_extractor_destroy(extractor);
    rlvc_metric_destroy(metric);
}

/* Of pairs of a feature and a picture of another object, about the wanted share show the
 * feature. */
static void check_share(uint32_t descriptor, uint32_t kind, float share) {
    static float vectors[OBJECTS][200 * RLVC_DIMENSIONS_MAX];
    uint32_t counts[OBJECTS];
    rlvc_vision_config config = config_of(descriptor);
    uint32_t n = rlvc_descriptor_dimensions(descriptor);
    rlvc_fitter *fitter = fed(&config, RLVC_PAIR_COPIES);
    rlvc_metric *metric = fit(fitter, kind, share);
    rlvc_extractor *extractor = extractor_of(&config, metric);
    for (uint32_t i = 0; i < OBJECTS; i++) {
        test_picture made = test_picture_make(96, 96, RLVC_PICTURE_BGR, i);
        look(extractor, &config, &made.picture, &a);
        counts[i] = a.count;
        memcpy(vectors[i], a.vector.real, (size_t)a.count * n * sizeof(float));
        test_picture_free(&made);
    }
    uint32_t asked = 0, shown = 0;
    for (uint32_t i = 0; i < OBJECTS; i++)
        for (uint32_t p = 0; p < counts[i]; p++)
            for (uint32_t j = 0; j < OBJECTS; j++) {
                float least = INFINITY;
                for (uint32_t q = 0; q < counts[j]; q++) {
                    float distance = 0;
                    for (uint32_t k = 0; k < n; k++) {
                        float d = vectors[i][p * n + k] - vectors[j][q * n + k];
                        distance += d * d;
                    }
                    least = fminf(least, sqrtf(distance));
                }
                asked += i != j;
                shown += i != j && least <= rlvc_metric_tau(metric);
            }
    if (!(fabs((double)shown / asked - (double)share) < 0.01))
        fail_msg("%s, kind %u: %u of %u for a share of %g", rlvc_descriptor_name(descriptor), kind,
                 shown, asked, (double)share);
    rlvc_extractor_destroy(extractor);
    rlvc_metric_destroy(metric);
    rlvc_fitter_destroy(fitter);
}

static void test_tau_gives_the_share(void **state) {
    (void)state;
    check_share(RLVC_DESCRIPTOR_INVARIANTS, RLVC_METRIC_COVARIANCE, 0.2f);
    check_share(RLVC_DESCRIPTOR_SQRT_INVARIANTS, RLVC_METRIC_CHANGE, 0.05f);
    check_share(RLVC_DESCRIPTOR_SQRT_INVARIANTS, RLVC_METRIC_PLAIN, 0.5f);
    check_share(RLVC_DESCRIPTOR_SIFT_UPRIGHT, RLVC_METRIC_PLAIN, 0.1f);
    check_share(RLVC_DESCRIPTOR_SIFT, RLVC_METRIC_CHANGE, 0.1f);
    check_share(RLVC_DESCRIPTOR_ORB, RLVC_METRIC_PLAIN, 0.1f);
    check_share(RLVC_DESCRIPTOR_SIFT_UPRIGHT, RLVC_METRIC_DISCRIMINANT, 0.1f);
}

/* Under the metric of change, a copy's vectors move by about 1 in each number. */
static void test_change_becomes_one(void **state) {
    (void)state;
    rlvc_vision_config config = config_of(RLVC_DESCRIPTOR_SQRT_INVARIANTS);
    rlvc_metric *metric = fitted(&config, RLVC_METRIC_CHANGE);
    rlvc_extractor *extractor = extractor_of(&config, metric);
    double square = 0;
    uint32_t numbers = 0;
    for (uint32_t i = 0; i < OBJECTS; i++) {
        test_picture made = test_picture_make(96, 96, RLVC_PICTURE_BGR, i);
        test_picture noisy = test_picture_noisy(&made, 4, i + 100);
        look(extractor, &config, &made.picture, &a);
        look(extractor, &config, &noisy.picture, &b);
        for (uint32_t p = 0; p < a.count; p++)
            for (uint32_t q = 0; q < b.count; q++)
                if (a.points[p].x == b.points[q].x && a.points[p].y == b.points[q].y)
                    for (uint32_t k = 0; k < 8; k++, numbers++)
                        square +=
                            pow((double)(a.vector.real[p * 8 + k] - b.vector.real[q * 8 + k]), 2);
        test_picture_free(&noisy);
        test_picture_free(&made);
    }
    assert_true(numbers > 800);
    assert_true(square / numbers > 0.5 && square / numbers < 2);
    rlvc_extractor_destroy(extractor);
    rlvc_metric_destroy(metric);
}

static void refuse_metric(const rlvc_metric *metric, const rlvc_vision_config *config,
                          const char *what) {
    rlvc_vision_error error;
    rlvc_extractor *extractor = NULL;
    assert_int_equal(rlvc_extractor_create(config, metric, &extractor, &error),
                     RLVC_VISION_E_DESCRIPTOR);
    assert_null(extractor);
    if (strstr(error.text, what) == NULL)
        fail_msg("\"%s\" does not name %s", error.text, what);
}

/* Of all axes the first ones stay; each tells things apart better than the next. */
static void test_axes(void **state) {
    (void)state;
    enum { AXES = 5 };
    rlvc_vision_error error;
    rlvc_vision_config config = config_of(RLVC_DESCRIPTOR_SIFT_UPRIGHT), few = config;
    few.axes = AXES;
    assert_int_equal(rlvc_vision_dimensions(&config), 128);
    assert_int_equal(rlvc_vision_dimensions(&few), AXES);
    rlvc_metric *all = fitted(&config, RLVC_METRIC_DISCRIMINANT);
    rlvc_metric *first = fitted(&few, RLVC_METRIC_DISCRIMINANT);
    double spread[AXES] = {0};
    for (uint32_t i = 0; i < OBJECTS; i++) {
        test_picture made = test_picture_make(96, 96, RLVC_PICTURE_BGR, i);
        look_once(&config, all, &made.picture, &a);
        look_once(&few, first, &made.picture, &b);
        assert_int_equal(a.count, b.count);
        for (uint32_t p = 0; p < a.count; p++)
            for (uint32_t k = 0; k < AXES; k++) {
                const float number = b.vector.real[p * AXES + k];
                assert_true(fabsf(number - a.vector.real[p * 128 + k]) < 1e-4f);
                spread[k] += (double)(number * number);
            }
        test_picture_free(&made);
    }
    for (uint32_t k = 1; k < AXES; k++)
        assert_true(spread[k] < spread[k - 1]);
    refuse_metric(first, &config, "axes 5");
    rlvc_fitter *fitter = fed(&few, RLVC_PAIR_COPIES);
    rlvc_metric *none = NULL;
    assert_int_equal(rlvc_fitter_fit(fitter, RLVC_METRIC_CHANGE, SHARE, &none, &error),
                     RLVC_VISION_E_RANGE);
    assert_non_null(strstr(error.text, "config.axes is 5"));
    rlvc_extractor *extractor = NULL;
    assert_int_equal(rlvc_extractor_create(&few, NULL, &extractor, &error), RLVC_VISION_E_METRIC);
    rlvc_fitter_destroy(fitter);
    rlvc_metric_destroy(all);
    rlvc_metric_destroy(first);
}

/* Pictures that never change leave every direction alike. */
static void test_axes_without_change(void **state) {
    (void)state;
    rlvc_vision_error error;
    rlvc_vision_config config = config_of(RLVC_DESCRIPTOR_SQRT_INVARIANTS);
    config.axes = 2;
    rlvc_fitter *fitter = fitter_of(&config);
    for (uint32_t i = 0; i < OBJECTS; i++) {
        test_picture made = test_picture_make(96, 96, RLVC_PICTURE_BGR, i);
        assert_ok(rlvc_fitter_add(fitter, &made.picture, i, &error));
        assert_ok(rlvc_fitter_pair(fitter, &made.picture, &made.picture, RLVC_PAIR_COPIES, &error));
        test_picture_free(&made);
    }
    rlvc_metric_destroy(fit(fitter, RLVC_METRIC_DISCRIMINANT, SHARE));
    rlvc_fitter_destroy(fitter);
}

static void test_views_find_their_partners(void **state) {
    (void)state;
    rlvc_vision_config config = config_of(RLVC_DESCRIPTOR_SQRT_INVARIANTS);
    rlvc_fitter *copies = fed(&config, RLVC_PAIR_COPIES), *views = fed(&config, RLVC_PAIR_VIEWS);
    rlvc_metric *by_copies = fit(copies, RLVC_METRIC_CHANGE, SHARE);
    rlvc_metric *by_views = fit(views, RLVC_METRIC_CHANGE, SHARE);
    float ratio = rlvc_metric_tau(by_views) / rlvc_metric_tau(by_copies);
    if (!(ratio > 0.3f && ratio < 3.0f))
        fail_msg("tau differs by a factor of %g", (double)ratio);
    rlvc_metric_destroy(by_copies);
    rlvc_metric_destroy(by_views);
    rlvc_fitter_destroy(copies);
    rlvc_fitter_destroy(views);
}

static void test_int8_is_near(void **state) {
    (void)state;
    rlvc_vision_config config = config_of(RLVC_DESCRIPTOR_SQRT_INVARIANTS);
    rlvc_metric *metric = fitted(&config, RLVC_METRIC_COVARIANCE);
    test_picture made = test_picture_make(96, 96, RLVC_PICTURE_BGR, 3);
    look_once(&config, metric, &made.picture, &a);
    config.form = RLVC_FORM_INT8;
    rlvc_extractor *extractor = extractor_of(&config, metric);
    look(extractor, &config, &made.picture, &b);
    float step = rlvc_extractor_step(extractor);
    assert_true(step > 0.0f && step < 0.1f);
    assert_true(a.count > 0 && a.count == b.count);
    uint32_t near = 0;
    for (uint32_t i = 0; i < 8 * a.count; i++) {
        float off = fabsf(step * (float)b.vector.whole[i] - a.vector.real[i]);
        near += off <= 0.5001f * step;
        assert_true(off <= 0.5001f * step || abs(b.vector.whole[i]) == 127);
    }
    assert_true(near >= 8 * a.count - 3);
    rlvc_extractor_destroy(extractor);
    rlvc_metric_destroy(metric);
    test_picture_free(&made);
}

static void test_a_world_without_colour(void **state) {
    (void)state;
    rlvc_vision_error error;
    rlvc_vision_config config = config_of(RLVC_DESCRIPTOR_INVARIANTS);
    rlvc_fitter *fitter = fitter_of(&config);
    for (uint32_t i = 0; i < OBJECTS; i++) {
        test_picture made = test_picture_make(96, 96, RLVC_PICTURE_GREY, i);
        assert_ok(rlvc_fitter_add(fitter, &made.picture, i, &error));
        test_picture_free(&made);
    }
    rlvc_metric *metric = fit(fitter, RLVC_METRIC_COVARIANCE, SHARE);
    test_picture made = test_picture_make(96, 96, RLVC_PICTURE_GREY, 77);
    look_once(&config, metric, &made.picture, &a);
    for (uint32_t i = 0; i < 8 * a.count; i++)
        assert_true(fabsf(a.vector.real[i]) < 50.0f);
    test_picture_free(&made);
    rlvc_metric_destroy(metric);
    rlvc_fitter_destroy(fitter);
}

/* ------------------------------------------------------------------------- text */

/* The text of a metric, ended by 0; free() it. */
static char *text_of(const rlvc_metric *metric, size_t *bytes) {
    rlvc_vision_error error;
    assert_int_equal(rlvc_metric_write(metric, NULL, 0, bytes, &error), RLVC_VISION_E_ROOM);
    char *text = calloc(*bytes + 1, 1);
    assert_non_null(text);
    assert_int_equal(rlvc_metric_write(metric, text, *bytes - 1, bytes, NULL), RLVC_VISION_E_ROOM);
    assert_int_equal(text[0], 0);
    assert_ok(rlvc_metric_write(metric, text, *bytes, bytes, &error));
    return text;
}

static void test_text_comes_back(void **state) {
    (void)state;
    for (uint32_t descriptor = 0; descriptor < RLVC_DESCRIPTORS; descriptor++)
        for (uint32_t kind = 0; kind <= RLVC_METRIC_DISCRIMINANT; kind++) {
            rlvc_vision_error error;
            rlvc_vision_config config = config_of(descriptor), kept;
            if (descriptor >= RLVC_DESCRIPTOR_ORB && kind != RLVC_METRIC_PLAIN)
                continue; /* too few vectors for so many numbers */
            config.points = 77;
            config.axes = kind == RLVC_METRIC_DISCRIMINANT ? 3 : 0;
            rlvc_metric *metric = fitted(&config, kind), *read = NULL;
            size_t bytes, again;
            char *text = text_of(metric, &bytes);
            assert_ok(rlvc_metric_read(text, bytes, &read, &error));
            char *second = text_of(read, &again);
            assert_string_equal(text, second);
            assert_true(rlvc_metric_tau(read) == rlvc_metric_tau(metric));
            rlvc_metric_config(read, &kept);
            assert_memory_equal(&kept, &config, sizeof kept);
            free(text);
            free(second);
            rlvc_metric_destroy(metric);
            rlvc_metric_destroy(read);
        }
}

static unsigned permissions(const char *path) {
    struct stat there;
    assert_int_equal(stat(path, &there), 0);
    return there.st_mode & 07777u;
}

static void test_files(void **state) {
    (void)state;
    rlvc_vision_error error;
    rlvc_vision_config config = config_of(RLVC_DESCRIPTOR_INVARIANTS);
    rlvc_metric *metric = fitted(&config, RLVC_METRIC_COVARIANCE), *read = NULL;
    static const char path[] = "test_metric_kept.json";
    const mode_t mask = umask(027);
    assert_ok(rlvc_metric_save(metric, path, &error));
    assert_int_equal(permissions(path), 0640);
    assert_int_equal(chmod(path, 0604), 0);
    assert_ok(rlvc_metric_save(metric, path, &error));
    assert_int_equal(permissions(path), 0604);
    assert_int_equal(umask(mask), 027);
    assert_ok(rlvc_metric_load(path, &read, &error));
    assert_true(rlvc_metric_tau(read) == rlvc_metric_tau(metric));
    rlvc_metric_destroy(read);
    read = NULL;

    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    fputs("{\"rlvc_metric\": 1}", file);
    fclose(file);
    assert_int_equal(rlvc_metric_load(path, &read, &error), RLVC_VISION_E_FORMAT);
    assert_non_null(strstr(error.text, path));
    remove(path);
    assert_int_equal(rlvc_metric_load(path, &read, &error), RLVC_VISION_E_FILE);
    assert_non_null(strstr(error.text, path));
    assert_int_equal(rlvc_metric_load(".", &read, &error), RLVC_VISION_E_FILE);
    assert_int_equal(rlvc_metric_save(metric, "/nowhere/metric", &error), RLVC_VISION_E_FILE);
    assert_null(read);
    rlvc_metric_destroy(metric);
}

/* A FIFO would make the caller wait, and a link may lead anywhere. */
static void test_what_is_no_file(void **state) {
    (void)state;
    rlvc_vision_error error;
    rlvc_vision_config config = config_of(RLVC_DESCRIPTOR_INVARIANTS);
    rlvc_metric *metric = fitted(&config, RLVC_METRIC_PLAIN), *read = NULL;
    static const char fifo[] = "test_metric_fifo", link[] = "test_metric_link",
                      path[] = "test_metric_mode";
    remove(fifo);
    remove(link);
    assert_int_equal(mkfifo(fifo, 0600), 0);
    assert_int_equal(symlink(path, link), 0);
    assert_int_equal(rlvc_metric_load(fifo, &read, &error), RLVC_VISION_E_FILE);
    assert_int_equal(rlvc_metric_save(metric, fifo, &error), RLVC_VISION_E_FILE);
    assert_int_equal(rlvc_metric_save(metric, link, &error), RLVC_VISION_E_FILE);
    assert_non_null(strstr(error.text, link));
    assert_int_equal(rlvc_metric_save(metric, "/dev/null", &error), RLVC_VISION_E_FILE);

    struct stat there;
    assert_ok(rlvc_metric_save(metric, path, &error));
    assert_int_equal(chmod(path, 0604), 0);
    assert_ok(rlvc_metric_save(metric, path, &error));
    assert_int_equal(stat(path, &there), 0);
    assert_int_equal(there.st_mode & 0777, 0604);
    remove(fifo);
    remove(link);
    remove(path);
    rlvc_metric_destroy(metric);
}

static void refuse_text(const char *text, size_t bytes) {
    rlvc_vision_error error;
    rlvc_metric *metric = NULL;
    rlvc_vision_status status = rlvc_metric_read(text, bytes, &metric, &error);
    if (status != RLVC_VISION_E_FORMAT)
        fail_msg("status %d (%s) for: %.*s", status, error.text, (int)bytes, text);
    assert_null(metric);
    assert_true(error.text[0] != '\0');
}

static void test_cut_texts_refused(void **state) {
    (void)state;
    rlvc_vision_config config = config_of(RLVC_DESCRIPTOR_INVARIANTS);
    rlvc_metric *metric = fitted(&config, RLVC_METRIC_COVARIANCE);
    size_t bytes;
    char *text = text_of(metric, &bytes);
    for (size_t i = 0; i + 2 < bytes; i++) { /* the last two are } and a newline */
        char *exact = malloc(i + 1);
        assert_non_null(exact);
        memcpy(exact, text, i);
        refuse_text(exact, i);
        free(exact);
    }
    free(text);
    rlvc_metric_destroy(metric);
}

/* Replaces the value of a key, up to the comma or brace behind it. */
static void refuse_value(const char *text, const char *key, const char *value) {
    char quoted[40];
    snprintf(quoted, sizeof quoted, "\"%s\":", key);
    const char *at = strstr(text, quoted);
    assert_non_null(at);
    at += strlen(quoted);
    const char *rest = *at == '[' ? strchr(at, ']') + 1 : at + strcspn(at, ",}");
    char *changed = malloc(strlen(text) + strlen(value) + 1);
    assert_non_null(changed);
    sprintf(changed, "%.*s%s%s", (int)(at - text), text, value, rest);
    refuse_text(changed, strlen(changed));
    free(changed);
}

static void test_values_refused(void **state) {
    (void)state;
    static const char *const wrong[][2] = {
        {"rlvc_metric", "2"},
        {"rlvc_metric", "\"1\""},
        {"rlvc_metric", "-1"},
        {"descriptor", "\"surf\""},
        {"descriptor", "1"},
        {"kind", "\"best\""},
        {"kind", "0"},
        {"points", "0"},
        {"points", "1001"},
        {"points", "4294967326"},
        {"points", "30.5"},
        {"radius", "0"},
        {"normalise", "2"},
        {"normalise", "256"},
        {"axes", "4"},
        {"axes", "256"},
        {"form", "true"},
        {"sd", "0"},
        {"si", "\"2\""},
        {"k", "0.25"},
        {"threshold", "-1"},
        {"sigma", "1e30"},
        {"tau", "0"},
        {"tau", "-1"},
        {"tau", "1e400"},
        {"tau", "null"},
        {"step", "0"},
        {"step", "[]"},
        {"mean", "[1,2,3]"},
        {"mean", "1"},
        {"mean", "[1,2,3,4,5,6,7,null]"},
        {"matrix", "[]"},
        {"mean", "[1,2,3,4,5,6,7,1e13]"},
        {"descriptor", "\"sift\""}, /* whose mean has 128 numbers */
    };
    rlvc_vision_config config = config_of(RLVC_DESCRIPTOR_INVARIANTS);
    rlvc_metric *metric = fitted(&config, RLVC_METRIC_COVARIANCE);
    size_t bytes;
    char *text = text_of(metric, &bytes);
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++)
        refuse_value(text, wrong[i][0], wrong[i][1]);
    refuse_text("", 0);
    refuse_text("[]", 2);
    refuse_text("null", 4);
    free(text);
    rlvc_metric_destroy(metric);
}

/* ------------------------------------------------------------------------- refusals */

static void test_other_descriptors_refused(void **state) {
    (void)state;
    rlvc_vision_config config = config_of(RLVC_DESCRIPTOR_INVARIANTS);
    rlvc_metric *metric = fitted(&config, RLVC_METRIC_COVARIANCE);
    config.sigma = 3;
    refuse_metric(metric, &config, "sigma");
    config = config_of(RLVC_DESCRIPTOR_INVARIANTS);
    config.normalise = 1;
    refuse_metric(metric, &config, "normalise");
    config = config_of(RLVC_DESCRIPTOR_SQRT_INVARIANTS);
    refuse_metric(metric, &config, "sqrt-invariants");
    config = config_of(RLVC_DESCRIPTOR_ORB);
    refuse_metric(metric, &config, "orb");
    /* What only chooses points may differ. */
    config = config_of(RLVC_DESCRIPTOR_INVARIANTS);
    config.points = 10;
    config.radius = 5;
    rlvc_extractor_destroy(extractor_of(&config, metric));
    rlvc_metric_destroy(metric);
}

static void test_too_few(void **state) {
    (void)state;
    rlvc_vision_error error;
    rlvc_vision_config config = config_of(RLVC_DESCRIPTOR_SQRT_INVARIANTS);
    rlvc_fitter *fitter = fitter_of(&config);
    rlvc_metric *metric = NULL;
    for (uint32_t kind = 0; kind <= RLVC_METRIC_DISCRIMINANT; kind++)
        assert_int_equal(rlvc_fitter_fit(fitter, kind, SHARE, &metric, &error), RLVC_VISION_E_FEW);
    test_picture made = test_picture_make(96, 96, RLVC_PICTURE_BGR, 1);
    for (int i = 0; i < 3; i++) {
        assert_ok(rlvc_fitter_add(fitter, &made.picture, 7, &error));
        assert_int_equal(rlvc_fitter_fit(fitter, RLVC_METRIC_PLAIN, SHARE, &metric, &error),
                         RLVC_VISION_E_FEW);
    }
    assert_ok(rlvc_fitter_add(fitter, &made.picture, 8, &error));
    rlvc_metric_destroy(fit(fitter, RLVC_METRIC_PLAIN, SHARE));
    rlvc_metric_destroy(fit(fitter, RLVC_METRIC_COVARIANCE, SHARE));
    assert_int_equal(rlvc_fitter_fit(fitter, RLVC_METRIC_CHANGE, SHARE, &metric, &error),
                     RLVC_VISION_E_FEW);
    /* Pictures that show nothing exhibit nothing: of them no share can be had. */
    static const uint8_t black[12];
    rlvc_picture nothing = {black, 6, 2, 2, RLVC_PICTURE_BGR};
    for (uint32_t i = 0; i < 30; i++)
        assert_ok(rlvc_fitter_add(fitter, &nothing, 100 + i, &error));
    assert_int_equal(rlvc_fitter_fit(fitter, RLVC_METRIC_PLAIN, 0.9f, &metric, &error),
                     RLVC_VISION_E_FEW);
    assert_null(metric);
    test_picture_free(&made);
    rlvc_fitter_destroy(fitter);
}

static void test_calls_refused(void **state) {
    (void)state;
    rlvc_vision_error error;
    rlvc_vision_config config = config_of(RLVC_DESCRIPTOR_SQRT_INVARIANTS);
    rlvc_fitter *fitter = fed(&config, RLVC_PAIR_COPIES);
    rlvc_metric *metric = NULL;
    static const float shares[] = {0.0f, 1.0f, -0.5f, NAN};
    for (size_t i = 0; i < 4; i++)
        assert_int_equal(rlvc_fitter_fit(fitter, 0, shares[i], &metric, &error),
                         RLVC_VISION_E_RANGE);
    assert_int_equal(rlvc_fitter_fit(fitter, 4, SHARE, &metric, &error), RLVC_VISION_E_RANGE);
    test_picture one = test_picture_make(20, 20, RLVC_PICTURE_BGR, 1);
    test_picture other = test_picture_make(20, 21, RLVC_PICTURE_BGR, 1);
    const rlvc_picture *p = &one.picture, *q = &other.picture;
    assert_int_equal(rlvc_fitter_pair(fitter, p, q, RLVC_PAIR_COPIES, &error),
                     RLVC_VISION_E_PICTURE);
    assert_ok(rlvc_fitter_pair(fitter, p, q, RLVC_PAIR_VIEWS, &error));
    assert_int_equal(rlvc_fitter_pair(fitter, p, p, 2, &error), RLVC_VISION_E_RANGE);
    other.picture.height = 0;
    assert_int_equal(rlvc_fitter_pair(fitter, p, q, RLVC_PAIR_VIEWS, &error),
                     RLVC_VISION_E_PICTURE);
    assert_non_null(strstr(error.text, "after"));
    assert_int_equal(rlvc_fitter_add(fitter, q, 0, &error), RLVC_VISION_E_PICTURE);
    assert_int_equal(rlvc_fitter_add(NULL, p, 0, &error), RLVC_VISION_E_NULL);
    assert_int_equal(rlvc_fitter_add(fitter, NULL, 0, &error), RLVC_VISION_E_NULL);
    assert_int_equal(rlvc_fitter_pair(fitter, p, NULL, 0, &error), RLVC_VISION_E_NULL);
    assert_int_equal(rlvc_fitter_fit(fitter, 0, SHARE, NULL, &error), RLVC_VISION_E_NULL);
    assert_int_equal(rlvc_metric_load(NULL, &metric, &error), RLVC_VISION_E_NULL);
    assert_int_equal(rlvc_metric_read(NULL, 1, &metric, &error), RLVC_VISION_E_NULL);
    assert_int_equal(rlvc_metric_save(NULL, "x", &error), RLVC_VISION_E_NULL);
    assert_int_equal(rlvc_fitter_create(NULL, &fitter, &error), RLVC_VISION_E_NULL);
    rlvc_metric_destroy(NULL);
    rlvc_fitter_destroy(NULL);
    rlvc_fitter_destroy(fitter);
    test_picture_free(&one);
    test_picture_free(&other);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_covariance_becomes_one),
        cmocka_unit_test(test_tau_gives_the_share),
        cmocka_unit_test(test_change_becomes_one),
        cmocka_unit_test(test_axes),
        cmocka_unit_test(test_axes_without_change),
        cmocka_unit_test(test_views_find_their_partners),
        cmocka_unit_test(test_int8_is_near),
        cmocka_unit_test(test_a_world_without_colour),
        cmocka_unit_test(test_text_comes_back),
        cmocka_unit_test(test_files),
        cmocka_unit_test(test_what_is_no_file),
        cmocka_unit_test(test_cut_texts_refused),
        cmocka_unit_test(test_values_refused),
        cmocka_unit_test(test_other_descriptors_refused),
        cmocka_unit_test(test_too_few),
        cmocka_unit_test(test_calls_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
