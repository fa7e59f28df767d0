/* SPDX-License-Identifier: MIT */
/* The search for the best cutpoint.
 *
 * Let A samples of N exhibit the feature and B not. The cutpoints are points (x, y) of a path from
 * (0, 0) to (A, B) that goes one step right at a present sample and one step up at an absent one.
 * The score is convex in (x, y) and 0 on the line n = 0, where n = x B - y A (score.h). Over a
 * block of samples the path stays in the rectangle from (x0, y0) to (x1, y1), and so no score on it
 * exceeds
 *
 *      max(score(x1, y0) if n > 0 there, score(x0, y1) if n < 0 there):
 *
 * from a point with n > 0, going down and right leads away from the line, along which a convex
 * function that is 0 on it can only grow. A block whose bound is not above the best score so far
 * (the bar) holds no better cutpoint, nor an equal one when roundings are allowed for (MARGIN), and
 * is passed over whole.
 *
 * Two bounds are tried, a cheap one that needs no logarithm and division, then the score itself.
 * The cheap one compares n^2 with a number that only changes with the bar. With i = x + y:
 *
 *      score <= bar  if  n^2 <= bar (2 ln 2 / f) A B i (N - i)
 *
 * where f = 10/9 if |n| / Q <= 1/4 for the least Q = r * c of the four cells, since with u = -n / Q
 * a cell adds at most u^2 / 2 (1 + (u / 3) / (1 - u)) of E (term by term: (1 + u) ln (1 + u) - u is
 * u^2 / 2 - u^3 / 6 + u^4 / 12 - ...); and f = 2 always, since the sum of O ln(O / E) is at most N
 * times the logarithm of the mean of O / E, which is 1 + chi2 / N, hence at most chi2.
 *
 * The phases:
 *      COUNT   bits of the column, by chunks of a sixteenth of it;
 *      PROBE   the score at a cutpoint near the end of each chunk, so that the bar is high early;
 *              a column of one word is looked at bit by bit at once;
 *      then, from left to right,
 *      CHUNK   a chunk is passed over, if it may be;
 *      BLOCK   a block of 2^level words in it is passed over, if it may be, else halved; after one
 *              that was, the next may be twice as long;
 *      BITS    in a block of one word that could not be passed over, cutpoint by cutpoint;
 *      or, by ranks, RANK in place of all but the first: each word goes into the sums of
 * rank_sum.h. Each action costs at most ACTION_MAX units and is only begun if so much is left; none
 * depends on how much is left, which is why the slicing changes nothing. */
#include "rlvc/float_rules.h"

#include "cutpoint.h"

#include "../base/assert.h"
#include "../base/popcount.h"
#include "../base/solver_select.h"
#include "../stats/score.h"
#include "rlvc/agent.h"

enum { COUNT, PROBE, CHUNK, BLOCK, BITS, RANK };

#define HAS_RANKS RLVC_HAS_SCORE(RLVC_SCORE_RANKS)
#define BLOCK_WORDS 16u /* the longest block */
#define BLOCK_LEVEL 4u  /* its logarithm */
#define ACTION_MAX RLVC_BUDGET_MIN

/* Twice the error of a score (of the one that set the bar, and of the one passed over), and much
 * more than the roundings of a bound and of what it is compared with. */
#define MARGIN (4.0f * RLVC_SCORE_ERROR)

#define LN_2 0.693147181f

static uint32_t words_of(const rlvc_cutpoint_cursor *scan) {
    return (scan->count + 63u) / 64u;
}

static uint32_t chunk_words(const rlvc_cutpoint_cursor *scan) {
    const uint32_t unit = RLVC_CUTPOINT_CHUNKS * BLOCK_WORDS;
    return (words_of(scan) + unit - 1u) / unit * BLOCK_WORDS;
}

static uint32_t smaller(uint32_t a, uint32_t b) {
    return a < b ? a : b;
}

