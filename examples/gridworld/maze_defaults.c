/* SPDX-License-Identifier: MIT */
/* Defaults found by trial.
 *
 * The published criterion asks for the same evidence from every feature. In a small maze without
 * slip the residual criterion learns fast, from the interactions that fit into 36 KiB. Slip needs
 * more samples. In a larger maze the memory must hold all interactions, and all actions are
 * exploring ones: the greedy action of a class that still covers half the maze would only push the
 * walk into a corner. Splits by successors are off there: they take several times as long, and
 * rewards alone separate as much in the end. An incremental solver forgets at its learning rate,
 * so it needs more interactions, and more of them along its policy. */
#include "maze_defaults.h"

#define SMALL_CELLS 46u /* as many as Sutton's maze has */
#define LARGE_INTERACTIONS_A_CELL 320u
#define CLASSES_MIN 64u
#define CLASSES_MAX 65535u
#define SUCCESSORS_BITS_MAX 64u /* their search needs all bits in one block of columns */

static const gridworld_defaults published = {10000, 20, 0, 0, 0.8f, 0.05f, 0.0001f, 0};
static const gridworld_defaults small = {2500, 25, 1200, 0, 0.9f, 0.01f, 1.0f, 1};
static const gridworld_defaults small_incremental = {20000, 200, 1200, 0, 0.3f, 0.01f, 1.0f, 1};
static const gridworld_defaults large = {0, 60, 0, 0, 1.0f, 0.01f, 0.00001f, 0};

static gridworld_defaults by_residuals(const gridworld_maze *maze,
                                       const gridworld_learner *learner) {
    gridworld_defaults defaults = large;
    if (maze->free_cells <= SMALL_CELLS && learner->slip == 0.0f) {
        return learner->incremental ? small_incremental : small;
    }
    defaults.interactions = LARGE_INTERACTIONS_A_CELL * maze->free_cells;
    if (learner->incremental) {
        defaults.epsilon = small_incremental.epsilon;
    }
    return defaults;
}

/* Four classes for three cells, within the limits. */
static uint32_t classes_for(uint32_t cells) {
    const uint32_t classes = cells / 3 * 4 + 4;
    if (classes < CLASSES_MIN) {
        return CLASSES_MIN;
    }
    return classes > CLASSES_MAX ? CLASSES_MAX : classes;
}

gridworld_defaults gridworld_defaults_for(const gridworld_maze *maze,
                                          const gridworld_learner *learner) {
    gridworld_defaults defaults = learner->returns ? published : by_residuals(maze, learner);
    if (gridworld_bits(maze, learner->distractors) > SUCCESSORS_BITS_MAX) {
        defaults.successors = 0;
    }
    defaults.classes = classes_for(maze->free_cells);
    return defaults;
}
