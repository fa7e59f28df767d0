/* SPDX-License-Identifier: MIT */
/* The search for what an action influences, and for what lasts: see successor_search.h.
 *
 * Phases: a block of candidates is asked for (PROPOSE), unless the block is given. Then, for each
 * class and action, each sample is looked at (COUNT), and what was counted is weighed (WEIGH).
 * After the last pair each feature is tested (TEST). The counts lie in the memory of the columns.
 */
#include "rlvc/float_rules.h"

#include "successor_search.h"

#include "../base/popcount.h"
#include "../base/solver_select.h"
#include "successor_evidence.h"
#include <string.h>

enum { PROPOSE, COUNT, WEIGH, TEST, DONE };

/* What weighing a feature is charged: three tables. */
#define WEIGH_UNITS 64u

/* Of each feature of the block. The same number fits on every target, as a snapshot asks for the
 * same blocks. */
typedef struct tally {
    rlvc_following action; /* of the pair at work */
    rlvc_successor_evidence evidence;
} tally;
#define TALLY_WORDS 11u
typedef char tally_fits[sizeof(tally) <= TALLY_WORDS * 8u ? 1 : -1];

static tally *tally_of(const rlvc_split_input *input, uint32_t j) {
    return (tally *)(void *)input->space->columns + j;
}

static void *feature_of(const rlvc_successor_cursor *search, const rlvc_split_input *input,
                        uint32_t j) {
    return rlvc_workspace_feature(input->space, search->kept + j);
}

static void enter(rlvc_successor_cursor *search, uint8_t phase) {
    search->phase = phase;
    search->feature = 0;
    search->done = phase == DONE;
}

/* Begins to count in the pairs from search->pair on. */
static void open_pairs(rlvc_successor_cursor *search, const rlvc_split_input *input,
                       uint32_t block) {
    search->block = block;
    memset(tally_of(input, 0), 0, block * sizeof(tally));
    enter(search, block > 0 ? COUNT : DONE);
}

static void begin(rlvc_successor_cursor *search, const rlvc_split_input *input,
                  const uint32_t *first, uint32_t pair, uint32_t end) {
    memset(search, 0, sizeof *search);
    search->view.percepts = input->replay->percept;
    search->view.percept_bytes = input->replay->percept_bytes;
    search->view.sample = input->space->rows.sample;
    search->view.count = first[end];
    search->pair = pair;
    search->end = end;
    search->at = first[pair];
    search->samples = first[end] - first[pair];
    /* Those that pass as influenced must have room together, for what lasts. */
    search->room = input->space->column_words / TALLY_WORDS;
    if (search->room > input->space->features_at_once)
        search->room = input->space->features_at_once;
}

void rlvc_influence_begin(rlvc_successor_cursor *search, const rlvc_split_input *input,
                          const uint32_t *first, uint32_t pairs, float log_level) {
    begin(search, input, first, 0, pairs);
    search->log_level = log_level - rlvc_successor_evidence_log_tests(input->domain->features_max);
    /* Of no samples there are no candidates to be asked for. */
    enter(search, search->view.count > 0 ? PROPOSE : DONE);
}

void rlvc_lasting_begin(rlvc_successor_cursor *search, const rlvc_split_input *input,
                        const uint32_t *first, uint32_t class_id, uint32_t features) {
    const uint32_t actions = input->space->actions, pair = class_id * actions;
    begin(search, input, first, pair, pair + actions);
    open_pairs(search, input, search->samples < input->min_samples ? 0 : features);
}

static rlvc_status propose(rlvc_successor_cursor *search, const rlvc_split_input *input) {
    const rlvc_domain *domain = input->domain;
    uint32_t written = 0;
    if (domain->candidates(domain->ctx, &search->view, search->first, search->room,
                           feature_of(search, input, 0), &written) != 0 ||
        written > search->room)
        return RLVC_E_CALLBACK;
    search->pair = 0;
    search->at = 0;
    open_pairs(search, input, written);
    return RLVC_OK;
}

/* Looks for feature `feature` in the sample at work and in what follows it. */
static rlvc_status count(rlvc_successor_cursor *search, const rlvc_split_input *input) {
    const rlvc_replay *replay = input->replay;
    const uint32_t slot = search->view.sample[search->at].slot;
    const void *feature = feature_of(search, input, search->feature);
    uint8_t now = 0, next = 0;
    uint32_t then = RLVC_ENDED;
    rlvc_status status = rlvc_split_input_exhibits(input, slot, feature, &now);
    if (status == RLVC_OK && rlvc_replay_linked(replay, slot)) {
        status = rlvc_split_input_exhibits(input, rlvc_replay_next(replay, slot), feature, &next);
        then = next != 0;
    }
    if (status != RLVC_OK)
        return status;
    tally_of(input, search->feature)->action.n[now != 0][then]++;
    if (++search->feature == search->block) {
        search->feature = 0;
        search->at++;
    }
    return RLVC_OK;
}

