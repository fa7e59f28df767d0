// SPDX-License-Identifier: MIT
#include "policy.h"

#include "../cli/check.h"

#include <set>

namespace {

constexpr int draws = 16; // percepts of each cell

CellPolicy look_up_cell(const Decide &decide, const gridworld_maze &maze, uint32_t distractors,
                        const Optimum &optimum, uint32_t cell, gridworld_random &random) {
    unsigned char percept[GRIDWORLD_PERCEPT_BYTES(GRIDWORLD_BITS_MAX)];
    CellPolicy result;
    result.optimal = result.near_optimal = true;
    for (int i = 0; i < draws; i++) {
        gridworld_encode(&maze, distractors, cell, &random, percept);
        const auto [class_id, action] = decide(percept);
        result.optimal = result.optimal && optimum.optimal(cell, action);
        result.near_optimal = result.near_optimal && optimum.near_optimal(cell, action);
        if (i == 0) {
            result.class_id = class_id;
            result.action = action;
        }
        if (result.class_id != class_id) {
            result.class_id.reset();
        }
        if (result.action != action) {
            result.action.reset();
        }
    }
    return result;
}

} // namespace

Policy look_up_policy(const Decide &decide, const gridworld_maze &maze, uint32_t distractors,
                      const Optimum &optimum) {
    Policy policy;
    gridworld_random random; // not the world's, so that looking changes nothing
    gridworld_random_seed(&random, 0);
    policy.cells.resize(std::size_t{maze.width} * maze.height);
    for (uint32_t cell = 0; cell < policy.cells.size(); cell++) {
        if (maze.cells[cell] == GRIDWORLD_FREE) {
            policy.cells[cell] = look_up_cell(decide, maze, distractors, optimum, cell, random);
            policy.optimal += policy.cells[cell].optimal;
            policy.near_optimal += policy.cells[cell].near_optimal;
        }
    }
    return policy;
}

Policy look_up_policy(rlvc_agent *agent, const gridworld_maze &maze, uint32_t distractors,
                      const Optimum &optimum) {
    const auto decide = [agent](const unsigned char *percept) {
        Decision decision{};
        check(rlvc_predict(agent, percept, &decision.class_id, &decision.action), "rlvc_predict");
        return decision;
    };
    return look_up_policy(decide, maze, distractors, optimum);
}

std::vector<uint32_t> bits_used(const rlvc_agent *agent) {
    rlvc_statistics statistics;
    std::set<uint32_t> bits;
    check(rlvc_stats(agent, &statistics), "rlvc_stats");
    for (uint32_t i = 0; i + 1 < statistics.classes; i++) {
        unsigned char feature[RLVC_BITS_FEATURE_BYTES];
        check(rlvc_split_at(agent, i, nullptr, feature), "rlvc_split_at");
        bits.insert(rlvc_bits_feature(feature));
    }
    return {bits.begin(), bits.end()};
}

bool is_distractor(const gridworld_maze &maze, uint32_t distractors, uint32_t bit) {
    const uint32_t first = gridworld_x_bits(&maze);
    return bit >= first && bit < first + distractors;
}
