/* SPDX-License-Identifier: MIT */
/* The search for the best split of a class: see split_search.h.
 *
 * Phases: each group is sorted (SORT) and its cutpoints marked (MARK). Then, a block of candidates
 * at a time (PROPOSE), each group that takes part has the block's columns made (DETECT) and scanned
 * (SCAN); a block that all groups have seen is closed (CLOSE). With the domain's own oracle, each
 * cutpoint of each group is put to it (ASK) and its feature counted (ANSWER). At the end the
 * winners get their p-values (TEST_PER_ACTION, TEST_POOLED), and what the split is worth is found
 * in each group that takes part (EFFECT), if that is asked for. */
#include "rlvc/float_rules.h"

#include "split_search.h"

#include "../base/popcount.h"
#include "../base/solver_select.h"
#include "../stats/score.h"
#include <string.h>

/* Decided when the library is built, where it has one score. */
#define BY_RANKS(input) (RLVC_HAS_SCORE(RLVC_SCORE_RANKS) && (input)->by_ranks)

enum {
    SORT,
    MARK,
    PROPOSE,
    DETECT,
    SCAN,
    CLOSE,
    ASK,
    ANSWER,
    TEST_PER_ACTION,
    TEST_POOLED,
    EFFECT,
    DONE = 12 /* a snapshot may hold it; 11 is not in use */
};

void rlvc_workspace_carve(rlvc_workspace *space, rlvc_arena *arena, const rlvc_config *config,
                          uint32_t feature_bytes) {
    /* All slots hold an interaction when the newest terminated. */
    uint32_t slots = config->capacity + 1u;
    uint32_t words = (slots + 63u * config->actions) / 64u;
    uint32_t columns = (words | 1u) * config->features_at_once; /* words of all columns */
    if (columns < RLVC_SORT_SCRATCH_BYTES / sizeof *space->columns)
        columns = RLVC_SORT_SCRATCH_BYTES / sizeof *space->columns;
    space->rows.sample = rlvc_arena_carve(arena, slots, sizeof *space->rows.sample);
    space->cutpoints = rlvc_arena_carve(arena, words, sizeof *space->cutpoints);
    space->columns = rlvc_arena_carve(arena, columns, sizeof *space->columns);
    space->column_words = columns;
    space->features = rlvc_arena_carve(arena, config->features_at_once, feature_bytes);
    space->per_action = rlvc_arena_carve(arena, 1, feature_bytes);
    space->pooled = rlvc_arena_carve(arena, 1, feature_bytes);
    space->of_action.group =
        rlvc_arena_carve(arena, config->actions, sizeof *space->of_action.group);
    space->pool = rlvc_arena_carve(arena, config->features_at_once, sizeof *space->pool);
    if (RLVC_CLASSES_MAX > RLVC_CLASSES_SMALL)
        space->remembers = (uint8_t)(config->classes > RLVC_CLASSES_SMALL);
    if (rlvc_workspace_remembers(space)) {
        space->in_vain.order =
            rlvc_arena_carve(arena, config->classes, sizeof *space->in_vain.order);
        space->in_vain.units =
            rlvc_arena_carve(arena, config->classes, sizeof *space->in_vain.units);
    }
    space->feature_bytes = feature_bytes;
    space->features_at_once = config->features_at_once;
    space->actions = config->actions;
}

static void enter(rlvc_split_cursor *search, uint8_t phase) {
    search->phase = phase;
    search->at = 0;
    search->done = phase == DONE;
}

static uint32_t size_of(const rlvc_group *group) {
    return group->end - group->begin;
}

/* The group at work as the domain's oracle sees it. */
static rlvc_samples view_of(const rlvc_split_cursor *search, const rlvc_group *group) {
    rlvc_samples view = search->view;
    view.sample += group->begin;
    view.count = size_of(group);
    return view;
}

