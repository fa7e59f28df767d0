/* SPDX-License-Identifier: MIT */
/* A bag of vectors, and what a percept scores by it. */
#ifndef RLVC_DOMAINS_BAG_H
#define RLVC_DOMAINS_BAG_H

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

rlvc_layout rlvc_bag_layout(const rlvc_bags *bags);

/* The bag of a feature. */
void rlvc_bag_read(const rlvc_layout *layout, const void *feature, rlvc_bag *bag);

#endif
