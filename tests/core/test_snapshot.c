/* SPDX-License-Identifier: MIT */
/* Snapshots: what is saved at any moment resumes bit for bit, whatever happens to the store and the
 * bytes (test_powercut.c has what happens to the power). RLVC_WRITE_GOLDEN=1 in the environment
 * makes the golden snapshots anew. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "snapshots.h"
#include "agent/learn.h"

#include <stdlib.h>

static player_result expected, got;
static content older, newer;

/* ------------------------------------------------------------------ helpers */

/* Offsets in a snapshot of version 1. */
enum {
    AT_VERSION = 4,
    AT_SEQUENCE = 8,
    AT_DOMAIN = 16,
    AT_CONFIG = 24,
    AT_INTERACTIONS = 88,
    AT_STEP = 104,
    AT_RUN = 108,
    AT_LAST_SPLIT = 112,
    AT_SWEEPS = 120,
    AT_RESIDUAL = 124,
    AT_HEAD = 128,
    AT_COUNT = 132,
    AT_FROZEN = 140,
    AT_OPEN = 144,
    AT_SLOTS = 145
};
#define SLOT_BYTES 9u /* of percepts of one byte */
#define SPLIT_BYTES 30u
#define LEARNER_BYTES 70u

typedef struct kind {
    uint8_t criterion, solver;
    int form;
} kind;

static void prepare(const kind *k) {
    player_enter_world(&p, k->form);
    p.config.criterion = k->criterion;
    p.config.solver = k->solver;
    p.config.epsilon = k->criterion == RLVC_CRITERION_RETURNS ? 0.3f : 0.9f;
    if (k->criterion == RLVC_CRITERION_RETURNS && k->solver == RLVC_SOLVER_VALUE_ITERATION)
        p.config.explore = RLVC_EXPLORE_UNIFORM;
    p.config.min_samples = 4;
    p.config.capacity = 900;
    p.config.alpha_known = 0.3f;
    p.config.successors = k->form != OWN_ORACLE;
    p.config.dependence = k->form != OWN_ORACLE;
    p.config.smallest_effect = k->form == BATCH ? 0.05f : 0.0f;
    p.config.score = k->form == ONE_BY_ONE ? RLVC_SCORE_RANKS : RLVC_SCORE_GAIN;
    player_init(&p);
}

/* ------------------------------------------------------------------ resuming */

/* Saves, loads, and lets both go on, learning and playing in turn: each call must do the same. */
static void resume_and_compare(uint32_t budget, const rlvc_store *store) {
    static content a, b;
    rlvc_progress progress, resumed;
    assert_int_equal(rlvc_save(p.agent, store), RLVC_OK);
    assert_int_equal(load(&other, store), RLVC_OK);
    assert_int_equal(rlvc_agent_check(other.agent), RLVC_OK);
    content_of(&p, &a);
    content_of(&other, &b);
    assert_true(same_content(&a, &b));
    other.world = p.world;
    other.playing = p.playing;
    memcpy(other.percept, p.percept, sizeof p.percept);
    player_save(&p);
    for (int i = 0; i < 4; i++) {
        assert_int_equal(rlvc_learn(p.agent, budget, &progress), RLVC_OK);
        assert_int_equal(rlvc_learn(other.agent, budget, &resumed), RLVC_OK);
        assert_memory_equal(&progress, &resumed, sizeof progress);
        player_play(&p, 1);
        player_play(&other, 1);
    }
    content_of(&p, &a);
    content_of(&other, &b);
    assert_true(same_content(&a, &b));
    player_restore(&p);
}

static void test_resume_anywhere(void **state) {
    (void)state;
    uint32_t phases[RLVC_PHASE_INFLUENCE + 1] = {0};
    for (int i = 0; i < FORMS * 8; i++) {
        const kind k = {(uint8_t)(i & 1), (uint8_t)(i / 2 % 4), i / 8};
        const uint32_t budget = 64u + 37u * (uint32_t)(i / 3 % 5);
        const int incremental = k.solver == RLVC_SOLVER_Q_LEARNING || k.solver == RLVC_SOLVER_SARSA;
        const uint32_t stride = k.form == OWN_ORACLE ? 1u : RLVC_STRIDE; /* its slices are few */
        const uint32_t every = (incremental ? 1u : 3u) * stride;
        rlvc_progress progress = {0, 0, 0, 0, {0, 0, 0}};
        prepare(&k);
        rlvc_store store = medium_store(&m, &p.config, &p.domain, i % 2);
        for (uint32_t n = 0, steps = 0; steps < 3; n++) {
            if (n == 0 || progress.done)
                player_play(&p, 60);
            assert_int_equal(rlvc_learn(p.agent, budget, &progress), RLVC_OK);
            steps += progress.done;
            if (n % 3 == 0 && p.agent->replay.count < p.config.capacity - 200u)
                player_play(&p, 1);
            const uint32_t due = n < 1000u ? every : RLVC_STRIDE * every; /* two take 20,000 */
            if (n % due == 0 || phases[p.agent->learner.phase] < 3u) {
                phases[p.agent->learner.phase]++;
                resume_and_compare(budget, &store);
            }
        }
    }
    for (int phase = 0; phase <= RLVC_PHASE_INFLUENCE; phase++)
        assert_true(phases[phase] > 0 || phase == RLVC_PHASE_FINISH);
}