/* The score of the point (x, y). */
static float score_at(const rlvc_cutpoint_cursor *scan, uint32_t x, uint32_t y) {
    uint32_t all_present = scan->best.present;
    uint32_t all_absent = scan->count - all_present;
    return rlvc_score(x, y, all_present - x, all_absent - y);
}

/* Sets the bar, and what the cheap bounds compare n^2 with. */
static void set_bar(rlvc_cutpoint_cursor *scan, float bar) {
    float present = (float)scan->best.present;
    float absent = (float)(scan->count - scan->best.present);
    float lowered = bar * (1.0f - MARGIN) * present * absent;
    scan->bar = bar;
    scan->wide = lowered * LN_2;
    scan->narrow = lowered * (1.8f * LN_2);
}

/* n = x B - y A. */
static int64_t deviation(const rlvc_cutpoint_cursor *scan, uint32_t x, uint32_t y) {
    int64_t present = scan->best.present;
    return x * ((int64_t)scan->count - present) - y * present;
}

/* Whether (x, y), where n is as given, is surely not above the bar, by the cheap bound. */
static inline int surely_below(const rlvc_cutpoint_cursor *scan, int64_t n, uint32_t x,
                               uint32_t y) {
    float size = (float)n;
    float square = size * size;
    uint32_t below = x + y;
    uint32_t above = scan->count - below;
    float rows = (float)((int64_t)below * above);
    if (square <= scan->wide * rows)
        return 1;
    if (square > scan->narrow * rows)
        return 0;
    uint32_t present = scan->best.present;
    int64_t smallest = (int64_t)smaller(below, above) * smaller(present, scan->count - present);
    return 4 * (n < 0 ? -n : n) <= smallest;
}

/* Keeps the cutpoint at `below`, x samples with the feature below it, if it is the best so far. */
static void consider(rlvc_cutpoint_cursor *scan, uint32_t below, uint32_t x) {
    float score = score_at(scan, x, below - x);
    if (score > scan->bar || (score == scan->bar && below < scan->best.below)) {
        scan->best.score = score;
        scan->best.below = below;
        scan->best.present_below = x;
        set_bar(scan, score);
    }
}

void rlvc_cutpoint_begin(rlvc_cutpoint_cursor *scan, const uint64_t *column, const uint64_t *cuts,
                         uint32_t count, uint8_t by_ranks, float beat) {
    RLVC_ASSERT(count >= 1u && count <= INT32_MAX);
    RLVC_ASSERT((cuts[0] & 1u) == 0);
    const rlvc_cutpoint_cursor fresh = {.best = {.score = -1.0f}, .phase = COUNT};
    *scan = fresh;
    scan->by_ranks = by_ranks;
    scan->count = count;
    scan->column = column;
    scan->cuts = cuts;
    scan->bar = beat > 0.0f ? beat : 0.0f;
}

/* Counts the words that `budget` allows, up to the end of the chunk. */
static uint32_t count_step(rlvc_cutpoint_cursor *scan, uint32_t budget) {
    uint32_t words = words_of(scan);
    uint32_t chunk = scan->word / chunk_words(scan);
    uint32_t begin = scan->word;
    uint32_t end = smaller(words, (chunk + 1u) * chunk_words(scan));
    if (end - begin > budget / RLVC_CUTPOINT_WORD_UNITS)
        end = begin + budget / RLVC_CUTPOINT_WORD_UNITS;
    uint32_t present = 0;
    uint32_t word = begin;
    for (; end - word >= BLOCK_WORDS; word += BLOCK_WORDS)
        present += rlvc_popcount(scan->column + word, BLOCK_WORDS);
    present += rlvc_popcount(scan->column + word, end - word);
    scan->chunk_present[chunk] += present;
    scan->best.present += present;
    scan->word = end;
    if (end == words) {
        scan->phase = HAS_RANKS && scan->by_ranks ? RANK : words == 1u ? BITS : PROBE;
        scan->word = 0;
        scan->done = scan->best.present == 0 || scan->best.present == scan->count;
        set_bar(scan, scan->bar);
    }
    return (end - begin) * RLVC_CUTPOINT_WORD_UNITS;
}

