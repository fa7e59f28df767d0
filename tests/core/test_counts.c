/* SPDX-License-Identifier: MIT */
/* Learning from counts: the same, bit for bit, as from the interactions that are counted, however
 * they are put into rows; and every table that contradicts itself refused. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "player.h"
#include "rlvc/counts.h"
#include "rlvc/export.h"

#define BITS 6u
#define MOST 2400u
#define CAPACITY 3000u

static player p;
static uint64_t ring[1u << 16], fresh[1u << 16], workspace[1u << 16];

typedef struct interaction {
    unsigned char now, next;
    uint8_t action, end;
    float reward;
} interaction;

static interaction seen[MOST];
static uint32_t seen_count;

static rlvc_count_row row[MOST];
static uint64_t with[MOST * BITS];
static rlvc_count_pair pair[MOST];
static uint64_t pair_count[MOST]; /* also of what terminated */
static uint64_t follow[MOST * 2u * BITS];
static rlvc_exact_sum reward[MOST];
static unsigned char feature[2u * BITS];
static uint32_t tested[BITS];
static rlvc_counts counts;

/* Plays, by chance, in a maze where one move in `slip` goes astray. */
static void play(uint32_t count, uint32_t seed, float slip) {
    static const unsigned char cells[] = "..#*....";
    static const gridworld_maze maze = {4, 2, BITS, cells};
    rlvc_rng rng;
    gridworld world;
    rlvc_rng_seed(&rng, seed);
    assert_int_equal(gridworld_init(&world, &maze, 3, slip, seed), 0);
    unsigned char percept[8];
    gridworld_percept(&world, percept);
    for (seen_count = 0; seen_count < count; seen_count++) {
        interaction *now = &seen[seen_count];
        now->now = percept[0];
        now->action = (uint8_t)rlvc_rng_below(&rng, GRIDWORLD_ACTIONS);
        now->end = gridworld_step(&world, now->action, &now->reward) ? RLVC_TERMINATED
                   : seen_count % 50u == 17u                         ? RLVC_TRUNCATED
                                                                     : RLVC_GOES_ON;
        now->reward += 0.1f * (float)rlvc_rng_below(&rng, 2);
        gridworld_percept(&world, percept);
        now->next = now->end == RLVC_TERMINATED ? 0 : percept[0];
        if (now->end == RLVC_TRUNCATED)
            gridworld_reset(&world);
        gridworld_percept(&world, percept);
        if (now->end == RLVC_GOES_ON)
            percept[0] = now->next;
    }
}

static rlvc_agent *agent_in(uint64_t *memory, size_t bytes) {
    rlvc_agent *agent;
    assert_int_equal(rlvc_agent_init(&p.config, &p.domain, memory, bytes, &agent), RLVC_OK);
    return agent;
}

static void configure(uint8_t successors) {
    player_enter_world(&p, BATCH);
    p.config.capacity = CAPACITY;
    p.config.successors = successors;
}

/* What the ring makes of it. */
static rlvc_agent *learn_ring(void) {
    rlvc_agent *agent = agent_in(ring, sizeof ring);
    rlvc_progress progress;
    for (uint32_t i = 0; i < seen_count; i++) {
        const rlvc_choice choice = {seen[i].action, 0};
        if (i == 0 || seen[i - 1u].end != RLVC_GOES_ON)
            assert_int_equal(rlvc_begin(agent, &seen[i].now), RLVC_OK);
        assert_int_equal(rlvc_observe(agent, choice, seen[i].reward, &seen[i].next, seen[i].end),
                         RLVC_OK);
    }
    assert_int_equal(rlvc_learn(agent, RLVC_BUDGET_UNBOUNDED, &progress), RLVC_OK);
    return agent;
}

/* ------------------------------------------------------------------ counting */

