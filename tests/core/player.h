/* SPDX-License-Identifier: MIT */
/* An agent in a small maze, for tests: its block of memory, of which every byte counts, the
 * domain in its several forms, a player, and what was learnt as a string of bytes. Include after
 * cmocka.h. */
#ifndef RLVC_TESTS_PLAYER_H
#define RLVC_TESTS_PLAYER_H

#include "block.h"
#include "faulty.h"
#include "gridworld.h"
#include "rlvc/agent.h"
#include "rlvc/bits.h"
#include "base/rng.h"
#include "stats/score.h"

#include <stdio.h>

/* Forms of the domain. */
enum { BATCH, ONE_BY_ONE, OWN_ORACLE, FORMS };
static const char *const form_names[FORMS] = {"detect()", "exhibits()", "oracle()"};

#define BLOCK_BYTES (1u << 15)
#define CANARY 0xa5
#define RESULT_BYTES (1u << 16)

typedef struct player {
    uint64_t block[BLOCK_BYTES / sizeof(uint64_t)];
    unsigned char saved[BLOCK_BYTES];
    size_t bytes; /* of the block that are the agent's */
    rlvc_agent *agent;
    rlvc_config config;
    rlvc_domain domain;
    faulty faulty;
    gridworld world;
    gridworld saved_world;
    unsigned char percept[8];
    uint8_t playing; /* an episode is under way */
    uint8_t saved_playing;
} player;

/* The refining oracle for bits: the one of highest gain, among all. */
static inline int player_oracle(void *ctx, const rlvc_samples *samples, uint32_t below,
                                void *feature, uint32_t *considered) {
    const uint32_t bits = (uint32_t)(uintptr_t)ctx;
    float best = 0.0f;
    *considered = 0;
    for (uint32_t bit = 0; bit < bits; bit++) {
        uint32_t present_below = 0, present = 0;
        for (uint32_t i = 0; i < samples->count; i++) {
            const unsigned char *percept = (const unsigned char *)rlvc_samples_percept(samples, i);
            uint32_t shows = (uint32_t)percept[bit / 8u] >> bit % 8u & 1u;
            present += shows;
            present_below += i < below ? shows : 0u;
        }
        uint32_t absent = samples->count - present, absent_below = below - present_below;
        float score =
            rlvc_score(present_below, absent_below, present - present_below, absent - absent_below);
        if (score > best) {
            const unsigned char record[2] = {(unsigned char)bit, 0};
            best = score;
            memcpy(feature, record, sizeof record);
            *considered = bits;
        }
    }
    return 0;
}

/* The maze: 7 cells to act in, seen as 3 bits that matter and 3 at random. */
static inline void player_enter_world(player *p, int form) {
    static const unsigned char cells[] = "..#*....";
    static const gridworld_maze maze = {4, 2, 6, cells};
    rlvc_domain bits;
    assert_int_equal(gridworld_init(&p->world, &maze, 3, 0.0f, 7), 0);
    assert_int_equal(rlvc_bits_domain(gridworld_bits(&maze, 3), &bits), RLVC_OK);
    if (form != BATCH)
        bits.detect = NULL;
    if (form == OWN_ORACLE) {
        bits.oracle = player_oracle;
        bits.candidates = NULL;
    }
    p->domain = faulty_domain(&p->faulty, &bits);
    p->playing = 0;
    assert_int_equal(rlvc_config_default(&p->config, &p->domain, GRIDWORLD_ACTIONS), RLVC_OK);
    p->config.classes = 20;
    p->config.capacity = 300;
    p->config.alpha = 0.05f;
    p->config.alpha_known = 0.05f;
    p->config.successors = 0;
    p->config.dependence = 0;
}

/* Makes the agent that p->config asks for. */
static inline void player_init(player *p) {
    block_fill(p->block, CANARY, sizeof p->block);
    assert_int_equal(rlvc_agent_size(&p->config, &p->domain, &p->bytes), RLVC_OK);
    assert_true(p->bytes <= sizeof p->block);
    assert_int_equal(rlvc_agent_init(&p->config, &p->domain, p->block, p->bytes, &p->agent),
                     RLVC_OK);
    assert_int_equal(rlvc_agent_check(p->agent), RLVC_OK);
}

static inline void player_save(player *p) {
    block_copy(p->saved, p->block, sizeof p->block);
    p->saved_world = p->world;
    p->saved_playing = p->playing;
}