/* Scores the first cutpoint, if any, of the word that ends the chunk. */
static uint32_t probe_step(rlvc_cutpoint_cursor *scan) {
    uint32_t words = words_of(scan);
    uint32_t chunk = scan->word / chunk_words(scan);
    uint32_t end = smaller(words, scan->word + chunk_words(scan));
    uint64_t column = scan->column[end - 1u];
    uint64_t cuts = scan->cuts[end - 1u];
    uint32_t work = 2u * RLVC_CUTPOINT_WORD_UNITS;
    scan->present += scan->chunk_present[chunk];
    if (cuts != 0) {
        uint64_t before = (cuts & (0u - cuts)) - 1u;
        uint64_t after = column & ~before;
        uint32_t below = (end - 1u) * 64u + rlvc_popcount(&before, 1);
        consider(scan, below, scan->present - rlvc_popcount(&after, 1));
        work += RLVC_CUTPOINT_SCORE_UNITS;
    }
    scan->word = end;
    if (end == words) {
        scan->phase = CHUNK;
        scan->word = 0;
        scan->present = 0;
        scan->level = BLOCK_LEVEL;
    }
    return work;
}

static int no_cuts(const uint64_t *cuts, uint32_t words) {
    uint64_t any = 0;
    for (uint32_t i = 0; i < words; i++)
        any |= cuts[i];
    return any == 0;
}

/* Moves on to a word, with `present` more samples of the feature behind. */
static void move_to(rlvc_cutpoint_cursor *scan, uint32_t word, uint32_t present) {
    scan->word = word;
    scan->present += present;
    scan->phase = word % chunk_words(scan) == 0 ? CHUNK : BLOCK;
    scan->done = word == words_of(scan);
}

/* Whether no cutpoint in the words up to `end`, `present` samples in which exhibit the feature, is
 * above the bar. Adds to *work. */
static int holds_nothing(const rlvc_cutpoint_cursor *scan, uint32_t end, uint32_t present,
                         uint32_t *work) {
    const uint32_t words = end - scan->word;
    const uint32_t samples = smaller(scan->count, end * 64u) - scan->word * 64u;
    const uint32_t x0 = scan->present;
    const uint32_t y0 = scan->word * 64u - x0;
    const uint32_t x1 = x0 + present;
    const uint32_t y1 = y0 + (samples - present);
    const int64_t right = deviation(scan, x1, y0);
    const int64_t left = deviation(scan, x0, y1);
    const int right_open = right > 0 && !surely_below(scan, right, x1, y0);
    const int left_open = left < 0 && !surely_below(scan, left, x0, y1);
    const float limit = scan->bar * (1.0f - MARGIN);
    *work += 2u * RLVC_CUTPOINT_BOUND_UNITS;
    if (!right_open && !left_open)
        return 1;
    if (words <= BLOCK_WORDS && no_cuts(scan->cuts + scan->word, words))
        return 1;
    if (right_open) {
        *work += RLVC_CUTPOINT_SCORE_UNITS;
        if (score_at(scan, x1, y0) > limit)
            return 0;
    }
    if (left_open) {
        *work += RLVC_CUTPOINT_SCORE_UNITS;
        return score_at(scan, x0, y1) <= limit;
    }
    return 1;
}

static uint32_t chunk_step(rlvc_cutpoint_cursor *scan) {
    uint32_t present = scan->chunk_present[scan->word / chunk_words(scan)];
    uint32_t end = smaller(words_of(scan), scan->word + chunk_words(scan));
    uint32_t work = 0;
    if (holds_nothing(scan, end, present, &work))
        move_to(scan, end, present);
    else
        scan->phase = BLOCK;
    return work;
}

