/* SPDX-License-Identifier: MIT */
/* The search for the best split of a group of samples: see split.h. */
#include "split.h"

#include "real.h"
#include "rlvc/chi2.h"
#include "score.h"
#include <string.h>

enum { SORT, MARK, PROPOSE, DETECT, SCAN, ASK, ANSWER, DONE };

void rlvc_workspace_carve(rlvc_workspace *space, rlvc_arena *arena, const rlvc_config *config,
                          uint32_t feature_bytes) {
    uint64_t words = ((uint64_t)config->capacity + 63u) / 64u;
    uint64_t columns = (words | 1u) * config->features_at_once * sizeof *space->columns;
    if (columns < RLVC_SORT_SCRATCH_BYTES)
        columns = RLVC_SORT_SCRATCH_BYTES;
    space->sample = rlvc_arena_carve(arena, config->capacity, sizeof *space->sample);
    space->cuts = rlvc_arena_carve(arena, words + 1u, sizeof *space->cuts);
    space->columns = rlvc_arena_carve(arena, 1, columns);
    space->features = rlvc_arena_carve(arena, config->features_at_once, feature_bytes);
    space->winner = rlvc_arena_carve(arena, 1, feature_bytes);
    space->chosen = rlvc_arena_carve(arena, 1, feature_bytes);
    space->feature_bytes = feature_bytes;
    space->features_at_once = config->features_at_once;
}

static uint32_t words_of(const rlvc_search *search) {
    return (search->view.count + 63u) / 64u;
}

/* Column j of the block. An odd number of words apart, so that the words of one place in all columns do
 * not fall on the same lines of a cache. */
static uint64_t *column(const rlvc_search *search, const rlvc_workspace *space, uint32_t j) {
    return space->columns + (size_t)(words_of(search) | 1u) * j;
}

static void enter(rlvc_search *search, uint8_t phase) {
    search->phase = phase;
    search->at = 0;
    search->done = phase == DONE;
}

void rlvc_search_begin(rlvc_search *search, const rlvc_workspace *space, const rlvc_replay *replay,
                       uint32_t begin, uint32_t end) {
    search->view.percepts = replay->percept;
    search->view.percept_bytes = replay->percept_bytes;
    search->view.sample = space->sample + begin;
    search->view.count = end - begin;
    search->best.score = 0.0f;
    search->tests = 0;
    search->cuts = 0;
    search->first = 0;
    search->block = 0;
    enter(search, SORT);
    rlvc_sort_begin(&search->inner.sort, space->sample + begin, end - begin, space->columns);
}

/* Marks whether a cutpoint lies before sample `at`. Targets are gathered into clusters from the lowest up
 * as aliasing.h tells them apart. */
static void mark(rlvc_search *search, const rlvc_workspace *space, const rlvc_aliasing *aliasing,
                 const rlvc_domain *domain) {
    uint32_t at = search->at;
    if (at == search->view.count) {
        enter(search, search->cuts == 0 ? DONE : domain->oracle ? ASK : PROPOSE);
        return;
    }
    uint32_t key = search->view.sample[at].key;
    if (at % 64u == 0)
        space->cuts[at / 64u] = 0;
    if (at == 0) {
        search->lowest = key;
    } else if (rlvc_aliasing_distinct(aliasing, search->lowest, key)) {
        space->cuts[at / 64u] |= (uint64_t)1 << at % 64u;
        search->cuts++;
        search->lowest = key;
    }
    search->at++;
}

/* Asks for the next block of candidates. */
static rlvc_status propose(rlvc_search *search, const rlvc_workspace *space,
                           const rlvc_domain *domain) {
    uint32_t written = 0;
    if (domain->candidates(domain->ctx, &search->view, search->first, space->features_at_once,
                           space->features, &written) != 0 ||
        written > space->features_at_once)
        return RLVC_E_CALLBACK;
    search->block = written;
    search->column = 0;
    enter(search, written == 0 ? DONE : DETECT);
    return RLVC_OK;
}

