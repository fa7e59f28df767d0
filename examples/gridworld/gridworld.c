/* SPDX-License-Identifier: MIT */
/* The maze: its text, its moves, its percepts. gridworld.h says what they are.
 *
 * Whether every free cell has a way to an exit is found by a depth-first walk from the exits that
 * needs no stack: a cell's byte, once visited, holds the direction that leads back to where the
 * walk came from ('0' to '3'). A free cell that is still free after the walk cannot be reached. */
#include "gridworld.h"

#define EXIT_REWARD 100.0f
#define MOVE_REWARD -1.0f

#define RANDOM_BITS 24u /* of a probability: exact in a binary32 */
#define RANDOM_ONE (1u << RANDOM_BITS)

static const unsigned char sutton_cells[] = ".......#*"
                                            "..#....#."
                                            "..#....#."
                                            "..#......"
                                            ".....#..."
                                            ".........";

const gridworld_maze gridworld_sutton = {9, 6, 46, sutton_cells};

/* ------------------------------------------------------------------ reading a maze */

static int fail(gridworld_error *error, uint32_t line, uint32_t column, const char *what) {
    if (error) {
        error->line = line;
        error->column = column;
        error->what = what;
    }
    return -1;
}

static int is_cell(char sign) {
    return sign == GRIDWORLD_WALL || sign == GRIDWORLD_FREE || sign == GRIDWORLD_EXIT;
}

/* How many signs from `at` on belong to its line; *next is where the next line starts. */
static size_t line_length(const char *text, size_t bytes, size_t at, size_t *next) {
    size_t end = at;
    while (end < bytes && text[end] != '\n') {
        end++;
    }
    *next = end + 1;
    return end < bytes && end > at && text[end - 1] == '\r' ? end - at - 1 : end - at;
}

/* The first sign of the line that is no cell, or its length. */
static size_t cells_of_line(const char *line, size_t length) {
    size_t i = 0;
    while (i < length && is_cell(line[i])) {
        i++;
    }
    return i;
}

/* What is wrong with a line of cells, or NULL, and in which column. */
static const char *fault_of_line(const gridworld_maze *maze, size_t length, size_t room,
                                 uint32_t *column) {
    *column = 1;
    if (maze->height == GRIDWORLD_SIDE_MAX) {
        return "a maze is at most 256 cells high";
    }
    if (length == 0) {
        return "this line is empty";
    }
    if (maze->height > 0 && length != maze->width) {
        *column = 1 + (length < maze->width ? (uint32_t)length : maze->width);
        return length < maze->width ? "this line is shorter than the first"
                                    : "this line is longer than the first";
    }
    return length > room - (size_t)maze->height * maze->width ? "no memory for this line" : NULL;
}

static int read_line(gridworld_maze *maze, const char *line, size_t length, unsigned char *cells,
                     size_t room, gridworld_error *error) {
    const uint32_t number = maze->height + 1;
    const size_t first = (size_t)maze->height * maze->width;
    const size_t readable = cells_of_line(line, length);
    const char *fault;
    uint32_t column;
    size_t i;
    if (readable < length && readable < GRIDWORLD_SIDE_MAX) {
        return fail(error, number, (uint32_t)readable + 1,
                    "not a cell: expected '#' (wall), '.' (free) or '*' (exit)");
    }
    if (length > GRIDWORLD_SIDE_MAX) {
        return fail(error, number, GRIDWORLD_SIDE_MAX + 1, "a maze is at most 256 cells wide");
    }
    fault = fault_of_line(maze, length, room, &column);
    if (fault) {
        return fail(error, number, column, fault);
    }
    for (i = 0; i < length; i++) {
        cells[first + i] = (unsigned char)line[i];
    }
    maze->width = (uint32_t)length;
    maze->height = number;
    return 0;
}

