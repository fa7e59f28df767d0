/* SPDX-License-Identifier: MIT */
/* A simulated robot that learns its way through Sutton's maze, in a control loop of a fixed period.
 *
 * Each tick the robot senses and acts, and then lends the learner a slice of work, if there is any.
 * It explores until the interactions for the next learning step are there. While that step is under
 * way, which takes many ticks, it patrols: it does what it has learnt so far, elsewhere in the
 * maze, and what happens there is not recorded. So what is learnt does not depend on how learning
 * is sliced. */
#ifndef FIRMWARE_ROBOT_H
#define FIRMWARE_ROBOT_H

#include "settings.h"

struct robot {
    rlvc_agent *agent;
    gridworld world;  /* where it explores */
    gridworld patrol; /* and where it works */
    unsigned char percept[PERCEPT_BYTES];
    uint8_t learning; /* a learning step is under way */
    uint8_t finished; /* the last tick has finished one */
    uint32_t interactions;
    uint32_t steps;              /* learning steps finished */
    uint32_t splits;             /* of the last one */
    uint32_t patrols;            /* ticks of patrol, */
    uint32_t arrivals;           /* and how often it came to the exit there */
    uint32_t slice_instructions; /* of the last tick; 0 where they cannot be counted */
};

/* Makes the robot, in static memory: there is one. O(classes * actions).
 * @return 0; -1: it could not be made. */
int robot_init(struct robot *robot);

/* The bytes of the static block that the agent lives in. */
uint32_t robot_block_bytes(void);

/* One period of the control loop.
 * @return 0; -1: something failed that cannot fail. */
int robot_tick(struct robot *robot);

#endif
