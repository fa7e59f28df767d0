/* SPDX-License-Identifier: MIT */
/* Learning: the same whatever the budgets, and whatever fails on the way, for each criterion,
 * solver and form of the domain; a full tree; interactions observed while learning. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "player.h"

static player p, other;
static player_result expected, got;

typedef struct learning {
    uint8_t criterion;
    uint8_t solver;
    uint8_t score;
    int form;
} learning;

#define CRITERIA 2u
#define SOLVERS 4u
#define SCORES 2u
#define CASES (CRITERIA * SOLVERS * FORMS)

static const uint8_t scores[SCORES] = {RLVC_SCORE_GAIN, RLVC_SCORE_RANKS};

static learning case_number(uint32_t i) {
    learning made;
    made.criterion = (uint8_t)(i % CRITERIA);
    made.solver = (uint8_t)(i / CRITERIA % SOLVERS);
    made.form = (int)(i / CRITERIA / SOLVERS);
    made.score = made.form == OWN_ORACLE ? RLVC_SCORE_GAIN
                                         : scores[(made.solver + (uint32_t)made.form) % SCORES];
    return made;
}

/* What reruns a case that failed. */
static void name_case(const learning *l) {
    print_message("criterion %u, solver %u, score %u, %s\n", l->criterion, l->solver, l->score,
                  form_names[l->form]);
}

/* An agent that has learnt `steps` times and has more to learn from. */
static void prepare(player *agent, const learning *l, uint32_t steps) {
    player_enter_world(agent, l->form);
    agent->config.criterion = l->criterion;
    agent->config.solver = l->solver;
    agent->config.score = l->score;
    agent->config.epsilon = l->criterion == RLVC_CRITERION_RETURNS ? 0.5f : 0.9f;
    agent->config.explore = l->criterion == RLVC_CRITERION_RESIDUAL; /* directed, or uniform */
    agent->config.capacity = 300;
    agent->config.alpha = 1.0f;
    agent->config.alpha_known = 0.3f;
    agent->config.successors = l->form != OWN_ORACLE && l->solver != RLVC_SOLVER_POLICY_ITERATION;
    agent->config.dependence = l->form != BATCH && l->solver != RLVC_SOLVER_VALUE_ITERATION;
    agent->config.smallest_effect = l->form == BATCH ? 0.1f : 0.0f;
    agent->config.features_at_once = agent->config.successors ? 6 : 2;
    player_init(agent);
    for (uint32_t i = 0; i < steps; i++) {
        player_play(agent, 240);
        player_learn(agent, RLVC_BUDGET_UNBOUNDED, NULL);
    }
    player_play(agent, 240);
    player_save(agent);
}

/* ------------------------------------------------------------------ slices */

static void test_budgets_do_not_matter(void **state) {
    (void)state;
    const uint32_t budgets[] = {RLVC_BUDGET_MIN, 65, 97, 1000, 100000, UINT32_MAX - 1u};
    for (uint32_t i = 0; i < CASES; i++) {
        const learning l = case_number(i);
        rlvc_rng rng;
        rlvc_rng_seed(&rng, i);
        name_case(&l);
        prepare(&p, &l, 1u);
        player_learn(&p, RLVC_BUDGET_UNBOUNDED, NULL);
        player_result_of(&p, &expected);
        assert_true(player_stats(&p).classes > 1u); /* or there is nothing to see */
        block_copy(other.block, p.block, sizeof p.block);
        for (uint32_t j = 0; j < 10u; j++) {
            player_restore(&p);
            player_learn(&p, j < 6u ? budgets[j] : 0, j < 6u ? NULL : &rng);
            player_result_of(&p, &got);
            assert_int_equal(got.bytes, expected.bytes);
            assert_memory_equal(got.text, expected.text, expected.bytes);
            assert_true(block_equal(p.block, other.block, sizeof p.block));
        }
    }
}

