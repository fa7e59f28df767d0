/* SPDX-License-Identifier: MIT */
/* The search for a feature that predicts the successors: see successor_search.h.
 *
 * Phases: the candidates are asked for (PROPOSE), and the column of each f is made (NOW). Then, for
 * each g, its column over the successors (NEXT), in the place of the cutpoints, and, for each f and
 * each action, a table (COUNT, TABLE). The winner gets its p-value (TEST). */
#include "rlvc/float_rules.h"

#include "successor_search.h"

#include "../base/popcount.h"
#include <string.h>

enum { PROPOSE, NOW, NEXT, COUNT, TABLE, TEST, DONE };

/* What a word of a table, and a table, are charged. */
#define WORD_UNITS 2u
#define TABLE_UNITS 24u

static void enter(rlvc_successor_cursor *search, uint8_t phase) {
    search->phase = phase;
    search->action = 0;
    search->at = 0;
    search->done = phase == DONE;
}

void rlvc_successor_search_begin(rlvc_successor_cursor *search, const rlvc_split_input *input,
                                 const uint32_t *first) {
    memset(search, 0, sizeof *search);
    search->words = rlvc_split_input_open(input, first, &search->view);
    enter(search, search->view.count < input->min_samples ? DONE : PROPOSE);
}

static rlvc_status propose(rlvc_successor_cursor *search, const rlvc_split_input *input) {
    uint32_t written;
    rlvc_status status = rlvc_split_input_propose(input, &search->view, 0, &written);
    if (status != RLVC_OK)
        return status;
    search->features = written;
    enter(search, written > 0 ? NOW : DONE);
    return RLVC_OK;
}

static uint64_t *now_column(const rlvc_successor_cursor *search, const rlvc_workspace *space) {
    return rlvc_workspace_column(space, search->words, search->now);
}

/* ------------------------------------------------------------------ columns */

/* Does s, or s', of sample i of the class exhibit a feature? */
static rlvc_status exhibits(const rlvc_successor_cursor *search, const rlvc_split_input *input,
                            uint32_t i, uint8_t *present) {
    const rlvc_replay *replay = input->replay;
    uint32_t slot = search->view.sample[i].slot;
    uint32_t j = search->phase == NOW ? search->now : search->next;
    if (search->phase == NEXT) {
        *present = 0;
        if (!rlvc_replay_linked(replay, slot))
            return RLVC_OK;
        slot = rlvc_replay_next(replay, slot);
    }
    return rlvc_split_input_exhibits(input, slot, rlvc_workspace_feature(input->space, j), present);
}

/* A column is complete. */
static void close_column(rlvc_successor_cursor *search) {
    if (search->phase == NOW && ++search->now < search->features) {
        enter(search, NOW);
        return;
    }
    uint8_t then = search->phase == NOW ? NEXT : COUNT;
    search->now = 0;
    enter(search, then);
}

/* Sets the bits of up to `budget` samples of the group at work, and goes on to the next group. */
static rlvc_status fill(rlvc_successor_cursor *search, const rlvc_split_input *input,
                        uint32_t budget, uint32_t *used) {
    const rlvc_workspace *space = input->space;
    const rlvc_group *group = &space->group[search->action];
    uint64_t *word =
        (search->phase == NOW ? now_column(search, space) : space->bits.successors) + group->word;
    uint32_t size = group->end - group->begin;
    for (*used = 0; *used < budget && search->at < size; ++*used) {
        uint32_t at = search->at;
        uint8_t present = 0;
        rlvc_status status = exhibits(search, input, group->begin + at, &present);
        if (status != RLVC_OK)
            return status;
        rlvc_bit_append(word, at, present);
        search->at++;
    }
    if (search->at < size)
        return RLVC_OK;
    *used += *used == 0; /* an empty group */
    search->at = 0;
    if (++search->action == space->actions)
        close_column(search);
    return RLVC_OK;
}

/* ------------------------------------------------------------------ tables */