/* The cell of a percept: the bits of `mask`, the lowest first. */
static uint64_t cell_of(unsigned char percept, uint32_t mask) {
    uint64_t cell = 0;
    uint32_t place = 0;
    for (uint32_t bit = 0; bit < BITS; bit++)
        if (mask >> bit & 1u)
            cell |= (uint64_t)(percept >> bit & 1u) << place++;
    return cell;
}

/* The row for an interaction, a new one with a chance of 1 in `apart` although there is one. */
static uint32_t row_of(const interaction *of, uint32_t mask, uint32_t apart, rlvc_rng *rng) {
    const rlvc_count_row made = {0,
                                 cell_of(of->now, mask),
                                 cell_of(of->next, mask),
                                 of->reward,
                                 of->action,
                                 of->end == RLVC_TERMINATED,
                                 {0, 0}};
    uint32_t i = 0;
    if (rlvc_rng_below(rng, apart) == 0)
        i = counts.rows;
    for (; i < counts.rows; i++) {
        const rlvc_count_row *other = &row[i];
        if (other->now == made.now && other->next == made.next && other->reward == made.reward &&
            other->action == made.action && other->terminated == made.terminated)
            return i;
    }
    row[i] = made;
    counts.rows++;
    return i;
}

static uint32_t pair_of(const interaction *of, uint32_t mask) {
    uint32_t i = 0;
    while (i < counts.pairs &&
           (pair[i].now != cell_of(of->now, mask) || pair[i].action != of->action))
        i++;
    pair[i].now = cell_of(of->now, mask);
    pair[i].action = of->action;
    counts.pairs += i == counts.pairs;
    return i;
}

/* Counts what was seen, each interaction `times`. */
static void count(uint32_t mask, uint32_t apart, uint64_t times) {
    rlvc_rng rng;
    rlvc_rng_seed(&rng, 3);
    memset(with, 0, sizeof with);
    memset(follow, 0, sizeof follow);
    memset(pair_count, 0, sizeof pair_count);
    counts.rows = 0;
    counts.pairs = 0;
    counts.cell_bits = 0;
    for (uint32_t bit = 0; bit < BITS; bit++) {
        feature[2u * bit] = (unsigned char)bit;
        if (mask >> bit & 1u)
            tested[counts.cell_bits++] = bit;
    }
    for (uint32_t k = 0; k < seen_count; k++) {
        const interaction *of = &seen[apart > MOST ? k : seen_count - 1u - k];
        uint32_t i = row_of(of, mask, apart, &rng), j = pair_of(of, mask);
        row[i].count += times;
        pair_count[j] += times;
        for (uint32_t f = 0; f < BITS; f++) {
            uint32_t shows = of->now >> f & 1u;
            uint32_t then = of->end == RLVC_TERMINATED ? 0 : of->next >> f & 1u;
            with[i * BITS + f] += shows * times;
            follow[i * 2u * BITS + f] += then * times;
            follow[(i * 2u + 1u) * BITS + f] += (shows & then) * times;
        }
    }
    counts.row = row;
    counts.with = with;
    counts.pair = pair;
    counts.follow = follow;
    counts.reward = NULL;
    counts.feature = feature;
    counts.tested = tested;
    counts.features = BITS;
}

static rlvc_status round_of(rlvc_agent *agent, rlvc_progress *progress) {
    size_t bytes;
    rlvc_status status = rlvc_counts_size(agent, &counts, &bytes);
    if (status != RLVC_OK)
        return status;
    assert_true(bytes <= sizeof workspace);
    return rlvc_learn_counts(agent, &counts, workspace, bytes, progress);
}

