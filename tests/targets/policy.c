/* SPDX-License-Identifier: MIT */
/* The exported policy of the maze on the least target, without the library: does at each of the
 * 2^18 percepts what the agent does that it was exported from. Prints what it does in the cells of
 * the maze. */
#include "gridworld.h"
#include "maze_agent.h"
#include <stdio.h>

#define BITS 18u
#define DISTRACTORS 11u

unsigned maze_policy(const unsigned char *percept);

/* ------------------------------------------------------------------ the stack */

#define PAINT 0x5ac3965bu
#define PAINTED 64u /* words */

/* The bytes of stack that a call takes, or 0 where that is not known: what is below the stack in
 * use is painted, and the lowest place that lost its paint tells. */
static unsigned stack_of(unsigned (*volatile policy)(const unsigned char *),
                         const unsigned char *percept) {
#if defined(__arm__)
    unsigned (*const call)(const unsigned char *) = policy;
    volatile uint32_t *top;
    unsigned words = PAINTED;
    __asm__ volatile("mov %0, sp" : "=r"(top));
    for (unsigned i = 1; i <= PAINTED; i++)
        *(top - i) = PAINT;
    (void)call(percept);
    while (words > 0 && *(top - words) == PAINT)
        words--;
    return 4u * words;
#else
    (void)policy;
    (void)percept;
    return 0;
#endif
}

/* ------------------------------------------------------------------ the actions */

/* At how many percepts the policy does something else than the agent. */
static unsigned count_unlike(void) {
    unsigned unlike = 0;
    for (uint32_t value = 0; value < (uint32_t)1 << BITS; value++) {
        const unsigned char percept[3] = {(unsigned char)value, (unsigned char)(value >> 8),
                                          (unsigned char)(value >> 16)};
        unsigned agents = (unsigned)maze_agent[value / 4u] >> 2u * (value % 4u) & 3u;
        unlike += maze_policy(percept) != agents;
    }
    return unlike;
}

/* The action of each cell, if it is the same whatever the bits that say nothing are. */
static unsigned print_cells(void) {
    static const char *const names[GRIDWORLD_ACTIONS] = {"up", "right", "down", "left"};
    const gridworld_maze *maze = &gridworld_sutton;
    gridworld_random random;
    unsigned unsteady = 0;
    gridworld_random_seed(&random, 1);
    for (uint32_t cell = 0; cell < maze->width * maze->height; cell++) {
        unsigned char percept[GRIDWORLD_PERCEPT_BYTES(BITS)];
        printf("%s", cell == 0 ? "[[" : cell % maze->width == 0 ? "],[" : ",");
        if (maze->cells[cell] != GRIDWORLD_FREE) {
            printf("null");
            continue;
        }
        gridworld_encode(maze, DISTRACTORS, cell, &random, percept);
        unsigned action = maze_policy(percept);
        printf("\"%s\"", names[action]);
        for (unsigned i = 0; i < 100u; i++) {
            gridworld_encode(maze, DISTRACTORS, cell, &random, percept);
            unsteady += maze_policy(percept) != action;
        }
    }
    printf("]]");
    return unsteady;
}

int main(void) {
    static const unsigned char percept[GRIDWORLD_PERCEPT_BYTES(BITS)] = {0xff, 0xff, 3};
    unsigned stack = stack_of(maze_policy, percept);
    printf("Stack of a decision: %u bytes\n", stack);
    printf("{\"cell_actions\":");
    unsigned unsteady = print_cells(), unlike = count_unlike();
    printf(",\"unsteady\":%u,\"unlike_the_agent\":%u}\n", unsteady, unlike);
    return stack > 64u || unsteady > 0 || unlike > 0;
}
