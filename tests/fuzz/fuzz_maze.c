/* SPDX-License-Identifier: MIT */
/* Any text as a maze. The first byte chooses how much room there is for the cells. What is refused
 * has its place in the text. What is accepted is a maze as the header promises, the same when its
 * rows are read again, and a world that a walk does not leave. */
#include "gridworld.h"
#include "must.h"

#include <string.h>

static unsigned char cells[GRIDWORLD_CELLS_MAX], again[GRIDWORLD_CELLS_MAX];
static char rows[GRIDWORLD_CELLS_MAX + GRIDWORLD_SIDE_MAX];
static uint32_t queue[GRIDWORLD_CELLS_MAX];

/* How many free cells have a way to an exit: backwards from the exits, breadth first. */
static uint32_t cells_with_a_way(const gridworld_maze *maze) {
    static unsigned char seen[GRIDWORLD_CELLS_MAX];
    const uint32_t count = maze->width * maze->height;
    uint32_t end = 0, found = 0;
    memset(seen, 0, count);
    for (uint32_t cell = 0; cell < count; cell++)
        if (maze->cells[cell] == GRIDWORLD_EXIT) {
            seen[cell] = 1;
            queue[end++] = cell;
        }
    for (uint32_t at = 0; at < end; at++)
        for (uint32_t direction = 0; direction < GRIDWORLD_ACTIONS; direction++) {
            const uint32_t next = gridworld_neighbour(maze, queue[at], direction);
            must(next < count);
            if (!seen[next] && maze->cells[next] == GRIDWORLD_FREE) {
                seen[next] = 1;
                queue[end++] = next;
                found++;
            }
        }
    return found;
}

static void check_maze(const gridworld_maze *maze) {
    const uint32_t count = maze->width * maze->height;
    uint32_t free_cells = 0;
    must(maze->width >= 1 && maze->width <= GRIDWORLD_SIDE_MAX);
    must(maze->height >= 1 && maze->height <= GRIDWORLD_SIDE_MAX);
    for (uint32_t cell = 0; cell < count; cell++) {
        const unsigned char sign = maze->cells[cell];
        must(sign == GRIDWORLD_WALL || sign == GRIDWORLD_FREE || sign == GRIDWORLD_EXIT);
        free_cells += sign == GRIDWORLD_FREE;
    }
    must(free_cells >= 1 && free_cells == maze->free_cells && free_cells == cells_with_a_way(maze));
}

static void read_again(const gridworld_maze *maze) {
    gridworld_maze other;
    size_t bytes = 0;
    for (uint32_t y = 0; y < maze->height; y++) {
        memcpy(rows + bytes, maze->cells + (size_t)y * maze->width, maze->width);
        bytes += maze->width;
        rows[bytes++] = '\n';
    }
    must(gridworld_parse(&other, rows, bytes, again, sizeof again, NULL) == 0);
    must(other.width == maze->width && other.height == maze->height);
    must(memcmp(again, maze->cells, (size_t)maze->width * maze->height) == 0);
}

static void walk(const gridworld_maze *maze, uint32_t seed) {
    unsigned char percept[GRIDWORLD_PERCEPT_BYTES(GRIDWORLD_BITS_MAX)];
    gridworld world;
    gridworld_random random;
    must(gridworld_init(&world, maze, seed, 0.25f, seed) == 0);
    gridworld_random_seed(&random, seed);
    for (uint32_t i = 0; i < 50u; i++) {
        float reward;
        must(world.cell < maze->width * maze->height);
        must(maze->cells[world.cell] == GRIDWORLD_FREE);
        gridworld_percept(&world, percept);
        random.state = random.state * UINT64_C(6364136223846793005) + 1442695040888963407u;
        if (gridworld_step(&world, (uint32_t)(random.state >> 62), &reward))
            gridworld_reset(&world);
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    const gridworld_maze untouched = {1, 2, 3, cells};
    gridworld_maze maze = untouched;
    gridworld_error error = {0, 0, NULL};
    if (size < 1)
        return 0;
    const size_t room = data[0] < 128u ? sizeof cells : data[0] - 128u;
    if (gridworld_parse(&maze, (const char *)data + 1, size - 1, cells, room, &error) != 0) {
        must(error.what != NULL && memcmp(&maze, &untouched, sizeof maze) == 0);
        must((error.line == 0) == (error.column == 0) && error.line <= size);
        return 0;
    }
    check_maze(&maze);
    must((size_t)maze.width * maze.height <= room);
    read_again(&maze);
    walk(&maze, data[0] % 64u);
    return 0;
}