/* Learns from counts; counts anew when the tree tests a feature that is not in the mask. */
static rlvc_agent *learn_counts(uint32_t mask, uint32_t apart, uint64_t times, uint32_t *passes) {
    rlvc_agent *agent = agent_in(fresh, sizeof fresh);
    rlvc_progress progress = {0};
    count(mask, apart, times);
    *passes = 1;
    while (!progress.done) {
        rlvc_status status = round_of(agent, &progress);
        if (status == RLVC_E_MISMATCH) {
            unsigned char record[2];
            rlvc_statistics stats;
            assert_int_equal(rlvc_stats(agent, &stats), RLVC_OK);
            for (uint32_t j = 0; j + 1u < stats.classes; j++) {
                assert_int_equal(rlvc_split_at(agent, j, NULL, record), RLVC_OK);
                mask |= 1u << rlvc_bits_feature(record);
            }
            count(mask, apart, times);
            ++*passes;
            continue;
        }
        assert_int_equal(status, RLVC_OK);
        assert_int_equal(rlvc_agent_check(agent), RLVC_OK);
    }
    return agent;
}

/* ------------------------------------------------------------------ the same as a ring */

typedef struct text {
    char bytes[1u << 16];
    size_t size;
} text;

static int keep(void *ctx, const char *bytes, size_t size) {
    text *to = ctx;
    assert_true(to->size + size <= sizeof to->bytes);
    memcpy(to->bytes + to->size, bytes, size);
    to->size += size;
    return 0;
}

/* The printed tree has Q, V, samples and the figures of each split to the last bit. */
static void expect_same(rlvc_agent *one, rlvc_agent *other, uint32_t seed) {
    static text a, b;
    a.size = b.size = 0;
    assert_int_equal(rlvc_print(one, RLVC_PRINT_JSON, keep, &a), RLVC_OK);
    assert_int_equal(rlvc_print(other, RLVC_PRINT_JSON, keep, &b), RLVC_OK);
    if (a.size != b.size || memcmp(a.bytes, b.bytes, a.size) != 0)
        fail_msg("seed %u: %.*s\nfrom counts %.*s", (unsigned)seed, (int)a.size, a.bytes,
                 (int)b.size, b.bytes);
}

static void test_same_as_a_ring(void **state) {
    static const float smallest[] = {0, 0, 0, 0, 0, 0, 0.1f, 2.0f, 30.0f};
    (void)state;
    for (uint32_t seed = 1; seed <= 9u; seed++) {
        configure(seed % 2u);
        p.config.smallest_effect = smallest[seed - 1u];
        p.config.explore = seed % 3u != 0;
        if (seed == 5u)
            p.config.features_at_once = 1; /* fewer than the agent influences */
        p.config.solver = seed > 4u ? RLVC_SOLVER_POLICY_ITERATION : RLVC_SOLVER_VALUE_ITERATION;
        play(seed > 6u ? MOST : 400u * seed, seed, seed % 2u ? 0.0f : 0.1f);
        rlvc_agent *expected = learn_ring();
        uint32_t passes;
        expect_same(expected, learn_counts(0, 1u << 20, 1, &passes), seed);
        assert_in_range(passes, 1, 1u + BITS);
        expect_same(expected, learn_counts(63, 1u << 20, 1, &passes), seed);
        assert_int_equal(passes, 1);
        expect_same(expected, learn_counts(5, 1, 1, &passes), seed); /* rows of one each */
        expect_same(expected, learn_counts(9, 3, 1, &passes), seed); /* some of more */
    }
}

/* Sums of rewards beside the rows count for the mean reward, and for nothing else. */
static void test_sums_of_rewards(void **state) {
    (void)state;
    configure(1);
    play(800, 1, 0.0f);
    uint32_t passes;
    rlvc_progress progress;
    count(63, 1u << 20, 1);
    memset(reward, 0, sizeof reward);
    for (uint32_t i = 0; i < counts.pairs; i++)
        reward[i].word[2] = pair_count[i] << 21; /* 1 is 2^149 units */
    counts.reward = reward;
    rlvc_agent *agent = agent_in(ring, sizeof ring);
    assert_int_equal(round_of(agent, &progress), RLVC_OK);
    float first = 0.0f, discount = p.config.discount;
    rlvc_statistics stats;
    assert_int_equal(rlvc_stats(agent, &stats), RLVC_OK);
    assert_true(stats.classes > 1u);
    p.config.discount = 0.0f;
    agent = agent_in(ring, sizeof ring);
    do {
        assert_int_equal(round_of(agent, &progress), RLVC_OK);
    } while (!progress.done);
    assert_int_equal(rlvc_q(agent, 0, 0, &first, NULL), RLVC_OK);
    assert_true(first == 1.0f);
    p.config.discount = discount;
    (void)learn_counts(0, 1u << 20, 1, &passes);
}

