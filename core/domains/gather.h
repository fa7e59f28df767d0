/* SPDX-License-Identifier: MIT */
/* Gathering bags: which vectors a candidate has, and how much of it a percept needs. */
#ifndef RLVC_DOMAINS_GATHER_H
#define RLVC_DOMAINS_GATHER_H

#include "vectors.h"

/* The domain's candidates, given a layout and K. */
int rlvc_gather_candidates(const rlvc_layout *layout, uint32_t size, const rlvc_samples *samples,
                           uint32_t first, uint32_t room, void *features, uint32_t *written);

#endif
