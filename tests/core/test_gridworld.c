/* SPDX-License-Identifier: MIT */
/* The maze: what its text may be, where its moves lead, how its percepts are laid out. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "gridworld.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static unsigned char cells[GRIDWORLD_CELLS_MAX];

static int parse(gridworld_maze *maze, const char *text, gridworld_error *error) {
    return gridworld_parse(maze, text, strlen(text), cells, sizeof cells, error);
}

/* ------------------------------------------------------------------ text */

static const char sutton_text[] =
    ".......#*\n..#....#.\n..#....#.\n..#......\n.....#...\n.........\n";

static void test_built_in_maze_is_the_text_of_it(void **state) {
    gridworld_maze maze;
    gridworld_error error;
    (void)state;
    assert_int_equal(parse(&maze, sutton_text, &error), 0);
    assert_null(error.what);
    assert_int_equal(maze.width, gridworld_sutton.width);
    assert_int_equal(maze.height, gridworld_sutton.height);
    assert_int_equal(maze.free_cells, gridworld_sutton.free_cells);
    assert_int_equal(maze.free_cells, 46);
    assert_memory_equal(maze.cells, gridworld_sutton.cells, 9 * 6);
}

static void test_line_ends(void **state) {
    static const char *const texts[] = {".*\n.#", ".*\n.#\n", ".*\r\n.#\r\n", ".*\r\n.#"};
    size_t i;
    (void)state;
    for (i = 0; i < sizeof texts / sizeof *texts; i++) {
        gridworld_maze maze;
        assert_int_equal(parse(&maze, texts[i], NULL), 0);
        assert_int_equal(maze.width, 2);
        assert_int_equal(maze.height, 2);
        assert_int_equal(maze.free_cells, 2);
        assert_memory_equal(maze.cells, ".*.#", 4);
    }
}

static void test_errors_name_their_place(void **state) {
    static const struct {
        const char *text;
        uint32_t line, column;
        const char *what; /* a part of it */
    } cases[] = {
        {"", 0, 0, "empty"},
        {"\n", 1, 1, "empty"},
        {".*\n\n", 2, 1, "empty"},
        {".*\n..\n\n", 3, 1, "empty"},
        {"..\n.x\n.*", 2, 2, "not a cell"},
        {".*\r.", 1, 3, "not a cell"},
        {". *", 1, 2, "not a cell"},
        {"..*\n..\n", 2, 3, "shorter"},
        {"..*\n....\n", 2, 4, "longer"},
        {"..\n..\n", 0, 0, "no exit"},
        {"#*\n##\n", 0, 0, "no free cell"},
        {"..*\n###\n...", 3, 1, "reached"},
        {"*#.\n.#.\n.#.", 1, 3, "reached"},
        {"*.#\n.#.", 2, 3, "reached"}, /* a diagonal is no way */
    };
    size_t i;
    (void)state;
    for (i = 0; i < sizeof cases / sizeof *cases; i++) {
        gridworld_maze maze = {1, 2, 3, NULL};
        gridworld_error error;
        printf("case %zu: \"%s\"\n", i, cases[i].text);
        assert_int_equal(parse(&maze, cases[i].text, &error), -1);
        assert_int_equal(error.line, cases[i].line);
        assert_int_equal(error.column, cases[i].column);
        assert_non_null(strstr(error.what, cases[i].what));
        assert_true(maze.width == 1 && maze.height == 2 && maze.free_cells == 3 && !maze.cells);
        assert_int_equal(parse(&maze, cases[i].text, NULL), -1);
    }
}

static void test_a_zero_byte_is_no_cell(void **state) {
    gridworld_maze maze;
    gridworld_error error;
    (void)state;
    assert_int_equal(gridworld_parse(&maze, ".\0*", 3, cells, sizeof cells, &error), -1);
    assert_int_equal(error.column, 2);
}

/* A text of `height` lines of `width` exits, of which the first is a free cell. */
static size_t rectangle(char *text, size_t width, size_t height) {
    size_t y, at = 0;
    for (y = 0; y < height; y++) {
        memset(text + at, GRIDWORLD_EXIT, width);
        at += width;
        text[at++] = '\n';
    }
    text[0] = GRIDWORLD_FREE;
    return at;
}