/* More interactions than any ring holds: the same tests or more, never fewer. */
static void test_many(void **state) {
    (void)state;
    configure(1);
    play(600, 2, 0.1f);
    rlvc_statistics before, after;
    uint32_t passes;
    assert_int_equal(rlvc_stats(learn_counts(0, 1u << 20, 1, &passes), &before), RLVC_OK);
#if RLVC_COUNT_BITS == 64
    const uint64_t times[] = {1000, UINT64_C(1) << 22, UINT64_C(1) << 24,
                              UINT64_C(100000000000) / 600};
#else
    const uint64_t times[] = {1000, 1u << 20};
#endif
    for (size_t i = 0; i < sizeof times / sizeof times[0]; i++) {
        rlvc_agent *agent = learn_counts(0, 1u << 20, times[i], &passes);
        assert_int_equal(rlvc_stats(agent, &after), RLVC_OK);
        assert_true(after.classes >= before.classes);
        assert_true(after.interactions == seen_count * times[i]);
        uint64_t samples = 0;
        for (uint32_t c = 0; c < after.classes; c++)
            for (uint32_t a = 0; a < GRIDWORLD_ACTIONS; a++) {
                uint32_t tried;
                assert_int_equal(rlvc_q(agent, c, a, NULL, &tried), RLVC_OK);
                samples += tried;
            }
        if (after.interactions <= UINT32_MAX)
            assert_true(samples == after.interactions);
    }
}

/* More of one action than its table by class and action can say: it says the most that it can. */
static void test_more_than_is_said(void **state) {
    (void)state;
#if RLVC_COUNT_BITS == 64
    configure(0);
    play(8, 1, 0.0f);
    count(63, 1u << 20, UINT64_C(1) << 33);
    rlvc_progress progress;
    uint32_t tried = 0;
    p.config.classes = 1;
    rlvc_agent *agent = agent_in(ring, sizeof ring);
    assert_int_equal(round_of(agent, &progress), RLVC_OK);
    assert_true(progress.done);
    assert_int_equal(rlvc_q(agent, 0, seen[0].action, NULL, &tried), RLVC_OK);
    assert_int_equal(tried, UINT32_MAX);
#endif
}

/* ------------------------------------------------------------------ refusals */

static void expect_refused(rlvc_status expected) {
    rlvc_agent *agent = agent_in(ring, sizeof ring);
    rlvc_progress progress;
    size_t bytes = 1;
    assert_int_equal(rlvc_counts_size(agent, &counts, &bytes), expected);
    assert_int_equal(bytes, 0);
    assert_int_equal(rlvc_learn_counts(agent, &counts, workspace, sizeof workspace, &progress),
                     expected);
}

#define FAULTS 21u

