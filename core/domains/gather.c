/* SPDX-License-Identifier: MIT */
/* A candidate begins as the vectors of one percept of a run of equal targets: it has of the thing
 * that is seen, but also of what is behind it, or before it. The percepts of the run that score
 * most by it show the same thing, mostly. Of their vectors those are kept that are common to them
 * and rare in percepts with other targets; and once more with these.
 *
 * How much of a bag is needed is then chosen by the targets, too: of the run many should have it,
 * of the others few. Where nothing lies between them, it is put near the others, since of a thing
 * seen in other ways something is missing. A percept whose vectors are in the bag has these for
 * certain, which a new one has not: they do not count in its score.
 *
 * What is chosen so by targets fits them, even if they are noise. So only every second sample is
 * looked at, and the others must bear the candidate out, or it is refused. What they bear out is
 * gathered once more, from all samples. */
#include "rlvc/float_rules.h"

#include "gather.h"

#include "bag.h"
#include "nearest.h"
#include "rlvc/chi2.h"
#include "runs.h"

#include <string.h>

#define ROUNDS 2u
#define POOL 128u /* vectors among which those of a bag are chosen */
#define NEAR 32u  /* percepts that they come from */
#define RUN 64u   /* percepts of the run that are measured, at most; */
#define RARE 64u  /* of the others, where vectors are chosen; */
#define REST 448u /* where it is seen how much is needed */
#define BINS 64u
#define BIN_MIN 9u       /* less of a bag is never enough, */
#define BINS_OF_ALL 128u /* in parts of what a percept with all of its vectors scores */
#define NEARER 8u        /* into the first eighth of a gap */
#define APART 0.25f      /* of tau^2: nearer vectors are the same */
#define SELDOM 2.0f      /* how much more it counts that others have a vector */
#define LEFT_OVER 8u     /* so many of a run for each of the others are no thing */
#define REFUSED (-1.0f)
#define LEVEL 0.01f /* of a class of noise that it has a candidate that is borne out */

/* So many of the others count as one of the run; but a share of them at least twice that of the
 * run: where actions' targets ascend, up to half of them are of the same thing. */
#define FOREIGN 6u
#define FOREIGN_MIN 2u
#define FOREIGN_MAX 16u

/* The percepts of a run, and those with other targets of the same action: where targets descend,
 * another action begins. Where they happen to ascend, the others are of both. */
typedef struct parts {
    const rlvc_layout *layout;
    const rlvc_samples *samples;
    uint32_t run[2], all[2];
    uint32_t first, step; /* looked at are the samples first, first + step, ... */
} parts;

typedef struct pool {
    uint32_t count;
    const void *vector[POOL];
    float worth[POOL];
} pool;

/* ------------------------------------------------------------------ scores */

static float whole_score(const parts *class_, const rlvc_bag *bag, const void *percept) {
    const float unlimited = 3e38f;
    return rlvc_bag_score(class_->layout, bag, percept, unlimited);
}

/* Is a vector one of the percept's own? Both are among the samples' percepts. */
static int is_own(const parts *class_, const void *vector, const void *percept) {
    return (size_t)((const unsigned char *)vector - (const unsigned char *)percept) <
           class_->samples->percept_bytes;
}

/* What a percept scores by the vectors that are not its own, as if all were like these; where all
 * are its own, by these. */
static float foreign_score(const parts *class_, const rlvc_bag *bag, const void *percept) {
    rlvc_bag foreign;
    foreign.count = 0;
    for (uint32_t i = 0; i < bag->count; i++)
        if (!is_own(class_, bag->vector[i], percept))
            foreign.vector[foreign.count++] = bag->vector[i];
    if (foreign.count == 0)
        return whole_score(class_, bag, percept);
    return whole_score(class_, &foreign, percept) * (float)bag->count / (float)foreign.count;
}

/* ------------------------------------------------------------------ which percepts */

static uint32_t least(uint32_t a, uint32_t b) {
    return a < b ? a : b;
}

/* How many samples before number `at` are looked at. */
static uint32_t before(const parts *class_, uint32_t at) {
    return (at + class_->step - 1u - class_->first) / class_->step;
}

static uint32_t run_length(const parts *class_) {
    return before(class_, class_->run[1]) - before(class_, class_->run[0]);
}

static uint32_t others(const parts *class_) {
    return before(class_, class_->all[1]) - before(class_, class_->all[0]) - run_length(class_);
}

