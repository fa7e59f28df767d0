/* SPDX-License-Identifier: MIT */
/* What the robot has learnt, compared with the optimum, as text and as JSON. */
#ifndef FIRMWARE_REPORT_H
#define FIRMWARE_REPORT_H

#include "robot.h"

#define CELLS 54u /* of Sutton's maze */
#define UNCLEAR 0xffffu

/* What the tree does in each cell. A cell is looked up with several percepts that differ in their
 * distractors. Where they disagree the entry is UNCLEAR; the cell counts as the worst of them. */
struct policy {
    uint16_t class_id[CELLS];
    uint16_t action[CELLS];
    uint8_t optimal[CELLS];
    uint32_t optimal_cells;
};

/* When all cells were optimal for the first time, and since when they are: interactions, or 0. */
struct milestones {
    uint32_t first;
    uint32_t since;
};

/* Looks the policy up. @return 0; -1: the agent failed. O(cells * depth). */
int report_policy(struct robot *robot, struct policy *policy);

/* Prints to standard output. */
void report_task(void);
void report_step(const struct robot *robot, const struct policy *policy);
void report_pictures(const struct policy *policy);
void report_summary(struct robot *robot, const struct policy *policy,
                    const struct milestones *reached);

/* Prints one object of JSON, the same on every machine. @return 0; -1: it could not be written. */
int report_json(struct robot *robot, const struct policy *policy, const struct milestones *reached);

#endif
