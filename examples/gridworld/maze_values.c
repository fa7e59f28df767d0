/* SPDX-License-Identifier: MIT */
/* Values of a maze's cells: see maze_values.h. */
#include "maze_values.h"

#define EXIT_REWARD 100.0
#define MOVE_REWARD (-1.0)
#define MAX_SWEEPS 100000u

void gridworld_backup(const gridworld_maze *maze, const double *v, uint32_t cell, double discount,
                      double slip, double *q) {
    double gain[GRIDWORLD_ACTIONS], sum = 0.0;
    uint32_t i;
    for (i = 0; i < GRIDWORLD_ACTIONS; i++) {
        const uint32_t next = gridworld_neighbour(maze, cell, i);
        gain[i] =
            maze->cells[next] == GRIDWORLD_EXIT ? EXIT_REWARD : MOVE_REWARD + discount * v[next];
        sum += gain[i];
    }
    for (i = 0; i < GRIDWORLD_ACTIONS; i++) {
        q[i] = (1.0 - slip) * gain[i] + slip / 3.0 * (sum - gain[i]);
    }
}

static double best(const double *q) {
    double most = q[0];
    uint32_t i;
    for (i = 1; i < GRIDWORLD_ACTIONS; i++) {
        most = q[i] > most ? q[i] : most;
    }
    return most;
}

/* One sweep in place. The direction alternates, because values spread from the exit to all sides.
 * Returns the largest change. */
static double sweep(const gridworld_maze *maze, const unsigned char *action, double discount,
                    double slip, int backwards, double *v) {
    const uint32_t count = maze->width * maze->height;
    double change = 0.0;
    uint32_t i;
    for (i = 0; i < count; i++) {
        const uint32_t cell = backwards ? count - 1 - i : i;
        double q[GRIDWORLD_ACTIONS], value, moved;
        if (maze->cells[cell] != GRIDWORLD_FREE) {
            continue;
        }
        gridworld_backup(maze, v, cell, discount, slip, q);
        value = action ? q[action[cell]] : best(q);
        moved = value < v[cell] ? v[cell] - value : value - v[cell];
        change = moved > change ? moved : change;
        v[cell] = value;
    }
    return change;
}

int gridworld_values(const gridworld_maze *maze, const unsigned char *action, double discount,
                     double slip, double settled, double *v) {
    uint32_t i;
    for (i = 0; i < maze->width * maze->height; i++) {
        v[i] = 0.0;
    }
    for (i = 0; i < MAX_SWEEPS; i++) {
        if (!(sweep(maze, action, discount, slip, i % 2 == 1, v) > settled)) {
            return 0;
        }
    }
    return -1;
}
