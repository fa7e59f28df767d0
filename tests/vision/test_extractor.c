/* SPDX-License-Identifier: MIT */
/* Pictures to percepts through the C ABI: the record, the points, what leaves the vectors alone,
 * and what is refused. */
#include <math.h>
#include <stdlib.h>

#include "percepts.h"

static seen a, b;

static int same(const rlvc_vision_config *config) {
    return memcmp(&a, &b, rlvc_vision_percept_bytes(config)) == 0;
}

/* ------------------------------------------------------------------------- names, sizes */

static void test_names(void **state) {
    (void)state;
    uint32_t descriptor;
    for (uint32_t i = 0; i < RLVC_DESCRIPTORS; i++) {
        assert_int_equal(rlvc_descriptor_named(rlvc_descriptor_name(i), &descriptor),
                         RLVC_VISION_OK);
        assert_int_equal(descriptor, i);
    }
    assert_null(rlvc_descriptor_name(RLVC_DESCRIPTORS));
    assert_int_equal(rlvc_descriptor_dimensions(RLVC_DESCRIPTORS), 0);
    assert_int_equal(rlvc_descriptor_named("surf", &descriptor), RLVC_VISION_E_RANGE);
    assert_int_equal(rlvc_descriptor_named(NULL, &descriptor), RLVC_VISION_E_NULL);
    assert_int_equal(rlvc_descriptor_named("orb", NULL), RLVC_VISION_E_NULL);
    for (int status = 0; status >= -113; status--)
        assert_non_null(rlvc_vision_status_text((rlvc_vision_status)status));
}

static void test_sizes(void **state) {
    (void)state;
    rlvc_vision_config config = config_of(RLVC_DESCRIPTOR_INVARIANTS);
    assert_int_equal(rlvc_vision_percept_bytes(&config), 4 + 30 * 8 * 4);
    config.form = RLVC_FORM_INT8;
    assert_int_equal(rlvc_vision_percept_bytes(&config), 4 + 30 * 8);
    config = config_of(RLVC_DESCRIPTOR_ORB);
    config.points = RLVC_POINTS_MAX;
    assert_true(rlvc_vision_percept_bytes(&config) <= 1u << 20);
    config.points = 0;
    assert_int_equal(rlvc_vision_percept_bytes(&config), 0);
    config.points = RLVC_POINTS_MAX + 1;
    assert_int_equal(rlvc_vision_percept_bytes(&config), 0);
    assert_int_equal(rlvc_vision_percept_bytes(NULL), 0);
}

/* ------------------------------------------------------------------------- config */

static void refuse_config(const rlvc_vision_config *config, const char *field) {
    rlvc_vision_error error;
    rlvc_extractor *extractor = NULL;
    rlvc_fitter *fitter = NULL;
    assert_int_equal(rlvc_vision_config_check(config, &error), RLVC_VISION_E_CONFIG);
    if (strstr(error.text, field) == NULL)
        fail_msg("\"%s\" does not name %s", error.text, field);
    assert_int_equal(rlvc_vision_config_check(config, NULL), RLVC_VISION_E_CONFIG);
    assert_int_equal(rlvc_extractor_create(config, NULL, &extractor, &error), RLVC_VISION_E_CONFIG);
    assert_int_equal(rlvc_fitter_create(config, &fitter, &error), RLVC_VISION_E_CONFIG);
    assert_null(extractor);
    assert_null(fitter);
}

