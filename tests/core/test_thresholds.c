/* SPDX-License-Identifier: MIT */
/* The domain of thresholds: candidates against sorting, the batch detector against exhibits(), what
 * is no number, names, and an agent that learns with it. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "rlvc/agent.h"
#include "rlvc/thresholds.h"
#include "base/rng.h"

#define PERCEPTS 80u
#define COMPONENTS 3u
#define ROOM 64u

typedef struct fixture {
    rlvc_thresholds thresholds;
    rlvc_domain domain;
    rlvc_samples samples;
    rlvc_sample sample[PERCEPTS];
    float x[PERCEPTS][COMPONENTS];
    rlvc_rng rng;
} fixture;

/* Component 0 takes many values of either sign, 1 the values 0 and 1, 2 is always 7. */
static void open_fixture(fixture *f, uint32_t cutpoints, uint8_t oblique) {
    rlvc_rng_seed(&f->rng, 1);
    assert_int_equal(rlvc_thresholds_default(&f->thresholds, COMPONENTS), RLVC_OK);
    assert_int_equal(f->thresholds.cutpoints, 15);
    f->thresholds.cutpoints = cutpoints;
    f->thresholds.oblique = oblique;
    assert_int_equal(rlvc_thresholds_domain(&f->thresholds, &f->domain), RLVC_OK);
    for (uint32_t i = 0; i < PERCEPTS; i++) {
        f->x[i][0] = ((float)rlvc_rng_below(&f->rng, 61) - 30.0f) * 0.25f;
        f->x[i][1] = (float)rlvc_rng_below(&f->rng, 2);
        f->x[i][2] = 7.0f;
        f->sample[i] = (rlvc_sample){0, (i * 7u + 3u) % PERCEPTS};
    }
    f->samples = (rlvc_samples){(const unsigned char *)f->x, f->sample, sizeof f->x[0], PERCEPTS};
}

static uint32_t list(fixture *f, uint32_t room, rlvc_threshold *features) {
    uint32_t first = 0, written = room;
    for (; written == room; first += written) {
        assert_int_equal(f->domain.candidates(f->domain.ctx, &f->samples, first, room,
                                              features + first, &written),
                         0);
        assert_true(written <= room);
    }
    return first;
}

static int ascending(const void *a, const void *b) {
    const float left = *(const float *)a, right = *(const float *)b;
    return (left > right) - (left < right);
}

static float value(const fixture *f, uint32_t i, const rlvc_threshold *along) {
    const float *x = f->x[f->sample[i].slot];
    return along->slope != 0.0f ? x[along->component] + along->slope * x[along->other]
                                : x[along->component];
}

/* What candidate b of m along a direction must be. */
static float expected(const fixture *f, const rlvc_threshold *along, uint32_t b, uint32_t m) {
    float sorted[PERCEPTS];
    const uint32_t n = f->samples.count;
    for (uint32_t i = 0; i < n; i++)
        sorted[i] = value(f, i, along);
    qsort(sorted, n, sizeof *sorted, ascending);
    const float low = sorted[b * n / m];
    if (b > 0 && !(low > sorted[(b - 1u) * n / m]))
        return RLVC_THRESHOLDS_NONE;
    uint32_t next = b * n / m;
    while (next < n && !(sorted[next] > low))
        next++;
    return next == n ? RLVC_THRESHOLDS_NONE : low / 2.0f + sorted[next] / 2.0f;
}

static void check_candidates(fixture *f, uint32_t m, uint32_t directions) {
    static rlvc_threshold features[21u * PERCEPTS + ROOM], again[21u * PERCEPTS + ROOM];
    const uint32_t count = list(f, ROOM, features);
    assert_int_equal(count, directions * m);
    assert_int_equal(list(f, 7, again), count);
    assert_memory_equal(features, again, count * sizeof *features);
    for (uint32_t i = 0; i < count; i++) {
        if (i / m < COMPONENTS) {
            assert_int_equal(features[i].component, i / m);
            assert_int_equal(features[i].other, 0);
            assert_true(features[i].slope == 0.0f);
        }
        const float wanted = i / m >= COMPONENTS && features[i].slope == 0.0f
                                 ? RLVC_THRESHOLDS_NONE
                                 : expected(f, &features[i], i % m, m);
        assert_true(features[i].cutpoint == wanted);
    }
}