static void open_sort(rlvc_split_cursor *search, const rlvc_workspace *space) {
    const rlvc_group *group = &space->of_action.group[search->action];
    rlvc_sample *sample =
        space->rows.sample + (search->view.sample - space->rows.sample) + group->begin;
    rlvc_sort_begin(&search->inner.sort, sample, size_of(group), space->columns);
    enter(search, SORT);
}

rlvc_status rlvc_split_input_exhibits(const rlvc_split_input *input, uint32_t slot,
                                      const void *feature, uint8_t *present) {
    const rlvc_domain *domain = input->domain;
    *present = 0;
    return domain->exhibits(domain->ctx, rlvc_replay_percept(input->replay, slot), feature,
                            present) == 0
               ? RLVC_OK
               : RLVC_E_CALLBACK;
}

rlvc_status rlvc_split_input_detect(const rlvc_split_input *input, const rlvc_samples *view,
                                    uint32_t *at, const unsigned char *features, uint32_t block,
                                    uint64_t *word, uint32_t stride, uint32_t *used) {
    const rlvc_domain *domain = input->domain;
    uint64_t bits[RLVC_DETECT_FEATURES];
    uint32_t left = view->count - *at;
    uint32_t n = left < RLVC_DETECT_SAMPLES ? left : RLVC_DETECT_SAMPLES;
    if (!RLVC_HAS_OTHER_DOMAINS || domain->detect) {
        if (domain->detect(domain->ctx, view, *at, n, features, block, bits) != 0)
            return RLVC_E_CALLBACK;
        for (uint32_t j = 0; j < block; j++) /* a bit beyond the samples would be counted */
            word[(size_t)j * stride] = bits[j] & UINT64_MAX >> (64u - n);
    } else {
        n = 1;
        for (uint32_t j = 0; j < block; j++) {
            uint8_t present;
            rlvc_status status = rlvc_split_input_exhibits(
                input, view->sample[*at].slot, features + (size_t)j * input->space->feature_bytes,
                &present);
            if (status != RLVC_OK)
                return status;
            rlvc_bit_append(word + (size_t)j * stride, *at % 64u, present);
        }
    }
    *used = !RLVC_HAS_OTHER_DOMAINS || domain->detect ? n : block;
    *at += n;
    return RLVC_OK;
}

void rlvc_split_search_begin(rlvc_split_cursor *search, const rlvc_split_input *input,
                             const uint32_t *first) {
    const rlvc_workspace *space = input->space;
    memset(search, 0, sizeof *search);
    search->view.percepts = input->replay->percept;
    search->view.percept_bytes = input->replay->percept_bytes;
    search->view.sample = space->rows.sample + first[0];
    search->view.count = first[space->actions] - first[0];
    for (uint32_t a = 0; a < space->actions; a++) {
        rlvc_group *group = &space->of_action.group[a];
        group->begin = first[a] - first[0];
        group->end = first[a + 1u] - first[0];
        group->cuts = 0;
        group->word = search->words;
        search->words += (size_of(group) + 63u) / 64u;
    }
    if (search->view.count < input->min_samples)
        enter(search, DONE);
    else
        open_sort(search, space);
}

/* ------------------------------------------------------------------ cutpoints */

/* After all groups are marked: begins to look for features, if anything could be told apart. */
static void end_marking(rlvc_split_cursor *search, const rlvc_split_input *input) {
    search->action = 0;
    if (search->evidence.groups == 0 || search->evidence.samples < input->min_samples)
        enter(search, DONE);
    else
        enter(search, RLVC_HAS_OWN_ORACLE && input->domain->oracle ? ASK : PROPOSE);
}

/* Goes on with the hash of the order, which tells groups by their slots. */
static void take_down(rlvc_split_cursor *search, uint32_t slot, int distinct) {
    search->order = (search->order ^ (2u * (uint64_t)slot + 1u + (uint64_t)(distinct != 0))) *
                    0x9E3779B97F4A7C15u;
    search->order ^= search->order >> 32;
}