/* Percept number i of those looked at. */
static const void *looked_at(const parts *class_, uint32_t i) {
    return rlvc_samples_percept(class_->samples, class_->step * i + class_->first);
}

/* Percept number i of n of the run, evenly chosen. */
static const void *of_run(const parts *class_, uint32_t i, uint32_t n) {
    return looked_at(class_, before(class_, class_->run[0]) +
                                 (uint32_t)((uint64_t)i * run_length(class_) / n));
}

/* Likewise of the others. */
static const void *of_others(const parts *class_, uint32_t i, uint32_t n) {
    const uint32_t at =
        before(class_, class_->all[0]) + (uint32_t)((uint64_t)i * others(class_) / n);
    return looked_at(class_, at < before(class_, class_->run[0]) ? at : at + run_length(class_));
}

/* Finds run number `run` of those to gather from, and what lies beside it. A run of nearly all
 * samples of its action is what is left over of many things, and shows none of them. If there are
 * fewer, returns how many there are; else a number above `run`. */
static uint32_t find_parts(uint32_t run, parts *class_) {
    const rlvc_samples *samples = class_->samples;
    uint32_t found = 0, end = 0;
    class_->all[1] = 0;
    for (uint32_t begin = 0; begin < samples->count && found <= run; begin = end) {
        end = rlvc_run_end(samples, begin);
        if (begin == class_->all[1]) {
            class_->all[0] = begin;
            class_->all[1] = end;
            while (class_->all[1] < samples->count &&
                   samples->sample[class_->all[1]].key > samples->sample[class_->all[1] - 1u].key)
                class_->all[1] = rlvc_run_end(samples, class_->all[1]);
        }
        class_->run[0] = begin;
        class_->run[1] = end;
        found += run_length(class_) > 0 && run_length(class_) / LEFT_OVER < others(class_);
    }
    return found;
}

/* ------------------------------------------------------------------ which vectors */

/* Finds the percepts of the run that score most by the bag; of equals the first. Returns how many.
 */
static uint32_t find_near(const parts *class_, const rlvc_bag *bag, const void *near[NEAR]) {
    const uint32_t measured = least(run_length(class_), RUN);
    float score[NEAR];
    uint32_t n = 0;
    for (uint32_t i = 0; i < measured; i++) {
        const void *percept = of_run(class_, i, measured);
        const float made = whole_score(class_, bag, percept);
        uint32_t at = n;
        while (at > 0 && made > score[at - 1u])
            at--;
        if (at == NEAR)
            continue;
        n = least(n + 1u, NEAR);
        for (uint32_t j = n - 1u; j > at; j--) {
            score[j] = score[j - 1u];
            near[j] = near[j - 1u];
        }
        score[at] = made;
        near[at] = percept;
    }
    return n;
}

/* How common a vector is in these percepts, more than in the others: what others have as well costs
 * more than it helps. */
static float worth_of(const parts *class_, const void *vector, const void *const near[NEAR],
                      uint32_t n) {
    const uint32_t measured = least(others(class_), RARE);
    float common = 0.0f, rare = 0.0f;
    for (uint32_t i = 0; i < n; i++)
        common += rlvc_bag_likeness(class_->layout, vector, near[i]);
    for (uint32_t i = 0; i < measured; i++)
        rare += rlvc_bag_likeness(class_->layout, vector, of_others(class_, i, measured));
    return common / (float)n - SELDOM * rare / (float)measured;
}

/* Draws vectors of these percepts. */
static void fill_pool(const parts *class_, const void *const near[NEAR], uint32_t n,
                      uint32_t chance, pool *made) {
    made->count = 0;
    for (uint32_t t = 0; t < POOL; t++) {
        const void *percept = near[t % n];
        const uint32_t count = rlvc_vectors_count(percept);
        if (count == 0)
            continue;
        const void *vector =
            rlvc_vectors_at(class_->layout->d, percept, rlvc_scatter(chance + t) % count);
        made->vector[made->count] = vector;
        made->worth[made->count++] = worth_of(class_, vector, near, n);
    }
}

