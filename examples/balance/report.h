/* SPDX-License-Identifier: MIT */
/* What the controller has learnt, and how well it balances, as text and as JSON. */
#ifndef BALANCE_REPORT_H
#define BALANCE_REPORT_H

#include "controller.h"

/* When the learnt policy could balance for the first time, and since when it can: interactions, or
 * 0. */
struct milestones {
    uint32_t first;
    uint32_t since;
};

/* The steps that the learnt policy keeps the pole up, in TRIALS episodes together, of EPISODE_STEPS
 * at most. Nothing of the controller changes. O(steps * depth). */
uint32_t report_trials(const struct controller *controller);

/* Prints to standard output. */
void report_task(void);
void report_step(const struct controller *controller, uint32_t steps);
void report_summary(const struct controller *controller, uint32_t steps,
                    const struct milestones *reached);

/* Prints one object of JSON, the same on every machine. @return 0; -1: it could not be written. */
int report_json(const struct controller *controller, uint32_t steps,
                const struct milestones *reached);

#endif
