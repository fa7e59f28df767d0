/* SPDX-License-Identifier: MIT */
/* A controller that learns to balance a pole, in a control loop of a fixed period.
 *
 * Each tick it senses and pushes the cart, and then lends the learner a slice of work, if there is
 * any. After each episode there is a step of learning, which takes many ticks. Meanwhile the
 * controller balances by what it has learnt so far, and what happens there is not recorded. So what
 * is learnt does not depend on how learning is sliced. */
#ifndef BALANCE_CONTROLLER_H
#define BALANCE_CONTROLLER_H

#include "rlvc/planner.h"
#include "settings.h"

struct controller {
    rlvc_agent *agent;
    struct cart_pole cart; /* in the episodes that are learnt from */
    struct cart_pole meanwhile;
    uint8_t learning; /* a step of learning is under way */
    uint8_t finished; /* the last tick has finished one */
    uint32_t steps;   /* of the episode */
    uint32_t interactions;
    uint32_t episodes;           /* that ended */
    uint32_t slices;             /* lent to the learner */
    uint32_t falls;              /* while learning */
    uint32_t slice_instructions; /* of the last tick; 0 where they cannot be counted */
};

/* Makes the controller, in static memory: there is one. O(bytes of the block).
 * @return 0; -1: it could not be made. */
int controller_init(struct controller *controller, uint32_t seed);

/* The bytes of the static block that the agent lives in. */
uint32_t controller_block_bytes(void);

/* One period of the control loop.
 * @return 0; -1: something failed that cannot fail. */
int controller_tick(struct controller *controller);

#endif
