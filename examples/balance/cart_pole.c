/* SPDX-License-Identifier: MIT */
/* The cart and pole: see cart_pole.h. */
#include "cart_pole.h"

#define GRAVITY 9.8f
#define POLE_MASS 0.1f
#define MASS 1.1f        /* of cart and pole */
#define HALF_LENGTH 0.5f /* of the pole, m */
#define FORCE 10.0f      /* N */
#define PERIOD 0.02f     /* s */
#define TRACK 2.4f
#define FALLEN 0.20943951f /* 12 degrees */
#define START 0.05f

void cart_pole_init(struct cart_pole *cart, uint32_t seed) {
    cart->random = seed;
    cart_pole_reset(cart);
}

/* [-START, START): the upper 24 bits of a linear congruential generator (Knuth volume 2, 3.3.4). */
static float draw(struct cart_pole *cart) {
    cart->random = cart->random * UINT32_C(1664525) + UINT32_C(1013904223);
    return START * ((float)(cart->random >> 8) / 8388608.0f - 1.0f);
}

void cart_pole_reset(struct cart_pole *cart) {
    for (uint32_t i = 0; i < CART_POLE_COMPONENTS; i++)
        cart->state[i] = draw(cart);
}

/* Taylor series. The pole is down before the angle is 0.3 rad; there they are exact to 1e-8. */
static float sine(float x) {
    float s = x * x;
    return x * (1.0f - s / 6.0f * (1.0f - s / 20.0f * (1.0f - s / 42.0f)));
}

static float cosine(float x) {
    float s = x * x;
    return 1.0f - s / 2.0f * (1.0f - s / 12.0f * (1.0f - s / 30.0f));
}

int cart_pole_step(struct cart_pole *cart, uint32_t action) {
    float *state = cart->state;
    float force = action == CART_POLE_RIGHT ? FORCE : -FORCE;
    float sin = sine(state[2]), cos = cosine(state[2]);
    float push = (force + POLE_MASS * HALF_LENGTH * state[3] * state[3] * sin) / MASS;
    float turn =
        (GRAVITY * sin - cos * push) / (HALF_LENGTH * (4.0f / 3.0f - POLE_MASS * cos * cos / MASS));
    float speed_up = push - POLE_MASS * HALF_LENGTH * turn * cos / MASS;
    state[0] += PERIOD * state[1]; /* Euler's method */
    state[1] += PERIOD * speed_up;
    state[2] += PERIOD * state[3];
    state[3] += PERIOD * turn;
    return state[0] < -TRACK || state[0] > TRACK || state[2] < -FALLEN || state[2] > FALLEN;
}
