/* SPDX-License-Identifier: MIT */
/* Where the planner has been: for each pair of components, a grid of 12 x 12 cells over the bounds
 * of the dynamics model, with a bit for each cell that was visited. A single component is paired
 * with itself. */
#ifndef RLVC_SRC_CELLS_H
#define RLVC_SRC_CELLS_H

#include "../dynamics/dynamics.h"

#define RLVC_CELLS_SIDE 12u
#define RLVC_CELLS_BYTES (RLVC_CELLS_SIDE * RLVC_CELLS_SIDE / 8u)

static inline uint32_t rlvc_cells_pairs(uint32_t components) {
    return components > 1u ? components * (components - 1u) / 2u : 1u;
}

/* Marks the cells of a percept in bits[pairs][RLVC_CELLS_BYTES].
 * @return how many were not marked before. O(pairs). */
uint32_t rlvc_cells_mark(const rlvc_dynamics *dynamics, const float *percept, uint8_t *bits);

#endif
