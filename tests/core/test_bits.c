/* SPDX-License-Identifier: MIT */
/* The domain of bits: the batch detector agrees with exhibits(), and touches nothing else. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "rlvc/bits.h"
#include "base/rng.h"

#define PERCEPTS 80u
#define WIDTHS (sizeof widths / sizeof widths[0])

static const uint32_t widths[] = {1,  7,  8,  9,  18, 31, 32,  33,  40,   56,
                                  57, 63, 64, 65, 71, 72, 100, 128, 1023, 1024};

typedef struct fixture {
    rlvc_domain domain;
    rlvc_samples samples;
    rlvc_sample sample[PERCEPTS];
    unsigned char *percepts; /* of exactly the size they need, for the address sanitizer */
    rlvc_rng rng;
} fixture;

static void open_fixture(fixture *f, uint32_t bits) {
    rlvc_rng_seed(&f->rng, bits);
    assert_int_equal(rlvc_bits_domain(bits, &f->domain), RLVC_OK);
    size_t bytes = (size_t)PERCEPTS * f->domain.percept_bytes;
    f->percepts = malloc(bytes);
    assert_non_null(f->percepts);
    for (size_t i = 0; i < bytes; i++)
        f->percepts[i] = (unsigned char)rlvc_rng_next(&f->rng);
    for (uint32_t i = 0; i < PERCEPTS; i++)
        f->sample[i] = (rlvc_sample){0, rlvc_rng_below(&f->rng, PERCEPTS)};
    f->sample[PERCEPTS - 1u].slot = PERCEPTS - 1u;
    f->samples = (rlvc_samples){f->percepts, f->sample, f->domain.percept_bytes, PERCEPTS};
}

static void check_detect(fixture *f, const unsigned char *features, uint32_t m, uint32_t first,
                         uint32_t n) {
    uint64_t columns[RLVC_DETECT_FEATURES + 1u];
    columns[m] = 0x123456789abcdefu;
    assert_int_equal(f->domain.detect(f->domain.ctx, &f->samples, first, n, features, m, columns),
                     0);
    for (uint32_t j = 0; j < m; j++) {
        uint32_t bit = rlvc_bits_feature(features + 2u * j);
        uint64_t expected = 0;
        for (uint32_t i = 0; i < n; i++) {
            const unsigned char *percept = rlvc_samples_percept(&f->samples, first + i);
            uint8_t present = 2;
            f->domain.exhibits(f->domain.ctx, percept, features + 2u * j, &present);
            assert_int_equal(present, percept[bit / 8u] >> bit % 8u & 1);
            expected |= (uint64_t)present << i;
        }
        if (columns[j] != expected)
            fail_msg("feature %u (bit %u of %u bytes), samples %u + %u: %llx, not %llx", j, bit,
                     f->domain.percept_bytes, first, n, (unsigned long long)columns[j],
                     (unsigned long long)expected);
    }
    assert_true(columns[m] == 0x123456789abcdefu);
}

static void test_detect_consecutive(void **state) {
    (void)state;
    const uint32_t rooms[] = {1, 2, 5, 33, 64};
    const uint32_t samples[] = {1, 2, 63, 64};
    for (size_t w = 0; w < WIDTHS; w++) {
        fixture f;
        open_fixture(&f, widths[w]);
        for (size_t r = 0; r < sizeof rooms / sizeof rooms[0]; r++)
            for (uint32_t begin = 0; begin < widths[w]; begin += rooms[r]) {
                unsigned char features[2u * RLVC_DETECT_FEATURES];
                uint32_t m;
                f.domain.candidates(f.domain.ctx, &f.samples, begin, rooms[r], features, &m);
                assert_int_equal(m, widths[w] - begin < rooms[r] ? widths[w] - begin : rooms[r]);
                uint32_t n = samples[begin / rooms[r] % 4u];
                check_detect(&f, features, m, PERCEPTS - n, n);
                check_detect(&f, features, m, 0, 65u - n);
            }
        free(f.percepts);
    }
}

static void test_detect_any(void **state) {
    (void)state;
    for (size_t w = 0; w < WIDTHS; w++) {
        fixture f;
        open_fixture(&f, widths[w]);
        for (uint32_t m = 1; m <= RLVC_DETECT_FEATURES; m++) {
            unsigned char features[2u * RLVC_DETECT_FEATURES];
            for (uint32_t j = 0; j < m; j++) {
                uint32_t bit = rlvc_rng_below(&f.rng, widths[w]);
                features[2u * j] = (unsigned char)(bit % 256u);
                features[2u * j + 1u] = (unsigned char)(bit / 256u);
            }
            uint32_t n = 1u + rlvc_rng_below(&f.rng, RLVC_DETECT_SAMPLES);
            check_detect(&f, features, m, PERCEPTS - n, n);
        }
        free(f.percepts);
    }
}

static void test_candidates(void **state) {
    (void)state;
    for (size_t w = 0; w < WIDTHS; w++) {
        unsigned char features[2u * 64u];
        rlvc_domain domain;
        rlvc_bits_domain(widths[w], &domain);
        uint32_t first = 0;
        uint32_t written = 64;
        for (; written == 64u; first += written) {
            assert_int_equal(domain.candidates(domain.ctx, NULL, first, 64, features, &written), 0);
            for (uint32_t i = 0; i < written; i++)
                assert_int_equal(rlvc_bits_feature(features + 2u * i), first + i);
        }
        assert_int_equal(first, widths[w]);
    }
}

static void test_names(void **state) {
    (void)state;
    const uint32_t bits[] = {0, 3, 9, 10, 100, 909, 1023};
    const char *const names[] = {"bit 0",   "bit 3",   "bit 9",   "bit 10",
                                 "bit 100", "bit 909", "bit 1023"};
    rlvc_domain domain;
    rlvc_bits_domain(RLVC_BITS_MAX, &domain);
    for (size_t i = 0; i < sizeof bits / sizeof bits[0]; i++)
        for (uint32_t room = 1; room <= RLVC_NAME_BYTES; room++) {
            const unsigned char feature[2] = {(unsigned char)(bits[i] % 256u),
                                              (unsigned char)(bits[i] / 256u)};
            char text[RLVC_NAME_BYTES + 1u];
            memset(text, '#', sizeof text);
            assert_int_equal(domain.name(domain.ctx, feature, text, room), 0);
            size_t length = strlen(names[i]) < room ? strlen(names[i]) : room - 1u;
            assert_memory_equal(text, names[i], length);
            assert_int_equal(text[length], '\0');
            assert_int_equal(text[room], '#');
        }
}

static void test_status(void **state) {
    (void)state;
    rlvc_domain domain;
    rlvc_domain before;
    memset(&domain, 0x5a, sizeof domain);
    before = domain;
    assert_int_equal(rlvc_bits_domain(18, NULL), RLVC_E_NULL);
    assert_int_equal(rlvc_bits_domain(0, &domain), RLVC_E_RANGE);
    assert_int_equal(rlvc_bits_domain(RLVC_BITS_MAX + 1u, &domain), RLVC_E_RANGE);
    assert_memory_equal(&domain, &before, sizeof domain);
    assert_int_equal(rlvc_bits_domain(18, &domain), RLVC_OK);
    assert_int_equal(domain.percept_bytes, 3);
    assert_int_equal(domain.feature_bytes, RLVC_BITS_FEATURE_BYTES);
    assert_int_equal(domain.features_max, 18);
    assert_null(domain.oracle);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_detect_consecutive),
        cmocka_unit_test(test_detect_any),
        cmocka_unit_test(test_candidates),
        cmocka_unit_test(test_names),
        cmocka_unit_test(test_status),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
