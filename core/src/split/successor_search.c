/* SPDX-License-Identifier: MIT */
/* The search for a feature that tells successors apart: see successor_search.h.
 *
 * Phases: the candidates are asked for (PROPOSE), and the column of each f is made (NOW). Then, for
 * each g, its column over the successors (NEXT), in the place of the cutpoints, and, for each f and
 * each action, a table (COUNT, TABLE). The winner gets its p-value (TEST). */
#include "successor_search.h"

#include "../base/popcount.h"
#include "../base/float_math.h"
#include "rlvc/chi2.h"
#include <string.h>

enum { PROPOSE, NOW, NEXT, COUNT, TABLE, TEST, DONE };

/* What a word of a table, and a table, are charged. */
#define WORD_UNITS 2u
#define TABLE_UNITS 24u

static void enter(rlvc_succession *succession, uint8_t phase) {
    succession->phase = phase;
    succession->action = 0;
    succession->at = 0;
    succession->done = phase == DONE;
}

void rlvc_succession_begin(rlvc_succession *succession, const rlvc_searching *searching,
                           const uint32_t *first) {
    memset(succession, 0, sizeof *succession);
    succession->words = rlvc_searching_open(searching, first, &succession->view);
    enter(succession, succession->view.count < searching->min_samples ? DONE : PROPOSE);
}

static rlvc_status propose(rlvc_succession *succession, const rlvc_searching *searching) {
    uint32_t written;
    rlvc_status status = rlvc_searching_propose(searching, &succession->view, 0, &written);
    if (status != RLVC_OK)
        return status;
    succession->features = written;
    enter(succession, written > 0 ? NOW : DONE);
    return RLVC_OK;
}

static uint64_t *now_column(const rlvc_succession *succession, const rlvc_workspace *space) {
    return rlvc_workspace_column(space, succession->words, succession->now);
}

/* ------------------------------------------------------------------ columns */

/* Does s, or s', of sample i of the class exhibit a feature? */
static rlvc_status look(const rlvc_succession *succession, const rlvc_searching *searching,
                        uint32_t i, uint8_t *present) {
    const rlvc_replay *replay = searching->replay;
    uint32_t slot = succession->view.sample[i].slot;
    uint32_t j = succession->phase == NOW ? succession->now : succession->next;
    if (succession->phase == NEXT) {
        *present = 0;
        if (!rlvc_replay_linked(replay, slot))
            return RLVC_OK;
        slot = rlvc_replay_next(replay, slot);
    }
    return rlvc_searching_look(searching, slot, rlvc_workspace_feature(searching->space, j),
                               present);
}

/* A column is complete. */
static void close_column(rlvc_succession *succession) {
    if (succession->phase == NOW && ++succession->now < succession->features) {
        enter(succession, NOW);
        return;
    }
    uint8_t then = succession->phase == NOW ? NEXT : COUNT;
    succession->now = 0;
    enter(succession, then);
}

/* Sets the bits of up to `budget` samples of the group at work, and goes on to the next group. */
static rlvc_status fill(rlvc_succession *succession, const rlvc_searching *searching,
                        uint32_t budget, uint32_t *used) {
    const rlvc_workspace *space = searching->space;
    const rlvc_group *group = &space->group[succession->action];
    uint64_t *word =
        (succession->phase == NOW ? now_column(succession, space) : space->cuts) + group->word;
    uint32_t size = group->end - group->begin;
    for (*used = 0; *used < budget && succession->at < size; ++*used) {
        uint32_t at = succession->at;
        uint8_t present = 0;
        rlvc_status status = look(succession, searching, group->begin + at, &present);
        if (status != RLVC_OK)
            return status;
        uint64_t before = at % 64u == 0 ? 0 : word[at / 64u];
        word[at / 64u] = before | (uint64_t)(present != 0) << at % 64u;
        succession->at++;
    }
    if (succession->at < size)
        return RLVC_OK;
    *used += *used == 0; /* an empty group */
    succession->at = 0;
    if (++succession->action == space->actions)
        close_column(succession);
    return RLVC_OK;
}

/* ------------------------------------------------------------------ tables */

/* Counts up to `most` words of the group at work. Returns how many. */
static uint32_t count(rlvc_succession *succession, const rlvc_workspace *space, uint32_t most) {
    const rlvc_group *group = &space->group[succession->action];
    const uint64_t *now = now_column(succession, space) + group->word;
    const uint64_t *next = space->cuts + group->word;
    uint32_t words = (group->end - group->begin + 63u) / 64u;
    uint32_t from = succession->at, left = words - from;
    uint32_t to = from + (left < most ? left : most);
    for (uint32_t i = from; i < to; i++) {
        uint64_t both = now[i] & next[i];
        succession->with_now += rlvc_ones(now + i, 1);
        succession->with_next += rlvc_ones(next + i, 1);
        succession->with_both += rlvc_ones(&both, 1);
    }
    succession->at = to;
    if (to == words)
        succession->phase = TABLE;
    return to == from ? 1u : to - from; /* 1 for an empty group */
}

