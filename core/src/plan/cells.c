/* SPDX-License-Identifier: MIT */
/* What is new: see cells.h. */
#include "rlvc/float_rules.h"

#include "cells.h"

static uint32_t cell_of(const rlvc_dynamics *dynamics, const float *percept, uint32_t i) {
    float width = dynamics->high[i] - dynamics->low[i];
    if (!(width > 0.0f))
        return 0;
    float at = (percept[i] - dynamics->low[i]) / width * (float)RLVC_CELLS_SIDE;
    if (!(at > 0.0f))
        return 0;
    return at < (float)RLVC_CELLS_SIDE ? (uint32_t)at : RLVC_CELLS_SIDE - 1u;
}

uint32_t rlvc_cells_mark(const rlvc_dynamics *dynamics, const float *percept, uint8_t *bits) {
    uint32_t components = dynamics->basis.components, fresh = 0;
    uint8_t cell[RLVC_COMPONENTS_MAX];
    for (uint32_t i = 0; i < components; i++)
        cell[i] = (uint8_t)cell_of(dynamics, percept, i);
    for (uint32_t i = components > 1u; i < components; i++) {
        for (uint32_t j = 0; j < i + (components == 1u); j++) {
            uint32_t k = cell[i] * RLVC_CELLS_SIDE + cell[j];
            uint8_t bit = (uint8_t)(1u << (k & 7u));
            fresh += !(bits[k >> 3] & bit);
            bits[k >> 3] |= bit;
            bits += RLVC_CELLS_BYTES;
        }
    }
    return fresh;
}
