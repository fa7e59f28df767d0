/* SPDX-License-Identifier: MIT */
/* A controller that learns to balance a pole on a microcontroller: the control loop, and a report.
 *
 *     settings    what is learnt by, and what a tick may take   cart_pole   the cart and the pole
 *     controller  a tick of the control loop                    report      what was learnt
 *
 * port (what the machine tells) and load (how long slices and ticks take) are those of ../firmware,
 * whose robot learns a maze of bits in the same manner.
 *
 * What it prints ends in an object of JSON, the same on every machine. Exit status: 0 if no tick
 * overran and the learnt policy keeps the pole up for LEARNT steps in the mean; else 1. */
#include "load.h"
#include "port.h"
#include "report.h"
#include <stdio.h>

static int timed_tick(struct controller *controller, struct load *load) {
    uint32_t start = port_instructions();
    int status = controller_tick(controller);
    load_add(load, controller->slice_instructions, port_instructions() - start);
    return status;
}

/* What stands beside the control loop: how good the policy is after each step of learning. */
static uint32_t watch(const struct controller *controller, struct milestones *reached) {
    uint32_t steps = report_trials(controller);
    report_step(controller, steps);
    if (steps < LEARNT * TRIALS)
        reached->since = 0;
    else if (reached->since == 0)
        reached->since = controller->interactions;
    reached->first = reached->first == 0 ? reached->since : reached->first;
    return steps;
}

static int run(struct controller *controller, uint32_t *steps, struct milestones *reached,
               struct load *load) {
    int status = controller_init(controller, SEED);
    report_task();
    while (status == 0 && !(controller->finished && controller->interactions >= INTERACTIONS)) {
        status = timed_tick(controller, load);
        if (status == 0 && controller->finished)
            *steps = watch(controller, reached);
    }
    return status;
}

int main(void) {
    static struct controller controller;
    struct milestones reached = {0, 0};
    struct load load = {SLICE_INSTRUCTIONS, TICK_INSTRUCTIONS, 0, 0, 0};
    uint32_t steps = 0;
    port_begin();
    if (run(&controller, &steps, &reached, &load) != 0) {
        printf("failed at interaction %u\n", (unsigned)controller.interactions);
        return 1;
    }
    report_summary(&controller, steps, &reached);
    load_print(&load, controller_block_bytes());
    int fine = steps >= LEARNT * TRIALS && load.overruns == 0;
    return report_json(&controller, steps, &reached) == 0 && fine ? 0 : 1;
}