static uint32_t block_step(rlvc_cutpoint_cursor *scan) {
    uint32_t size = UINT32_C(1) << scan->level;
    uint32_t end = smaller(words_of(scan), scan->word + size);
    uint32_t words = end - scan->word;
    uint32_t present = rlvc_popcount(scan->column + scan->word, words);
    uint32_t work = words * RLVC_CUTPOINT_WORD_UNITS;
    if (holds_nothing(scan, end, present, &work)) {
        move_to(scan, end, present);
        if (scan->level < BLOCK_LEVEL && end % (2u * size) == 0)
            scan->level++;
    } else if (scan->level > 0) {
        scan->level--;
    } else {
        scan->phase = BITS;
        scan->bit = 0;
    }
    return work;
}

/* Looks at the next cutpoint of a word. */
static uint32_t bits_step(rlvc_cutpoint_cursor *scan) {
    uint64_t column = scan->column[scan->word];
    uint64_t cuts = scan->cuts[scan->word];
    uint32_t x = scan->present;
    uint32_t bit = scan->bit;
    uint32_t work = RLVC_CUTPOINT_BOUND_UNITS;
    while (bit < 64u && (cuts >> bit & 1u) == 0) {
        x += (uint32_t)(column >> bit & 1u);
        bit++;
    }
    scan->present = x;
    if (bit < 64u) {
        uint32_t below = scan->word * 64u + bit;
        if (!surely_below(scan, deviation(scan, x, below - x), x, below - x)) {
            consider(scan, below, x);
            work += RLVC_CUTPOINT_SCORE_UNITS;
        }
        scan->present = x + (uint32_t)(column >> bit & 1u);
        bit++;
    }
    scan->bit = bit;
    if (bit == 64u)
        move_to(scan, scan->word + 1u, 0);
    return work;
}

/* Adds a word to the sums of ranks; the last makes the statistic. */
static uint32_t rank_step(rlvc_cutpoint_cursor *scan) {
    uint32_t at = scan->word * 64u;
    uint64_t column = scan->column[scan->word];
    uint64_t cuts = scan->cuts[scan->word];
    rlvc_rank_sum_add(&scan->ranks, at, (uint32_t)column, (uint32_t)cuts);
    rlvc_rank_sum_add(&scan->ranks, at + 32u, (uint32_t)(column >> 32), (uint32_t)(cuts >> 32));
    scan->word++;
    if (scan->word == words_of(scan)) {
        scan->best.score = rlvc_rank_sum_statistic(&scan->ranks, scan->best.present, scan->count);
        scan->done = 1;
    }
    return cuts != 0 ? RLVC_CUTPOINT_SCORE_UNITS : RLVC_CUTPOINT_WORD_UNITS;
}

uint32_t rlvc_cutpoint_step(rlvc_cutpoint_cursor *scan, uint32_t budget) {
    uint32_t left = budget;
    RLVC_ASSERT(budget >= RLVC_BUDGET_MIN);
    while (!scan->done && left >= ACTION_MAX)
        if (scan->phase == COUNT)
            left -= count_step(scan, left);
        else if (scan->phase == PROBE)
            left -= probe_step(scan);
        else if (scan->phase == CHUNK)
            left -= chunk_step(scan);
        else if (scan->phase == BLOCK)
            left -= block_step(scan);
        else if (!HAS_RANKS || scan->phase == BITS)
            left -= bits_step(scan);
        else
            left -= rank_step(scan);
    return budget - left;
}

void rlvc_cutpoint_single(rlvc_cutpoint_cursor *scan) {
    if (scan->phase == COUNT)
        (void)count_step(scan, RLVC_CUTPOINT_WORD_UNITS);
    else
        (void)rlvc_cutpoint_step(scan, ACTION_MAX); /* one action, as each costs something */
}

void rlvc_cutpoint_mark(const rlvc_cutpoint_cursor *scan, uint32_t word[3]) {
    word[0] = scan->phase | (uint32_t)scan->level << 8;
    word[1] = scan->word;
    word[2] = scan->bit;
}