/* Is a vector none of the bag's, and none that is nearly the same? */
static int is_new(const rlvc_layout *layout, const rlvc_bag *bag, const void *vector) {
    const float apart = APART * layout->d->radius * layout->d->radius;
    const rlvc_pattern pattern = {{vector, NULL}, 0.0f, {0.0f, 0.0f}};
    rlvc_probe wanted;
    rlvc_probe_open(layout, &pattern, &wanted);
    uint32_t i = 0;
    while (i < bag->count && !(rlvc_probe_between(&wanted, 0, bag->vector[i], apart) < apart))
        i++;
    return i == bag->count;
}

/* Puts the best of the pool into the bag, in the order of their worth. */
static void choose(const rlvc_layout *layout, uint32_t size, pool *from, rlvc_bag *bag) {
    bag->count = 0;
    while (bag->count < size) {
        uint32_t best = from->count;
        float worth = 0.0f;
        for (uint32_t t = 0; t < from->count; t++)
            if (from->worth[t] > worth) {
                best = t;
                worth = from->worth[t];
            }
        if (best == from->count)
            return;
        from->worth[best] = 0.0f;
        if (is_new(layout, bag, from->vector[best]))
            bag->vector[bag->count++] = from->vector[best];
    }
}

static void improve(const parts *class_, uint32_t size, uint32_t chance, rlvc_bag *bag) {
    const void *near[NEAR];
    pool drawn;
    const uint32_t n = find_near(class_, bag, near);
    fill_pool(class_, near, n, chance, &drawn);
    choose(class_->layout, size, &drawn, bag);
}

/* ------------------------------------------------------------------ how much is needed */

/* How many percepts score at least so many bins. */
typedef struct tally {
    uint32_t of_run[BINS], of_others[BINS];
} tally;

static uint32_t bin_of(float score, float bin) {
    return score >= bin * (float)(BINS - 1u) ? BINS - 1u : (uint32_t)(score / bin);
}

static void count_scores(const parts *class_, const rlvc_bag *bag, float bin, uint32_t measured,
                         uint32_t rest, tally *made) {
    memset(made, 0, sizeof *made);
    for (uint32_t i = 0; i < measured; i++)
        made->of_run[bin_of(foreign_score(class_, bag, of_run(class_, i, measured)), bin)]++;
    for (uint32_t i = 0; i < rest; i++)
        made->of_others[bin_of(whole_score(class_, bag, of_others(class_, i, rest)), bin)]++;
    for (uint32_t b = BINS - 1u; b > 0; b--) {
        made->of_run[b - 1u] += made->of_run[b];
        made->of_others[b - 1u] += made->of_others[b];
    }
}

static int32_t weight_of_others(const parts *class_) {
    const uint32_t ratio = others(class_) / FOREIGN / run_length(class_);
    return (int32_t)least(ratio > FOREIGN_MIN ? ratio : FOREIGN_MIN, FOREIGN_MAX);
}

/* What parts the run from the others best: the row of bins that part them alike, of several the one
 * that needs least. */
static float find_needed(const parts *class_, const rlvc_bag *bag) {
    if (bag->count == 0)
        return REFUSED;
    const uint32_t measured = least(run_length(class_), RUN), rest = least(others(class_), REST);
    const float all = (float)bag->count * class_->layout->d->radius * class_->layout->d->radius;
    const float bin = all / (float)BINS_OF_ALL;
    tally scores;
    count_scores(class_, bag, bin, measured, rest, &scores);
    const int32_t weight = weight_of_others(class_);
    int32_t best = 0, last = 0;
    uint32_t row = 0, width = 1, low = 0;
    for (uint32_t b = BINS - 1u; b >= BIN_MIN; b--) {
        const int32_t worth =
            (int32_t)(scores.of_run[b] * rest) - weight * (int32_t)(scores.of_others[b] * measured);
        row = worth == last ? row + 1u : 1u;
        last = worth;
        if (worth >= best) {
            best = worth;
            width = row;
            low = b;
        }
    }
    return best > 0 ? bin * ((float)low + (float)(width - 1u) / (float)NEARER) : REFUSED;
}

/* ------------------------------------------------------------------ the other half */

/* How likely such a table is, or one farther from independence, if its rows do not differ: the
 * exact test of a small one. */
static float chance_of(const uint32_t found[2], const uint32_t measured[2]) {
    const uint32_t a = found[0], b = measured[0] - a, c = found[1], d = measured[1] - c;
    float p = 1.0f, statistic = 0.0f;
    if (rlvc_fisher_table(a, b, c, d, &p, NULL) != RLVC_OK) {
        (void)rlvc_chi2_table(a, b, c, d, &statistic);
        (void)rlvc_chi2_survival(statistic, 1u, &p, NULL);
    }
    return p;
}