/* Goes on to the next group. */
static void close_group(rlvc_split_cursor *search, const rlvc_split_input *input) {
    rlvc_group *group = &input->space->of_action.group[search->action];
    if (BY_RANKS(input) && group->cuts > 0)
        group->cuts = 1; /* a feature makes one test, wherever the cutpoints */
    rlvc_evidence_group(&search->evidence, size_of(group), group->cuts);
    if (++search->action == input->space->actions)
        end_marking(search, input);
    else
        open_sort(search, input->space);
}

/* Marks where cutpoints lie in the group at work, for up to `budget` samples. Targets are gathered
 * into clusters from the lowest up; targets.h says which are distinct. */
static uint32_t mark(rlvc_split_cursor *search, const rlvc_split_input *input, uint32_t budget) {
    rlvc_group *group = &input->space->of_action.group[search->action];
    const rlvc_sample *sample = search->view.sample + group->begin;
    uint64_t *cuts = input->space->cutpoints + group->word;
    uint32_t from = search->at, left = size_of(group) - from;
    uint32_t to = from + (left < budget ? left : budget);
    for (uint32_t at = from; at < to; at++) {
        int distinct =
            at > 0 && rlvc_target_distinct(input->aliasing, search->lowest, sample[at].key);
        rlvc_bit_append(cuts, at, distinct);
        group->cuts += (uint32_t)distinct;
        if (rlvc_workspace_remembers(input->space))
            take_down(search, sample[at].slot, distinct);
        if (at == 0 || distinct)
            search->lowest = sample[at].key;
    }
    search->at = to;
    if (to == size_of(group))
        close_group(search, input);
    return to - from;
}

/* ------------------------------------------------------------------ the default oracle */

/* Goes to the first group from search->action on that takes part; at the end, to the phase
 * `then`. */
static void next_group(rlvc_split_cursor *search, const rlvc_workspace *space, uint8_t phase,
                       uint8_t then) {
    while (search->action < space->actions && space->of_action.group[search->action].cuts == 0)
        search->action++;
    search->column = 0;
    enter(search, search->action < space->actions ? phase : then);
}

/* Asks for the next block of candidates. */
static rlvc_status propose(rlvc_split_cursor *search, const rlvc_split_input *input) {
    static const rlvc_pooled nothing = {0.0f, 0.0f, 0.0f, 0};
    const rlvc_workspace *space = input->space;
    const rlvc_domain *domain = input->domain;
    uint32_t written = 0;
    if (domain->candidates(domain->ctx, &search->view, search->first, space->features_at_once,
                           space->features, &written) != 0 ||
        written > space->features_at_once)
        return RLVC_E_CALLBACK;
    search->block = written;
    search->action = 0;
    for (uint32_t j = 0; j < written; j++)
        space->pool[j] = nothing;
    if (written == 0)
        enter(search, TEST_PER_ACTION);
    else
        next_group(search, space, DETECT, DONE);
    return RLVC_OK;
}

/* Begins to scan the column that search->column names. Where there is but one group, a column that
 * cannot beat the best so far need not be scanned to the end; else its own best counts, for the
 * sum. */
static void open_column(rlvc_split_cursor *search, const rlvc_split_input *input,
                        const rlvc_group *group) {
    const rlvc_workspace *space = input->space;
    rlvc_cutpoint_begin(&search->inner.scan,
                        rlvc_workspace_column(space, search->words, search->column) + group->word,
                        space->cutpoints + group->word, size_of(group), input->by_ranks,
                        search->evidence.groups == 1 ? search->evidence.per_action.score : 0.0f);
}

static rlvc_status detect(rlvc_split_cursor *search, const rlvc_split_input *input,
                          uint32_t *used) {
    const rlvc_workspace *space = input->space;
    const rlvc_group *group = &space->of_action.group[search->action];
    const rlvc_samples view = view_of(search, group);
    rlvc_status status = rlvc_split_input_detect(
        input, &view, &search->at, space->features, search->block,
        space->columns + group->word + search->at / 64u, search->words | 1u, used);
    if (status == RLVC_OK && search->at == size_of(group)) {
        open_column(search, input, group);
        enter(search, SCAN);
    }
    return status;
}

