/* SPDX-License-Identifier: MIT */
/* A robot that learns on a microcontroller: the control loop, and a report.
 *
 *     settings  how to learn, and the work of a tick      robot   a tick of the control loop
 *     report    what was learnt                           port    what depends on the machine
 *     load      the instructions of slices and ticks
 *
 * Its output ends with a JSON object, which is the same on every machine. Exit status: 0 if no tick
 * overran and, under the residual criterion, every cell's action is the best one at the end; else
 * 1. */
#include "load.h"
#include "port.h"
#include "report.h"
#include <stdio.h>

static int timed_tick(struct robot *robot, struct load *load) {
    uint32_t start = port_instructions();
    int status = robot_tick(robot);
    load_add(load, robot->slice_instructions, port_instructions() - start);
    return status;
}

/* What stands beside the control loop: how good the policy is after each learning step. */
static int watch(struct robot *robot, struct policy *policy, struct milestones *reached) {
    if (report_policy(robot, policy) != 0) {
        return -1;
    }
    report_step(robot, policy);
    if (policy->optimal_cells < gridworld_sutton.free_cells) {
        reached->since = 0;
    } else if (reached->since == 0) {
        reached->since = robot->interactions;
    }
    reached->first = reached->first == 0 ? reached->since : reached->first;
    return 0;
}

static int run(struct robot *robot, struct policy *policy, struct milestones *reached,
               struct load *load) {
    int status = robot_init(robot);
    report_task();
    while (status == 0 && robot->steps < STEPS) {
        status = timed_tick(robot, load);
        if (status == 0 && robot->finished) {
            status = watch(robot, policy, reached);
        }
    }
    return status;
}

int main(void) {
    static struct robot robot;
    static struct policy policy;
    struct milestones reached = {0, 0};
    struct load load = {SLICE_INSTRUCTIONS, TICK_INSTRUCTIONS, 0, 0, 0};
    port_begin();
    if (run(&robot, &policy, &reached, &load) != 0) {
        printf("failed at interaction %u\n", (unsigned)robot.interactions);
        return 1;
    }
    report_pictures(&policy);
    report_summary(&robot, &policy, &reached);
    load_print(&load, robot_block_bytes());
    int optimal = policy.optimal_cells == gridworld_sutton.free_cells;
    int wanted = CRITERION == RLVC_CRITERION_RETURNS || optimal;
    return report_json(&robot, &policy, &reached) == 0 && wanted && load.overruns == 0 ? 0 : 1;
}
