// SPDX-License-Identifier: MIT
#include "compaction.h"

#include "../cli/append.h"
#include "../cli/check.h"

#include <memory>
#include <new>
#include <vector>

namespace {

using Block = std::unique_ptr<uint64_t[]>;

Block allocate(std::size_t bytes) {
    Block block(new (std::nothrow) uint64_t[bytes / sizeof(uint64_t) + 1]);
    if (!block) {
        throw Failure("no memory for a policy of " + std::to_string(bytes) + " bytes");
    }
    return block;
}

rlvc_policy_config default_config(const rlvc_agent *agent) {
    rlvc_policy_config config;
    check(rlvc_policy_default(agent, &config), "rlvc_policy_default");
    return config;
}

} // namespace

Fewest fewest_leaves(const rlvc_agent *agent, const gridworld_maze &maze, const Optimum &optimum) {
    const rlvc_policy_config config = default_config(agent);
    std::vector<uint64_t> rows, allowed;
    const uint32_t x_bits = gridworld_x_bits(&maze);
    for (uint32_t cell = 0; cell < maze.width * maze.height; cell++) {
        if (maze.cells[cell] != GRIDWORLD_FREE) {
            continue;
        }
        rows.push_back(cell % maze.width | uint64_t{cell / maze.width} << x_bits);
        allowed.push_back(0);
        for (uint32_t action = 0; action < GRIDWORLD_ACTIONS; action++) {
            allowed.back() |= uint64_t{optimum.optimal(cell, action)} << action;
        }
    }
    rlvc_min_tree_task task{};
    task.row = rows.data();
    task.allowed = allowed.data();
    task.rows = static_cast<uint32_t>(rows.size());
    task.features = x_bits + gridworld_y_bits(&maze);
    task.entries = config.entries;
    task.effort = config.effort;
    std::size_t bytes = 0;
    rlvc_min_tree_result tree;
    check(rlvc_min_tree_size(&task, &bytes), "rlvc_min_tree_size");
    const Block block = allocate(bytes);
    check(rlvc_min_tree(&task, block.get(), bytes, &tree), "rlvc_min_tree");
    return {tree.leaves, tree.exact == 1};
}

Compaction compact(rlvc_agent *agent, const gridworld_maze &maze, uint32_t distractors,
                   const Optimum &optimum) {
    const rlvc_policy_config config = default_config(agent);
    std::size_t bytes = 0;
    rlvc_policy *policy = nullptr;
    Compaction made;
    check(rlvc_policy_size(agent, &config, &bytes), "rlvc_policy_size");
    const Block block = allocate(bytes);
    check(rlvc_policy_make(agent, &config, block.get(), bytes, &policy, &made.info),
          "rlvc_policy_make");
    const auto action_at = [&](const unsigned char *percept) {
        uint32_t action = 0;
        check(rlvc_policy_act(policy, percept, &action), "rlvc_policy_act");
        return Decision{0, action};
    };
    const Policy looked_up = look_up_policy(action_at, maze, distractors, optimum);
    made.optimal = looked_up.optimal;
    made.near_optimal = looked_up.near_optimal;
    check(rlvc_policy_print(policy, RLVC_PRINT_JSON, append, &made.tree_json), "rlvc_policy_print");
    check(rlvc_policy_export_c(policy, "maze", append, &made.policy_c, nullptr),
          "rlvc_policy_export_c");
    return made;
}
