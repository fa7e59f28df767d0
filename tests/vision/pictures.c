/* SPDX-License-Identifier: MIT */
#include "pictures.h"

#include <stdlib.h>
#include <string.h>

#define CARDS 24

uint32_t test_random(uint32_t *state) {
    *state ^= *state << 13;
    *state ^= *state >> 17;
    *state ^= *state << 5;
    return *state;
}

static uint32_t below(uint32_t *state, uint32_t n) {
    return test_random(state) % n;
}

static uint32_t channels_of(uint32_t format) {
    return format == RLVC_PICTURE_GREY ? 1 : 3;
}

static test_picture blank(uint32_t width, uint32_t height, uint32_t format) {
    test_picture made;
    size_t row = (size_t)width * channels_of(format);
    made.pixels = malloc(row * height);
    if (made.pixels == NULL)
        abort();
    made.picture.pixels = made.pixels;
    made.picture.stride = (ptrdiff_t)row;
    made.picture.width = width;
    made.picture.height = height;
    made.picture.format = format;
    return made;
}

static size_t size_of(const test_picture *picture) {
    return (size_t)picture->picture.stride * picture->picture.height;
}

/* A card, or the disc inside it. */
static void paint(test_picture *made, uint32_t *state) {
    uint32_t channels = channels_of(made->picture.format);
    int64_t width = made->picture.width, height = made->picture.height;
    int64_t side = 4 + below(state, (uint32_t)(width + height) / 8 + 1);
    int64_t left = (int64_t)below(state, (uint32_t)width) - side / 2;
    int64_t top = (int64_t)below(state, (uint32_t)height) - side / 2;
    uint32_t disc = below(state, 2);
    uint8_t colour[3];
    for (int c = 0; c < 3; c++)
        colour[c] = (uint8_t)(20 + below(state, 81));
    for (int64_t y = top < 0 ? 0 : top; y < top + side && y < height; y++)
        for (int64_t x = left < 0 ? 0 : left; x < left + side && x < width; x++) {
            int64_t dx = 2 * (x - left) - side, dy = 2 * (y - top) - side;
            if (disc != 0 && dx * dx + dy * dy > side * side)
                continue;
            memcpy(made->pixels + (size_t)(y * width + x) * channels, colour, channels);
        }
}

test_picture test_picture_make(uint32_t width, uint32_t height, uint32_t format, uint32_t seed) {
    test_picture made = blank(width, height, format);
    uint32_t state = seed * 2654435761u + 1;
    uint32_t channels = channels_of(format);
    for (size_t i = 0; i < size_of(&made); i++)
        made.pixels[i] = (uint8_t)(30 + 40 * (i / channels % width) / width);
    for (int i = 0; i < CARDS; i++)
        paint(&made, &state);
    test_picture noisy = test_picture_noisy(&made, 3, seed + 1);
    test_picture_free(&made);
    return noisy;
}

test_picture test_picture_lit(const test_picture *from, const int gain[3], const int offset[3]) {
    test_picture made = blank(from->picture.width, from->picture.height, from->picture.format);
    for (size_t i = 0; i < size_of(from); i++) {
        size_t c = i % channels_of(from->picture.format);
        made.pixels[i] = (uint8_t)(gain[c] * from->pixels[i] + offset[c]);
    }
    return made;
}

test_picture test_picture_turned(const test_picture *from) {
    uint32_t channels = channels_of(from->picture.format);
    uint32_t width = from->picture.width, height = from->picture.height;
    test_picture made = blank(height, width, from->picture.format);
    for (uint32_t y = 0; y < height; y++)
        for (uint32_t x = 0; x < width; x++)
            memcpy(made.pixels + ((size_t)x * height + (height - 1 - y)) * channels,
                   from->pixels + ((size_t)y * width + x) * channels, channels);
    return made;
}

test_picture test_picture_noisy(const test_picture *from, int amount, uint32_t seed) {
    test_picture made = blank(from->picture.width, from->picture.height, from->picture.format);
    uint32_t state = seed * 2246822519u + 1;
    for (size_t i = 0; i < size_of(from); i++) {
        int value = from->pixels[i] + (int)below(&state, 2 * (uint32_t)amount + 1) - amount;
        made.pixels[i] = (uint8_t)(value < 10 ? 10 : value > 110 ? 110 : value);
    }
    return made;
}

void test_picture_free(test_picture *picture) {
    free(picture->pixels);
    picture->pixels = NULL;
}