static void test_binned(void **state) {
    fixture f;
    (void)state;
    open_fixture(&f, 15, 0);
    assert_int_equal(f.domain.features_max, 45);
    check_candidates(&f, 15, 3);
}

static void test_exact(void **state) {
    fixture f;
    (void)state;
    open_fixture(&f, 0, 0);
    assert_int_equal(f.domain.features_max, 0);
    check_candidates(&f, PERCEPTS, 3);
    /* More bins than samples: the same. */
    open_fixture(&f, 1000, 0);
    check_candidates(&f, PERCEPTS, 3);
}

static void test_oblique(void **state) {
    static rlvc_threshold features[21u * 8u + ROOM];
    const float factor[6] = {1.0f, -1.0f, 2.0f, -2.0f, 0.5f, -0.5f};
    fixture f;
    (void)state;
    open_fixture(&f, 8, 1);
    assert_int_equal(f.domain.features_max, 21 * 8);
    check_candidates(&f, 8, 21);
    (void)list(&f, ROOM, features);
    float sorted[PERCEPTS];
    for (uint32_t i = 0; i < PERCEPTS; i++)
        sorted[i] = f.x[i][0];
    qsort(sorted, PERCEPTS, sizeof *sorted, ascending);
    const float spread = sorted[60] - sorted[20];
    for (uint32_t k = 0; k < 6; k++) {
        const rlvc_threshold *pair = &features[(COMPONENTS + k) * 8u];
        assert_int_equal(pair->component, 0);
        assert_int_equal(pair->other, 1);
        assert_true(pair->slope == factor[k] * spread); /* component 1 has the quartiles 0 and 1 */
        /* Component 2 does not vary, so that no slope is to be had of it. */
        assert_true(pair[6u * 8u].slope == 0.0f && pair[12u * 8u].slope == 0.0f);
    }
}

static void test_slopes_out_of_range(void **state) {
    static rlvc_threshold features[21u * 2u + ROOM];
    fixture f;
    (void)state;
    open_fixture(&f, 2, 1);
    for (uint32_t i = 0; i < PERCEPTS; i++) {
        f.x[i][0] = (float)i * 1e13f;
        f.x[i][1] = (float)i * 1e-13f;
        f.x[i][2] = (float)(i * i) * 1e11f;
    }
    assert_int_equal(list(&f, ROOM, features), 21 * 2);
    for (uint32_t i = 0; i < 21; i++) {
        const int usable = i < COMPONENTS || (i >= 9 && i < 15); /* the pair of 0 and 2 */
        assert_int_equal(features[2u * i].cutpoint < RLVC_THRESHOLDS_NONE, usable);
        assert_int_equal(features[2u * i].slope != 0.0f, usable && i >= COMPONENTS);
    }
}