/* A neighbour that is free and not visited, or `cell` (which is visited) if there is none. */
static uint32_t unvisited_neighbour(const gridworld_maze *maze, uint32_t cell,
                                    uint32_t *direction) {
    uint32_t d;
    for (d = 0; d < GRIDWORLD_ACTIONS; d++) {
        const uint32_t next = gridworld_neighbour(maze, cell, d);
        if (maze->cells[next] == GRIDWORLD_FREE) {
            *direction = d;
            return next;
        }
    }
    return cell;
}

/* Marks the free cells that have a way to this exit with the first step of one such way. */
static void walk_from_exit(const gridworld_maze *maze, uint32_t exit, unsigned char *cells) {
    uint32_t cell = exit;
    for (;;) {
        uint32_t direction = 0;
        const uint32_t next = unvisited_neighbour(maze, cell, &direction);
        if (next != cell) {
            cells[next] = (unsigned char)('0' + (direction + 2) % GRIDWORLD_ACTIONS);
            cell = next;
        } else if (cell != exit) {
            cell = gridworld_neighbour(maze, cell, (uint32_t)(cells[cell] - '0'));
        } else {
            return;
        }
    }
}

/* Counts the free cells; each must have a way to an exit. */
static int check_cells(gridworld_maze *maze, unsigned char *cells, gridworld_error *error) {
    const uint32_t count = maze->width * maze->height;
    uint32_t cell, exits = 0;
    for (cell = 0; cell < count; cell++) {
        if (cells[cell] == GRIDWORLD_EXIT) {
            exits++;
            walk_from_exit(maze, cell, cells);
        }
    }
    if (exits == 0) {
        return fail(error, 0, 0, "the maze has no exit '*'");
    }
    for (cell = 0; cell < count; cell++) {
        if (cells[cell] == GRIDWORLD_FREE) {
            return fail(error, cell / maze->width + 1, cell % maze->width + 1,
                        "no exit can be reached from this cell");
        }
        if (cells[cell] != GRIDWORLD_WALL && cells[cell] != GRIDWORLD_EXIT) {
            cells[cell] = GRIDWORLD_FREE;
            maze->free_cells++;
        }
    }
    return maze->free_cells == 0 ? fail(error, 0, 0, "the maze has no free cell '.'") : 0;
}

int gridworld_parse(gridworld_maze *maze, const char *text, size_t bytes, unsigned char *cells,
                    size_t room, gridworld_error *error) {
    gridworld_maze made = {0, 0, 0, cells};
    size_t at = 0;
    if (error) {
        error->line = error->column = 0;
        error->what = NULL;
    }
    if (bytes == 0) {
        return fail(error, 0, 0, "the maze is empty");
    }
    while (at < bytes) {
        size_t next;
        const size_t length = line_length(text, bytes, at, &next);
        if (read_line(&made, text + at, length, cells, room, error)) {
            return -1;
        }
        at = next;
    }
    if (check_cells(&made, cells, error)) {
        return -1;
    }
    *maze = made;
    return 0;
}

/* ------------------------------------------------------------------ moves */

uint32_t gridworld_neighbour(const gridworld_maze *maze, uint32_t cell, uint32_t direction) {
    const uint32_t x = cell % maze->width, y = cell / maze->width;
    uint32_t next = cell;
    if (direction == GRIDWORLD_UP && y > 0) {
        next = cell - maze->width;
    } else if (direction == GRIDWORLD_RIGHT && x + 1 < maze->width) {
        next = cell + 1;
    } else if (direction == GRIDWORLD_DOWN && y + 1 < maze->height) {
        next = cell + maze->width;
    } else if (direction == GRIDWORLD_LEFT && x > 0) {
        next = cell - 1;
    }
    return maze->cells[next] == GRIDWORLD_WALL ? cell : next;
}

/* ------------------------------------------------------------------ pseudorandom numbers */

static uint32_t random_next(gridworld_random *random) {
    const uint64_t old = random->state;
    const uint32_t mixed = (uint32_t)((old ^ (old >> 18)) >> 27);
    const uint32_t turn = (uint32_t)(old >> 59);
    random->state = old * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return (mixed >> turn) | (mixed << ((32u - turn) & 31u));
}