/* Every single slice of one step, as short as slices get, and on to the end of it. */
static void test_resume_every_slice(void **state) {
    (void)state;
    for (int i = 0; i < 6; i++) {
        const uint8_t solvers[] = {RLVC_SOLVER_POLICY_ITERATION, RLVC_SOLVER_VALUE_ITERATION};
        const kind k = {(uint8_t)(i & 1), solvers[i >> 1 & 1], i < 4 ? BATCH : ONE_BY_ONE};
        rlvc_progress progress;
        prepare(&k);
        rlvc_store store = medium_store(&m, &p.config, &p.domain, 0);
        player_play(&p, 250);
        player_save(&p);
        player_learn(&p, RLVC_BUDGET_UNBOUNDED, NULL);
        player_result_of(&p, &expected);
        player_restore(&p);
        for (uint32_t n = 1;; n++) {
            assert_int_equal(rlvc_learn(p.agent, RLVC_BUDGET_MIN, &progress), RLVC_OK);
            if (progress.done)
                break;
            if (n % RLVC_STRIDE != 0)
                continue;
            assert_int_equal(rlvc_save(p.agent, &store), RLVC_OK);
            assert_int_equal(load(&other, &store), RLVC_OK);
            player_learn(&other, RLVC_BUDGET_UNBOUNDED, NULL);
            player_result_of(&other, &got);
            assert_memory_equal(&got, &expected, sizeof got);
        }
    }
}

static void test_sequence_comes_round(void **state) {
    (void)state;
    prepare_small();
    rlvc_store store = medium_store(&m, &p.config, &p.domain, 0);
    rlvc_snapshot_info info;
    assert_int_equal(rlvc_save(p.agent, &store), RLVC_OK);
    rlvc_put(m.bytes + AT_SEQUENCE, UINT32_MAX - 1u, 4);
    snapshot_mend(m.bytes);
    for (uint32_t i = 1; i < 6; i++) {
        assert_int_equal(rlvc_save(p.agent, &store), RLVC_OK);
        assert_int_equal(rlvc_snapshot_peek(&store, &info), RLVC_OK);
        assert_int_equal(info.sequence, UINT32_MAX - 1u + i);
        assert_int_equal(info.slot, i % 2);
    }
}

/* ------------------------------------------------------------------ damage */

/* An agent in the middle of something, with a snapshot in slot 0 and a newer one in slot 1. */
static rlvc_store two_snapshots(uint32_t interactions, uint32_t slices, uint32_t budget) {
    rlvc_progress progress;
    prepare_holding(interactions + 20u);
    rlvc_store store = medium_store(&m, &p.config, &p.domain, 0);
    player_play(&p, interactions);
    content_of(&p, &older);
    assert_int_equal(rlvc_save(p.agent, &store), RLVC_OK);
    for (uint32_t i = 0; i < slices; i++)
        assert_int_equal(rlvc_learn(p.agent, budget, &progress), RLVC_OK);
    content_of(&p, &newer);
    assert_int_equal(rlvc_save(p.agent, &store), RLVC_OK);
    return store;
}

/* A bit that has changed makes the other snapshot count; in both, there is none. */
static void test_bit_flips(void **state) {
    (void)state;
    static content loaded;
    rlvc_store store = two_snapshots(30, 9, RLVC_BUDGET_MIN);
    for (uint32_t slot = 0; slot < 2; slot++) {
        unsigned char *snapshot = medium_slot(&store, slot);
        const uint32_t bits = 8u * (slot ? newer.bytes : older.bytes);
        for (uint32_t bit = 0; bit < bits; bit += RLVC_STRIDE) {
            snapshot[bit / 8u] ^= (unsigned char)(1u << bit % 8u);
            assert_int_equal(load(&other, &store), RLVC_OK);
            content_of(&other, &loaded);
            assert_true(same_content(&loaded, slot ? &older : &newer));
            medium_slot(&store, 1u - slot)[77] ^= 1u;
            rlvc_status status = load(&other, &store);
            assert_true(status == RLVC_E_DAMAGED || status == RLVC_E_EMPTY);
            medium_slot(&store, 1u - slot)[77] ^= 1u;
            snapshot[bit / 8u] ^= (unsigned char)(1u << bit % 8u);
        }
    }
}