static void test_largest_maze(void **state) {
    static char text[258 * 258];
    static const struct {
        size_t width, height;
        int result;
        uint32_t line, column;
    } cases[] = {
        {256, 256, 0, 0, 0}, {257, 2, -1, 1, 257}, {300, 1, -1, 1, 257}, {2, 257, -1, 257, 1}};
    size_t i;
    (void)state;
    for (i = 0; i < sizeof cases / sizeof *cases; i++) {
        gridworld_maze maze;
        gridworld_error error;
        const size_t bytes = rectangle(text, cases[i].width, cases[i].height);
        printf("case %zu\n", i);
        assert_int_equal(gridworld_parse(&maze, text, bytes, cells, sizeof cells, &error),
                         cases[i].result);
        assert_int_equal(error.line, cases[i].line);
        assert_int_equal(error.column, cases[i].column);
    }
}

static void test_memory_for_the_cells_is_not_overrun(void **state) {
    size_t room;
    (void)state;
    for (room = 0; room <= 54; room++) {
        unsigned char mine[55];
        gridworld_maze maze;
        gridworld_error error;
        const int expected = room == 54 ? 0 : -1;
        memset(mine, 'Z', sizeof mine);
        assert_int_equal(
            gridworld_parse(&maze, sutton_text, strlen(sutton_text), mine, room, &error), expected);
        assert_int_equal(mine[room], 'Z');
        if (expected != 0) {
            assert_int_equal(error.line, room / 9 + 1);
        }
    }
}

/* The longest way of all: a corridor that winds through the whole maze. */
static void test_long_corridor_is_walked(void **state) {
    static char text[257 * 255];
    gridworld_maze maze;
    size_t y, at = 0;
    (void)state;
    for (y = 0; y < 255; y++) {
        memset(text + at, y % 2 ? GRIDWORLD_WALL : GRIDWORLD_FREE, 256);
        if (y % 2) {
            text[at + (y % 4 == 1 ? 255 : 0)] = GRIDWORLD_FREE;
        }
        text[at + 256] = '\n';
        at += 257;
    }
    text[at - 2] = GRIDWORLD_EXIT;
    assert_int_equal(gridworld_parse(&maze, text, at, cells, sizeof cells, NULL), 0);
    assert_int_equal(maze.free_cells, 128 * 256 + 127 - 1);
}

static void test_more_than_one_exit(void **state) {
    gridworld_maze maze;
    (void)state;
    assert_int_equal(parse(&maze, "*..#..*\n", NULL), 0);
    assert_int_equal(maze.free_cells, 4);
    assert_memory_equal(maze.cells, "*..#..*", 7);
}

/* ------------------------------------------------------------------ moves */

static gridworld make_world(const gridworld_maze *maze, float slip, uint32_t seed) {
    gridworld world;
    assert_int_equal(gridworld_init(&world, maze, 11, slip, seed), 0);
    return world;
}

static void test_neighbours(void **state) {
    static const struct {
        uint32_t x, y, direction, to_x, to_y;
    } cases[] = {
        {0, 0, GRIDWORLD_UP, 0, 0},    {0, 0, GRIDWORLD_LEFT, 0, 0},
        {0, 0, GRIDWORLD_RIGHT, 1, 0}, {0, 0, GRIDWORLD_DOWN, 0, 1},
        {1, 1, GRIDWORLD_RIGHT, 1, 1}, /* a wall */
        {2, 0, GRIDWORLD_DOWN, 2, 0},  /* a wall */
        {8, 1, GRIDWORLD_UP, 8, 0},    /* the exit */
        {8, 5, GRIDWORLD_RIGHT, 8, 5}, {8, 5, GRIDWORLD_DOWN, 8, 5},
        {8, 3, GRIDWORLD_RIGHT, 8, 3}, /* no way round to the next row */
        {0, 4, GRIDWORLD_LEFT, 0, 4},
    };
    size_t i;
    (void)state;
    for (i = 0; i < sizeof cases / sizeof *cases; i++) {
        printf("case %zu\n", i);
        assert_int_equal(
            gridworld_neighbour(&gridworld_sutton, cases[i].y * 9 + cases[i].x, cases[i].direction),
            cases[i].to_y * 9 + cases[i].to_x);
    }
}

static void test_rewards_and_end_of_episode(void **state) {
    gridworld world = make_world(&gridworld_sutton, 0.0f, 1);
    float reward = 0.0f;
    (void)state;
    world.cell = 2 * 9 + 8;
    assert_int_equal(gridworld_step(&world, GRIDWORLD_RIGHT, &reward), 0);
    assert_int_equal(world.cell, 2 * 9 + 8);
    assert_true(reward == -1.0f);
    assert_int_equal(gridworld_step(&world, GRIDWORLD_UP, &reward), 0);
    assert_true(reward == -1.0f);
    assert_int_equal(gridworld_step(&world, GRIDWORLD_UP, &reward), 1);
    assert_true(reward == 100.0f);
    assert_int_equal(world.cell, 8);
    reward = 7.0f;
    assert_int_equal(gridworld_step(&world, GRIDWORLD_DOWN, &reward), -1);
    assert_int_equal(world.cell, 8);
    gridworld_reset(&world);
    assert_int_equal(gridworld_sutton.cells[world.cell], GRIDWORLD_FREE);
    assert_int_equal(gridworld_step(&world, GRIDWORLD_ACTIONS, &reward), -1);
    assert_true(reward == 7.0f);
}

