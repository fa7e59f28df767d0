/* SPDX-License-Identifier: MIT */
/* The Binary Gridworld (section 6.1): a maze whose cells are seen as strings of bits.
 *
 *     gridworld_parse, or gridworld_sutton     a maze, shared by as many worlds as you like
 *     gridworld_init                           a world: an agent's place in a maze
 *     gridworld_percept, gridworld_step        at each interaction
 *     gridworld_reset                          after each episode
 *
 * A move goes to the next cell in its direction, or nowhere if a wall or the edge is there. The
 * move into an exit earns 100 and ends the episode; any other move earns -1. The next episode
 * starts at a random free cell.
 *
 * A percept is a string of bits, of which bit i is bit i % 8 (0 the lowest) of byte i / 8:
 *
 *     x, lowest bit first | distractors, drawn anew at each percept | y, lowest bit first
 *
 * with as few bits for x and y as the maze's width and height need. Sutton's maze with 11
 * distractors has bits 0 to 3 for x, 4 to 14 at random and 15 to 17 for y.
 *
 * C99, without a C library and without memory of its own. Same seed, same world, on every machine.
 */
#ifndef GRIDWORLD_H
#define GRIDWORLD_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define GRIDWORLD_SIDE_MAX 256u
#define GRIDWORLD_CELLS_MAX (GRIDWORLD_SIDE_MAX * GRIDWORLD_SIDE_MAX)
#define GRIDWORLD_BITS_MAX 1024u
#define GRIDWORLD_PERCEPT_BYTES(bits) (((uint32_t)(bits) + 7u) / 8u)

#define GRIDWORLD_WALL '#'
#define GRIDWORLD_FREE '.'
#define GRIDWORLD_EXIT '*'

/* Actions; y grows downwards. */
#define GRIDWORLD_UP 0u
#define GRIDWORLD_RIGHT 1u
#define GRIDWORLD_DOWN 2u
#define GRIDWORLD_LEFT 3u
#define GRIDWORLD_ACTIONS 4u

/* A maze. Cell (x, y) has the number y * width + x. Every free cell has a way to an exit. */
typedef struct gridworld_maze {
    uint32_t width, height;     /* [1, GRIDWORLD_SIDE_MAX] */
    uint32_t free_cells;        /* cells in which to act, at least 1 */
    const unsigned char *cells; /* [width * height], each one of the three signs above */
} gridworld_maze;

/* The maze of section 6.1: 9 x 6 cells, 46 of them free. */
extern const gridworld_maze gridworld_sutton;

/* What is wrong with the text of a maze, and where. */
typedef struct gridworld_error {
    uint32_t line, column; /* from 1; 0 if it concerns the text as a whole */
    const char *what;      /* a constant phrase; null if all is well */
} gridworld_error;

/* Reads a maze from text: one line for each row from the top, all equally long; '#' is a wall, '.'
 * a free cell, '*' an exit, of which there is at least one. Lines end with "\n" or "\r\n", the last
 * one with or without. A free cell from which no exit can be reached is an error. O(cells).
 * @param cells the maze's memory from then on, of `room` bytes; one a cell is needed
 * @param error optional
 * @return 0; -1: *error says why, *maze is unchanged and *cells is undefined. */
int gridworld_parse(gridworld_maze *maze, const char *text, size_t bytes, unsigned char *cells,
                    size_t room, gridworld_error *error);

/* Bits of a percept, and of its parts. The whole may exceed GRIDWORLD_BITS_MAX: gridworld_init then
 * refuses it. O(1). */
uint32_t gridworld_x_bits(const gridworld_maze *maze);
uint32_t gridworld_y_bits(const gridworld_maze *maze);
uint32_t gridworld_bits(const gridworld_maze *maze, uint32_t distractors);

/* The cell next to `cell` in a direction below GRIDWORLD_ACTIONS, or `cell` itself if a wall or the
 * edge is there. O(1). */
uint32_t gridworld_neighbour(const gridworld_maze *maze, uint32_t cell, uint32_t direction);

/* Pseudorandom numbers: a permuted congruential generator. */
typedef struct gridworld_random {
    uint64_t state;
} gridworld_random;

void gridworld_random_seed(gridworld_random *random, uint32_t seed);

/* Writes the percept of a cell, with distractors drawn from *random. O(bits).
 * @param percept GRIDWORLD_PERCEPT_BYTES(gridworld_bits(maze, distractors)) */
void gridworld_encode(const gridworld_maze *maze, uint32_t distractors, uint32_t cell,
                      gridworld_random *random, unsigned char *percept);

/* An agent's place in a maze. */
typedef struct gridworld {
    const gridworld_maze *maze;
    gridworld_random random;
    uint32_t distractors;
    uint32_t slip; /* probability in units of 2^-24 */
    uint32_t cell; /* where the agent is */
} gridworld;

/* Makes a world and puts the agent into a random free cell. The maze is not copied. O(cells).
 * @param distractors bits of a percept that say nothing
 * @param slip        probability that a move goes astray, in one of the three other directions, [0,
 * 1]
 * @return 0; -1: slip out of range, or a percept of more than GRIDWORLD_BITS_MAX bits. */
int gridworld_init(gridworld *world, const gridworld_maze *maze, uint32_t distractors, float slip,
                   uint32_t seed);

/* Puts the agent into a free cell, each with the same probability. O(cells). */
void gridworld_reset(gridworld *world);

/* Writes the percept of the agent's cell. O(bits). */
void gridworld_percept(gridworld *world, unsigned char *percept);

/* Moves the agent. O(1).
 * @return 0: go on; 1: the agent is at an exit, call gridworld_reset next; -1, and nothing is done:
 * no such action, or the agent is at an exit already. */
int gridworld_step(gridworld *world, uint32_t action, float *reward);

#ifdef __cplusplus
}
#endif

#endif