/* Is a bag more common in the run than in the others, in the half that it was not gathered from?
 * The p-value is corrected by the number of candidates, and halved as it looks to one side. */
static int is_borne_out(const parts *class_, const rlvc_bag *bag, float needed) {
    parts rest = *class_;
    rest.first = 1u;
    const uint32_t measured[2] = {least(run_length(&rest), RUN), least(others(&rest), REST)};
    uint32_t found[2] = {0, 0};
    for (uint32_t i = 0; i < measured[0]; i++)
        found[0] += whole_score(&rest, bag, of_run(&rest, i, measured[0])) >= needed;
    for (uint32_t i = 0; i < measured[1]; i++)
        found[1] += whole_score(&rest, bag, of_others(&rest, i, measured[1])) >= needed;
    return found[0] * measured[1] > found[1] * measured[0] &&
           chance_of(found, measured) * (float)class_->layout->d->candidates < 2.0f * LEVEL;
}

/* ------------------------------------------------------------------ candidates */

/* As many vectors of a percept as there is room for: not all are of the thing. */
static void begin_bag(const rlvc_layout *layout, const void *percept, uint32_t chance,
                      rlvc_bag *bag) {
    const uint32_t count = rlvc_vectors_count(percept);
    bag->count = least(count, RLVC_BAGS_SIZE_MAX);
    for (uint32_t i = 0; i < bag->count; i++)
        bag->vector[i] = rlvc_vectors_at(layout->d, percept, (chance % count + i) % count);
}

static void write_feature(const rlvc_layout *layout, const rlvc_bag *bag, float needed,
                          unsigned char *out) {
    const uint32_t bytes = RLVC_DESCRIPTORS_VECTOR_BYTES(layout->d->dimensions, layout->d->form);
    memset(out, 0, layout->feature_bytes);
    memcpy(out, &needed, sizeof needed);
    memcpy(out + 4, &bag->count, sizeof bag->count);
    for (uint32_t i = 0; i < bag->count; i++)
        memcpy(out + 8u + (size_t)i * bytes, bag->vector[i], bytes);
}

/* Gathers once more, from all samples. Returns how much is needed. */
static float gather_whole(const parts *class_, uint32_t size, uint32_t chance, rlvc_bag *bag) {
    parts whole = *class_;
    whole.step = 1u;
    improve(&whole, size, chance, bag);
    return find_needed(&whole, bag);
}

static void gather(const parts *class_, uint32_t size, uint32_t number, unsigned char *out) {
    const uint32_t chance = rlvc_scatter(number + 1u);
    const uint32_t length = run_length(class_);
    const void *seed = of_run(class_, chance % length, length);
    rlvc_bag bag;
    begin_bag(class_->layout, seed, rlvc_scatter(chance), &bag);
    for (uint32_t round = 0; round < ROUNDS; round++)
        improve(class_, size, chance + round * POOL, &bag);
    float needed = find_needed(class_, &bag);
    if (needed >= 0.0f)
        needed = is_borne_out(class_, &bag, needed)
                     ? gather_whole(class_, size, chance + ROUNDS * POOL, &bag)
                     : REFUSED;
    write_feature(class_->layout, &bag, needed, out);
}

int rlvc_gather_candidates(const rlvc_layout *layout, uint32_t size, const rlvc_samples *samples,
                           uint32_t first, uint32_t room, void *features, uint32_t *written) {
    const uint32_t all = layout->d->candidates;
    parts class_ = {layout, samples, {0, 0}, {0, 0}, 0, 2u};
    const uint32_t runs = find_parts(samples->count, &class_);
    uint32_t n = 0;
    for (uint32_t i = 0; i < samples->count; i++)
        if (rlvc_vectors_count(rlvc_samples_percept(samples, i)) > layout->d->points)
            return -1;
    for (; runs > 0 && n < room && first + n < all; n++) {
        const uint32_t i = first + n;
        (void)find_parts(runs < all ? i % runs : (uint32_t)((uint64_t)i * runs / all), &class_);
        gather(&class_, size, i, (unsigned char *)features + (size_t)n * layout->feature_bytes);
    }
    *written = n;
    return 0;
}