/* ------------------------------------------------------------------ evidence */

/* Weighs a cutpoint of the group at work: its table, and the evidence. */
static rlvc_per_action weigh(const rlvc_split_cursor *search, const rlvc_split_input *input,
                             const rlvc_cutpoint *cut, uint32_t count) {
    uint32_t above = cut->present - cut->present_below;
    const rlvc_table table = {cut->present_below, cut->below - cut->present_below, above,
                              count - cut->below - above};
    return rlvc_evidence_weigh(&table, cut->score, search->action, BY_RANKS(input));
}

static void keep_best_per_action(rlvc_split_cursor *search, const rlvc_workspace *space,
                                 const rlvc_per_action *found, uint32_t j) {
    if (rlvc_evidence_keep(&search->evidence, found))
        memcpy(space->per_action, rlvc_workspace_feature(space, j), space->feature_bytes);
}

/* Takes the result of one column and goes on to the next, or to the next group. */
static void close_column(rlvc_split_cursor *search, const rlvc_split_input *input) {
    const rlvc_workspace *space = input->space;
    const rlvc_group *group = &space->of_action.group[search->action];
    const rlvc_cutpoint *found = &search->inner.scan.best;
    rlvc_pooled *pool = &space->pool[search->column];
    if (found->present > 0 && found->present < size_of(group))
        rlvc_evidence_divides(pool, group->cuts);
    if (found->score > 0.0f) {
        rlvc_per_action weighed = weigh(search, input, found, size_of(group));
        rlvc_evidence_pool(pool, &weighed, BY_RANKS(input));
        keep_best_per_action(search, space, &weighed, search->column);
    }
    if (++search->column < search->block) {
        open_column(search, input, group);
        return;
    }
    search->action++;
    next_group(search, space, DETECT, CLOSE);
}

/* All groups have seen the block: looks at feature `column` of it, together. A unit each. */
static void close_feature(rlvc_split_cursor *search, const rlvc_workspace *space) {
    if (rlvc_evidence_close(&search->evidence, &space->pool[search->column]))
        memcpy(space->pooled, rlvc_workspace_feature(space, search->column), space->feature_bytes);
    if (++search->column < search->block)
        return;
    search->first += search->block;
    enter(search, search->block < space->features_at_once ? TEST_PER_ACTION : PROPOSE);
}

/* ------------------------------------------------------------------ the domain's own oracle */

/* Puts the next cutpoint of the group at work to the oracle. */
static rlvc_status ask(rlvc_split_cursor *search, const rlvc_split_input *input) {
    const rlvc_workspace *space = input->space;
    const rlvc_domain *domain = input->domain;
    const rlvc_group *group = &space->of_action.group[search->action];
    uint32_t at = search->at;
    if (group->cuts == 0 || at == size_of(group)) {
        search->action++;
        next_group(search, space, ASK, TEST_PER_ACTION);
        return RLVC_OK;
    }
    if (space->cutpoints[group->word + at / 64u] >> at % 64u & 1u) {
        static const rlvc_answer nothing = {0, 0, 0, 0};
        rlvc_samples view = view_of(search, group);
        rlvc_answer *answer = &search->inner.answer;
        *answer = nothing;
        if (domain->oracle(domain->ctx, &view, at, space->features, &answer->considered) != 0)
            return RLVC_E_CALLBACK;
        if (answer->considered > 0) {
            search->phase = ANSWER;
            return RLVC_OK;
        }
    }
    search->at++;
    return RLVC_OK;
}

/* Looks for the oracle's feature in one sample; after the last, weighs it at the oracle's
 * cutpoint. */