/* Counts up to `most` words of the group at work. Returns how many. */
static uint32_t count(rlvc_successor_cursor *search, const rlvc_workspace *space, uint32_t most) {
    const rlvc_group *group = &space->group[search->action];
    const uint64_t *now = now_column(search, space) + group->word;
    const uint64_t *next = space->bits.successors + group->word;
    uint32_t words = (group->end - group->begin + 63u) / 64u;
    uint32_t from = search->at, left = words - from;
    uint32_t to = from + (left < most ? left : most);
    for (uint32_t i = from; i < to; i++) {
        uint64_t both = now[i] & next[i];
        search->with_now += rlvc_popcount(now + i, 1);
        search->with_next += rlvc_popcount(next + i, 1);
        search->with_both += rlvc_popcount(&both, 1);
    }
    search->at = to;
    if (to == words)
        search->phase = TABLE;
    return to == from ? 1u : to - from; /* 1 for an empty group */
}

/* The sums of a pair are complete: goes on to the next pair. */
static void close_pair(rlvc_successor_cursor *search) {
    rlvc_successor_pair_close(&search->sum, search->now, search->next, search->features,
                              &search->best);
    if (++search->now < search->features) {
        enter(search, COUNT);
        return;
    }
    search->now = 0;
    enter(search, ++search->next < search->features ? NEXT : TEST);
}

/* Weighs the table of one action. */
static void weigh(rlvc_successor_cursor *search, const rlvc_workspace *space) {
    const rlvc_group *group = &space->group[search->action];
    rlvc_successor_pair_add(&search->sum, group->end - group->begin, search->with_now,
                            search->with_next, search->with_both);
    search->with_both = 0;
    search->with_now = 0;
    search->with_next = 0;
    search->at = 0;
    search->phase = COUNT;
    if (++search->action == space->actions)
        close_pair(search);
}

/* ------------------------------------------------------------------ the whole */

static rlvc_status advance(rlvc_successor_cursor *search, const rlvc_split_input *input,
                           uint32_t budget, uint32_t *used) {
    switch (search->phase) {
    case PROPOSE:
        *used = 1;
        return propose(search, input);
    case NOW:
    case NEXT:
        return fill(search, input, budget, used);
    case COUNT:
        *used = WORD_UNITS * count(search, input->space, budget / WORD_UNITS);
        return RLVC_OK;
    case TABLE:
        *used = TABLE_UNITS;
        weigh(search, input->space);
        return RLVC_OK;
    default:
        *used = RLVC_TEST_UNITS;
        search->log_p = rlvc_successor_pair_log_p(&search->best);
        enter(search, DONE);
        return RLVC_OK;
    }
}

static uint32_t needed(const rlvc_successor_cursor *search) {
    if (search->phase == TEST)
        return RLVC_TEST_UNITS;
    if (search->phase == COUNT)
        return WORD_UNITS;
    return search->phase == TABLE ? TABLE_UNITS : 1u;
}

rlvc_status rlvc_successor_search_step(rlvc_successor_cursor *search, const rlvc_split_input *input,
                                       uint32_t budget, uint32_t *used) {
    *used = 0;
    while (!search->done && budget - *used >= needed(search)) {
        uint32_t units = 0;
        rlvc_status status = advance(search, input, budget - *used, &units);
        *used += units;
        if (status != RLVC_OK)
            return status;
    }
    return RLVC_OK;
}

rlvc_status rlvc_successor_search_single(rlvc_successor_cursor *search,
                                         const rlvc_split_input *input) {
    uint32_t used = 0;
    return advance(search, input, search->phase == COUNT ? WORD_UNITS : 1u, &used);
}

void rlvc_successor_search_mark(const rlvc_successor_cursor *search, uint32_t word[5]) {
    word[0] = search->phase;
    word[1] = search->next;
    word[2] = search->now;
    word[3] = search->action;
    word[4] = search->at;
}

const void *rlvc_successor_search_result(const rlvc_successor_cursor *search,
                                         const rlvc_workspace *space, rlvc_split *about) {
    if (!rlvc_successor_pair_result(&search->best, search->log_p, search->features,
                                    search->view.count, space->actions, about))
        return NULL;
    return rlvc_workspace_feature(space, search->best.feature);
}