/* Fewer samples are not worth detecting at once. */
#define RUN_MIN 4u

/* How many samples from the one at work on, before `end`, have each a next percept, in the slot
 * after its own: with all percepts a slot further on, detect() sees what follows them. At most as
 * many as it is asked about at once. */
static uint32_t run_of(const rlvc_successor_cursor *search, const rlvc_split_input *input,
                       uint32_t end) {
    const rlvc_sample *sample = search->view.sample + search->at;
    const uint32_t left = end - search->at;
    const uint32_t most = left < RLVC_DETECT_SAMPLES ? left : RLVC_DETECT_SAMPLES;
    uint32_t n = 0;
    while (n < most && rlvc_replay_linked(input->replay, sample[n].slot) &&
           rlvc_replay_next(input->replay, sample[n].slot) != 0)
        n++;
    return n;
}

/* Features detected at once: half of what detect() takes, for the stack. */
#define RUN_FEATURES (RLVC_DETECT_FEATURES / 2u)

/* Of each feature in a run: how many samples exhibit it, how many are followed by it, and both. */
typedef struct in_run {
    uint8_t now[RLVC_DETECT_FEATURES], next[RLVC_DETECT_FEATURES], both[RLVC_DETECT_FEATURES];
} in_run;

/* Looks for features [first, first + m) of the block in the next n samples: a run. */
static rlvc_status detect_run(const rlvc_successor_cursor *search, const rlvc_split_input *input,
                              uint32_t n, uint32_t first, uint32_t m, in_run *found) {
    const rlvc_domain *domain = input->domain;
    const void *features = feature_of(search, input, first);
    const uint64_t asked = UINT64_MAX >> (64u - n);
    uint64_t now[RUN_FEATURES], next[RUN_FEATURES];
    rlvc_samples after = search->view;
    after.percepts += after.percept_bytes;
    if (domain->detect(domain->ctx, &search->view, search->at, n, features, m, now) != 0 ||
        domain->detect(domain->ctx, &after, search->at, n, features, m, next) != 0)
        return RLVC_E_CALLBACK;
    for (uint32_t j = 0; j < m; j++) {
        now[j] &= asked;
        next[j] &= asked;
    }
    rlvc_popcount_each(now, m, found->now + first);
    rlvc_popcount_each(next, m, found->next + first);
    for (uint32_t j = 0; j < m; j++)
        now[j] &= next[j];
    rlvc_popcount_each(now, m, found->both + first);
    return RLVC_OK;
}

/* Counts all features of the block in a run of n samples, or if a callback fails none. */
static rlvc_status count_run(rlvc_successor_cursor *search, const rlvc_split_input *input,
                             uint32_t n) {
    in_run found;
    for (uint32_t first = 0; first < search->block; first += RUN_FEATURES) {
        const uint32_t left = search->block - first;
        rlvc_status status =
            detect_run(search, input, n, first, left < RUN_FEATURES ? left : RUN_FEATURES, &found);
        if (status != RLVC_OK)
            return status;
    }
    for (uint32_t j = 0; j < search->block; j++) {
        rlvc_following *action = &tally_of(input, j)->action;
        const uint32_t now = found.now[j], next = found.next[j], both = found.both[j];
        action->n[1][1] += both;
        action->n[1][0] += now - both;
        action->n[0][1] += next - both;
        action->n[0][0] += n + both - now - next;
    }
    search->at += n;
    return RLVC_OK;
}

/* Counts on in the pair at work: where the domain detects many features at once and the budget is
 * large, in a run of samples; else one feature in one of them. The units are the same. */
static rlvc_status count_some(rlvc_successor_cursor *search, const rlvc_split_input *input,
                              uint32_t end, uint32_t budget, uint32_t *used) {
    const uint32_t each = 2u * search->block;
    if (RLVC_AT_ONCE && search->feature == 0 && budget >= each * RLVC_DETECT_SAMPLES &&
        input->domain->detect) {
        const uint32_t n = run_of(search, input, end);
        *used = each * n;
        if (n >= RUN_MIN)
            return count_run(search, input, n);
    }
    *used = 2;
    return count(search, input);
}

