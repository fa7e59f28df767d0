/* SPDX-License-Identifier: MIT */
/* The robot: see robot.h. */
#include "robot.h"

#include "port.h"

static uint64_t block[RLVC_AGENT_BYTES(GRIDWORLD_ACTIONS, CAPACITY, CLASSES, PERCEPT_BYTES,
                                       RLVC_BITS_FEATURE_BYTES, FEATURES_AT_ONCE) /
                      sizeof(uint64_t)];

uint32_t robot_block_bytes(void) {
    return (uint32_t)sizeof block;
}

int robot_init(struct robot *robot) {
    rlvc_domain domain;
    rlvc_config config;
    if (rlvc_bits_domain(PERCEPT_BITS, &domain) != RLVC_OK ||
        rlvc_config_default(&config, &domain, GRIDWORLD_ACTIONS) != RLVC_OK) {
        return -1;
    }
    config.features_at_once = FEATURES_AT_ONCE;
    config.capacity = CAPACITY;
    config.classes = CLASSES;
    config.seed = SEED;
    config.criterion = CRITERION;
    if (CRITERION == RLVC_CRITERION_RETURNS) { /* as published: through the teleport, all alike */
        config.continuing = 1;
        config.explore = RLVC_EXPLORE_UNIFORM;
    }
    config.discount = DISCOUNT;
    config.epsilon = EPSILON;
    config.alpha = ALPHA;
    config.alpha_known = ALPHA_KNOWN;
    config.successors = SUCCESSORS;
    static const struct robot made;
    *robot = made;
    if (rlvc_agent_init(&config, &domain, block, sizeof block, &robot->agent) != RLVC_OK ||
        gridworld_init(&robot->world, &gridworld_sutton, DISTRACTORS, 0.0f, SEED) != 0 ||
        gridworld_init(&robot->patrol, &gridworld_sutton, DISTRACTORS, 0.0f, SEED + 1u) != 0) {
        return -1;
    }
    gridworld_percept(&robot->world, robot->percept);
    return rlvc_begin(robot->agent, robot->percept) == RLVC_OK ? 0 : -1;
}

static int explore(struct robot *robot) {
    rlvc_choice choice;
    rlvc_status status = RLVC_OK;
    float reward = 0.0f;
    if (rlvc_act(robot->agent, &choice) != RLVC_OK) {
        return -1;
    }
    int over = gridworld_step(&robot->world, choice.action, &reward);
    if (over == 1) {
        status = rlvc_observe(robot->agent, choice, reward, NULL, RLVC_TERMINATED);
        gridworld_reset(&robot->world);
    }
    gridworld_percept(&robot->world, robot->percept);
    if (status == RLVC_OK && over == 1) {
        status = rlvc_begin(robot->agent, robot->percept);
    } else if (status == RLVC_OK) {
        status = rlvc_observe(robot->agent, choice, reward, robot->percept, RLVC_GOES_ON);
    }
    robot->interactions++;
    return status == RLVC_OK && over >= 0 ? 0 : -1;
}

static int patrol(struct robot *robot) {
    unsigned char percept[PERCEPT_BYTES];
    uint32_t action;
    float reward;
    gridworld_percept(&robot->patrol, percept);
    if (rlvc_predict(robot->agent, percept, NULL, &action) != RLVC_OK) {
        return -1;
    }
    if (gridworld_step(&robot->patrol, action, &reward) == 1) {
        gridworld_reset(&robot->patrol);
        robot->arrivals++;
    }
    robot->patrols++;
    return 0;
}

static int lend_slice(struct robot *robot) {
    rlvc_progress progress;
    uint32_t start = port_instructions();
    rlvc_status status = rlvc_learn(robot->agent, SLICE, &progress);
    robot->slice_instructions = port_instructions() - start;
    if (status != RLVC_OK) {
        return -1;
    }
    if (progress.done) {
        robot->splits = progress.splits;
        robot->learning = 0;
        robot->finished = 1;
        robot->steps++;
    }
    return 0;
}

int robot_tick(struct robot *robot) {
    robot->finished = 0;
    robot->slice_instructions = 0;
    if ((robot->learning ? patrol(robot) : explore(robot)) != 0) {
        return -1;
    }
    if (robot->interactions == (robot->steps + 1u) * STEP_INTERACTIONS) {
        robot->learning = 1;
    }
    return robot->learning ? lend_slice(robot) : 0;
}