/* Makes a number wrong. Row 0 did not terminate. */
static void spoil(uint32_t fault) {
    uint64_t *next = follow, *both = follow + BITS;
    row[0].terminated = 0;
    switch (fault) {
    case 0:
        counts.rows = 0;
        break;
    case 1:
        counts.rows = UINT32_C(1) << 31;
        break;
    case 2:
        counts.pairs = UINT32_C(1) << 31;
        break;
    case 3:
        counts.features = 0;
        break;
    case 4:
        counts.features = RLVC_COUNTS_FEATURES_MAX + 1u;
        break;
    case 5:
        counts.cell_bits = RLVC_CELL_BITS_MAX + 1u;
        break;
    case 6:
        tested[0] = BITS;
        break;
    case 7:
        row[1].count = 0;
        break;
    case 8:
        row[1].count = RLVC_COUNTS_MAX + 1u;
        break;
    case 9:
        row[1].action = GRIDWORLD_ACTIONS;
        break;
    case 10:
        row[1].terminated = 2;
        break;
    case 11:
        row[1].reward = 2e12f;
        break;
    case 12:
        row[1].reward = -2e12f;
        break;
    case 13:
        with[2] = row[0].count + 1u;
        break;
    case 14:
        pair[1].action = GRIDWORLD_ACTIONS;
        break;
    case 15: /* both, but not now */
        with[0] = 0;
        next[0] = both[0] = 1;
        break;
    case 16: /* both, but not next */
        with[0] = both[0] = 1;
        next[0] = 0;
        break;
    case 17: /* more than all */
        with[0] = both[0] = 0;
        next[0] = row[0].count + 1u;
        break;
    case 18: /* now and next, one of them without the other, are more than all */
        with[0] = next[0] = row[0].count;
        both[0] = 0;
        break;
    case 19: /* what terminated has no next */
        row[0].terminated = 1;
        next[0] = with[0] = both[0] = 1;
        break;
    default:
        row[0].count = row[1].count = RLVC_COUNTS_MAX;
        break;
    }
}

static void test_contradictions(void **state) {
    (void)state;
    configure(1);
    play(200, 1, 0.0f);
    for (uint32_t fault = 0; fault < FAULTS; fault++) {
        count(3, 1u << 20, 1);
        spoil(fault);
        expect_refused(RLVC_E_RANGE);
    }
}

/* As many interactions as can be counted are let through, to where memory is asked for; one more is
 * not. */
static void test_the_most(void **state) {
    (void)state;
    configure(1);
    play(200, 1, 0.0f);
    for (uint32_t more = 0; more < 2u; more++) {
        rlvc_progress progress;
        uint64_t others = 0;
        count(0, 1u << 20, 1);
        for (uint32_t i = 1; i < counts.rows; i++)
            others += row[i].count;
        row[0].count = RLVC_COUNTS_MAX - others + more;
        rlvc_agent *agent = agent_in(ring, sizeof ring);
        assert_int_equal(rlvc_learn_counts(agent, &counts, workspace, 0, &progress),
                         more ? RLVC_E_RANGE : RLVC_E_MEMORY);
    }
}

static void test_missing_arrays(void **state) {
    (void)state;
    configure(1);
    play(200, 1, 0.0f);
    const void *none = NULL;
    for (uint32_t i = 0; i < 5u; i++) {
        count(3, 1u << 20, 1);
        const void *array[] = {&counts.row, &counts.with, &counts.feature, &counts.tested,
                               &counts.pair};
        memcpy((void *)(uintptr_t)array[i], &none, sizeof none);
        expect_refused(RLVC_E_NULL);
    }
    for (uint32_t i = 0; i < 2u; i++) { /* what is empty is not needed */
        count(0, 1u << 20, 1);
        counts.pair = NULL;
        counts.pairs = 0;
        counts.tested = i ? NULL : tested;
        rlvc_progress progress;
        rlvc_agent *agent = agent_in(ring, sizeof ring);
        assert_int_equal(round_of(agent, &progress), RLVC_OK);
    }
}

/* A feature that the domain does not vouch for would become one of the tree. */
static void test_strange_features(void **state) {
    static unsigned char strange[BITS * RLVC_BITS_FEATURE_BYTES];
    (void)state;
    configure(1);
    play(200, 1, 0.0f);
    for (uint32_t f = 0; f < BITS; f++) {
        rlvc_progress progress;
        count(0, 1u << 20, 1);
        memcpy(strange, counts.feature, sizeof strange);
        strange[f * RLVC_BITS_FEATURE_BYTES] = BITS;
        counts.feature = strange;
        rlvc_agent *agent = agent_in(ring, sizeof ring);
        assert_int_equal(round_of(agent, &progress), RLVC_E_RANGE);
        assert_int_equal(rlvc_agent_check(agent), RLVC_OK);
        p.domain.check_feature = NULL; /* an own domain's may be anything */
        agent = agent_in(ring, sizeof ring);
        assert_int_equal(round_of(agent, &progress), RLVC_OK);
        configure(1);
    }
}

