/* SPDX-License-Identifier: MIT */
/* A controller that only acts, by a policy that was learnt elsewhere and exported as lake.h. It
 * needs neither the library nor a C library; sense() and move() stand for what a board has. */
#include "lake.h"

volatile unsigned char sensor; /* the cell, 0 to 15 */
volatile unsigned motor;       /* 0 left, 1 down, 2 right, 3 up */

static unsigned char sense(void) {
    return sensor;
}

static void move(unsigned action) {
    motor = action;
}

void control_tick(void) {
    const unsigned char percept = sense();
    move(policy_act(&percept));
}