/* ------------------------------------------------------------------ evidence */

/* Weighs some features of the block; after the last, goes on to the next pair. */
static uint32_t weigh(rlvc_successor_cursor *search, const rlvc_split_input *input,
                      uint32_t budget) {
    uint32_t used = 0;
    int last = (search->pair + 1u) % input->space->actions == 0;
    for (; search->feature < search->block && budget - used >= WEIGH_UNITS; used += WEIGH_UNITS) {
        tally *feature = tally_of(input, search->feature++);
        if (search->log_level < 0.0f)
            rlvc_influence_add(&feature->evidence, &feature->action, last);
        else
            rlvc_lasting_add(&feature->evidence, &feature->action);
        memset(&feature->action, 0, sizeof feature->action);
    }
    if (search->feature == search->block)
        enter(search, ++search->pair < search->end ? COUNT : TEST);
    return used;
}

/* Takes a feature of the block that is influenced: it moves to those that passed. */
static void pass(rlvc_successor_cursor *search, const rlvc_split_input *input, uint32_t j) {
    memmove(feature_of(search, input, search->passed++), feature_of(search, input, j),
            input->space->feature_bytes);
}

static void close_block(rlvc_successor_cursor *search) {
    const int more = search->block == search->room;
    search->first += search->block;
    search->kept += search->passed;
    search->room -= search->passed;
    search->passed = 0;
    enter(search, more && search->room > 0 ? PROPOSE : DONE);
}

/* Tests a feature of the block. */
static void test(rlvc_successor_cursor *search, const rlvc_split_input *input) {
    const uint32_t j = search->feature++;
    const rlvc_successor_evidence *evidence = &tally_of(input, j)->evidence;
    const int influence = search->log_level < 0.0f;
    float log_p = rlvc_successor_evidence_log_p(evidence);
    if (influence && log_p < search->log_level)
        pass(search, input, j);
    if (!influence && log_p < search->log_p) {
        search->best = j;
        search->statistic = evidence->statistic;
        search->log_p = log_p;
    }
    if (search->feature < search->block)
        return;
    if (influence)
        close_block(search);
    else
        enter(search, DONE);
}

/* ------------------------------------------------------------------ the whole */

static rlvc_status advance(rlvc_successor_cursor *search, const rlvc_split_input *input,
                           const uint32_t *first, uint32_t budget, uint32_t *used) {
    switch (search->phase) {
    case PROPOSE:
        *used = 1;
        return propose(search, input);
    case COUNT:
        if (search->at < first[search->pair + 1u])
            return count_some(search, input, first[search->pair + 1u], budget, used);
        *used = 2;
        enter(search, WEIGH);
        return RLVC_OK;
    case WEIGH:
        *used = weigh(search, input, budget);
        return RLVC_OK;
    default:
        *used = RLVC_TEST_UNITS;
        test(search, input);
        return RLVC_OK;
    }
}

rlvc_status rlvc_successor_search_step(rlvc_successor_cursor *search, const rlvc_split_input *input,
                                       const uint32_t *first, uint32_t budget, uint32_t *used) {
    *used = 0;
    while (!search->done && budget - *used >= RLVC_BUDGET_MIN) {
        uint32_t units = 0;
        rlvc_status status = advance(search, input, first, budget - *used, &units);
        if (status != RLVC_OK)
            return status;
        *used += units;
    }
    return RLVC_OK;
}

rlvc_status rlvc_successor_search_single(rlvc_successor_cursor *search,
                                         const rlvc_split_input *input, const uint32_t *first) {
    uint32_t used = 0;
    return advance(search, input, first, WEIGH_UNITS, &used);
}

void rlvc_successor_search_mark(const rlvc_successor_cursor *search, uint32_t word[5]) {
    word[0] = search->phase;
    word[1] = search->first;
    word[2] = search->pair;
    word[3] = search->at;
    word[4] = search->feature;
}

const void *rlvc_successor_search_result(const rlvc_successor_cursor *search,
                                         const rlvc_workspace *space, rlvc_split *about) {
    if (!(search->log_p < 0.0f))
        return NULL;
    about->action = space->actions + 1u;
    about->samples = search->samples;
    about->score = search->statistic / (float)search->samples;
    about->log_tests = rlvc_successor_evidence_log_tests(search->block);
    about->log_p = search->log_p + about->log_tests;
    return rlvc_workspace_feature(space, search->best);
}