/* ------------------------------------------------------------------ failures */

/* Learns, with the n-th callback failing, and goes on to the end. */
static void learn_with_failure(uint64_t n) {
    rlvc_progress progress;
    player_restore(&p);
    p.faulty.fail_at = n;
    assert_int_equal(rlvc_learn(p.agent, RLVC_BUDGET_UNBOUNDED, &progress), RLVC_E_CALLBACK);
    assert_int_equal(progress.done, 0);
    assert_int_equal(rlvc_agent_check(p.agent), RLVC_OK);
    assert_int_equal(rlvc_learn(p.agent, RLVC_BUDGET_UNBOUNDED, &progress), RLVC_OK);
    assert_int_equal(progress.done, 1);
}

/* Learns with every n-th call failing. */
static void learn_with_failures(uint64_t n, uint32_t budget) {
    rlvc_progress progress;
    uint64_t failures = 0;
    player_restore(&p);
    p.faulty.fail_every = n;
    do {
        rlvc_status status = rlvc_learn(p.agent, budget, &progress);
        assert_true(status == RLVC_OK || status == RLVC_E_CALLBACK);
        assert_true(progress.work <= budget);
        assert_int_equal(rlvc_agent_check(p.agent), RLVC_OK);
        failures += status == RLVC_E_CALLBACK;
    } while (!progress.done);
    assert_int_equal(failures, p.faulty.calls / n);
}

static void test_every_callback_fails(void **state) {
    (void)state;
    for (uint32_t i = 0; i < CASES; i++) {
        const learning l = case_number(i);
        name_case(&l);
        prepare(&p, &l, 1u);
        player_restore(&p);
        player_learn(&p, RLVC_BUDGET_UNBOUNDED, NULL);
        uint64_t calls = p.faulty.calls;
        block_copy(other.block, p.block, sizeof p.block);
        assert_true(calls > 50u);
        for (uint64_t n = 1; n <= calls; n += RLVC_STRIDE) {
            learn_with_failure(n);
            if (!block_equal(p.block, other.block, sizeof p.block))
                fail_msg("another result after callback %u failed", (unsigned)n);
        }
        /* A sample is looked at by all features of a block at once: so many calls in a row must
         * succeed. */
        for (uint64_t n = p.config.features_at_once + 1u; n < 11u; n++) {
            learn_with_failures(n, n % 2u == 0 ? RLVC_BUDGET_UNBOUNDED : 97);
            assert_true(block_equal(p.block, other.block, sizeof p.block));
        }
    }
}

static void test_callbacks_call_back(void **state) {
    (void)state;
    for (int form = 0; form < FORMS; form++) {
        const learning l = {RLVC_CRITERION_RESIDUAL, RLVC_SOLVER_SARSA, RLVC_SCORE_GAIN, form};
        prepare(&p, &l, 1);
        player_learn(&p, RLVC_BUDGET_UNBOUNDED, NULL);
        player_result_of(&p, &expected);
        prepare(&p, &l, 1);
        p.faulty.agent = p.agent;
        player_learn(&p, RLVC_BUDGET_UNBOUNDED, NULL);
        player_result_of(&p, &got);
        p.faulty.agent = NULL;
        assert_true(p.faulty.refused > 5u);
        assert_memory_equal(&got, &expected, sizeof got);
    }
}

/* Says that there are more candidates than there is room for. */
static int too_many(void *ctx, const rlvc_samples *samples, uint32_t first, uint32_t room,
                    void *features, uint32_t *written) {
    (void)ctx;
    (void)samples;
    (void)first;
    (void)features;
    *written = room + 1u;
    return 0;
}

static void test_too_many_candidates(void **state) {
    (void)state;
    rlvc_progress progress;
    player_enter_world(&p, BATCH);
    p.domain.candidates = too_many;
    player_init(&p);
    player_play(&p, 280);
    assert_int_equal(rlvc_learn(p.agent, RLVC_BUDGET_UNBOUNDED, &progress), RLVC_E_CALLBACK);
    assert_int_equal(rlvc_agent_check(p.agent), RLVC_OK);
}

