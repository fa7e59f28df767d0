/* SPDX-License-Identifier: MIT */
/* The optimal policy of a maze, from full knowledge of its cells and probabilities; and what any
 * policy is worth. In double precision. */
#ifndef GRIDWORLD_MAZE_VALUES_H
#define GRIDWORLD_MAZE_VALUES_H

#include "gridworld.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Q of the actions of one cell:
 *
 *     Q(s, a) = (1 - slip) G(s, a) + slip / 3 * sum of G(s, b) over the directions b other than a
 *     G(s, d) = 100 if the neighbour s' in direction d is an exit, or else -1 + discount * V(s')
 *
 * @param v [cells] the values V
 * @param q [GRIDWORLD_ACTIONS] O(1). */
void gridworld_backup(const gridworld_maze *maze, const double *v, uint32_t cell, double discount,
                      double slip, double *q);

/* The values V of the cells, by iteration: V(s) is the Q of the cell's action.
 * @param action [cells] the policy, each below GRIDWORLD_ACTIONS; null: the best one in each cell
 * @param settled the largest change of the last sweep, in units of reward
 * @param v [cells] 0 for walls and exits
 * @return 0; -1: they do not settle, as for a discount very close to 1. O(cells) a sweep, 100,000
 * sweeps at most. */
int gridworld_values(const gridworld_maze *maze, const unsigned char *action, double discount,
                     double slip, double settled, double *v);

#ifdef __cplusplus
}
#endif

#endif