static inline void player_restore(player *p) {
    block_copy(p->block, p->saved, sizeof p->block);
    p->world = p->saved_world;
    p->playing = p->saved_playing;
    p->faulty.calls = 0;
    p->faulty.fail_at = 0;
    p->faulty.fail_every = 0;
}

/* Fails unless every byte, also of what lies behind the agent's, is as it was saved. */
static inline void player_unchanged(const player *p, const char *after) {
    size_t i = block_difference(p->block, p->saved, sizeof p->block);
    if (i < sizeof p->block)
        fail_msg("byte %u of %u differs after %s", (unsigned)i, (unsigned)p->bytes, after);
}

static inline void player_begin(player *p) {
    gridworld_percept(&p->world, p->percept);
    assert_int_equal(rlvc_begin(p->agent, p->percept), RLVC_OK);
    p->playing = 1;
}

/* Some interactions, also with episodes cut short. */
static inline void player_play(player *p, uint32_t interactions) {
    for (uint32_t i = 0; i < interactions; i++) {
        rlvc_choice choice;
        float reward;
        if (!p->playing)
            player_begin(p);
        assert_int_equal(rlvc_act(p->agent, &choice), RLVC_OK);
        int at_exit = gridworld_step(&p->world, choice.action, &reward);
        uint8_t end = at_exit ? RLVC_TERMINATED : i % 50u == 17u ? RLVC_TRUNCATED : RLVC_GOES_ON;
        gridworld_percept(&p->world, p->percept);
        assert_int_equal(rlvc_observe(p->agent, choice, reward, at_exit ? NULL : p->percept, end),
                         RLVC_OK);
        p->playing = end == RLVC_GOES_ON;
        if (!p->playing)
            gridworld_reset(&p->world);
        else if (i % 50u == 41u)
            player_begin(p);
        assert_int_equal(rlvc_agent_check(p->agent), RLVC_OK);
    }
}

/* One learning step in calls of `budget`, or of random budgets for which `rng` is given. */
static inline void player_learn(player *p, uint32_t budget, rlvc_rng *rng) {
    rlvc_progress progress;
    do {
        uint32_t now =
            rng ? RLVC_BUDGET_MIN + (rlvc_rng_next(rng) >> rlvc_rng_below(rng, 26u) >> 6) : budget;
        assert_int_equal(rlvc_learn(p->agent, now, &progress), RLVC_OK);
        assert_true(progress.work <= now);
        assert_true(progress.work > 0);
        assert_true(progress.rounds >= (uint32_t)(progress.splits > 0) &&
                    progress.rounds <= progress.splits + 1u);
        assert_int_equal(rlvc_agent_check(p->agent), RLVC_OK);
    } while (!progress.done);
}

static inline rlvc_statistics player_stats(const player *p) {
    rlvc_statistics statistics;
    assert_int_equal(rlvc_stats(p->agent, &statistics), RLVC_OK);
    return statistics;
}

typedef struct player_result {
    size_t bytes;
    char text[RESULT_BYTES];
} player_result;

static inline int player_append(void *ctx, const char *text, size_t bytes) {
    player_result *result = (player_result *)ctx;
    if (bytes > sizeof result->text - result->bytes)
        return 1;
    memcpy(result->text + result->bytes, text, bytes);
    result->bytes += bytes;
    return 0;
}

/* All that was learnt: the tree as JSON, then the bits of every Q, V and record of a split. */
static inline void player_result_of(player *p, player_result *result) {
    rlvc_statistics statistics = player_stats(p);
    memset(result, 0, sizeof *result);
    assert_int_equal(rlvc_print(p->agent, RLVC_PRINT_JSON, player_append, result), RLVC_OK);
    for (uint32_t c = 0; c < statistics.classes; c++) {
        float q, value;
        for (uint32_t a = 0; a < p->config.actions; a++) {
            assert_int_equal(rlvc_q(p->agent, c, a, &q, NULL), RLVC_OK);
            assert_int_equal(player_append(result, (const char *)&q, sizeof q), 0);
        }
        assert_int_equal(rlvc_value(p->agent, c, &value, NULL), RLVC_OK);
        assert_int_equal(player_append(result, (const char *)&value, sizeof value), 0);
    }
    for (uint32_t j = 0; j + 1u < statistics.classes; j++) {
        rlvc_split split;
        assert_int_equal(rlvc_split_at(p->agent, j, &split, NULL), RLVC_OK);
        assert_int_equal(player_append(result, (const char *)&split, sizeof split), 0);
    }
}

#endif