/* Sums that no rewards have: values stay finite. */
static void test_sums_of_nothing(void **state) {
    static const uint64_t words[][RLVC_EXACT_SUM_WORDS] = {
        {UINT64_MAX, UINT64_MAX, UINT64_MAX, INT64_MAX},
        {0, 0, 0, UINT64_C(1) << 63},
        {1, 2, 3, UINT64_C(1) << 40},
        {7, 7, 7, UINT64_MAX - (UINT64_C(1) << 40)},
    };
    (void)state;
    for (uint32_t i = 0; i < sizeof words / sizeof words[0]; i++) {
        configure(1);
        play(200, 1, 0.0f);
        count(3, 1u << 20, 1);
        for (uint32_t k = 0; k < counts.pairs; k++)
            memcpy(reward[k].word, words[i], sizeof words[i]);
        counts.reward = reward;
        rlvc_progress progress;
        rlvc_agent *agent = agent_in(ring, sizeof ring);
        assert_int_equal(round_of(agent, &progress), RLVC_OK);
        assert_int_equal(rlvc_agent_check(agent), RLVC_OK);
        for (uint32_t a = 0; a < GRIDWORLD_ACTIONS; a++) {
            float q;
            assert_int_equal(rlvc_q(agent, 0, a, &q, NULL), RLVC_OK);
            assert_true(q >= -1e28f && q <= 1e28f);
        }
    }
}

static void test_refusals(void **state) {
    (void)state;
    rlvc_progress progress;
    size_t bytes;
    configure(0);
    play(200, 1, 0.0f);
    count(0, 1u << 20, 1);
    counts.follow = NULL; /* not needed */
    rlvc_agent *agent = agent_in(ring, sizeof ring);
    assert_int_equal(rlvc_counts_size(NULL, &counts, &bytes), RLVC_E_NULL);
    assert_int_equal(rlvc_counts_size(agent, NULL, &bytes), RLVC_E_NULL);
    assert_int_equal(rlvc_counts_size(agent, &counts, NULL), RLVC_E_NULL);
    assert_int_equal(rlvc_learn_counts(NULL, &counts, workspace, 1, &progress), RLVC_E_NULL);
    assert_int_equal(rlvc_learn_counts(agent, NULL, workspace, 1, &progress), RLVC_E_NULL);
    assert_int_equal(rlvc_learn_counts(agent, &counts, workspace, 1, NULL), RLVC_E_NULL);
    assert_int_equal(rlvc_learn_counts(agent, &counts, NULL, 1, &progress), RLVC_E_NULL);
    assert_int_equal(rlvc_counts_size(agent, &counts, &bytes), RLVC_OK);
    assert_int_equal(rlvc_learn_counts(agent, &counts, workspace, bytes - 1u, &progress),
                     RLVC_E_MEMORY);
    assert_int_equal(rlvc_learn_counts(agent, &counts, workspace, bytes, &progress), RLVC_OK);
    assert_true(progress.splits > 0 && !progress.done);
    assert_int_equal(rlvc_learn_counts(agent, &counts, workspace, sizeof workspace, &progress),
                     RLVC_E_MISMATCH);

    /* A step of rlvc_learn is under way. */
    agent = learn_ring();
    const unsigned char percept = 0;
    const rlvc_choice choice = {0, 0};
    assert_int_equal(rlvc_begin(agent, &percept), RLVC_OK);
    assert_int_equal(rlvc_observe(agent, choice, 0.0f, NULL, RLVC_TERMINATED), RLVC_OK);
    assert_int_equal(rlvc_learn(agent, RLVC_BUDGET_MIN, &progress), RLVC_OK);
    assert_false(progress.done);
    assert_int_equal(rlvc_learn_counts(agent, &counts, workspace, sizeof workspace, &progress),
                     RLVC_E_BUSY);

    for (uint32_t i = 0; i < 5u; i++) { /* what does not depend on counts alone */
        configure(0);
        p.config.criterion = i != 0;
        p.config.solver = i == 1 ? RLVC_SOLVER_SARSA : RLVC_SOLVER_VALUE_ITERATION;
        p.config.score = i == 2 ? RLVC_SCORE_RANKS : RLVC_SCORE_GAIN;
        p.config.dependence = p.config.successors = i == 4;
        if (i == 3)
            player_enter_world(&p, OWN_ORACLE);
        agent = agent_in(ring, sizeof ring);
        assert_int_equal(rlvc_learn_counts(agent, &counts, workspace, sizeof workspace, &progress),
                         RLVC_E_CONFIG);
    }
    configure(0);
    p.config.dependence = 1; /* which nothing asks for without successors */
    p.config.successors = 0;
    agent = agent_in(ring, sizeof ring);
    assert_int_equal(rlvc_learn_counts(agent, &counts, workspace, sizeof workspace, &progress),
                     RLVC_OK);
}

