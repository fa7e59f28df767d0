/* SPDX-License-Identifier: MIT */
/* Sorting in place, with 2 KiB of counters and no recursion.
 *
 * A level is a range of samples that is already distributed by the bits from shift[level] up: those
 * with equal upper bits stand together as a bucket, and the buckets stand in order. Level 0 is the
 * whole, not distributed at all; a deeper level lies within one bucket of the level above and
 * begins where that begins. The samples before `begin` are in their final places, so that the end
 * and the shift of each level are all that a stack would have to hold. The phases:
 *
 *      INSERT  goes through the buckets of the deepest level and sorts them by insertion, as long
 *              as they are short;
 *      FIND    finds the end of a bucket that proves to be long, and the bits in which its keys
 *              differ (if none, it is sorted);
 *      COUNT   counts in it each value of the digit that begins with the highest such bit: what
 *              bits all keys share are skipped. The digit has 8 bits, or fewer in a run so short
 *              that most buckets would get a sample or none;
 *      PLACE   brings every sample to its bucket, which makes a new level.
 *
 * PLACE visits the buckets in turn. It exchanges each sample of the unfilled part of a bucket with
 * the first sample of the unfilled part of the bucket where it belongs; then comes the next bucket,
 * and after the last the first again, until all are full. An exchange fills a place for good, so
 * there are at most as many as samples; a round fills at least half of what was unfilled (what it
 * does not meet at its visit has been filled in that same round); and unlike in a walk along the
 * cycles of the permutation the next exchange need not wait for the last. */
#include "rlvc/float_rules.h"

#include "sort.h"

#include "../base/assert.h"
#include "rlvc/agent.h"

enum { INSERT, FIND, COUNT, PLACE };

#define SHORT_RUN 32u /* sorted by insertion */
#define BUCKETS_MIN 16u
#define BUCKETS_MAX 256u
#define BUCKET_SAMPLES                                                                             \
    8u /* in a bucket, on average, at least; but for the smallest number of buckets */
#define CLEARED_A_UNIT 8u /* counters cleared for one unit */
#define SUMMED_A_UNIT 4u
#define ACTION_MAX RLVC_BUDGET_MIN

/* The scratch: where the unfilled part of each bucket begins, and where the bucket ends. */
static uint32_t *next_of(const rlvc_sort_cursor *sort) {
    return sort->scratch;
}

static uint32_t *end_of(const rlvc_sort_cursor *sort) {
    return sort->scratch + BUCKETS_MAX;
}

static uint32_t least(uint32_t a, uint32_t b) {
    return a < b ? a : b;
}

/* The bits of a key by which the deepest level is distributed. */
static uint32_t upper_bits(const rlvc_sort_cursor *sort) {
    return sort->level == 0 ? 0u : UINT32_MAX << sort->shift[sort->level];
}

static void begin_run(rlvc_sort_cursor *sort, uint32_t at) {
    sort->begin = at;
    sort->at = at;
    sort->differ = 0;
    sort->phase = INSERT;
}

/* Leaves the levels that end where the run at work begins. */
static void leave_levels(rlvc_sort_cursor *sort) {
    while (sort->level > 0 && sort->begin == sort->level_end[sort->level])
        sort->level--;
    sort->done = sort->begin == sort->level_end[0];
}

void rlvc_sort_begin(rlvc_sort_cursor *sort, rlvc_sample *sample, uint32_t count, void *scratch) {
    RLVC_ASSERT(count <= INT32_MAX);
    sort->sample = sample;
    sort->scratch = (uint32_t *)scratch;
    sort->level = 0;
    sort->level_end[0] = count;
    sort->bucket = 0;
    sort->unplaced = 0;
    begin_run(sort, 0);
    leave_levels(sort);
}

/* Places the samples of a level by insertion, each at most SHORT_RUN places down its bucket. */
static uint32_t insert_step(rlvc_sort_cursor *sort, uint32_t budget) {
    rlvc_sample *sample = sort->sample;
    const uint32_t upper = upper_bits(sort);
    const uint32_t end = sort->level_end[sort->level];
    uint32_t work = 0;
    uint32_t at = sort->at;
    while (at < end && work + SHORT_RUN < budget) {
        rlvc_sample moved = sample[at];
        uint32_t differ = sample[sort->begin].key ^ moved.key;
        if ((differ & upper) != 0) {
            begin_run(sort, at);
            differ = 0;
        } else if (at - sort->begin == SHORT_RUN) {
            sort->phase = FIND;
            break;
        }
        sort->differ |= differ;
        uint32_t place = at;
        for (; place > sort->begin && sample[place - 1u].key > moved.key; place--)
            sample[place] = sample[place - 1u];
        sample[place] = moved;
        work += 1u + (at - place);
        at++;
    }
    sort->at = at;
    if (at == end) {
        begin_run(sort, at);
        leave_levels(sort);
    }
    return work;
}

/* Makes the run [begin, at) a new level, to be distributed by the digit that begins with the
 * highest bit in which its keys differ. Returns the units used. */
