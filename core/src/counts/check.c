/* SPDX-License-Identifier: MIT */
/* Whether tables of counts contradict themselves: a difference of counts would wrap. */
#include "rlvc/float_rules.h"

#include "table.h"

static int arrays_are_there(const rlvc_counts *counts) {
    return counts->row && counts->with && counts->feature &&
           (counts->tested || counts->cell_bits == 0) && (counts->pair || counts->pairs == 0);
}

static int numbers_fit(const rlvc_counts *counts) {
    if (counts->rows < 1u || counts->rows > INT32_MAX || counts->pairs > INT32_MAX)
        return 0;
    if (counts->features < 1u || counts->features > RLVC_COUNTS_FEATURES_MAX)
        return 0;
    if (counts->cell_bits > RLVC_CELL_BITS_MAX)
        return 0;
    for (uint32_t i = 0; i < counts->cell_bits; i++) {
        if (counts->tested[i] >= counts->features)
            return 0;
    }
    return 1;
}

static int row_fits(const rlvc_agent *agent, const rlvc_counts *counts, uint32_t i) {
    const rlvc_count_row *row = &counts->row[i];
    const uint64_t *with = counts->with + (size_t)i * counts->features;
    if (row->count < 1u || row->count > RLVC_COUNT_MAX)
        return 0;
    if (row->action >= agent->config.actions || row->terminated > 1u)
        return 0;
    if (!(row->reward >= -RLVC_REWARD_MAX && row->reward <= RLVC_REWARD_MAX))
        return 0;
    for (uint32_t f = 0; f < counts->features; f++) {
        if (with[f] > row->count)
            return 0;
    }
    return 1;
}

/* Of `size` interactions, can `both` be where `now` and `next` meet? */
static int meet(uint64_t size, uint64_t now, uint64_t next, uint64_t both) {
    return both <= now && both <= next && next <= size && now - both <= size - next;
}

static int follow_fits(const rlvc_counts *counts, uint32_t i) {
    const rlvc_count_row *row = &counts->row[i];
    const uint64_t *with = counts->with + (size_t)i * counts->features;
    const uint64_t *next = counts->follow + (size_t)i * 2u * counts->features;
    const uint64_t *both = next + counts->features;
    for (uint32_t f = 0; f < counts->features; f++) {
        if (!meet(row->count, with[f], next[f], both[f]) || (row->terminated && next[f] > 0))
            return 0;
    }
    return 1;
}

rlvc_status rlvc_counts_check(const rlvc_agent *agent, const rlvc_counts *counts, uint64_t *total) {
    *total = 0;
    if (!arrays_are_there(counts))
        return RLVC_E_NULL;
    if (!numbers_fit(counts) || (agent->config.successors && !counts->follow))
        return RLVC_E_RANGE;
    for (uint32_t i = 0; i < counts->rows; i++) {
        if (!row_fits(agent, counts, i) || (counts->follow && !follow_fits(counts, i)))
            return RLVC_E_RANGE;
        *total += counts->row[i].count;
        if (*total > RLVC_COUNT_MAX)
            return RLVC_E_RANGE;
    }
    for (uint32_t i = 0; i < counts->pairs; i++) {
        if (counts->pair[i].action >= agent->config.actions)
            return RLVC_E_RANGE;
    }
    return RLVC_OK;
}

int rlvc_counts_check_features(rlvc_agent *agent, const rlvc_counts *counts) {
    const rlvc_domain *domain = &agent->domain;
    const unsigned char *feature = counts->feature;
    int sound = 1;
    agent->busy = 1;
    for (uint32_t f = 0; domain->check_feature && sound && f < counts->features; f++)
        sound = !domain->check_feature(domain->ctx, feature + (size_t)f * domain->feature_bytes);
    agent->busy = 0;
    return sound;
}