static void test_resets_are_even(void **state) {
    enum { draws = 46000 };
    uint32_t count[54] = {0};
    gridworld world = make_world(&gridworld_sutton, 0.0f, 3);
    double chi2 = 0.0;
    uint32_t i;
    (void)state;
    for (i = 0; i < draws; i++) {
        gridworld_reset(&world);
        count[world.cell]++;
    }
    for (i = 0; i < 54; i++) {
        if (gridworld_sutton.cells[i] == GRIDWORLD_FREE) {
            chi2 += (count[i] - 1000.0) * (count[i] - 1000.0) / 1000.0;
        } else {
            assert_int_equal(count[i], 0);
        }
    }
    assert_true(chi2 < 80.1); /* 45 degrees of freedom, 0.001 */
}

/* In the middle of an empty maze each direction shows where it led. */
static void test_slips(void **state) {
    enum { draws = 40000 };
    static const float slips[] = {0.0f, 0.1f, 0.5f, 1.0f};
    gridworld_maze maze;
    size_t i;
    (void)state;
    assert_int_equal(parse(&maze, "...\n...\n..*\n", NULL), 0);
    for (i = 0; i < sizeof slips / sizeof *slips; i++) {
        gridworld world = make_world(&maze, slips[i], 5);
        uint32_t action;
        for (action = 0; action < GRIDWORLD_ACTIONS; action++) {
            uint32_t went[GRIDWORLD_ACTIONS] = {0}, n, d;
            for (n = 0; n < draws; n++) {
                float reward;
                world.cell = 4;
                assert_int_equal(gridworld_step(&world, action, &reward), 0);
                for (d = 0; gridworld_neighbour(&maze, 4, d) != world.cell; d++) {
                }
                went[d]++;
            }
            for (d = 0; d < GRIDWORLD_ACTIONS; d++) {
                const double p = d == action ? 1.0 - (double)slips[i] : (double)slips[i] / 3.0;
                const double deviation = sqrt(draws * p * (1.0 - p));
                printf("slip %g, action %u, direction %u: %u\n", (double)slips[i], (unsigned)action,
                       (unsigned)d, (unsigned)went[d]);
                assert_true(fabs(went[d] - draws * p) <= 4.0 * deviation + 0.01);
            }
        }
    }
}

/* ------------------------------------------------------------------ percepts */

static uint32_t field(const unsigned char *percept, uint32_t first, uint32_t bits) {
    uint32_t i, value = 0;
    for (i = 0; i < bits; i++) {
        value |= ((uint32_t)percept[(first + i) / 8] >> (first + i) % 8 & 1u) << i;
    }
    return value;
}

static void test_suttons_percepts(void **state) {
    unsigned char percept[4];
    gridworld_random random;
    uint32_t cell, seen_ones = 0, seen_zeros = 0;
    (void)state;
    assert_int_equal(gridworld_bits(&gridworld_sutton, 11), 18);
    gridworld_random_seed(&random, 1);
    for (cell = 0; cell < 54; cell++) {
        percept[3] = 0x5a;
        gridworld_encode(&gridworld_sutton, 11, cell, &random, percept);
        assert_int_equal(field(percept, 0, 4), cell % 9);
        assert_int_equal(field(percept, 15, 3), cell / 9);
        assert_int_equal(percept[2] >> 2, 0); /* bits that are none */
        assert_int_equal(percept[3], 0x5a);
        seen_ones |= field(percept, 4, 11);
        seen_zeros |= ~field(percept, 4, 11);
    }
    assert_int_equal(seen_ones, 0x7ff);
    assert_int_equal(seen_zeros & 0x7ff, 0x7ff);
}