static uint32_t enter_level(rlvc_sort_cursor *sort) {
    const uint32_t samples = sort->at - sort->begin;
    uint32_t buckets = BUCKETS_MIN;
    uint8_t shift = 0;
    while (buckets < BUCKETS_MAX && samples >= 2u * BUCKET_SAMPLES * buckets)
        buckets *= 2u;
    while (sort->differ >> shift >= buckets)
        shift++;
    for (uint32_t i = 0; i < buckets; i++)
        end_of(sort)[i] = 0;
    sort->level++;
    RLVC_ASSERT(sort->level < RLVC_SORT_LEVELS);
    sort->level_end[sort->level] = sort->at;
    sort->shift[sort->level] = shift;
    sort->buckets = buckets;
    sort->at = sort->begin;
    sort->phase = COUNT;
    return buckets / CLEARED_A_UNIT;
}

/* Goes to the end of the bucket. */
static uint32_t find_step(rlvc_sort_cursor *sort, uint32_t budget) {
    const rlvc_sample *sample = sort->sample;
    const uint32_t first = sample[sort->begin].key;
    const uint32_t upper = upper_bits(sort);
    const uint32_t from = sort->at;
    const uint32_t stop =
        from + least(budget - BUCKETS_MAX / CLEARED_A_UNIT, sort->level_end[sort->level] - from);
    uint32_t differ = sort->differ;
    uint32_t at = from;
    for (; at < stop && ((sample[at].key ^ first) & upper) == 0; at++)
        differ |= sample[at].key ^ first;
    sort->at = at;
    sort->differ = differ;
    if (at == stop && at < sort->level_end[sort->level])
        return at - from;
    if (differ == 0) {
        begin_run(sort, at);
        leave_levels(sort);
        return at - from;
    }
    return at - from + enter_level(sort);
}

/* Counts in end_of(sort); then turns the counts into the buckets' ends and beginnings. */
static uint32_t count_step(rlvc_sort_cursor *sort, uint32_t budget) {
    uint32_t *end = end_of(sort);
    const uint32_t shift = sort->shift[sort->level];
    const uint32_t mask = sort->buckets - 1u;
    const uint32_t from = sort->at;
    const uint32_t stop = from + least(budget, sort->level_end[sort->level] - from);
    for (uint32_t i = from; i < stop; i++)
        end[sort->sample[i].key >> shift & mask]++;
    sort->at = stop;
    if (stop < sort->level_end[sort->level] || budget - (stop - from) < BUCKETS_MAX / SUMMED_A_UNIT)
        return stop - from;
    uint32_t sum = sort->begin;
    for (uint32_t i = 0; i < sort->buckets; i++) {
        next_of(sort)[i] = sum;
        sum += end[i];
        end[i] = sum;
    }
    sort->unplaced = sum - sort->begin;
    sort->bucket = 0;
    sort->at = sort->begin;
    sort->phase = PLACE;
    return stop - from + sort->buckets / SUMMED_A_UNIT;
}

/* Exchanges samples of the unfilled part of one bucket after the other. */
static uint32_t place_step(rlvc_sort_cursor *sort, uint32_t budget) {
    rlvc_sample *sample = sort->sample;
    uint32_t *next = next_of(sort);
    const uint32_t *end = end_of(sort);
    const uint32_t shift = sort->shift[sort->level];
    const uint32_t mask = sort->buckets - 1u;
    uint32_t left = budget;
    while (left > 2u && sort->unplaced > 0) {
        const uint32_t unfilled = end[sort->bucket] - sort->at;
        const uint32_t count = least(unfilled, (left - 1u) / 2u);
        const uint32_t stop = sort->at + count;
        for (uint32_t i = sort->at; i < stop; i++) {
            uint32_t place = next[sample[i].key >> shift & mask]++;
            rlvc_sample other = sample[place];
            sample[place] = sample[i];
            sample[i] = other;
        }
        left -= 1u + 2u * count;
        sort->unplaced -= count;
        sort->at = stop;
        if (count == unfilled) {
            sort->bucket = (sort->bucket + 1u) & mask;
            sort->at = next[sort->bucket];
        }
    }
    if (sort->unplaced == 0)
        begin_run(sort, sort->begin);
    return budget - left;
}

uint32_t rlvc_sort_step(rlvc_sort_cursor *sort, uint32_t budget) {
    uint32_t left = budget;
    RLVC_ASSERT(budget >= RLVC_BUDGET_MIN);
    while (!sort->done && left >= ACTION_MAX)
        if (sort->phase == INSERT)
            left -= insert_step(sort, left);
        else if (sort->phase == FIND)
            left -= find_step(sort, left);
        else if (sort->phase == COUNT)
            left -= count_step(sort, left);
        else
            left -= place_step(sort, left);
    return budget - left;
}

void rlvc_sort_single(rlvc_sort_cursor *sort) {
    int counting = sort->at < sort->level_end[sort->level];
    if (sort->phase == INSERT)
        (void)insert_step(sort, SHORT_RUN + 1u);
    else if (sort->phase == FIND)
        (void)find_step(sort, BUCKETS_MAX / CLEARED_A_UNIT + 1u);
    else if (sort->phase == COUNT)
        (void)count_step(sort, counting ? 1u : BUCKETS_MAX / SUMMED_A_UNIT);
    else
        (void)place_step(sort, 3u);
}

void rlvc_sort_mark(const rlvc_sort_cursor *sort, uint32_t word[5]) {
    word[0] = sort->phase | (uint32_t)sort->level << 8;
    word[1] = sort->begin;
    word[2] = sort->at;
    word[3] = sort->bucket;
    word[4] = sort->unplaced;
}