#define REFUSE(field, value)                                                                       \
    do {                                                                                           \
        rlvc_vision_config config_ = config_of(RLVC_DESCRIPTOR_INVARIANTS);                        \
        config_.field = (value);                                                                   \
        refuse_config(&config_, "config." #field);                                                 \
    } while (0)

static void test_configs_refused(void **state) {
    (void)state;
    REFUSE(descriptor, RLVC_DESCRIPTORS);
    REFUSE(points, 0);
    REFUSE(points, RLVC_POINTS_MAX + 1);
    REFUSE(radius, 0);
    REFUSE(radius, 32);
    REFUSE(form, 2);
    REFUSE(normalise, 2);
    REFUSE(sd, 0.49f);
    REFUSE(sd, 4.01f);
    REFUSE(sd, NAN);
    REFUSE(si, 0.49f);
    REFUSE(si, 8.01f);
    REFUSE(k, -0.01f);
    REFUSE(k, 0.25f);
    REFUSE(k, NAN);
    REFUSE(threshold, -0.01f);
    REFUSE(threshold, 1.0f);
    REFUSE(noise, -1.0f);
    REFUSE(noise, 64.1f);
    REFUSE(noise, NAN);
    REFUSE(sigma, INFINITY);
    REFUSE(sigma, 0.0f);
    rlvc_vision_config config = config_of(RLVC_DESCRIPTOR_INVARIANTS);
    config.places = 3;
    refuse_config(&config, "config.places");
    config = config_of(RLVC_DESCRIPTOR_INVARIANTS);
    config.axes = 9;
    refuse_config(&config, "config.axes");
    assert_int_equal(rlvc_vision_dimensions(&config), 0);
    assert_int_equal(rlvc_vision_percept_bytes(&config), 0);
    assert_int_equal(rlvc_vision_dimensions(NULL), 0);
    assert_int_equal(rlvc_vision_config_default(RLVC_DESCRIPTORS, &config), RLVC_VISION_E_RANGE);
    assert_int_equal(rlvc_vision_config_default(0, NULL), RLVC_VISION_E_NULL);
    assert_int_equal(rlvc_vision_config_check(NULL, NULL), RLVC_VISION_E_NULL);
}

/* ------------------------------------------------------------------------- the record */

/* What must hold of any percept: order, spacing, bounds, finite numbers, zeros behind. */
static void check_percept(const rlvc_vision_config *config, const rlvc_picture *picture) {
    uint32_t n = rlvc_descriptor_dimensions(config->descriptor);
    for (uint32_t i = 0; i < a.count; i++) {
        const rlvc_point *p = &a.points[i];
        assert_true(p->x >= 0.0f && p->x < (float)picture->width);
        assert_true(p->y >= 0.0f && p->y < (float)picture->height);
        assert_true(p->response > config->threshold * a.points[0].response);
        assert_true(i == 0 || p->response <= a.points[i - 1].response);
        for (uint32_t j = 0; j < i; j++)
            assert_true(fabsf(p->x - a.points[j].x) > (float)config->radius ||
                        fabsf(p->y - a.points[j].y) > (float)config->radius);
    }
    for (uint32_t i = 0; i < a.count * n; i++)
        assert_true(isfinite(a.vector.real[i]));
    for (uint32_t i = a.count * n; i < config->points * n; i++)
        assert_true(memcmp(&a.vector.real[i], "\0\0\0\0", 4) == 0);
}

static void test_record(void **state) {
    (void)state;
    test_picture made = test_picture_make(128, 96, RLVC_PICTURE_BGR, 1);
    for (uint32_t descriptor = 0; descriptor < RLVC_DESCRIPTOR_QUARTERS; descriptor++) {
        rlvc_vision_config config = config_of(descriptor);
        for (config.points = 5; config.points <= 200; config.points += 195) {
            look_once(&config, NULL, &made.picture, &a);
            assert_true(config.points == 5 ? a.count == 5 : a.count > 20 && a.count < 200);
            check_percept(&config, &made.picture);
        }
    }
    test_picture_free(&made);
}

/* Places and directions stand behind the vectors, which they leave alone. */
static void test_places(void **state) {
    (void)state;
    test_picture made = test_picture_make(90, 90, RLVC_PICTURE_BGR, 1);
    for (uint32_t d = 0; d < RLVC_DESCRIPTOR_QUARTERS; d++) {
        rlvc_vision_config config = config_of(d);
        config.points = 9; /* so that directions end in zeros */
        const uint32_t plain = rlvc_vision_percept_bytes(&config);
        look_once(&config, NULL, &made.picture, &a);
        for (config.places = RLVC_PLACES_POINTS; config.places <= RLVC_PLACES_DIRECTED;
             config.places++) {
            const uint32_t bytes = rlvc_vision_percept_bytes(&config);
            assert_int_equal(bytes, plain + (config.places == RLVC_PLACES_POINTS ? 36u : 56u));
            look_once(&config, NULL, &made.picture, &b);
            assert_memory_equal(&a.count, &b.count, plain);
            const unsigned char *at = (const unsigned char *)&b.count + plain;
            for (uint32_t i = 0; i < b.count; i++) {
                int16_t place[2];
                memcpy(place, at + 4u * i, sizeof place);
                assert_true((float)place[0] == b.points[i].x && (float)place[1] == b.points[i].y);
                if (config.places == RLVC_PLACES_DIRECTED) {
                    const int8_t *unit = (const int8_t *)at + 36u + 2u * i;
                    assert_in_range(unit[0] * unit[0] + unit[1] * unit[1], 126 * 126, 128 * 128);
                }
            }
        }
    }
    test_picture_free(&made);
}

/* A sky with noise of 3 grey levels has no point, unless any response will do. */
static void test_a_plain_sky(void **state) {
    (void)state;
    static uint8_t pixels[3 * 200 * 150];
    uint32_t random = 1;
    for (size_t i = 0; i < sizeof pixels; i++) {
        int sum = 0;
        for (int k = 0; k < 12; k++) { /* of deviation 1 * 256, nearly normally distributed */
            random = random * 1664525u + 1013904223u;
            sum += (int)(random >> 24);
        }
        pixels[i] = (uint8_t)(180 + (sum - 12 * 128) * 3 / 256);
    }
    const rlvc_picture sky[2] = {{pixels, 3 * 200, 200, 150, RLVC_PICTURE_RGB},
                                 {pixels, 200, 200, 150, RLVC_PICTURE_GREY}};
    for (uint32_t i = 0; i < 2u; i++) {
        rlvc_vision_config config = config_of(RLVC_DESCRIPTOR_INVARIANTS);
        look_once(&config, NULL, &sky[i], &a);
        assert_int_equal(a.count, 0);
        config.noise = 0.0f;
        look_once(&config, NULL, &sky[i], &a);
        assert_int_equal(a.count, config.points);
    }
}

/* The quarters' means, added up pixel by pixel: a pixel belongs to the second half of a side if
 * twice its number is not below the side, or to both if it is the only one. */
static void quarter_means(const test_picture *made, double mean[12]) {
    const uint32_t width = made->picture.width, height = made->picture.height;
    const uint32_t channels = made->picture.format == RLVC_PICTURE_GREY ? 1u : 3u;
    for (uint32_t k = 0; k < 12u; k++) {
        const uint32_t q = k / 3u, red_first = k % 3u;
        const uint32_t channel = channels == 1u                             ? 0u
                                 : made->picture.format == RLVC_PICTURE_BGR ? 2u - red_first
                                                                            : red_first;
        double sum = 0;
        uint32_t count = 0;
        for (uint32_t y = 0; y < height; y++)
            for (uint32_t x = 0; x < width; x++)
                if ((height == 1u || (2u * y + 1u >= height) == (q >= 2u)) &&
                    (width == 1u || (2u * x + 1u >= width) == (q % 2u == 1u))) {
                    sum += made->pixels[(y * width + x) * channels + channel];
                    count++;
                }
        mean[k] = sum / count;
    }
}

static void test_quarters(void **state) {
    (void)state;
    static const uint32_t sides[][2] = {{80, 60}, {41, 37}, {1, 1}, {1, 9}, {6, 1}, {2, 3}};
    rlvc_vision_config config = config_of(RLVC_DESCRIPTOR_QUARTERS);
    assert_int_equal(config.points, 1);
    for (uint32_t i = 0; i < 18u; i++) {
        test_picture made = test_picture_make(sides[i / 3u][0], sides[i / 3u][1], i % 3u, i);
        double mean[12];
        quarter_means(&made, mean);
        config.form = RLVC_FORM_FLOAT;
        look_once(&config, NULL, &made.picture, &a);
        config.form = RLVC_FORM_INT8;
        look_once(&config, NULL, &made.picture, &b);
        assert_true(a.count == 1u && b.count == 1u);
        assert_true(a.points[0].x == (float)(made.picture.width / 2u) &&
                    a.points[0].y == (float)(made.picture.height / 2u) &&
                    a.points[0].response == 1.0f);
        for (uint32_t k = 0; k < 12u; k++) {
            assert_true(fabs((double)a.vector.real[k] - mean[k]) < 1e-4);
            assert_true(fabs(b.vector.whole[k] + 128.0 - mean[k]) <= 0.5001);
        }
        test_picture_free(&made);
    }
}

static void test_length_is_one(void **state) {
    (void)state;
    test_picture made = test_picture_make(100, 100, RLVC_PICTURE_RGB, 2);
    for (uint32_t d = RLVC_DESCRIPTOR_SIFT_UPRIGHT; d <= RLVC_DESCRIPTOR_ORB; d++) {
        rlvc_vision_config config = config_of(d);
        uint32_t n = rlvc_descriptor_dimensions(d);
        look_once(&config, NULL, &made.picture, &a);
        assert_true(a.count > 0);
        for (uint32_t i = 0; i < a.count; i++) {
            double sum = 0;
            for (uint32_t j = 0; j < n; j++)
                sum += (double)a.vector.real[i * n + j] * (double)a.vector.real[i * n + j];
            assert_true(fabs(sqrt(sum) - 1) < 0.02);
        }
    }
    test_picture_free(&made);
}

static void test_int8_loses_nothing_of_sift_and_orb(void **state) {
    (void)state;
    test_picture made = test_picture_make(100, 100, RLVC_PICTURE_BGR, 3);
    for (uint32_t d = RLVC_DESCRIPTOR_SIFT_UPRIGHT; d <= RLVC_DESCRIPTOR_ORB; d++) {
        rlvc_vision_config config = config_of(d);
        uint32_t numbers = rlvc_descriptor_dimensions(d);
        float centre = d == RLVC_DESCRIPTOR_ORB ? 0.0f : 0.25f;
        look_once(&config, NULL, &made.picture, &a);
        config.form = RLVC_FORM_INT8;
        rlvc_extractor *extractor = extractor_of(&config, NULL);
        float step = rlvc_extractor_step(extractor);
        look(extractor, &config, &made.picture, &b);
        assert_int_equal(a.count, b.count);
        for (uint32_t i = 0; i < a.count * numbers; i++)
            assert_true(fabsf(step * (float)b.vector.whole[i] + centre - a.vector.real[i]) <
                        step * 1.001f); /* -128 saturates to -127 */
        rlvc_extractor_destroy(extractor);
    }
    test_picture_free(&made);
}

/* ------------------------------------------------------------------------- layouts */

static void test_formats_agree(void **state) {
    (void)state;
    test_picture grey = test_picture_make(70, 50, RLVC_PICTURE_GREY, 4);
    uint8_t *pixels = malloc(3 * 70 * 50);
    assert_non_null(pixels);
    for (size_t i = 0; i < 3 * 70 * 50; i++)
        pixels[i] = grey.pixels[i / 3];
    rlvc_picture colour = {pixels, 3 * 70, 70, 50, RLVC_PICTURE_BGR};
    for (uint32_t d = 0; d < RLVC_DESCRIPTORS; d++) {
        rlvc_vision_config config = config_of(d);
        look_once(&config, NULL, &grey.picture, &a);
        for (colour.format = RLVC_PICTURE_BGR; colour.format <= RLVC_PICTURE_RGB; colour.format++) {
            look_once(&config, NULL, &colour, &b);
            assert_true(a.count > 0 && same(&config));
        }
    }
    free(pixels);
    test_picture_free(&grey);
}

static void test_red_and_blue_change_places(void **state) {
    (void)state;
    test_picture bgr = test_picture_make(90, 60, RLVC_PICTURE_BGR, 5);
    test_picture rgb = test_picture_make(90, 60, RLVC_PICTURE_RGB, 5);
    rlvc_vision_config config = config_of(RLVC_DESCRIPTOR_INVARIANTS);
    config.points = 1;
    look_once(&config, NULL, &bgr.picture, &a);
    look_once(&config, NULL, &rgb.picture, &b);
    assert_true(a.count == 1 && a.vector.real[0] != a.vector.real[4]);
    for (int i = 0; i < 2; i++) {
        assert_true(a.vector.real[i] == b.vector.real[4 + i]);
        assert_true(a.vector.real[2 + i] == b.vector.real[2 + i]);
    }
    test_picture_free(&bgr);
    test_picture_free(&rgb);
}

static void test_strides(void **state) {
    (void)state;
    test_picture made = test_picture_make(41, 37, RLVC_PICTURE_BGR, 6);
    enum { row = 3 * 41, gap = 13 };
    uint8_t *pixels = malloc((row + gap) * 37);
    assert_non_null(pixels);
    memset(pixels, 0xff, (row + gap) * 37);
    for (uint32_t d = 0; d < RLVC_DESCRIPTORS; d++) {
        rlvc_vision_config config = config_of(d);
        config.normalise = 1;
        look_once(&config, NULL, &made.picture, &a);
        assert_true(a.count > 0);
        rlvc_picture picture = made.picture;
        picture.pixels = pixels;
        picture.stride = row + gap;
        for (size_t y = 0; y < 37; y++)
            memcpy(pixels + y * (row + gap), made.pixels + y * row, row);
        look_once(&config, NULL, &picture, &b);
        assert_true(same(&config));
        for (size_t y = 0; y < 37; y++)
            memcpy(pixels + (36 - y) * (row + gap), made.pixels + y * row, row);
        picture.pixels = pixels + (size_t)36 * (row + gap);
        picture.stride = -(row + gap);
        look_once(&config, NULL, &picture, &b);
        assert_true(same(&config));
    }
    free(pixels);
    test_picture_free(&made);
}

static void test_sizes_follow_each_other(void **state) {
    (void)state;
    static const uint32_t sides[][2] = {{200, 30}, {1, 1},  {16, 160}, {2, 300}, {300, 2},
                                        {64, 64},  {1, 90}, {90, 1},   {3, 3},   {200, 30}};
    for (uint32_t d = 0; d < RLVC_DESCRIPTORS; d++) {
        rlvc_vision_config config = config_of(d);
        config.normalise = 1;
        rlvc_extractor *extractor = extractor_of(&config, NULL);
        for (uint32_t i = 0; i < sizeof sides / sizeof sides[0]; i++) {
            test_picture made = test_picture_make(sides[i][0], sides[i][1], i % 3, i);
            look(extractor, &config, &made.picture, &a);
            look_once(&config, NULL, &made.picture, &b);
            assert_true(same(&config));
            test_picture_free(&made);
        }
        rlvc_extractor_destroy(extractor);
    }
}

static void test_nothing_to_see(void **state) {
    (void)state;
    static const uint8_t black[3 * 40 * 40];
    for (uint32_t d = 0; d < RLVC_DESCRIPTOR_QUARTERS; d++)
        for (uint32_t side = 1; side <= 40; side += 13)
            for (uint32_t format = 0; format <= RLVC_PICTURE_RGB; format++) {
                rlvc_picture picture = {black, 120, side, side, format};
                rlvc_vision_config config = config_of(d);
                config.normalise = (uint8_t)(side % 2);
                look_once(&config, NULL, &picture, &a);
                assert_int_equal(a.count, 0);
                check_percept(&config, &picture);
            }
}

/* ------------------------------------------------------------------------- invariance */

/* The number of the point at a place of percept b; b.count if there is none. */
static uint32_t find(float x, float y) {
    uint32_t i = 0;
    while (i < b.count && !(b.points[i].x == x && b.points[i].y == y))
        i++;
    return i;
}

static void test_quarter_turns(void **state) {
    (void)state;
    for (uint32_t seed = 10; seed < 15; seed++) {
        test_picture made = test_picture_make(128, 100, RLVC_PICTURE_BGR, seed);
        test_picture turned = test_picture_turned(&made);
        rlvc_vision_config config = config_of(RLVC_DESCRIPTOR_INVARIANTS);
        config.points = 200;
        look_once(&config, NULL, &made.picture, &a);
        look_once(&config, NULL, &turned.picture, &b);
        assert_true(a.count > 20 && a.count == b.count);
        for (uint32_t i = 0; i < a.count; i++) {
            uint32_t j = find(99 - a.points[i].y, a.points[i].x);
            if (j == b.count)
                fail_msg("seed %u: the point at %g %g is lost", seed, (double)a.points[i].x,
                         (double)a.points[i].y);
            for (uint32_t k = 0; k < 8; k++) {
                float before = a.vector.real[i * 8 + k], after = b.vector.real[j * 8 + k];
                if (!(fabsf(before - after) <= 1e-5f * fabsf(before)))
                    fail_msg("seed %u: number %u of a vector turns from %g to %g", seed, k,
                             (double)before, (double)after);
            }
        }
        test_picture_free(&turned);
        test_picture_free(&made);
    }
}

static void test_light(void **state) {
    (void)state;
    static const int gain[3] = {2, 1, 2}, offset[3] = {-19, 100, 30};
    for (uint32_t seed = 20; seed < 25; seed++) {
        test_picture made = test_picture_make(120, 90, RLVC_PICTURE_RGB, seed);
        test_picture lit = test_picture_lit(&made, gain, offset);
        rlvc_vision_config config = config_of(RLVC_DESCRIPTOR_SQRT_INVARIANTS);
        config.normalise = 1;
        config.points = 200;
        look_once(&config, NULL, &made.picture, &a);
        look_once(&config, NULL, &lit.picture, &b);
        assert_true(a.count > 20 && a.count == b.count);
        for (uint32_t i = 0; i < a.count; i++) {
            uint32_t j = find(a.points[i].x, a.points[i].y);
            assert_true(j < b.count);
            for (uint32_t k = 0; k < 8; k++)
                if (!(fabsf(a.vector.real[i * 8 + k] - b.vector.real[j * 8 + k]) < 2e-3f))
                    fail_msg("seed %u: number %u of a vector goes from %g to %g", seed, k,
                             (double)a.vector.real[i * 8 + k], (double)b.vector.real[j * 8 + k]);
        }
        config.normalise = 0;
        look_once(&config, NULL, &lit.picture, &b);
        assert_false(same(&config));
        test_picture_free(&lit);
        test_picture_free(&made);
    }
}

/* ------------------------------------------------------------------------- refusals */

static void refuse_picture(rlvc_picture picture, rlvc_vision_status expected, const char *field) {
    rlvc_vision_config config = config_of(RLVC_DESCRIPTOR_SIFT);
    rlvc_extractor *extractor = extractor_of(&config, NULL);
    rlvc_vision_error error;
    memset(&a, 0x5a, sizeof a);
    b = a;
    assert_int_equal(rlvc_extractor_extract(extractor, &picture, &a,
                                            rlvc_vision_percept_bytes(&config), a.points, &error),
                     expected);
    if (strstr(error.text, field) == NULL)
        fail_msg("\"%s\" does not name %s", error.text, field);
    assert_memory_equal(&a, &b, sizeof a);
    rlvc_extractor_destroy(extractor);
}

static void test_pictures_refused(void **state) {
    (void)state;
    static const uint8_t byte[12];
    rlvc_picture picture;
#define REFUSE_PICTURE(...)                                                                        \
    picture = (rlvc_picture){__VA_ARGS__};                                                         \
    refuse_picture(picture, RLVC_VISION_E_PICTURE,
    REFUSE_PICTURE(byte, 6, 0, 2, RLVC_PICTURE_BGR) "width");
    REFUSE_PICTURE(byte, 6, 2, 0, RLVC_PICTURE_BGR) "height");
    REFUSE_PICTURE(byte, 6, RLVC_PICTURE_SIDE_MAX + 1, 1, RLVC_PICTURE_BGR) "width");
    REFUSE_PICTURE(byte, 6, 1, UINT32_MAX, RLVC_PICTURE_BGR) "height");
    REFUSE_PICTURE(byte, 5, 2, 2, RLVC_PICTURE_BGR) "stride");
    REFUSE_PICTURE(byte, -5, 2, 2, RLVC_PICTURE_RGB) "stride");
    REFUSE_PICTURE(byte, 0, 2, 2, RLVC_PICTURE_GREY) "stride");
    REFUSE_PICTURE(byte, PTRDIFF_MAX, 2, 2, RLVC_PICTURE_GREY) "stride");
    REFUSE_PICTURE(byte, PTRDIFF_MIN, 2, 2, RLVC_PICTURE_GREY) "stride");
    REFUSE_PICTURE(byte, 2, 2, 2, 3) "format");
    picture = (rlvc_picture){NULL, 6, 2, 2, RLVC_PICTURE_BGR};
    refuse_picture(picture, RLVC_VISION_E_NULL, "pixels");
    /* Of one row there is no next one. */
    rlvc_vision_config config = config_of(RLVC_DESCRIPTOR_INVARIANTS);
    picture = (rlvc_picture){byte, 0, 4, 1, RLVC_PICTURE_BGR};
    look_once(&config, NULL, &picture, &a);
}

