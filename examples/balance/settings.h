/* SPDX-License-Identifier: MIT */
/* What the controller learns by, and the work of a tick: constants, so that all memory is there
 * when the program is linked. */
#ifndef BALANCE_SETTINGS_H
#define BALANCE_SETTINGS_H

#include "cart_pole.h"

#define EPISODE_STEPS 500u /* 10 s: an episode that gets so far is cut off */
#define TRIALS 100u        /* episodes that tell how good a policy is */
#ifndef SEED
#define SEED 1u
#endif

/* The planner's memory: the defaults, but half the leaves of a model, of which there are two. */
#define CAPACITY 2000u
#define SAMPLE 2000u
#define MODEL_LEAVES 16u

/* BALANCE_SHORT (0 or 1) chooses a run that ends before much is learnt, with less work in a tick:
 * for processors without floating point, which take ten times as many instructions. */
#if BALANCE_SHORT
#define INTERACTIONS 300u /* to learn from, and then to the end of the episode */
#define LEARNT 100u       /* steps for which a policy keeps the pole up, if it can balance */
#define CANDIDATES 30u    /* the planner's, as the next one */
#define PATIENCE 30u
#define SLICE 8192u /* the work that a tick lends to the learner, in the library's units */
#else
#define INTERACTIONS 2500u
#define LEARNT 475u
#define CANDIDATES 300u
#define PATIENCE 150u
#define SLICE 80000u
#endif

/* The most instructions of a slice and of a tick: the 20 ms of a processor that executes 100
 * million a second. A tick that takes more is an overrun. */
#define SLICE_INSTRUCTIONS 1900000u
#define TICK_INSTRUCTIONS 2000000u

#endif