/* Loads what may be anything: it is refused, or is an agent that works. */
static uint32_t try_anything(const rlvc_store *store) {
    static const unsigned char percept[1] = {3};
    rlvc_progress progress;
    rlvc_choice choice;
    rlvc_status status = load(&other, store);
    if (status != RLVC_OK) {
        assert_true(status == RLVC_E_DAMAGED || status == RLVC_E_MISMATCH ||
                    status == RLVC_E_VERSION || status == RLVC_E_EMPTY);
        return 0;
    }
    assert_int_equal(rlvc_agent_check(other.agent), RLVC_OK);
    for (int i = 0; i < 50; i++)
        assert_int_equal(rlvc_learn(other.agent, 500, &progress), RLVC_OK);
    rlvc_status begun = rlvc_begin(other.agent, percept);
    assert_true(begun == RLVC_OK || begun == RLVC_E_BUSY);
    if (begun == RLVC_OK)
        assert_int_equal(rlvc_act(other.agent, &choice), RLVC_OK);
    return 1;
}

/* Changed bits under a CRC that is right: what is loaded is not trusted. */
static void test_forgery(void **state) {
    (void)state;
    uint32_t accepted = 0, tried = 0;
    for (uint32_t slices = 0; slices < 60; slices += 5) {
        rlvc_store store = two_snapshots(30, slices, RLVC_BUDGET_MIN);
        unsigned char *snapshot = medium_slot(&store, 1);
        for (uint32_t bit = 8u * 16u; bit < 8u * (newer.bytes - 4u); bit += 1u + slices % 7u) {
            snapshot[bit / 8u] ^= (unsigned char)(1u << bit % 8u);
            snapshot_mend(snapshot);
            accepted += try_anything(&store);
            tried++;
            snapshot[bit / 8u] ^= (unsigned char)(1u << bit % 8u);
        }
    }
    assert_true(accepted > 0 && accepted < tried);
}

/* Sets `bytes` bytes of the snapshot in slot 1, makes it whole, tries to load it and puts them
 * back. */
static rlvc_status load_forged(const rlvc_store *store, uint32_t at, uint64_t number,
                               uint32_t bytes) {
    unsigned char *snapshot = medium_slot(store, 1);
    uint64_t before = rlvc_get(snapshot + at, bytes);
    rlvc_put(snapshot + at, number, bytes);
    snapshot_mend(snapshot);
    rlvc_status status = load(&other, store);
    rlvc_put(snapshot + at, before, bytes);
    snapshot_mend(snapshot);
    return status;
}

/* m and the last action, then for each class what leads on, and 4 counts. */
#define EXPLORER_BYTES(classes) (2u + 5u * (classes))
#define NOT_A_NUMBER 0x7fc00000u