static rlvc_status answer(rlvc_split_cursor *search, const rlvc_split_input *input) {
    const rlvc_workspace *space = input->space;
    const rlvc_group *group = &space->of_action.group[search->action];
    rlvc_answer *answer = &search->inner.answer;
    uint32_t count = size_of(group), below = search->at;
    if (answer->at < count) {
        uint8_t present;
        uint32_t slot = search->view.sample[group->begin + answer->at].slot;
        rlvc_status status = rlvc_split_input_exhibits(input, slot, space->features, &present);
        if (status != RLVC_OK)
            return status;
        answer->present += present != 0;
        answer->present_below += present != 0 && answer->at < below;
        answer->at++;
        return RLVC_OK;
    }
    search->phase = ASK;
    search->at++;
    if (answer->present == 0 || answer->present == count)
        return RLVC_OK;
    search->evidence.features += answer->considered;
    uint32_t above = answer->present - answer->present_below;
    rlvc_cutpoint cut = {0.0f, below, answer->present_below, answer->present};
    cut.score =
        rlvc_score(cut.present_below, below - cut.present_below, above, count - below - above);
    rlvc_per_action weighed = weigh(search, input, &cut, count);
    keep_best_per_action(search, space, &weighed, 0);
    return RLVC_OK;
}

static rlvc_status consult(rlvc_split_cursor *search, const rlvc_split_input *input) {
    return search->phase == ASK ? ask(search, input) : answer(search, input);
}

/* ------------------------------------------------------------------ the whole */

/* The p-values are there. */
static void close_test(rlvc_split_cursor *search, const rlvc_split_input *input) {
    if (!RLVC_HAS_EFFECT || !(input->smallest_effect > 0.0f)) {
        enter(search, DONE);
        return;
    }
    memset(&search->inner.effect, 0, sizeof search->inner.effect);
    search->action = 0;
    next_group(search, input->space, EFFECT, DONE);
}

/* Looks for the winner in the next sample of the group at work, for what it is worth; after the
 * last group drops it if that is too little. */
static rlvc_status measure(rlvc_split_cursor *search, const rlvc_split_input *input) {
    const rlvc_group *group = &input->space->of_action.group[search->action];
    rlvc_effect *effect = &search->inner.effect;
    if (search->at < size_of(group)) {
        const rlvc_sample *sample = &search->view.sample[group->begin + search->at];
        rlvc_split about;
        uint8_t present;
        rlvc_status status = rlvc_split_input_exhibits(
            input, sample->slot, rlvc_split_search_result(search, input->space, &about), &present);
        if (status != RLVC_OK)
            return status;
        rlvc_effect_add(effect, sample->key, present == 0, present != 0);
        search->at++;
        return RLVC_OK;
    }
    rlvc_effect_close(effect, input->smallest_effect, input->min_samples);
    search->action++;
    next_group(search, input->space, EFFECT, DONE);
    if (search->done && !effect->matters)
        search->evidence.per_action.evidence = 0.0f;
    return RLVC_OK;
}

/* Finds the p-value of one of the winners, if there are any. */
static uint32_t test(rlvc_split_cursor *search, const rlvc_split_input *input) {
    rlvc_evidence *evidence = &search->evidence;
    if (!rlvc_evidence_found(evidence)) {
        enter(search, DONE);
        return 1;
    }
    if (search->phase == TEST_PER_ACTION) {
        rlvc_evidence_test_per_action(evidence, BY_RANKS(input));
        if (rlvc_evidence_is_pooled(evidence))
            enter(search, TEST_POOLED);
        else
            close_test(search, input);
    } else {
        rlvc_evidence_test_pooled(evidence);
        close_test(search, input);
    }
    return RLVC_TEST_UNITS;
}

/* A step of a phase that looks at one sample or asks about one. */
static rlvc_status one_sample(rlvc_split_cursor *search, const rlvc_split_input *input) {
    if (RLVC_HAS_EFFECT && search->phase == EFFECT)
        return measure(search, input);
    return RLVC_HAS_OWN_ORACLE ? consult(search, input) : RLVC_OK;
}

