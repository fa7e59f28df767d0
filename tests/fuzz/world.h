/* SPDX-License-Identifier: MIT */
/* A world of 16 cells in a row, seen through each kind of domain, for the fuzz targets of agents.
 */
#ifndef RLVC_TESTS_WORLD_H
#define RLVC_TESTS_WORLD_H

#include "must.h"
#include "rlvc/agent.h"
#include "rlvc/bags.h"
#include "rlvc/bits.h"
#include "rlvc/spatial.h"
#include "rlvc/thresholds.h"

#include <string.h>

#define CELLS 16u
#define PERCEPT_MAX 32u /* bytes */

/* ------------------------------------------------------------------ a domain of one's own */

/* A percept is a byte, a feature a byte that stands for a bit of it: any record will do, so there
 * is nothing to check. No batch detector, no bound of the features. */
static inline int own_exhibits(void *ctx, const void *percept, const void *feature,
                               uint8_t *present) {
    (void)ctx;
    *present = *(const unsigned char *)percept >> *(const unsigned char *)feature % 8u & 1u;
    return 0;
}

static inline int own_candidates(void *ctx, const rlvc_samples *samples, uint32_t first,
                                 uint32_t room, void *features, uint32_t *written) {
    (void)ctx;
    (void)samples;
    for (*written = 0; *written < room && first + *written < 4u; ++*written)
        ((unsigned char *)features)[*written] = (unsigned char)(first + *written);
    return 0;
}

static inline int own_name(void *ctx, const void *feature, char *text, uint32_t room) {
    const char name[] = {(char)('a' + *(const unsigned char *)feature % 8u), '\0'};
    (void)ctx;
    must(room >= sizeof name);
    memcpy(text, name, sizeof name);
    return 0;
}

/* ------------------------------------------------------------------ all six */

/* A domain of a kind (RLVC_DOMAIN_*), of which there are two variants. */
static inline rlvc_domain world_domain(uint32_t kind, uint32_t variant) {
    static rlvc_thresholds thresholds;
    static rlvc_descriptors descriptors;
    static rlvc_spatial spatial;
    static rlvc_bags bags;
    rlvc_domain domain;
    memset(&domain, 0, sizeof domain);
    if (kind == RLVC_DOMAIN_BITS) {
        must(rlvc_bits_domain(variant ? 11 : 4, &domain) == RLVC_OK);
    } else if (kind == RLVC_DOMAIN_THRESHOLDS) {
        must(rlvc_thresholds_default(&thresholds, 2) == RLVC_OK);
        thresholds.cutpoints = 5;
        thresholds.oblique = variant != 0;
        must(rlvc_thresholds_domain(&thresholds, &domain) == RLVC_OK);
    } else if (kind == RLVC_DOMAIN_DESCRIPTORS) {
        must(rlvc_descriptors_default(&descriptors, 2, 2,
                                      variant ? RLVC_DESCRIPTORS_INT8 : RLVC_DESCRIPTORS_FLOAT,
                                      1.5f) == RLVC_OK);
        descriptors.candidates = 8;
        descriptors.draws = 2;
        must(rlvc_descriptors_domain(&descriptors, &domain) == RLVC_OK);
    } else if (kind == RLVC_DOMAIN_SPATIAL) {
        must(rlvc_spatial_default(&spatial, 2, 2,
                                  variant ? RLVC_DESCRIPTORS_INT8 : RLVC_DESCRIPTORS_FLOAT, variant,
                                  1.5f) == RLVC_OK);
        spatial.vectors.candidates = 4;
        spatial.vectors.draws = 2;
        spatial.pairs = 4;
        must(rlvc_spatial_domain(&spatial, &domain) == RLVC_OK);
    } else if (kind == RLVC_DOMAIN_BAGS) {
        must(rlvc_bags_default(&bags, 2, 2,
                               variant ? RLVC_DESCRIPTORS_INT8 : RLVC_DESCRIPTORS_FLOAT,
                               3.0f) == RLVC_OK);
        bags.size = 4;
        bags.vectors.candidates = 2;
        must(rlvc_bags_domain(&bags, &domain) == RLVC_OK);
    } else {
        domain.percept_bytes = 1;
        domain.feature_bytes = 1;
        domain.exhibits = own_exhibits;
        domain.method = &rlvc_method_classes;
        domain.candidates = own_candidates;
        domain.name = own_name;
    }
    return domain;
}

/* Are percepts vectors? */
static inline int sees_vectors(const rlvc_domain *domain) {
    return domain->kind == RLVC_DOMAIN_DESCRIPTORS || domain->kind == RLVC_DOMAIN_SPATIAL ||
           domain->kind == RLVC_DOMAIN_BAGS;
}

/* What a cell looks like. */
static inline void world_percept(const rlvc_domain *domain, uint32_t cell,
                                 unsigned char percept[PERCEPT_MAX]) {
    const float place[2] = {(float)(cell % 4u) * 1.5f, (float)(cell / 4u) * 1.5f};
    const uint32_t points = 1u + cell % 2u;
    memset(percept, 0, PERCEPT_MAX);
    must(domain->percept_bytes <= PERCEPT_MAX);
    if (domain->kind == RLVC_DOMAIN_THRESHOLDS) {
        memcpy(percept, place, sizeof place);
    } else if (sees_vectors(domain)) {
        memcpy(percept, &points, sizeof points);
        if (((const rlvc_descriptors *)domain->ctx)->form == RLVC_DESCRIPTORS_FLOAT) {
            memcpy(percept + 4, place, sizeof place);
        } else {
            percept[4] = (unsigned char)(cell % 4u * 2u);
            percept[5] = (unsigned char)(cell / 4u * 2u);
        }
        if (domain->kind == RLVC_DOMAIN_SPATIAL) /* the second point's x, or a direction */
            percept[domain->percept_bytes - 4u] = (unsigned char)(8u + cell);
    } else {
        percept[0] = (unsigned char)cell;
    }
}

/* The last cell pays. To gather a bag takes more samples of a kind: there half of the cells pay. */
static inline float world_reward(const rlvc_domain *domain, uint32_t cell) {
    const int bags = domain->kind == RLVC_DOMAIN_BAGS;
    return cell == CELLS - 1u || (bags && cell < CELLS / 2u) ? 1.0f : 0.0f;
}

/* One interaction that begins in *cell; the last cell ends the episode. */
static inline void world_step(rlvc_agent *agent, const rlvc_domain *domain, uint32_t *cell,
                              rlvc_choice choice) {
    unsigned char percept[PERCEPT_MAX];
    *cell = (*cell + (choice.action ? 1u : CELLS - 1u)) % CELLS;
    uint8_t end = *cell == CELLS - 1u ? RLVC_TERMINATED : RLVC_GOES_ON;
    world_percept(domain, *cell, percept);
    rlvc_status status = rlvc_observe(agent, choice, world_reward(domain, *cell), percept, end);
    must(status == RLVC_OK || status == RLVC_E_BUSY);
    if (end == RLVC_TERMINATED || status == RLVC_E_BUSY) {
        *cell = (*cell * 5u + 3u) % (CELLS - 1u);
        world_percept(domain, *cell, percept);
        status = rlvc_begin(agent, percept);
        must(status == RLVC_OK || status == RLVC_E_BUSY);
    }
}

#endif