/* Has no candidates. */
static int none(void *ctx, const rlvc_samples *samples, uint32_t first, uint32_t room,
                void *features, uint32_t *written) {
    (void)ctx;
    (void)samples;
    (void)first;
    (void)room;
    (void)features;
    *written = 0;
    return 0;
}

/* Interactions without a reward, whose percept changes at every tenth, by the other action: what
 * follows is foretold by it. */
static void change_seldom(uint32_t interactions) {
    unsigned char percept = 0;
    assert_int_equal(rlvc_begin(p.agent, &percept), RLVC_OK);
    for (uint32_t i = 0; i < interactions; i++) {
        const rlvc_choice choice = {i % 10u == 9u, 1};
        percept ^= choice.action;
        assert_int_equal(rlvc_observe(p.agent, choice, 0.0f, &percept, RLVC_GOES_ON), RLVC_OK);
    }
}

/* While all rewards are equal, it is the search by what follows that asks for candidates. */
static void test_candidates_of_what_follows(void **state) {
    (void)state;
    for (int nothing = 0; nothing < 2; nothing++) {
        rlvc_progress progress;
        player_enter_world(&p, BATCH);
        p.domain.candidates = nothing ? none : too_many;
        p.config.successors = 1;
        player_init(&p);
        change_seldom(100);
        assert_int_equal(rlvc_learn(p.agent, RLVC_BUDGET_UNBOUNDED, &progress),
                         nothing ? RLVC_OK : RLVC_E_CALLBACK);
        assert_int_equal(rlvc_agent_check(p.agent), RLVC_OK);
        assert_int_equal(player_stats(&p).classes, 1);
    }
}

/* A table of several words, cut between them. */
static void test_slices_of_what_follows(void **state) {
    (void)state;
    rlvc_progress progress;
    player_enter_world(&p, BATCH);
    p.config.successors = 1;
    player_init(&p);
    change_seldom(250);
    player_save(&p);
    player_learn(&p, RLVC_BUDGET_UNBOUNDED, NULL);
    assert_true(player_stats(&p).classes > 1u);
    block_copy(other.block, p.block, sizeof p.block);
    for (uint32_t budget = RLVC_BUDGET_MIN; budget < RLVC_BUDGET_MIN + 8u; budget++) {
        player_restore(&p);
        do {
            assert_int_equal(rlvc_learn(p.agent, budget, &progress), RLVC_OK);
        } while (!progress.done);
        assert_true(block_equal(p.block, other.block, sizeof p.block));
    }
}

/* ------------------------------------------------------------------ forms of one domain */

/* Feature detector or batch detector, and blocks of any size: the same tree. */
static void test_detectors_and_blocks(void **state) {
    (void)state;
    const uint32_t at_once[] = {1, 3, 6, 64};
    for (uint32_t i = 0; i < 2u * SCORES * 8u; i++) {
        player_enter_world(&p, i % 2u == 0 ? BATCH : ONE_BY_ONE);
        p.config.features_at_once = at_once[i / 2u % 4u];
        p.config.score = scores[i / 8u % SCORES];
        p.config.criterion = (uint8_t)(i / (8u * SCORES));
        p.config.epsilon = 0.5f;
        p.config.alpha = 1.0f;
        player_init(&p);
        for (int step = 0; step < 2; step++) {
            player_play(&p, 280);
            player_learn(&p, RLVC_BUDGET_UNBOUNDED, NULL);
        }
        assert_true(player_stats(&p).classes > 1u);
        player_result_of(&p, i % 8u == 0 ? &expected : &got);
        if (i % 8u != 0)
            assert_memory_equal(&got, &expected, sizeof got);
    }
}

/* ---------------------------------------------------------------- the ring and the tree fill up */