/* One elementary step of the phase. */
static rlvc_status advance(rlvc_split_cursor *search, const rlvc_split_input *input,
                           uint32_t budget, uint32_t *used) {
    *used = 1;
    switch (search->phase) {
    case SORT:
        *used = rlvc_sort_step(&search->inner.sort, budget);
        if (search->inner.sort.done)
            enter(search, MARK);
        return RLVC_OK;
    case MARK:
        *used = mark(search, input, budget);
        return RLVC_OK;
    case PROPOSE:
        return propose(search, input);
    case DETECT:
        return detect(search, input, used);
    case SCAN:
        *used = rlvc_cutpoint_step(&search->inner.scan, budget);
        if (search->inner.scan.done)
            close_column(search, input);
        return RLVC_OK;
    case CLOSE:
        close_feature(search, input->space);
        return RLVC_OK;
    case ASK:
    case ANSWER:
    case EFFECT:
        return one_sample(search, input);
    default:
        *used = test(search, input);
        return RLVC_OK;
    }
}

/* The units that the phase needs to get on: the steps of some are not divided further. */
static uint32_t needed(const rlvc_split_cursor *search) {
    int divided = search->phase == MARK || search->phase == PROPOSE || search->phase == CLOSE ||
                  search->phase == ASK || search->phase == ANSWER ||
                  (RLVC_HAS_EFFECT && search->phase == EFFECT);
    return divided ? 1u : RLVC_BUDGET_MIN;
}

int rlvc_split_search_is_sorted(const rlvc_split_cursor *search) {
    return search->phase == PROPOSE && search->first == 0;
}

rlvc_status rlvc_split_search_step(rlvc_split_cursor *search, const rlvc_split_input *input,
                                   uint32_t budget, uint32_t *used) {
    *used = 0;
    while (!search->done && budget - *used >= needed(search)) {
        uint32_t units = 0;
        const int unsorted = search->phase == MARK;
        rlvc_status status = advance(search, input, budget - *used, &units);
        if (status != RLVC_OK)
            return status;
        *used += units;
        if (rlvc_workspace_remembers(input->space) && unsorted &&
            rlvc_split_search_is_sorted(search) && budget - *used >= RLVC_BUDGET_MIN)
            break; /* the caller goes on at once */
    }
    return RLVC_OK;
}

void rlvc_split_search_sort(rlvc_split_cursor *search, const rlvc_split_input *input,
                            const uint32_t *first) {
    rlvc_split_search_begin(search, input, first);
    while (search->phase <= MARK) {
        uint32_t used; /* no callback is called, so that none fails */
        (void)advance(search, input, RLVC_BUDGET_UNBOUNDED, &used);
    }
}

rlvc_status rlvc_split_search_single(rlvc_split_cursor *search, const rlvc_split_input *input) {
    uint32_t used = 0;
    if (search->phase == SORT && !search->inner.sort.done) {
        rlvc_sort_single(&search->inner.sort);
        if (search->inner.sort.done)
            enter(search, MARK);
    } else if (search->phase == MARK) {
        (void)mark(search, input, 1);
    } else if (search->phase == SCAN) {
        rlvc_cutpoint_single(&search->inner.scan);
        if (search->inner.scan.done)
            close_column(search, input);
    } else {
        return advance(search, input, RLVC_BUDGET_MIN, &used);
    }
    return RLVC_OK;
}

void rlvc_split_search_mark(const rlvc_split_cursor *search, uint32_t word[10]) {
    word[0] = search->phase;
    word[1] = search->action;
    word[2] = search->at;
    word[3] = search->first;
    word[4] = search->column;
    if (search->phase == SORT)
        rlvc_sort_mark(&search->inner.sort, word + 5);
    else if (search->phase == SCAN)
        rlvc_cutpoint_mark(&search->inner.scan, word + 5);
    else if (search->phase == ANSWER)
        word[5] = search->inner.answer.at;
}

const void *rlvc_split_search_result(const rlvc_split_cursor *search, const rlvc_workspace *space,
                                     rlvc_split *about) {
    if (!rlvc_evidence_found(&search->evidence))
        return NULL;
    rlvc_evidence_result(&search->evidence, space->actions, about);
    return about->action == space->actions ? space->pooled : space->per_action;
}