/* [0, bound), one draw */
static uint32_t random_below(gridworld_random *random, uint32_t bound) {
    return (uint32_t)(((uint64_t)random_next(random) * bound) >> 32);
}

/* Neighbouring seeds must not give neighbouring sequences: the state is stepped over the seed. */
void gridworld_random_seed(gridworld_random *random, uint32_t seed) {
    random->state = 0;
    random_next(random);
    random->state += seed;
    random_next(random);
    random_next(random);
}

/* ------------------------------------------------------------------ percepts */

static uint32_t bits_for(uint32_t values) {
    uint32_t bits = 0;
    while ((values - 1) >> bits) {
        bits++;
    }
    return bits;
}

uint32_t gridworld_x_bits(const gridworld_maze *maze) {
    return bits_for(maze->width);
}

uint32_t gridworld_y_bits(const gridworld_maze *maze) {
    return bits_for(maze->height);
}

uint32_t gridworld_bits(const gridworld_maze *maze, uint32_t distractors) {
    const uint32_t place = gridworld_x_bits(maze) + gridworld_y_bits(maze);
    return distractors > UINT32_MAX - place ? UINT32_MAX : place + distractors;
}

/* Appends the low bits of a word to a string of *at bits, whose further bits are 0. */
static void append(unsigned char *percept, uint32_t *at, uint32_t word, uint32_t bits) {
    uint32_t i;
    for (i = 0; i < bits; i++, ++*at) {
        percept[*at / 8] |= (unsigned char)((word >> i & 1u) << *at % 8);
    }
}

void gridworld_encode(const gridworld_maze *maze, uint32_t distractors, uint32_t cell,
                      gridworld_random *random, unsigned char *percept) {
    const uint32_t bytes = GRIDWORLD_PERCEPT_BYTES(gridworld_bits(maze, distractors));
    uint32_t i, at = 0;
    for (i = 0; i < bytes; i++) {
        percept[i] = 0;
    }
    append(percept, &at, cell % maze->width, gridworld_x_bits(maze));
    for (i = 0; i < distractors; i += 32) {
        append(percept, &at, random_next(random), distractors - i < 32 ? distractors - i : 32);
    }
    append(percept, &at, cell / maze->width, gridworld_y_bits(maze));
}

/* ------------------------------------------------------------------ the world */

int gridworld_init(gridworld *world, const gridworld_maze *maze, uint32_t distractors, float slip,
                   uint32_t seed) {
    if (!(slip >= 0.0f && slip <= 1.0f) || gridworld_bits(maze, distractors) > GRIDWORLD_BITS_MAX) {
        return -1;
    }
    world->maze = maze;
    world->distractors = distractors;
    world->slip = (uint32_t)(slip * (float)RANDOM_ONE);
    gridworld_random_seed(&world->random, seed);
    gridworld_reset(world);
    return 0;
}

void gridworld_reset(gridworld *world) {
    uint32_t left = random_below(&world->random, world->maze->free_cells);
    uint32_t cell = 0;
    while (world->maze->cells[cell] != GRIDWORLD_FREE || left-- > 0) {
        cell++;
    }
    world->cell = cell;
}

void gridworld_percept(gridworld *world, unsigned char *percept) {
    gridworld_encode(world->maze, world->distractors, world->cell, &world->random, percept);
}

int gridworld_step(gridworld *world, uint32_t action, float *reward) {
    uint32_t direction = action;
    if (action >= GRIDWORLD_ACTIONS || world->maze->cells[world->cell] == GRIDWORLD_EXIT) {
        return -1;
    }
    if (world->slip > 0 && random_next(&world->random) >> (32u - RANDOM_BITS) < world->slip) {
        direction = (action + 1 + random_below(&world->random, 3)) % GRIDWORLD_ACTIONS;
    }
    world->cell = gridworld_neighbour(world->maze, world->cell, direction);
    if (world->maze->cells[world->cell] == GRIDWORLD_EXIT) {
        *reward = EXIT_REWARD;
        return 1;
    }
    *reward = MOVE_REWARD;
    return 0;
}