/* Between two episodes there is no current percept, and the ring may hold one interaction more than
 * its capacity: what is learnt from them is what a larger ring learns from the same. */
static void test_every_slot_terminated(void **state) {
    (void)state;
    for (uint32_t capacity = 127; capacity < 131u; capacity++) {
        for (uint32_t room = 0; room < 2u; room++) {
            rlvc_rng rng;
            rlvc_rng_seed(&rng, capacity);
            player_enter_world(&p, BATCH);
            p.config.capacity = capacity + room;
            p.config.actions = 1;
            p.config.successors = 1;
            player_init(&p);
            for (uint32_t i = 0; i <= capacity; i++) {
                unsigned char percept = (unsigned char)(rlvc_rng_next(&rng) & 63u);
                const rlvc_choice choice = {0, 1};
                float reward = (float)(percept & 3u);
                assert_int_equal(rlvc_begin(p.agent, &percept), RLVC_OK);
                assert_int_equal(rlvc_observe(p.agent, choice, reward, NULL, RLVC_TERMINATED),
                                 RLVC_OK);
            }
            assert_int_equal(player_stats(&p).stored, capacity + 1u);
            player_learn(&p, RLVC_BUDGET_UNBOUNDED, NULL);
            assert_int_equal(player_stats(&p).classes, 4);
            player_result_of(&p, room == 0 ? &expected : &got);
        }
        assert_memory_equal(&got, &expected, sizeof got);
    }
}

static void test_full_tree(void **state) {
    (void)state;
    for (uint32_t classes = 1; classes < 5u; classes++) {
        rlvc_progress progress;
        player_enter_world(&p, BATCH);
        p.config.classes = classes;
        player_init(&p);
        player_play(&p, 300);
        assert_int_equal(rlvc_learn(p.agent, RLVC_BUDGET_UNBOUNDED, &progress), RLVC_OK);
        assert_int_equal(progress.done, 1);
        assert_int_equal(progress.splits, classes - 1u);
        rlvc_statistics statistics = player_stats(&p);
        assert_int_equal(statistics.classes, classes);
        assert_true(statistics.refused > 0);
        assert_int_equal(rlvc_agent_check(p.agent), RLVC_OK);
    }
}

/* ------------------------------------------------------------------ observing while learning */

static const rlvc_choice first_action = {0, 1};

/* Observes into spare room between slices: the step does not see it, the next one does. */
static void test_observe_while_learning(void **state) {
    (void)state;
    for (uint32_t i = 0; i < CRITERIA * SOLVERS; i++) {
        const learning l = case_number(i);
        rlvc_progress progress;
        uint32_t observed = 0;
        if (l.solver == RLVC_SOLVER_Q_LEARNING || l.solver == RLVC_SOLVER_SARSA)
            continue; /* these learn from what they observe, at once */
        prepare(&p, &l, 0);
        player_learn(&p, RLVC_BUDGET_UNBOUNDED, NULL);
        player_result_of(&p, &expected);
        player_restore(&p);
        do {
            assert_int_equal(rlvc_learn(p.agent, 500, &progress), RLVC_OK);
            if (!progress.done && observed < 20u) {
                player_play(&p, 1);
                observed++;
            }
        } while (!progress.done);
        player_result_of(&p, &got);
        assert_memory_equal(&got, &expected, sizeof got);
        assert_true(observed > 3u);
        assert_int_equal(player_stats(&p).interactions, 240u + observed);
        assert_int_equal(player_stats(&p).stored,
                         l.criterion == RLVC_CRITERION_RETURNS ? 0 : 240u + observed);
    }
}