static void test_unsound_fields(void **state) {
    (void)state;
    rlvc_store store = two_snapshots(90, 0, RLVC_BUDGET_MIN);
    player_learn(&p, RLVC_BUDGET_UNBOUNDED, NULL);
    player_play(&p, 4);
    assert_int_equal(rlvc_save(p.agent, &store), RLVC_OK);
    assert_int_equal(rlvc_save(p.agent, &store), RLVC_OK); /* in slot 1 */
    uint32_t classes = player_stats(&p).classes;
    assert_true(classes > 1);
    const uint32_t tree = AT_SLOTS + SLOT_BYTES * p.agent->replay.count;
    const uint32_t values = tree + 4u + SPLIT_BYTES * (classes - 1u);
    const uint32_t learner = values + classes * (8u + 12u * 4u) + EXPLORER_BYTES(classes);
    const uint32_t explorer = learner - EXPLORER_BYTES(classes);
    const struct {
        uint32_t at, number, bytes;
    } bad[] = {
        {AT_INTERACTIONS, 3, 8},
        {AT_RUN, 9, 4},
        {AT_LAST_SPLIT, 9, 4},
        {AT_SWEEPS, p.config.max_sweeps + 1u, 4},
        {AT_RESIDUAL, NOT_A_NUMBER, 4},
        {AT_HEAD, 111, 4},
        {AT_COUNT, 112, 4},
        {AT_COUNT, p.agent->replay.count - 1u, 4},
        {AT_FROZEN, 1, 4},
        {AT_OPEN, 2, 1},
        {AT_SLOTS + 8u, 8u | 1u, 1}, /* flags: too many, */
        {AT_SLOTS + 8u, 2, 1},       /* and of no interaction */
        {tree, 0, 4},                /* classes */
        {tree, 7, 4},
        {tree + 4u, 1, 4},  /* split 0 is of class 1 */
        {tree + 8u, 9, 4},  /* and of step 9 */
        {tree + 12u, 6, 4}, /* and of action 6 */
        {tree + 20u, NOT_A_NUMBER, 4},
        {tree + 24u, NOT_A_NUMBER, 4},
        {tree + 28u, NOT_A_NUMBER, 4},
        {values, NOT_A_NUMBER, 4},
        {values + 4u, 4, 1},       /* the policy */
        {values + 6u, classes, 2}, /* pending: a class that there is not ... */
        {values + 56u + 6u, 1, 2}, /* ... or that was split from another */
        {values + 8u, NOT_A_NUMBER, 4},
        {values + 12u, NOT_A_NUMBER, 4},
        {values, 0x7f7fffffu, 4}, /* finite, but more than any return, */
        {values, 0xff7fffffu, 4},
        {values + 8u, 0x7f7fffffu, 4},
        {values + 12u, 0x5a000000u, 4}, /* or than any reward */
        {explorer + 1u, 4, 1},          /* the last action */
        {explorer + 2u, 4, 1},          /* an action that leads on */
        {learner, 10, 1},               /* phase */
        {learner, 2, 1},                /* that this solver does not have */
        {learner + 30u, 1, 4},          /* a mark between two steps */
    };
    assert_int_equal(load_forged(&store, AT_RUN, 0, 4), RLVC_OK);
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        rlvc_status status = load_forged(&store, bad[i].at, bad[i].number, bad[i].bytes);
        if (status != RLVC_E_DAMAGED)
            fail_msg("change %u: %s", (unsigned)i, rlvc_status_text(status));
    }
}

/* Where the learner is in the snapshot of p. */
static uint32_t at_learner(void) {
    const uint32_t classes = p.agent->tree.classes;
    return AT_SLOTS + SLOT_BYTES * p.agent->replay.count + 4u + SPLIT_BYTES * (classes - 1u) +
           classes * (8u + 12u * 4u) + EXPLORER_BYTES(classes);
}

/* A position of the learner that no learner comes to. */
static void test_unsound_learner(void **state) {
    (void)state;
    uint32_t phases = 0;
    for (uint32_t slices = 1; slices < 80; slices++) {
        rlvc_store store = two_snapshots(90, slices, 80); /* some of them end while SEEK is under
                                                             way */
        const uint32_t learner = at_learner();
        const uint8_t phase = p.agent->learner.phase;
        if (phase == 0)
            break;
        phases |= 1u << phase;
        assert_int_equal(load_forged(&store, learner + 1u, 4, 1), RLVC_E_DAMAGED); /* searching */
        for (uint32_t field = 0; field < 7; field++) { /* end, at, node, classes, ... made */
            rlvc_status status = load_forged(&store, learner + 2u + 4u * field, 4000, 4);
            assert_true(status == RLVC_E_DAMAGED || field == 4);
        }
        assert_int_equal(load_forged(&store, learner + 2u, 1, 4), RLVC_E_DAMAGED);
        assert_int_equal(load_forged(&store, AT_FROZEN, p.agent->replay.frozen - 1u, 4),
                         RLVC_E_DAMAGED);
        if (phase != 1)
            assert_int_equal(load_forged(&store, AT_SLOTS + 5u, 0xffff, 2), RLVC_E_DAMAGED);
        const rlvc_solver_cursor *solver = &p.agent->learner.work.solver;
        if (phase == 4) /* a transition before the pair's first */
            assert_int_equal(
                load_forged(&store, learner + 30u + 12u, 0, 4),
                p.agent->values.begin.transition[4u * solver->class_id + solver->action] > 0
                    ? RLVC_E_DAMAGED
                    : RLVC_OK);
        for (uint32_t word = 0; word < 10; word++) {
            rlvc_status status = load_forged(&store, learner + 30u + 4u * word, NOT_A_NUMBER, 4);
            assert_true(status == RLVC_E_DAMAGED || (phase == 4 && (word == 3 || word == 9)));
        }
    }
    const uint32_t wanted = 1u << 1 | 1u << 3 | 1u << 4 | 1u << 5 | 1u << 6 | 1u << 7;
    assert_int_equal(phases & wanted, wanted);
}

