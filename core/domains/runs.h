/* SPDX-License-Identifier: MIT */
/* Runs of samples with equal targets, from which candidates are drawn alike: a rare target is not
 * missed. */
#ifndef RLVC_DOMAINS_RUNS_H
#define RLVC_DOMAINS_RUNS_H

#include "rlvc/domain.h"

/* A number that looks random (an integer hash by multiplication). */
uint32_t rlvc_scatter(uint32_t x);

/* Where the run ends that begins at a sample. */
uint32_t rlvc_run_end(const rlvc_samples *samples, uint32_t begin);

uint32_t rlvc_runs_count(const rlvc_samples *samples);

/* Where the run of candidate i of `of` begins and ends: each run has its turn; of more runs than
 * candidates some, evenly. */
void rlvc_runs_find(const rlvc_samples *samples, uint32_t runs, uint32_t i, uint32_t of,
                    uint32_t run[2]);

#endif