static void test_calls_refused(void **state) {
    (void)state;
    static const uint8_t pixel[3];
    rlvc_picture picture = {pixel, 3, 1, 1, RLVC_PICTURE_BGR};
    rlvc_vision_config config = config_of(RLVC_DESCRIPTOR_SQRT_INVARIANTS);
    uint32_t bytes = rlvc_vision_percept_bytes(&config);
    rlvc_extractor *extractor = extractor_of(&config, NULL);
    rlvc_vision_error error;
    assert_int_equal(rlvc_extractor_extract(NULL, &picture, &a, bytes, NULL, &error),
                     RLVC_VISION_E_NULL);
    assert_int_equal(rlvc_extractor_extract(extractor, NULL, &a, bytes, NULL, &error),
                     RLVC_VISION_E_NULL);
    assert_int_equal(rlvc_extractor_extract(extractor, &picture, NULL, bytes, NULL, &error),
                     RLVC_VISION_E_NULL);
    assert_int_equal(rlvc_extractor_extract(extractor, &picture, &a, bytes - 4, NULL, &error),
                     RLVC_VISION_E_ROOM);
    assert_int_equal(rlvc_extractor_extract(extractor, &picture, &a, bytes + 4, NULL, NULL),
                     RLVC_VISION_E_ROOM);
    assert_ok(rlvc_extractor_extract(extractor, &picture, &a, bytes, NULL, &error));
    assert_string_equal(error.text, "");
    assert_true(rlvc_extractor_step(extractor) == 1.0f);
    rlvc_extractor_destroy(extractor);
    rlvc_extractor_destroy(NULL);

    extractor = NULL;
    assert_int_equal(rlvc_extractor_create(NULL, NULL, &extractor, &error), RLVC_VISION_E_NULL);
    assert_int_equal(rlvc_extractor_create(&config, NULL, NULL, &error), RLVC_VISION_E_NULL);
    config.form = RLVC_FORM_INT8;
    assert_int_equal(rlvc_extractor_create(&config, NULL, &extractor, &error),
                     RLVC_VISION_E_METRIC);
    assert_null(extractor);
    assert_non_null(strstr(error.text, "sqrt-invariants"));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_names),
        cmocka_unit_test(test_sizes),
        cmocka_unit_test(test_configs_refused),
        cmocka_unit_test(test_record),
        cmocka_unit_test(test_places),
        cmocka_unit_test(test_a_plain_sky),
        cmocka_unit_test(test_length_is_one),
        cmocka_unit_test(test_quarters),
        cmocka_unit_test(test_int8_loses_nothing_of_sift_and_orb),
        cmocka_unit_test(test_formats_agree),
        cmocka_unit_test(test_red_and_blue_change_places),
        cmocka_unit_test(test_strides),
        cmocka_unit_test(test_sizes_follow_each_other),
        cmocka_unit_test(test_nothing_to_see),
        cmocka_unit_test(test_quarter_turns),
        cmocka_unit_test(test_light),
        cmocka_unit_test(test_pictures_refused),
        cmocka_unit_test(test_calls_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