/* A search that found nothing, whose mark says that what it found is being weighed. */
static void test_nothing_to_weigh(void **state) {
    (void)state;
    rlvc_store store = two_snapshots(90, 1, RLVC_BUDGET_MIN);
    const rlvc_learner *learner = &p.agent->learner;
    rlvc_progress progress = {0};
    rlvc_split split;
    while (learner->phase != RLVC_PHASE_SEARCH || !learner->work.split.done ||
           rlvc_split_search_result(&learner->work.split, &p.agent->space, &split) != NULL) {
        assert_int_equal(rlvc_learn(p.agent, RLVC_BUDGET_MIN, &progress), RLVC_OK);
        assert_false(progress.done);
    }
    for (uint32_t i = 0; i < 2; i++)
        assert_int_equal(rlvc_save(p.agent, &store), RLVC_OK);
    assert_int_equal(load(&other, &store), RLVC_OK);
    assert_int_equal(load_forged(&store, at_learner() + 30u + 4u * 8u, 1, 4), RLVC_E_DAMAGED);
}

/* A policy that is being made greedy is resumed too; slices rarely end there. */
static void test_resume_improving(void **state) {
    (void)state;
    uint32_t first[9] = {0}, word[10], again[10];
    rlvc_solver_cursor solver, resumed;
    rlvc_solver_input input = {NULL, 2, 10, 0.9f, 0.01f};
    rlvc_values values;
    memset(&values, 0, sizeof values);
    values.actions = 4;
    values.begin.transition = first;
    rlvc_solver_begin(&solver, RLVC_SOLVER_POLICY_ITERATION);
    solver.class_id = 1;
    solver.changed = 1;
    rlvc_solver_mark(&solver, word);
    rlvc_solver_begin(&resumed, RLVC_SOLVER_POLICY_ITERATION);
    assert_true(rlvc_solver_restore(&resumed, &input, &values, word));
    rlvc_solver_mark(&resumed, again);
    assert_memory_equal(word, again, sizeof word);
    assert_int_equal(resumed.phase, solver.phase);
    assert_int_equal(resumed.changed, 1);
    rlvc_solver_begin(&resumed, RLVC_SOLVER_VALUE_ITERATION);
    assert_false(rlvc_solver_restore(&resumed, &input, &values, word));
    for (uint32_t i = 7; i < 9; i++) { /* a sum of no terms */
        word[i] = 0x3f800000u;
        rlvc_solver_begin(&resumed, RLVC_SOLVER_POLICY_ITERATION);
        assert_false(rlvc_solver_restore(&resumed, &input, &values, word));
        word[i] = 0;
    }
    word[9] = 0x80000000u; /* more terms than there can be */
    assert_false(rlvc_solver_restore(&resumed, &input, &values, word));
    word[9] = 0;
    word[0] = 2; /* no phase */
    rlvc_solver_begin(&resumed, RLVC_SOLVER_POLICY_ITERATION);
    assert_false(rlvc_solver_restore(&resumed, &input, &values, word));
    word[0] = 1u << 16;
    rlvc_solver_begin(&resumed, RLVC_SOLVER_VALUE_ITERATION);
    assert_true(rlvc_solver_restore(&resumed, &input, &values, word));
    word[0] = 2u << 16;
    assert_false(rlvc_solver_restore(&resumed, &input, &values, word));
    word[0] = 1u << 24;
    rlvc_solver_begin(&resumed, RLVC_SOLVER_VALUE_ITERATION);
    assert_false(rlvc_solver_restore(&resumed, &input, &values, word));
}

/* A phase that a config does not have. */
static void test_unsound_phases(void **state) {
    (void)state;
    for (int i = 0; i < 8; i++) {
        const kind k = {(uint8_t)(i & 1), (uint8_t)(i >> 1), BATCH};
        prepare(&k);
        rlvc_store store = medium_store(&m, &p.config, &p.domain, 0);
        assert_int_equal(rlvc_save(p.agent, &store), RLVC_OK);
        assert_int_equal(rlvc_save(p.agent, &store), RLVC_OK);
        const uint32_t learner = AT_SLOTS + 4u + 8u + 12u * 4u + EXPLORER_BYTES(1u);
        for (uint32_t phase = 1; phase <= RLVC_PHASE_INFLUENCE + 1u; phase++)
            assert_int_equal(load_forged(&store, learner, phase, 1), RLVC_E_DAMAGED);
    }
}