/* 64 samples and the whole block by the domain's batch detector. */
static rlvc_status detect_batch(rlvc_search *search, const rlvc_workspace *space,
                                const rlvc_domain *domain, uint32_t *used) {
    uint64_t bits[RLVC_DETECT_FEATURES];
    uint32_t left = search->view.count - search->at;
    uint32_t n = left < RLVC_DETECT_SAMPLES ? left : RLVC_DETECT_SAMPLES;
    if (domain->detect(domain->ctx, &search->view, search->at, n, space->features, search->block,
                       bits) != 0)
        return RLVC_E_CALLBACK;
    for (uint32_t j = 0; j < search->block; j++)
        column(search, space, j)[search->at / 64u] = bits[j];
    search->at += n;
    *used = n;
    return RLVC_OK;
}

/* One sample and the whole block by the feature detector. */
static rlvc_status detect_each(rlvc_search *search, const rlvc_workspace *space,
                               const rlvc_domain *domain, uint32_t *used) {
    const void *percept = rlvc_samples_percept(&search->view, search->at);
    uint64_t bit = (uint64_t)1 << search->at % 64u;
    for (uint32_t j = 0; j < search->block; j++) {
        uint8_t present = 0;
        const void *feature = space->features + (size_t)j * space->feature_bytes;
        if (domain->exhibits(domain->ctx, percept, feature, &present) != 0)
            return RLVC_E_CALLBACK;
        uint64_t *word = &column(search, space, j)[search->at / 64u];
        *word = (search->at % 64u == 0 ? 0 : *word & ~bit) | (present ? bit : 0);
    }
    search->at++;
    *used = search->block;
    return RLVC_OK;
}

/* The column that search->column names is at hand: begins to scan it. */
static void open_column(rlvc_search *search, const rlvc_workspace *space, uint8_t score) {
    rlvc_scan_begin(&search->inner.scan, column(search, space, search->column), space->cuts,
                    search->view.count, score, search->best.score);
}

static rlvc_status detect(rlvc_search *search, const rlvc_workspace *space,
                          const rlvc_domain *domain, uint8_t score, uint32_t *used) {
    rlvc_status status = domain->detect ? detect_batch(search, space, domain, used)
                                        : detect_each(search, space, domain, used);
    if (status == RLVC_OK && search->at == search->view.count) {
        open_column(search, space, score);
        enter(search, SCAN);
    }
    return status;
}

static int divides(const rlvc_search *search, uint32_t present) {
    return present > 0 && present < search->view.count;
}

/* Takes the result of one column and goes on to the next, or to the next block. */
static void close_column(rlvc_search *search, const rlvc_workspace *space, uint8_t score) {
    const rlvc_cut *found = &search->inner.scan.best;
    if (divides(search, found->present))
        search->tests += search->cuts;
    if (found->score > search->best.score) {
        search->best = *found;
        memcpy(space->winner, space->features + (size_t)search->column * space->feature_bytes,
               space->feature_bytes);
    }
    if (++search->column < search->block) {
        open_column(search, space, score);
        return;
    }
    search->first += search->block;
    enter(search, search->block < space->features_at_once ? DONE : PROPOSE);
}

/* Asks the domain's own oracle about the next cutpoint. */
static rlvc_status ask(rlvc_search *search, const rlvc_workspace *space, const rlvc_domain *domain) {
    uint32_t at = search->at;
    if (at == search->view.count) {
        enter(search, DONE);
        return RLVC_OK;
    }
    if (space->cuts[at / 64u] >> at % 64u & 1u) {
        rlvc_answer *answer = &search->inner.answer;
        answer->considered = 0;
        if (domain->oracle(domain->ctx, &search->view, at, space->features, &answer->considered) !=
            0)
            return RLVC_E_CALLBACK;
        if (answer->considered > 0) {
            answer->at = answer->present_below = answer->present = 0;
            search->phase = ANSWER;
            return RLVC_OK;
        }
    }
    search->at++;
    return RLVC_OK;
}

