// SPDX-License-Identifier: MIT
#include "exploration.h"

#include "check.h"

Explorer::Explorer(uint32_t classes, uint32_t seed)
    : tried_(new uint8_t[classes][GRIDWORLD_ACTIONS]) {
    gridworld_explorer_init(&explorer_, tried_.get(), classes, seed);
}

void Explorer::direct(rlvc_agent *agent, const unsigned char *percept, rlvc_choice &choice) {
    uint32_t class_id = 0;
    check(rlvc_predict(agent, percept, &class_id, nullptr), "rlvc_predict");
    if (!choice.exploited) {
        uint32_t before[GRIDWORLD_ACTIONS] = {0};
        for (uint32_t a = 0; a < GRIDWORLD_ACTIONS; a++) {
            check(rlvc_q(agent, class_id, a, nullptr, &before[a]), "rlvc_q");
        }
        choice.action = gridworld_explorer_draw(&explorer_, class_id, before);
    }
    gridworld_explorer_note(&explorer_, class_id, choice.action);
}

void Explorer::forget() {
    gridworld_explorer_forget(&explorer_);
}

std::size_t Explorer::bytes() const {
    return std::size_t{explorer_.classes} * GRIDWORLD_ACTIONS;
}