/* Where the middle of two neighbours rounds to the upper one, and where a zero has a sign. */
static void test_close_neighbours(void **state) {
    const float values[][3] = {{1.0f, 1.00000012f, 1.0f},
                               {1.00000012f, 1.00000024f, 1.00000012f},
                               {1.4e-45f, 2.8e-45f, 1.4e-45f},
                               {4.2e-45f, 5.6e-45f, 4.2e-45f},
                               {-5.6e-45f, -4.2e-45f, -5.6e-45f},
                               {-1e15f, 1e15f, 0.0f},
                               {-0.0f, 1.0f, 0.5f},
                               {-1.0f, -0.0f, -0.5f}};
    fixture f;
    (void)state;
    for (size_t i = 0; i < sizeof values / sizeof values[0]; i++) {
        rlvc_threshold features[ROOM];
        uint32_t written;
        uint8_t low = 2, high = 2;
        open_fixture(&f, 0, 0);
        f.samples.count = 2;
        f.x[f.sample[0].slot][0] = values[i][1];
        f.x[f.sample[1].slot][0] = values[i][0];
        f.domain.candidates(f.domain.ctx, &f.samples, 0, ROOM, features, &written);
        assert_int_equal(written, 6);
        assert_true(features[0].cutpoint == values[i][2]);
        f.domain.exhibits(f.domain.ctx, f.x[f.sample[0].slot], features, &high);
        f.domain.exhibits(f.domain.ctx, f.x[f.sample[1].slot], features, &low);
        assert_int_equal(high, 1);
        assert_int_equal(low, 0);
    }
    /* -0 and 0 are one value. */
    f.x[f.sample[0].slot][0] = 0.0f;
    f.x[f.sample[1].slot][0] = -0.0f;
    rlvc_threshold feature;
    uint32_t written;
    f.domain.candidates(f.domain.ctx, &f.samples, 0, 1, &feature, &written);
    assert_true(feature.cutpoint == RLVC_THRESHOLDS_NONE);
}

static void test_detect(void **state) {
    static rlvc_threshold features[21u * 8u + ROOM];
    fixture f;
    (void)state;
    open_fixture(&f, 8, 1);
    const uint32_t count = list(&f, ROOM, features);
    for (uint32_t first = 0; first < count; first += ROOM) {
        const uint32_t m = count - first < ROOM ? count - first : ROOM;
        const uint32_t n = first % 128u ? 64u : 17u;
        uint64_t columns[ROOM];
        assert_int_equal(f.domain.detect(f.domain.ctx, &f.samples, PERCEPTS - n, n,
                                         features + first, m, columns),
                         0);
        for (uint32_t j = 0; j < m; j++) {
            uint64_t wanted = 0;
            for (uint32_t i = 0; i < n; i++) {
                uint8_t present = 2;
                const void *percept = rlvc_samples_percept(&f.samples, PERCEPTS - n + i);
                assert_int_equal(
                    f.domain.exhibits(f.domain.ctx, percept, &features[first + j], &present), 0);
                assert_int_equal(present, value(&f, PERCEPTS - n + i, &features[first + j]) >
                                              features[first + j].cutpoint);
                wanted |= (uint64_t)present << i;
            }
            assert_true(columns[j] == wanted);
        }
    }
}

/* Each percept that is none, at each place, is refused wherever it is looked at. */
static void test_no_numbers(void **state) {
    const uint32_t bits[] = {0x7fc00000u, 0xffc00000u, 0x7f800000u, 0xff800000u, 0x58635fa9u + 1u};
    (void)state;
    for (size_t b = 0; b < sizeof bits / sizeof bits[0]; b++)
        for (uint32_t component = 0; component < COMPONENTS; component++) {
            static rlvc_threshold features[21u * 8u];
            rlvc_threshold feature = {0.0f, 1.0f, 0, 0};
            uint64_t column;
            uint32_t written;
            uint8_t present = 2;
            fixture f;
            open_fixture(&f, 8, 1);
            float *x = f.x[f.sample[5].slot];
            assert_int_equal(rlvc_thresholds_check(&f.thresholds, x), RLVC_OK);
            memcpy(&x[component], &bits[b], sizeof bits[b]);
            assert_int_equal(rlvc_thresholds_check(&f.thresholds, x), RLVC_E_RANGE);
            for (uint32_t first = 0; first < 21u * 8u; first += 8u) {
                const int fails =
                    f.domain.candidates(f.domain.ctx, &f.samples, first, 8, features, &written);
                const uint32_t along = first / 8u;
                const int looks = along < 3    ? along == component
                                  : along < 9  ? component < 2
                                  : along < 15 ? component != 1
                                               : component > 0;
                assert_int_equal(fails != 0, looks);
            }
            /* Also in the middle of a call that began with sound ones. */
            assert_int_not_equal(
                f.domain.candidates(f.domain.ctx, &f.samples, 0, 21u * 8u, features, &written), 0);
            feature.component = (uint16_t)component;
            assert_int_not_equal(f.domain.exhibits(f.domain.ctx, x, &feature, &present), 0);
            feature.component = (uint16_t)((component + 1u) % COMPONENTS);
            feature.other = (uint16_t)component;
            assert_int_not_equal(f.domain.exhibits(f.domain.ctx, x, &feature, &present), 0);
            assert_int_not_equal(
                f.domain.detect(f.domain.ctx, &f.samples, 0, 6, &feature, 1, &column), 0);
            assert_int_equal(f.domain.detect(f.domain.ctx, &f.samples, 0, 5, &feature, 1, &column),
                             0);
            assert_int_equal(present, 2);
        }
}

