/* SPDX-License-Identifier: MIT */
/* Sorting samples by key, in place and in slices. */
#ifndef RLVC_SRC_SORT_H
#define RLVC_SRC_SORT_H
#include "rlvc/domain.h"

#define RLVC_SORT_SCRATCH_BYTES 2048u

typedef struct rlvc_sort {
    int placeholder;
    uint8_t done;
} rlvc_sort;

/* scratch: RLVC_SORT_SCRATCH_BYTES, aligned to 8, the cursor's until it is done. */
void rlvc_sort_begin(rlvc_sort *sort, rlvc_sample *sample, uint32_t count, void *scratch);
/* Works for at most `budget` (>= RLVC_BUDGET_MIN) units, one unit a sample touched; returns the units used. */
uint32_t rlvc_sort_step(rlvc_sort *sort, uint32_t budget);
#endif