static void test_follow_is_needed(void **state) {
    (void)state;
    configure(1);
    play(200, 1, 0.0f);
    count(3, 1u << 20, 1);
    counts.follow = NULL;
    expect_refused(RLVC_E_RANGE);
}

/* A callback of the agent may not call it. */
static rlvc_agent *called;
static rlvc_status answer;

static int reenter(void *ctx, const void *percept, const void *of, uint8_t *present) {
    rlvc_progress progress;
    (void)ctx;
    (void)percept;
    (void)of;
    *present = 0;
    answer = rlvc_learn_counts(called, &counts, workspace, sizeof workspace, &progress);
    return 0;
}

static void test_reentered(void **state) {
    (void)state;
    configure(0);
    play(200, 1, 0.0f);
    count(0, 1u << 20, 1);
    p.domain.exhibits = reenter;
    p.domain.detect = NULL;
    called = NULL;
    rlvc_agent *agent = agent_in(ring, sizeof ring);
    called = agent;
    (void)learn_ring();
    assert_int_equal(answer, RLVC_E_REENTERED);
}

/* What is in the ring is classified anew by the tree that counts have grown. */
static void test_ring_goes_on(void **state) {
    (void)state;
    configure(1);
    play(900, 5, 0.0f);
    rlvc_agent *agent = learn_ring();
    rlvc_progress progress = {0};
    count(63, 1u << 20, 50);
    while (!progress.done) {
        assert_int_equal(round_of(agent, &progress), RLVC_OK);
        assert_int_equal(rlvc_agent_check(agent), RLVC_OK);
    }
    assert_int_equal(rlvc_learn(agent, RLVC_BUDGET_UNBOUNDED, &progress), RLVC_OK);
    assert_int_equal(rlvc_agent_check(agent), RLVC_OK);
    assert_true(progress.done);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_same_as_a_ring),
        cmocka_unit_test(test_sums_of_rewards),
        cmocka_unit_test(test_many),
        cmocka_unit_test(test_contradictions),
        cmocka_unit_test(test_more_than_is_said),
        cmocka_unit_test(test_the_most),
        cmocka_unit_test(test_missing_arrays),
        cmocka_unit_test(test_strange_features),
        cmocka_unit_test(test_sums_of_nothing),
        cmocka_unit_test(test_refusals),
        cmocka_unit_test(test_follow_is_needed),
        cmocka_unit_test(test_reentered),
        cmocka_unit_test(test_ring_goes_on),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
