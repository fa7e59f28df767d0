/* SPDX-License-Identifier: MIT */
/* The cart and pole: a cart on a track carries a pole on a hinge, and is pushed to the left or to
 * the right 50 times a second so that the pole stays up. A textbook system: equations and constants
 * of A. G. Barto, R. S. Sutton and C. W. Anderson, "Neuronlike adaptive elements that can solve
 * difficult learning control problems", IEEE Transactions on Systems, Man, and Cybernetics 13
 * (1983), without friction.
 *
 * In binary32 by + - * / only, the sine and cosine by series: the same seed gives the same states
 * on every machine. */
#ifndef BALANCE_CART_POLE_H
#define BALANCE_CART_POLE_H

#include <stdint.h>

#define CART_POLE_COMPONENTS 4u
#define CART_POLE_ACTIONS 2u
#define CART_POLE_LEFT 0u
#define CART_POLE_RIGHT 1u
#define CART_POLE_PERIOD_MS 20u

struct cart_pole {
    float state[CART_POLE_COMPONENTS]; /* position in m, speed in m/s, angle of the pole in rad (0:
                                          upright; to the right: positive), its speed in rad/s */
    uint32_t random;
};

/* Makes a cart, whose starts the seed decides. O(1). */
void cart_pole_init(struct cart_pole *cart, uint32_t seed);

/* Puts the cart into the middle and the pole upright, but for up to 0.05 in each number of the
 * state. O(1). */
void cart_pole_reset(struct cart_pole *cart);

/* Pushes for one period.
 * @param action CART_POLE_LEFT or CART_POLE_RIGHT
 * @return 1: the pole fell (more than 12 degrees) or the cart left the track (more than 2.4 m);
 * else 0. O(1). */
int cart_pole_step(struct cart_pole *cart, uint32_t action);

#endif