/* Looks for the oracle's feature in one sample; after the last, scores it at the oracle's cutpoint. */
static rlvc_status answer(rlvc_search *search, const rlvc_workspace *space,
                          const rlvc_domain *domain, uint8_t score) {
    rlvc_answer *answer = &search->inner.answer;
    uint32_t count = search->view.count, below = search->at;
    if (answer->at < count) {
        uint8_t present = 0;
        const void *percept = rlvc_samples_percept(&search->view, answer->at);
        if (domain->exhibits(domain->ctx, percept, space->features, &present) != 0)
            return RLVC_E_CALLBACK;
        answer->present += present != 0;
        answer->present_below += present != 0 && answer->at < below;
        answer->at++;
        return RLVC_OK;
    }
    search->phase = ASK;
    search->at++;
    if (!divides(search, answer->present))
        return RLVC_OK;
    search->tests += answer->considered;
    uint32_t above = answer->present - answer->present_below;
    rlvc_cut cut = {0.0f, below, answer->present_below, answer->present};
    cut.score = rlvc_score(score, cut.present_below, below - cut.present_below, above,
                           count - below - above);
    if (cut.score > search->best.score) {
        search->best = cut;
        memcpy(space->winner, space->features, space->feature_bytes);
    }
    return RLVC_OK;
}

/* One elementary step of the phase. */
static rlvc_status advance(rlvc_search *search, const rlvc_workspace *space,
                           const rlvc_aliasing *aliasing, const rlvc_domain *domain, uint8_t score,
                           uint32_t budget, uint32_t *used) {
    *used = 1;
    switch (search->phase) {
    case SORT:
        *used = rlvc_sort_step(&search->inner.sort, budget);
        if (search->inner.sort.done)
            enter(search, MARK);
        return RLVC_OK;
    case MARK:
        mark(search, space, aliasing, domain);
        return RLVC_OK;
    case PROPOSE:
        return propose(search, space, domain);
    case DETECT:
        return detect(search, space, domain, score, used);
    case SCAN:
        *used = rlvc_scan_step(&search->inner.scan, budget);
        if (search->inner.scan.done)
            close_column(search, space, score);
        return RLVC_OK;
    case ASK:
        return ask(search, space, domain);
    default:
        return answer(search, space, domain, score);
    }
}

rlvc_status rlvc_search_step(rlvc_search *search, const rlvc_workspace *space,
                             const rlvc_aliasing *aliasing, const rlvc_domain *domain, uint8_t score,
                             uint32_t budget, uint32_t *used) {
    *used = 0;
    while (!search->done && budget - *used >= RLVC_BUDGET_MIN) {
        uint32_t units = 0;
        rlvc_status status =
            advance(search, space, aliasing, domain, score, budget - *used, &units);
        if (status != RLVC_OK)
            return status;
        *used += units;
    }
    return RLVC_OK;
}

int rlvc_search_result(const rlvc_search *search, rlvc_split *about) {
    const rlvc_cut *best = &search->best;
    if (!(best->score > 0.0f))
        return 0;
    uint32_t count = search->view.count;
    uint32_t above = best->present - best->present_below;
    float statistic = 0.0f, log_p = 0.0f;
    (void)rlvc_chi2_table(best->present_below, best->below - best->present_below, above,
                          count - best->below - above, &statistic);
    (void)rlvc_chi2_survival(statistic, 1, NULL, &log_p);
    log_p += rlvc_ln((float)search->tests);
    about->samples = count;
    about->tests = search->tests < UINT32_MAX ? (uint32_t)search->tests : UINT32_MAX;
    about->score = best->score;
    about->log_p = log_p < 0.0f ? log_p : 0.0f;
    return 1;
}