/* A ring that is full of what is being learnt from takes nothing but the end of an episode. */
static void test_full_ring_while_learning(void **state) {
    (void)state;
    rlvc_progress progress;
    const unsigned char percept[8] = {0};
    player_enter_world(&p, BATCH);
    p.config.capacity = 50;
    player_init(&p);
    assert_int_equal(rlvc_begin(p.agent, percept), RLVC_OK);
    for (int i = 0; i < 60; i++)
        assert_int_equal(rlvc_observe(p.agent, first_action, 1.0f, percept, RLVC_GOES_ON), RLVC_OK);
    assert_int_equal(player_stats(&p).stored, 50);
    assert_int_equal(rlvc_learn(p.agent, RLVC_BUDGET_MIN, &progress), RLVC_OK);
    assert_int_equal(progress.done, 0);
    player_save(&p);
    assert_int_equal(rlvc_observe(p.agent, first_action, 1.0f, percept, RLVC_GOES_ON), RLVC_E_BUSY);
    assert_int_equal(rlvc_observe(p.agent, first_action, 1.0f, percept, RLVC_TRUNCATED),
                     RLVC_E_BUSY);
    assert_int_equal(rlvc_begin(p.agent, percept), RLVC_E_BUSY);
    player_unchanged(&p, "RLVC_E_BUSY");
    assert_int_equal(rlvc_observe(p.agent, first_action, 1.0f, NULL, RLVC_TERMINATED), RLVC_OK);
    assert_int_equal(rlvc_begin(p.agent, percept), RLVC_E_BUSY);
    player_learn(&p, RLVC_BUDGET_UNBOUNDED, NULL);
    assert_int_equal(rlvc_begin(p.agent, percept), RLVC_OK);
    assert_int_equal(rlvc_agent_check(p.agent), RLVC_OK);
}

/* ------------------------------------------------------------------ small databases */

static void test_nothing_to_learn_from(void **state) {
    (void)state;
    const unsigned char percept[8] = {0};
    for (uint32_t i = 0; i < CASES * 3u; i++) {
        const learning l = case_number(i / 3u);
        player_enter_world(&p, l.form);
        p.config.criterion = l.criterion;
        p.config.solver = l.solver;
        player_init(&p);
        for (uint32_t begun = 0; begun < i % 3u; begun++) {
            assert_int_equal(rlvc_begin(p.agent, percept), RLVC_OK);
            assert_int_equal(rlvc_observe(p.agent, first_action, 3.0f, percept, RLVC_TRUNCATED),
                             RLVC_OK);
        }
        player_learn(&p, RLVC_BUDGET_MIN, NULL);
        assert_int_equal(player_stats(&p).step, 1);
        assert_int_equal(player_stats(&p).classes, 1);
        assert_int_equal(player_stats(&p).stored,
                         l.criterion == RLVC_CRITERION_RETURNS ? 0 : i % 3u);
    }
}

/* The special case of section 7: without a discount and with two rewards only, refinement is the
 * learning of a decision tree for two classes of percepts. Here the reward is 1 where bit 1 or both
 * bits 2 and 4 are 1. */
static void test_classification(void **state) {
    (void)state;
    for (uint32_t i = 0; i < CRITERIA * SCORES; i++) {
        rlvc_rng rng;
        rlvc_domain bits;
        rlvc_rng_seed(&rng, i);
        assert_int_equal(rlvc_bits_domain(8, &bits), RLVC_OK);
        player_enter_world(&p, BATCH);
        p.domain = bits;
        assert_int_equal(rlvc_config_default(&p.config, &bits, 1), RLVC_OK);
        p.config.criterion = (uint8_t)(i % CRITERIA);
        p.config.score = scores[i / CRITERIA];
        p.config.capacity = 1500;
        p.config.classes = 8;
        p.config.discount = 0.0f;
        player_init(&p);
        for (uint32_t n = 0; n < 1500u; n++) {
            unsigned char percept = (unsigned char)rlvc_rng_next(&rng);
            int positive = (percept & 2) || (percept & 20) == 20;
            const rlvc_choice choice = {0, 1};
            assert_int_equal(rlvc_begin(p.agent, &percept), RLVC_OK);
            assert_int_equal(
                rlvc_observe(p.agent, choice, positive ? 1.0f : 0.0f, NULL, RLVC_TERMINATED),
                RLVC_OK);
        }
        player_learn(&p, 1000, NULL);
        assert_int_equal(player_stats(&p).classes, 4);
        for (uint32_t n = 0; n < 256u; n++) {
            unsigned char percept = (unsigned char)n;
            uint32_t class_id = UINT32_MAX;
            float value = -1.0f;
            assert_int_equal(rlvc_predict(p.agent, &percept, &class_id, NULL), RLVC_OK);
            assert_int_equal(rlvc_value(p.agent, class_id, &value, NULL), RLVC_OK);
            float reward = (n & 2u) || (n & 20u) == 20u ? 1.0f : 0.0f;
            assert_float_equal(value, reward, 0.0f);
        }
    }
}

