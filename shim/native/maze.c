/* SPDX-License-Identifier: MIT */
/* The maze under names that the package's library exports. */
#include "shim.h"

const gridworld_maze *rlvc_shim_sutton(void) {
    return &gridworld_sutton;
}

int rlvc_shim_maze_parse(gridworld_maze *maze, const char *text, size_t bytes, unsigned char *cells,
                         size_t room, gridworld_error *error) {
    return gridworld_parse(maze, text, bytes, cells, room, error);
}

uint32_t rlvc_shim_maze_bits(const gridworld_maze *maze, uint32_t distractors) {
    return gridworld_bits(maze, distractors);
}

void rlvc_shim_maze_encode(const gridworld_maze *maze, uint32_t distractors, uint32_t cell,
                           gridworld_random *random, unsigned char *percept) {
    gridworld_encode(maze, distractors, cell, random, percept);
}

int rlvc_shim_world_init(gridworld *world, const gridworld_maze *maze, uint32_t distractors,
                         float slip, uint32_t seed) {
    return gridworld_init(world, maze, distractors, slip, seed);
}

void rlvc_shim_world_reset(gridworld *world) {
    gridworld_reset(world);
}

void rlvc_shim_world_percept(gridworld *world, unsigned char *percept) {
    gridworld_percept(world, percept);
}

int rlvc_shim_world_step(gridworld *world, uint32_t action, float *reward) {
    return gridworld_step(world, action, reward);
}
