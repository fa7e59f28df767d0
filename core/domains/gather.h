/* SPDX-License-Identifier: MIT */
/* Gathering bags: which vectors a candidate has, and how much of it a percept needs. */
#ifndef RLVC_DOMAINS_GATHER_H
#define RLVC_DOMAINS_GATHER_H

#include "rlvc/bags.h"

#include "vectors.h"

/* A bag, whose vectors lie in a feature or in percepts. */
typedef struct rlvc_bag {
    uint32_t count;
    const void *vector[RLVC_BAGS_SIZE_MAX];
} rlvc_bag;

/* What a percept scores by a vector: tau^2 less the squared distance of the nearest, at least 0. */
float rlvc_bag_likeness(const rlvc_layout *layout, const void *vector, const void *percept);

/* What it scores by a bag: the sum, or the first part of it that is at least `enough`. */
float rlvc_bag_score(const rlvc_layout *layout, const rlvc_bag *bag, const void *percept,
                     float enough);

/* The domain's candidates, given a layout and K. */
int rlvc_gather_candidates(const rlvc_layout *layout, uint32_t size, const rlvc_samples *samples,
                           uint32_t first, uint32_t room, void *features, uint32_t *written);

#endif