/* A learning step that has nothing to learn from may be resumed too. */
static void test_resume_without_data(void **state) {
    (void)state;
    for (int i = 0; i < 8; i++) {
        const kind k = {(uint8_t)(i & 1), (uint8_t)(i >> 1), BATCH};
        rlvc_progress progress;
        prepare(&k);
        rlvc_store store = medium_store(&m, &p.config, &p.domain, 0);
        do {
            assert_int_equal(rlvc_learn(p.agent, RLVC_BUDGET_MIN, &progress), RLVC_OK);
            assert_int_equal(rlvc_save(p.agent, &store), RLVC_OK);
            assert_int_equal(load(&other, &store), RLVC_OK);
            content_of(&p, &older);
            content_of(&other, &newer);
            assert_true(same_content(&older, &newer));
        } while (!progress.done);
    }
}

/* ------------------------------------------------------------------ refusals */

static void test_versions_and_mismatches(void **state) {
    (void)state;
    rlvc_store store = two_snapshots(30, 3, RLVC_BUDGET_MIN);
    rlvc_snapshot_info info;
    assert_int_equal(load_forged(&store, AT_VERSION, 2, 4), RLVC_E_VERSION);
    assert_int_equal(load_forged(&store, AT_VERSION, 0, 4), RLVC_E_VERSION);
    assert_int_equal(rlvc_snapshot_peek(&store, &info), RLVC_OK);
    assert_int_equal(info.version, RLVC_SNAPSHOT_VERSION);
    assert_int_equal(info.bytes, newer.bytes);
    assert_int_equal(info.percept_bytes, 1);
    assert_int_equal(info.feature_bytes, 2);
    assert_null(info.config.method);
    assert_memory_equal(&info.config.actions, &p.config.actions,
                        offsetof(rlvc_config, sample) - offsetof(rlvc_config, actions));
    for (uint32_t at = AT_DOMAIN; at < AT_INTERACTIONS; at++) {
        uint8_t byte = medium_slot(&store, 1)[at];
        assert_int_equal(load_forged(&store, at, byte ^ 1u, 1), RLVC_E_MISMATCH);
    }
    medium_slot(&store, 1)[AT_INTERACTIONS - 33] = 1; /* of a field that is no more */
    snapshot_mend(medium_slot(&store, 1));
    assert_int_equal(rlvc_snapshot_peek(&store, &info), RLVC_E_MISMATCH);
}

static void test_arguments(void **state) {
    (void)state;
    rlvc_store store = two_snapshots(30, 3, RLVC_BUDGET_MIN), bad;
    rlvc_snapshot_info info;
    rlvc_agent *agent;
    uint32_t bytes = 1;
    rlvc_config config = p.config;
    assert_int_equal(rlvc_save(NULL, &store), RLVC_E_NULL);
    assert_int_equal(rlvc_save(p.agent, NULL), RLVC_E_NULL);
    assert_int_equal(rlvc_snapshot_peek(&store, NULL), RLVC_E_NULL);
    assert_int_equal(rlvc_snapshot_peek(NULL, &info), RLVC_E_NULL);
    assert_int_equal(rlvc_snapshot_size(&config, &p.domain, NULL), RLVC_E_NULL);
    assert_int_equal(rlvc_load(&config, &p.domain, other.block, p.bytes, &store, NULL),
                     RLVC_E_NULL);
    assert_int_equal(rlvc_load(NULL, &p.domain, other.block, p.bytes, &store, &agent), RLVC_E_NULL);
    assert_int_equal(rlvc_load(&config, &p.domain, NULL, p.bytes, &store, &agent), RLVC_E_NULL);
    assert_int_equal(rlvc_load(&config, &p.domain, other.block, p.bytes - 1u, &store, &agent),
                     RLVC_E_MEMORY);
    assert_null(agent);
    bad = store;
    bad.read = NULL;
    assert_int_equal(rlvc_save(p.agent, &bad), RLVC_E_NULL);
    bad = store;
    bad.write = NULL;
    assert_int_equal(rlvc_save(p.agent, &bad), RLVC_E_NULL);
    const uint32_t sizes[] = {0, store.slot_bytes - 64u, store.slot_bytes + 1u, 0x80000000u};
    for (int i = 0; i < 4; i++) {
        bad = store;
        bad.slot_bytes = sizes[i];
        assert_int_equal(rlvc_save(p.agent, &bad), RLVC_E_RANGE);
    }
    config.actions = 0;
    assert_int_equal(rlvc_snapshot_size(&config, &p.domain, &bytes), RLVC_E_CONFIG);
    assert_int_equal(bytes, 0);
    config = p.config;
    config.capacity = INT32_MAX;
    assert_int_equal(rlvc_snapshot_size(&config, &p.domain, &bytes), RLVC_E_MEMORY);
    config = p.config;
    store = medium_store(&m, &config, &p.domain, 1);
    assert_int_equal(load(&other, &store), RLVC_E_EMPTY);
    memcpy(m.bytes, "RLVS\1\0\0\0\1\0\0\0\0\0\0\0", 16);
    assert_int_equal(load(&other, &store), RLVC_E_EMPTY);
}