static void test_distractors_are_fair_and_independent(void **state) {
    enum { draws = 20000, bits = 40 };
    unsigned char percept[GRIDWORLD_PERCEPT_BYTES(bits + 7)];
    uint32_t ones[bits] = {0}, with_previous[bits] = {0}, i, n;
    gridworld_random random;
    (void)state;
    gridworld_random_seed(&random, 2);
    for (n = 0; n < draws; n++) {
        gridworld_encode(&gridworld_sutton, bits, 0, &random, percept);
        for (i = 0; i < bits; i++) {
            ones[i] += field(percept, 4 + i, 1);
            with_previous[i] += i > 0 && field(percept, 4 + i, 1) == field(percept, 3 + i, 1);
        }
    }
    for (i = 0; i < bits; i++) {
        const double deviation = sqrt(draws * 0.25);
        assert_true(fabs(ones[i] - draws / 2.0) < 4.0 * deviation);
        assert_true(i == 0 || fabs(with_previous[i] - draws / 2.0) < 4.0 * deviation);
    }
}

static void test_widths_follow_the_size(void **state) {
    static const struct {
        uint32_t side, bits;
    } cases[] = {{1, 0}, {2, 1}, {3, 2}, {4, 2}, {5, 3}, {64, 6}, {65, 7}, {255, 8}, {256, 8}};
    size_t i;
    (void)state;
    for (i = 0; i < sizeof cases / sizeof *cases; i++) {
        const gridworld_maze wide = {cases[i].side, 1, 0, NULL};
        const gridworld_maze high = {1, cases[i].side, 0, NULL};
        assert_int_equal(gridworld_x_bits(&wide), cases[i].bits);
        assert_int_equal(gridworld_y_bits(&wide), 0);
        assert_int_equal(gridworld_y_bits(&high), cases[i].bits);
        assert_int_equal(gridworld_bits(&high, 5), cases[i].bits + 5);
        assert_int_equal(gridworld_bits(&high, UINT32_MAX), UINT32_MAX);
    }
}

static void test_refused_worlds_are_untouched(void **state) {
    static const struct {
        uint32_t distractors;
        float slip;
        int result;
    } cases[] = {{0, 0.0f, 0},    {1017, 1.0f, 0}, {1018, 0.0f, -1}, {UINT32_MAX, 0.0f, -1},
                 {11, -0.1f, -1}, {11, 1.01f, -1}, {11, NAN, -1},    {11, INFINITY, -1}};
    size_t i;
    (void)state;
    for (i = 0; i < sizeof cases / sizeof *cases; i++) {
        gridworld world, before;
        memset(&world, 0x5a, sizeof world);
        before = world;
        printf("case %zu\n", i);
        assert_int_equal(
            gridworld_init(&world, &gridworld_sutton, cases[i].distractors, cases[i].slip, 1),
            cases[i].result);
        if (cases[i].result != 0) {
            assert_memory_equal(&world, &before, sizeof world);
        }
    }
}

/* ------------------------------------------------------------------ seeds */

/* A hash of a random walk: places, rewards and percepts. */
static uint32_t walk(uint32_t seed) {
    gridworld world = make_world(&gridworld_sutton, 0.25f, seed);
    uint32_t hash = 0, i;
    for (i = 0; i < 5000; i++) {
        unsigned char percept[3];
        float reward;
        gridworld_percept(&world, percept);
        hash = (hash * 31 + percept[0]) * 31 + percept[1];
        if (gridworld_step(&world, i * 7 % 4, &reward)) {
            gridworld_reset(&world);
        }
        hash = hash * 31 + world.cell;
    }
    return hash;
}

static void test_same_seed_same_world(void **state) {
    (void)state;
    assert_int_equal(walk(1), walk(1));
    assert_int_not_equal(walk(1), walk(2));
    assert_int_not_equal(walk(0), walk(1));
    assert_int_equal(walk(1), 0xf5cf4fecu); /* on every machine */
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_built_in_maze_is_the_text_of_it),
        cmocka_unit_test(test_line_ends),
        cmocka_unit_test(test_errors_name_their_place),
        cmocka_unit_test(test_a_zero_byte_is_no_cell),
        cmocka_unit_test(test_largest_maze),
        cmocka_unit_test(test_memory_for_the_cells_is_not_overrun),
        cmocka_unit_test(test_long_corridor_is_walked),
        cmocka_unit_test(test_more_than_one_exit),
        cmocka_unit_test(test_neighbours),
        cmocka_unit_test(test_rewards_and_end_of_episode),
        cmocka_unit_test(test_resets_are_even),
        cmocka_unit_test(test_slips),
        cmocka_unit_test(test_suttons_percepts),
        cmocka_unit_test(test_distractors_are_fair_and_independent),
        cmocka_unit_test(test_widths_follow_the_size),
        cmocka_unit_test(test_refused_worlds_are_untouched),
        cmocka_unit_test(test_same_seed_same_world),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
