/* SPDX-License-Identifier: MIT */
/* The exported policy of the maze, alone in a file: what it takes is what the compiler makes of
 * this. */
#include "maze.h"

unsigned maze_policy(const unsigned char *percept);

unsigned maze_policy(const unsigned char *percept) {
    return maze_act(percept);
}