/* A snapshot has the size that was promised, and a longer one is not loaded from. */
static void test_sizes(void **state) {
    (void)state;
    uint32_t bytes = 0, most = 0;
    rlvc_store store = two_snapshots(30, 0, RLVC_BUDGET_MIN);
    player_learn(&p, RLVC_BUDGET_UNBOUNDED, NULL);
    assert_int_equal(rlvc_snapshot_size(&p.config, &p.domain, &most), RLVC_OK);
    assert_int_equal(most, RLVC_SNAPSHOT_BYTES(4, 50, 5, 1, 2));
    assert_int_equal(rlvc_save(p.agent, &store), RLVC_OK);
    rlvc_config config = p.config;
    config.capacity = p.agent->replay.count - 1u;
    config.classes = player_stats(&p).classes;
    assert_int_equal(rlvc_snapshot_size(&config, &p.domain, &bytes), RLVC_OK);
    assert_int_equal(snapshot_bytes(medium_slot(&store, 0)), bytes);
    assert_true(bytes <= most);
    /* Longer and shorter by a unit, and whole. */
    for (uint32_t unit = 0; unit < 2; unit++) {
        unsigned char *snapshot = medium_slot(&store, 0);
        rlvc_put(snapshot + 12, unit ? bytes + 64u : bytes - 64u, 4);
        rlvc_put(snapshot + AT_SEQUENCE, 9, 4);
        if (snapshot_bytes(snapshot) <= store.slot_bytes) {
            snapshot_mend(snapshot);
            assert_int_equal(load(&other, &store), RLVC_E_DAMAGED);
        }
    }
}

/* ------------------------------------------------------------------ failures of others */

static void test_failing_store(void **state) {
    (void)state;
    static content loaded;
    for (int flash = 0; flash < 2; flash++) {
        prepare_small();
        rlvc_store store = medium_store(&m, &p.config, &p.domain, flash);
        player_play(&p, 30);
        content_of(&p, &older);
        assert_int_equal(rlvc_save(p.agent, &store), RLVC_OK);
        player_play(&p, 3);
        rlvc_status status = RLVC_E_STORE;
        const medium before = m;
        for (uint32_t n = 1; status != RLVC_OK; n++) {
            m = before;
            m.calls = 0;
            m.fail_at = n;
            status = rlvc_save(p.agent, &store);
            assert_true(status == RLVC_OK || status == RLVC_E_STORE);
            assert_int_equal(rlvc_agent_check(p.agent), RLVC_OK);
            medium_revive(&m);
            assert_int_equal(load(&other, &store), RLVC_OK);
            content_of(&other, &loaded);
            /* After a failed sync nobody knows: it is the newer one here. */
            if (status != RLVC_OK && n + 1u < before.calls)
                assert_true(same_content(&loaded, &older) || m.syncs > 1u);
        }
        status = RLVC_E_STORE;
        for (uint32_t n = 1; status != RLVC_OK; n++) {
            medium_revive(&m);
            m.fail_at = n;
            status = load(&other, &store);
            assert_true(status == RLVC_OK || status == RLVC_E_STORE);
        }
    }
}

/* Reads another thing the second time, in one unit. */
static uint32_t reads, unsteady_unit;
static int unsteady_read(void *ctx, uint32_t offset, void *buffer, uint32_t bytes) {
    int status = medium_read(ctx, offset, buffer, bytes);
    if (++reads == 3u + m.bytes[12] / 64u + 256u / 64u * m.bytes[13] + unsteady_unit)
        ((unsigned char *)buffer)[bytes - 5u] ^= 1u;
    return status;
}

static void test_unsteady_store(void **state) {
    (void)state;
    prepare_small();
    rlvc_store store = medium_store(&m, &p.config, &p.domain, 0);
    player_play(&p, 30);
    assert_int_equal(rlvc_save(p.agent, &store), RLVC_OK);
    store.read = unsteady_read;
    for (unsteady_unit = 0; unsteady_unit < snapshot_bytes(m.bytes) / 64u; unsteady_unit++) {
        reads = 0;
        rlvc_status status = load(&other, &store);
        assert_true(status == RLVC_E_DAMAGED || status == RLVC_E_MISMATCH);
    }
}