static void test_names(void **state) {
    const rlvc_threshold features[] = {{0.25f, 0.0f, 3, 0},
                                       {-1.23456789e-10f, 0.0f, 1023, 0},
                                       {1.0f, 0.5f, 0, 2},
                                       {-1e15f, -1.5e-7f, 62, 63}};
    const char *const names[] = {"x[3] > 0.25", "x[1023] > -1.2345679e-10", "x[0] + 0.5 x[2] > 1",
                                 "x[62] - 1.5e-7 x[63] > -1e+15"};
    fixture f;
    (void)state;
    open_fixture(&f, 8, 0);
    for (size_t i = 0; i < sizeof features / sizeof features[0]; i++)
        for (uint32_t room = 1; room <= RLVC_NAME_BYTES; room++) {
            char text[RLVC_NAME_BYTES + 1u];
            memset(text, '#', sizeof text);
            assert_int_equal(f.domain.name(f.domain.ctx, &features[i], text, room), 0);
            size_t length = strlen(names[i]) < room ? strlen(names[i]) : room - 1u;
            assert_memory_equal(text, names[i], length);
            assert_int_equal(text[length], '\0');
            assert_int_equal(text[room], '#');
        }
}

static void check_refused(uint32_t components, uint32_t cutpoints, uint8_t oblique) {
    rlvc_thresholds thresholds = {components, cutpoints, oblique, {0}};
    rlvc_domain domain, before;
    memset(&domain, 0x5a, sizeof domain);
    before = domain;
    assert_int_equal(rlvc_thresholds_domain(&thresholds, &domain), RLVC_E_RANGE);
    assert_memory_equal(&domain, &before, sizeof domain);
}

static void test_status(void **state) {
    rlvc_thresholds thresholds;
    rlvc_domain domain;
    const float x[1] = {0.0f};
    (void)state;
    assert_int_equal(rlvc_thresholds_default(NULL, 1), RLVC_E_NULL);
    assert_int_equal(rlvc_thresholds_default(&thresholds, 1), RLVC_OK);
    assert_int_equal(rlvc_thresholds_domain(NULL, &domain), RLVC_E_NULL);
    assert_int_equal(rlvc_thresholds_domain(&thresholds, NULL), RLVC_E_NULL);
    assert_int_equal(rlvc_thresholds_check(NULL, x), RLVC_E_NULL);
    assert_int_equal(rlvc_thresholds_check(&thresholds, NULL), RLVC_E_NULL);
    assert_true(rlvc_thresholds_feature(NULL).cutpoint == RLVC_THRESHOLDS_NONE);
    check_refused(0, 15, 0);
    check_refused(RLVC_THRESHOLDS_COMPONENTS_MAX + 1u, 15, 0);
    check_refused(RLVC_THRESHOLDS_OBLIQUE_MAX + 1u, 15, 1);
    check_refused(4, RLVC_THRESHOLDS_CUTPOINTS_MAX + 1u, 0);
    check_refused(4, 15, 2);
    assert_int_equal(rlvc_thresholds_domain(&thresholds, &domain), RLVC_OK);
    assert_int_equal(domain.percept_bytes, 4);
    assert_int_equal(domain.feature_bytes, sizeof(rlvc_threshold));
    assert_int_equal(domain.features_max, 15);
    assert_int_equal(domain.kind, RLVC_DOMAIN_THRESHOLDS);
    thresholds =
        (rlvc_thresholds){RLVC_THRESHOLDS_OBLIQUE_MAX, RLVC_THRESHOLDS_CUTPOINTS_MAX, 1, {0}};
    assert_int_equal(rlvc_thresholds_domain(&thresholds, &domain), RLVC_OK);
    assert_int_equal(domain.features_max, (64u + 2016u * 6u) * 65535u);
}