/* ln of the number of tests that a pair is corrected by (Bonferroni). Whether s' exhibits what s
 * exhibits is mostly told by s: the F pairs with g = f have half of the level, and the other F (F -
 * 1) the other half. */
static float log_tests(const rlvc_succession *succession, const rlvc_follows *pair) {
    float features = (float)succession->features;
    return rlvc_ln(2.0f * features * (pair->persists ? 1.0f : features - 1.0f));
}

/* The sums of a pair are complete: goes on to the next pair. */
static void close_pair(rlvc_succession *succession) {
    static const rlvc_follows nothing = {0.0f, 0.0f, 0, 0, 0};
    rlvc_follows *pair = &succession->sum;
    if (pair->degrees > 0) {
        pair->feature = succession->now;
        pair->persists = succession->now == succession->next;
        pair->evidence = pair->statistic - 2.0f * log_tests(succession, pair);
        if (succession->best.degrees == 0 || pair->evidence > succession->best.evidence)
            succession->best = *pair;
    }
    *pair = nothing;
    if (++succession->now < succession->features) {
        enter(succession, COUNT);
        return;
    }
    succession->now = 0;
    enter(succession, ++succession->next < succession->features ? NEXT : TEST);
}

/* Weighs the table of one action. */
static void weigh(rlvc_succession *succession, const rlvc_workspace *space) {
    const rlvc_group *group = &space->group[succession->action];
    uint32_t size = group->end - group->begin;
    uint32_t both = succession->with_both, now = succession->with_now, next = succession->with_next;
    if (now > 0 && now < size && next > 0 && next < size) {
        const rlvc_table table = {both, now - both, next - both, size - now - next + both};
        succession->sum.statistic += rlvc_table_statistic(&table);
        succession->sum.degrees++;
    }
    succession->with_both = 0;
    succession->with_now = 0;
    succession->with_next = 0;
    succession->at = 0;
    succession->phase = COUNT;
    if (++succession->action == space->actions)
        close_pair(succession);
}

/* ------------------------------------------------------------------ the whole */

static rlvc_status advance(rlvc_succession *succession, const rlvc_searching *searching,
                           uint32_t budget, uint32_t *used) {
    switch (succession->phase) {
    case PROPOSE:
        *used = 1;
        return propose(succession, searching);
    case NOW:
    case NEXT:
        return fill(succession, searching, budget, used);
    case COUNT:
        *used = WORD_UNITS * count(succession, searching->space, budget / WORD_UNITS);
        return RLVC_OK;
    case TABLE:
        *used = TABLE_UNITS;
        weigh(succession, searching->space);
        return RLVC_OK;
    default:
        *used = RLVC_TEST_UNITS;
        if (succession->best.degrees > 0)
            (void)rlvc_chi2_survival(succession->best.statistic, succession->best.degrees, NULL,
                                     &succession->log_p);
        enter(succession, DONE);
        return RLVC_OK;
    }
}

static uint32_t needed(const rlvc_succession *succession) {
    if (succession->phase == TEST)
        return RLVC_TEST_UNITS;
    if (succession->phase == COUNT)
        return WORD_UNITS;
    return succession->phase == TABLE ? TABLE_UNITS : 1u;
}

rlvc_status rlvc_succession_step(rlvc_succession *succession, const rlvc_searching *searching,
                                 uint32_t budget, uint32_t *used) {
    *used = 0;
    while (!succession->done && budget - *used >= needed(succession)) {
        uint32_t units = 0;
        rlvc_status status = advance(succession, searching, budget - *used, &units);
        *used += units;
        if (status != RLVC_OK)
            return status;
    }
    return RLVC_OK;
}

rlvc_status rlvc_succession_single(rlvc_succession *succession, const rlvc_searching *searching) {
    uint32_t used = 0;
    return advance(succession, searching, succession->phase == COUNT ? WORD_UNITS : 1u, &used);
}

void rlvc_succession_mark(const rlvc_succession *succession, uint32_t word[5]) {
    word[0] = succession->phase;
    word[1] = succession->next;
    word[2] = succession->now;
    word[3] = succession->action;
    word[4] = succession->at;
}

const void *rlvc_succession_result(const rlvc_succession *succession, const rlvc_workspace *space,
                                   rlvc_split *about) {
    if (succession->best.degrees == 0)
        return NULL;
    about->action = space->actions + 1u;
    about->samples = succession->view.count;
    about->score = succession->best.statistic / (float)succession->view.count;
    about->log_tests = log_tests(succession, &succession->best);
    about->log_p = succession->log_p + about->log_tests;
    about->log_p = about->log_p < 0.0f ? about->log_p : 0.0f;
    return rlvc_workspace_feature(space, succession->best.feature);
}