static void test_arguments(void **state) {
    (void)state;
    rlvc_progress progress;
    player_enter_world(&p, BATCH);
    player_init(&p);
    player_save(&p);
    assert_int_equal(rlvc_learn(NULL, 100, &progress), RLVC_E_NULL);
    assert_int_equal(rlvc_learn(p.agent, 100, NULL), RLVC_E_NULL);
    assert_int_equal(rlvc_learn(p.agent, 0, &progress), RLVC_E_RANGE);
    assert_int_equal(rlvc_learn(p.agent, RLVC_BUDGET_MIN - 1u, &progress), RLVC_E_RANGE);
    player_unchanged(&p, "a refused budget");
}

/* An endless world, with a percept of one bit that says nothing. */
static rlvc_agent *endless_world(float discount, uint32_t max_sweeps, float reward) {
    static uint64_t memory[RLVC_AGENT_BYTES(1, 50, 4, 1, RLVC_BITS_FEATURE_BYTES, 1) / 8u];
    const unsigned char percept = 0;
    const rlvc_choice choice = {0, 0};
    rlvc_domain domain;
    rlvc_config config;
    rlvc_agent *agent;
    rlvc_progress progress;
    assert_int_equal(rlvc_bits_domain(1, &domain), RLVC_OK);
    assert_int_equal(rlvc_config_default(&config, &domain, 1), RLVC_OK);
    config.capacity = 50;
    config.classes = 4;
    config.discount = discount;
    config.max_sweeps = max_sweeps;
    assert_int_equal(rlvc_agent_init(&config, &domain, memory, sizeof memory, &agent), RLVC_OK);
    assert_int_equal(rlvc_begin(agent, &percept), RLVC_OK);
    for (uint32_t i = 0; i < 20; i++)
        assert_int_equal(rlvc_observe(agent, choice, reward, &percept, RLVC_GOES_ON), RLVC_OK);
    assert_int_equal(rlvc_learn(agent, RLVC_BUDGET_UNBOUNDED, &progress), RLVC_OK);
    return agent;
}

static void check_solution(rlvc_agent *agent, uint32_t solution, float value) {
    rlvc_statistics statistics;
    float found;
    assert_int_equal(rlvc_stats(agent, &statistics), RLVC_OK);
    assert_int_equal(statistics.solution, solution);
    assert_int_equal(statistics.residual == RLVC_RESIDUAL_ENDLESS,
                     solution == RLVC_SOLUTION_ENDLESS);
    assert_int_equal(rlvc_value(agent, 0, &found, NULL), RLVC_OK);
    assert_true(found > value - 0.1f && found < value + 0.1f);
}

static void test_solutions(void **state) {
    (void)state;
    check_solution(endless_world(0.9f, 10000, -2.0f), RLVC_SOLUTION_CONVERGED, -20.0f);
    check_solution(endless_world(0.9f, 5, -2.0f), RLVC_SOLUTION_CUT_SHORT, -8.19f);
    check_solution(endless_world(1.0f, 100, -2.0f), RLVC_SOLUTION_ENDLESS, -100.0f);
    check_solution(endless_world(1.0f, 100, 2.0f), RLVC_SOLUTION_ENDLESS, 100.0f);
    check_solution(endless_world(1.0f, 100, 0.0f), RLVC_SOLUTION_CONVERGED, 0.0f);
}