static void test_failing_domain(void **state) {
    (void)state;
    const kind k = {RLVC_CRITERION_RESIDUAL, RLVC_SOLVER_VALUE_ITERATION, ONE_BY_ONE};
    rlvc_progress progress;
    uint32_t failed = 0;
    prepare(&k);
    rlvc_store store = medium_store(&m, &p.config, &p.domain, 0);
    player_play(&p, 100);
    do {
        assert_int_equal(rlvc_learn(p.agent, 300, &progress), RLVC_OK);
        assert_int_equal(rlvc_save(p.agent, &store), RLVC_OK);
        p.faulty.calls = 0;
        p.faulty.fail_at = 5;
        assert_int_equal(load(&other, &store), RLVC_OK);
        assert_int_equal(rlvc_agent_check(other.agent), RLVC_OK);
        p.faulty.fail_at = 0;
        if (other.faulty.calls >= 5u) { /* then the step was given up */
            assert_int_equal(other.agent->learner.phase, RLVC_PHASE_IDLE);
            assert_int_equal(other.agent->replay.frozen, 0);
            failed++;
        }
    } while (!progress.done);
    assert_true(failed > 0);
}

static void test_callbacks_call_back(void **state) {
    (void)state;
    rlvc_store store = two_snapshots(30, 3, RLVC_BUDGET_MIN);
    m.agent = p.agent;
    assert_int_equal(rlvc_save(p.agent, &store), RLVC_OK);
    m.agent = NULL;
    store.sync = NULL;
    assert_int_equal(rlvc_save(p.agent, &store), RLVC_OK);
    assert_int_equal(load(&other, &store), RLVC_OK);
}

/* ------------------------------------------------------------------ golden bytes */

static void golden_snapshot(const char *name) {
    char path[1024];
    static unsigned char bytes[MEDIUM_BYTES];
    rlvc_store store = medium_store(&spare, &p.config, &p.domain, 0);
    assert_int_equal(rlvc_save(p.agent, &store), RLVC_OK);
    snprintf(path, sizeof path, "%s/%s", RLVC_GOLDEN_DIR, name);
    FILE *file = fopen(path, getenv("RLVC_WRITE_GOLDEN") ? "w+b" : "rb");
    if (!file)
        fail_msg("cannot open %s", path);
    uint32_t length = snapshot_bytes(spare.bytes);
    if (getenv("RLVC_WRITE_GOLDEN")) {
        assert_int_equal(fwrite(spare.bytes, 1, length, file), length);
        rewind(file);
    }
    assert_int_equal(fread(bytes, 1, sizeof bytes, file), length);
    fclose(file);
    assert_memory_equal(bytes, spare.bytes, length);
    memset(spare.bytes, 0, sizeof spare.bytes);
    memcpy(spare.bytes, bytes, length);
    assert_int_equal(load(&other, &store), RLVC_OK);
}

static void test_golden(void **state) {
    (void)state;
    rlvc_progress progress;
    prepare_holding(100);
    player_play(&p, 90);
    do {
        assert_int_equal(rlvc_learn(p.agent, RLVC_BUDGET_MIN, &progress), RLVC_OK);
        assert_false(progress.done);
    } while (p.agent->learner.phase != 7 || p.agent->tree.classes < 2 ||
             !p.agent->learner.searching);
    golden_snapshot("snapshot_search.bin");
    player_learn(&p, RLVC_BUDGET_UNBOUNDED, NULL);
    golden_snapshot("snapshot_idle.bin");
}

static void test_crc(void **state) {
    (void)state;
    assert_int_equal(rlvc_crc(0, "123456789", 9), 0xcbf43926u);
    assert_int_equal(rlvc_crc(rlvc_crc(0, "1234", 4), "56789", 5), 0xcbf43926u);
    assert_int_equal(rlvc_crc(0, "", 0), 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_crc),
        cmocka_unit_test(test_resume_anywhere),
        cmocka_unit_test(test_resume_every_slice),
        cmocka_unit_test(test_sequence_comes_round),
        cmocka_unit_test(test_bit_flips),
        cmocka_unit_test(test_forgery),
        cmocka_unit_test(test_unsound_fields),
        cmocka_unit_test(test_unsound_learner),
        cmocka_unit_test(test_unsound_phases),
        cmocka_unit_test(test_nothing_to_weigh),
        cmocka_unit_test(test_resume_improving),
        cmocka_unit_test(test_resume_without_data),
        cmocka_unit_test(test_versions_and_mismatches),
        cmocka_unit_test(test_arguments),
        cmocka_unit_test(test_sizes),
        cmocka_unit_test(test_failing_store),
        cmocka_unit_test(test_unsteady_store),
        cmocka_unit_test(test_failing_domain),
        cmocka_unit_test(test_callbacks_call_back),
        cmocka_unit_test(test_golden),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
