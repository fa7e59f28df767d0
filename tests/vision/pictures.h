/* SPDX-License-Identifier: MIT */
/* Pictures for the tests: cards and discs of random colours and places on a shaded ground, with
 * noise. */
#ifndef RLVC_TEST_PICTURES_H
#define RLVC_TEST_PICTURES_H

#include "rlvc/vision.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The pixels lie from the first row to the last without a gap; free() them. Values are 10 to 110,
 * so that they can be doubled. Equal arguments give equal pictures. */
typedef struct test_picture {
    rlvc_picture picture;
    uint8_t *pixels;
} test_picture;

test_picture test_picture_make(uint32_t width, uint32_t height, uint32_t format, uint32_t seed);

/* The same picture, with every value v of channel c turned into gain[c] * v + offset[c]. */
test_picture test_picture_lit(const test_picture *from, const int gain[3], const int offset[3]);

/* The same picture, a quarter turned clockwise: (x, y) goes to (height - 1 - y, x). */
test_picture test_picture_turned(const test_picture *from);

/* The same picture, every value moved by -amount to amount. */
test_picture test_picture_noisy(const test_picture *from, int amount, uint32_t seed);

void test_picture_free(test_picture *picture);

/* The next number, of 32 random bits. */
uint32_t test_random(uint32_t *state);

#ifdef __cplusplus
}
#endif

#endif
