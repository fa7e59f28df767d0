/* SPDX-License-Identifier: MIT */
/* Directed exploration: see explorer.h. */
#include "explorer.h"

#define RANDOM_FACTOR 48271u
#define RANDOM_MODULUS 2147483647u /* 2^31 - 1 */
#define RANDOM_RANGE 2147483648.0
#define PERSISTENCE 4.0
#define ENOUGH 8u

void gridworld_explorer_init(gridworld_explorer *explorer, uint8_t (*tried)[GRIDWORLD_ACTIONS],
                             uint32_t classes, uint32_t seed) {
    explorer->tried = tried;
    explorer->classes = classes;
    explorer->last = GRIDWORLD_ACTIONS;
    explorer->random = seed % RANDOM_MODULUS == 0 ? 1u : seed % RANDOM_MODULUS;
    gridworld_explorer_forget(explorer);
}

void gridworld_explorer_forget(gridworld_explorer *explorer) {
    for (uint32_t c = 0; c < explorer->classes; c++) {
        for (uint32_t a = 0; a < GRIDWORLD_ACTIONS; a++) {
            explorer->tried[c][a] = 0;
        }
    }
}

uint8_t gridworld_explorer_draw(gridworld_explorer *explorer, uint32_t class_id,
                                const uint32_t before[GRIDWORLD_ACTIONS]) {
    /* 1 / (1 + n)^4 */
    static const double weight_of[ENOUGH + 1u] = {1.0,         1.0 / 16.0,   1.0 / 81.0,
                                                  1.0 / 256.0, 1.0 / 625.0,  1.0 / 1296.0,
                                                  1.0 / 2401.0, 1.0 / 4096.0, 1.0 / 6561.0};
    double weights[GRIDWORLD_ACTIONS], sum = 0.0;
    for (uint32_t a = 0; a < GRIDWORLD_ACTIONS; a++) {
        uint32_t n = before[a] + explorer->tried[class_id][a];
        double weight = weight_of[n < ENOUGH ? n : ENOUGH];
        weights[a] = a == explorer->last ? PERSISTENCE * weight : weight;
        sum += weights[a];
    }
    uint64_t product = (uint64_t)explorer->random * RANDOM_FACTOR;
    explorer->random = (uint32_t)(product % RANDOM_MODULUS);
    double left = sum * explorer->random / RANDOM_RANGE; /* below the sum */
    uint8_t action = 0;
    while (action + 1u < GRIDWORLD_ACTIONS && left >= weights[action]) {
        left -= weights[action++];
    }
    return action;
}

void gridworld_explorer_note(gridworld_explorer *explorer, uint32_t class_id, uint32_t action) {
    uint8_t *tried = &explorer->tried[class_id][action];
    *tried = *tried < UINT8_MAX ? (uint8_t)(*tried + 1u) : *tried;
    explorer->last = action;
}