/* An agent that is paid for saying whether x[1] is above 0.3 or x[0] above x[1]. */
static void learn(uint8_t oblique, uint32_t *classes, uint32_t *wrong) {
    static uint64_t memory[100000];
    rlvc_thresholds thresholds;
    rlvc_domain domain;
    rlvc_config config;
    rlvc_agent *agent;
    rlvc_progress progress;
    rlvc_statistics statistics;
    rlvc_rng rng;
    rlvc_rng_seed(&rng, 3);
    rlvc_thresholds_default(&thresholds, 2);
    thresholds.oblique = oblique;
    rlvc_thresholds_domain(&thresholds, &domain);
    rlvc_config_default(&config, &domain, 2);
    config.method = &rlvc_method_classes;
    config.epsilon = 1.0f;
    assert_int_equal(rlvc_agent_init(&config, &domain, memory, sizeof memory, &agent), RLVC_OK);
    *wrong = 0;
    for (uint32_t i = 0; i < 4000; i++) {
        const float x[2] = {(float)rlvc_rng_below(&rng, 1000) * 0.01f,
                            (float)rlvc_rng_below(&rng, 1000) * 0.001f};
        const uint32_t wanted = oblique ? x[0] > 10.0f * x[1] : x[1] > 0.3f;
        rlvc_choice choice;
        uint32_t action;
        assert_int_equal(rlvc_begin(agent, x), RLVC_OK);
        assert_int_equal(rlvc_act(agent, &choice), RLVC_OK);
        assert_int_equal(rlvc_predict(agent, x, NULL, &action), RLVC_OK);
        assert_int_equal(
            rlvc_observe(agent, choice, choice.action == wanted, NULL, RLVC_TERMINATED), RLVC_OK);
        *wrong += i >= 2000 && action != wanted;
        if (i == 1999)
            assert_int_equal(rlvc_learn(agent, RLVC_BUDGET_UNBOUNDED, &progress), RLVC_OK);
    }
    rlvc_stats(agent, &statistics);
    *classes = statistics.classes;
}

static void test_learning(void **state) {
    uint32_t classes, wrong;
    (void)state;
    learn(0, &classes, &wrong);
    if (classes < 2 || classes > 4 || wrong > 40)
        fail_msg("axis-parallel: %u classes, %u of 2000 wrong", classes, wrong);
    learn(1, &classes, &wrong);
    if (classes < 2 || classes > 6 || wrong > 120)
        fail_msg("oblique: %u classes, %u of 2000 wrong", classes, wrong);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_binned),           cmocka_unit_test(test_exact),
        cmocka_unit_test(test_oblique),          cmocka_unit_test(test_slopes_out_of_range),
        cmocka_unit_test(test_close_neighbours), cmocka_unit_test(test_detect),
        cmocka_unit_test(test_no_numbers),       cmocka_unit_test(test_names),
        cmocka_unit_test(test_status),           cmocka_unit_test(test_learning),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
