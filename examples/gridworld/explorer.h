/* SPDX-License-Identifier: MIT */
/* Directed exploration of a maze: what a class has seldom tried is tried first, and a walk that
 * knows nothing better goes on as before.
 *
 * A walk by actions drawn alike hardly leaves its neighbourhood, and in a ring that forgets, some
 * action of some cell is nearly always missing. Here an exploring action a is drawn with the weight
 *
 *     w(a) = p(a) / (1 + min(n(c, a), 8))^4,    p(a) = 4 if a is the action of before, else 1
 *
 * where n is how often the percept's class c has tried a, as far as is remembered. In a coarse class
 * all n are large, and the walk is random but for its tendency to keep its direction; in a fine class
 * hardly anything is repeated before all has been tried.
 *
 * C99, without a C library and without memory of its own. Same seed, same walk, on every machine. */
#ifndef GRIDWORLD_EXPLORER_H
#define GRIDWORLD_EXPLORER_H

#include "gridworld.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct gridworld_explorer {
    uint8_t (*tried)[GRIDWORLD_ACTIONS]; /* [classes] since the last gridworld_explorer_forget */
    uint32_t classes;
    uint32_t last;   /* the action of before */
    uint32_t random; /* state of a Lehmer generator, x := 48271 x mod 2^31 - 1 */
} gridworld_explorer;

/* Makes an explorer that has tried nothing. The table is its memory from then on. O(classes). */
void gridworld_explorer_init(gridworld_explorer *explorer, uint8_t (*tried)[GRIDWORLD_ACTIONS],
                             uint32_t classes, uint32_t seed);

/* Draws an exploring action for a class. O(1).
 * @param before how often the class had tried each action when last told to forget
 * @return below GRIDWORLD_ACTIONS */
uint8_t gridworld_explorer_draw(gridworld_explorer *explorer, uint32_t class_id,
                                const uint32_t before[GRIDWORLD_ACTIONS]);

/* Takes note of the action that was taken in a class, drawn here or not. O(1). */
void gridworld_explorer_note(gridworld_explorer *explorer, uint32_t class_id, uint32_t action);

/* Forgets what was tried: to be called when `before` will count it. O(classes). */
void gridworld_explorer_forget(gridworld_explorer *explorer);

#ifdef __cplusplus
}
#endif

#endif