/* A step without new interactions looks at the classes alone, and changes nothing. */
static void test_nothing_new(void **state) {
    (void)state;
    const unsigned char percept = 1;
    const rlvc_choice choice = {0, 0};
    rlvc_agent *agent = endless_world(0.9f, 10000, 1.0f);
    rlvc_statistics before, after;
    rlvc_progress progress;
    float value, again;
    assert_int_equal(rlvc_stats(agent, &before), RLVC_OK);
    assert_int_equal(rlvc_value(agent, 0, &value, NULL), RLVC_OK);
    assert_int_equal(rlvc_learn(agent, RLVC_BUDGET_UNBOUNDED, &progress), RLVC_OK);
    assert_true(progress.done && progress.rounds == 0 && progress.work == 2);
    assert_int_equal(rlvc_stats(agent, &after), RLVC_OK);
    assert_int_equal(rlvc_value(agent, 0, &again, NULL), RLVC_OK);
    assert_true(value == again && after.sweeps == before.sweeps);
    assert_int_equal(after.step, before.step + 1u);
    /* What is observed while a step is under way is new to the next, also where it ends the episode
     * at a percept that the step has labelled. */
    assert_int_equal(rlvc_observe(agent, choice, 1.0f, &percept, RLVC_GOES_ON), RLVC_OK);
    assert_int_equal(rlvc_learn(agent, RLVC_BUDGET_MIN, &progress), RLVC_OK);
    assert_false(progress.done);
    assert_int_equal(rlvc_observe(agent, choice, 1.0f, NULL, RLVC_TERMINATED), RLVC_OK);
    assert_int_equal(rlvc_learn(agent, RLVC_BUDGET_UNBOUNDED, &progress), RLVC_OK);
    assert_int_equal(rlvc_learn(agent, RLVC_BUDGET_UNBOUNDED, &progress), RLVC_OK);
    assert_int_equal(progress.rounds, 1);
    assert_int_equal(rlvc_learn(agent, RLVC_BUDGET_UNBOUNDED, &progress), RLVC_OK);
    assert_int_equal(progress.rounds, 0);
    assert_int_equal(rlvc_begin(agent, &percept), RLVC_OK);
    assert_int_equal(rlvc_learn(agent, RLVC_BUDGET_UNBOUNDED, &progress), RLVC_OK);
    assert_int_equal(progress.rounds, 0);
    assert_int_equal(rlvc_observe(agent, choice, 1.0f, NULL, RLVC_TERMINATED), RLVC_OK);
    assert_int_equal(rlvc_learn(agent, RLVC_BUDGET_UNBOUNDED, &progress), RLVC_OK);
    assert_int_equal(progress.rounds, 1);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_solutions),
        cmocka_unit_test(test_nothing_new),
        cmocka_unit_test(test_budgets_do_not_matter),
        cmocka_unit_test(test_every_callback_fails),
        cmocka_unit_test(test_callbacks_call_back),
        cmocka_unit_test(test_too_many_candidates),
        cmocka_unit_test(test_candidates_of_what_follows),
        cmocka_unit_test(test_slices_of_what_follows),
        cmocka_unit_test(test_detectors_and_blocks),
        cmocka_unit_test(test_every_slot_terminated),
        cmocka_unit_test(test_full_tree),
        cmocka_unit_test(test_observe_while_learning),
        cmocka_unit_test(test_full_ring_while_learning),
        cmocka_unit_test(test_nothing_to_learn_from),
        cmocka_unit_test(test_classification),
        cmocka_unit_test(test_arguments),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
