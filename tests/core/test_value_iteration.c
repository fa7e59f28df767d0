/* SPDX-License-Identifier: MIT */
/* The class-level model against plain counting, and the batch solvers, and the value of what was
 * little tried, against value iteration in double over dense tables. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "history.h"
#include "solve/model.h"
#include "explore/novelty.h"

#define CLASSES 7u
#define PAIRS (CLASSES * HISTORY_ACTIONS)
#define CAPACITY 400u
#define NOTHING -1e300

static history list;
static rlvc_replay replay;
static rlvc_values values;
static rlvc_target_input aliasing;
static rlvc_sample samples[CAPACITY];
static rlvc_rows rows = {samples};
static uint64_t values_block[512];
static uint64_t scratch[RLVC_SORT_SCRATCH_BYTES / sizeof(uint64_t)];

/* The same by plain counting: column CLASSES is where an episode terminated. */
static double reward[PAIRS], transitions[PAIRS][CLASSES + 1u], tried[PAIRS];

static uint32_t class_of(uint32_t percept) {
    return (percept * 2654435761u >> 8) % CLASSES;
}

static void make_values(void) {
    rlvc_arena arena = {(unsigned char *)values_block, 0};
    rlvc_config config;
    memset(&config, 0, sizeof config);
    config.classes = CLASSES;
    config.actions = HISTORY_ACTIONS;
    rlvc_values_carve(&values, &arena, &config);
    assert_true(arena.used <= sizeof values_block);
    rlvc_values_clear(&values);
    for (uint32_t c = 1; c < CLASSES; c++)
        rlvc_values_inherit(&values, c, 0);
}

/* `interactions` random ones on a small ring; class 3 never sees action 1 if `gaps`. */
static void make_database(uint32_t seed, uint32_t interactions, int gaps) {
    rlvc_rng rng;
    rlvc_rng_seed(&rng, seed);
    history_init(&list, &replay, CAPACITY);
    for (uint32_t i = 0; i < interactions; i++)
        history_do_random(&list, &replay, &rng, 4u);
    for (uint32_t position = 0; position < replay.count; position++) {
        uint32_t slot = rlvc_replay_slot(&replay, position);
        replay.label[slot] = (uint16_t)class_of(history_percept_at(&replay, position));
        if (gaps && replay.label[slot] == 3u && replay.action[slot] == 1u)
            replay.action[slot] = 2;
    }
    aliasing.returns.replay = &replay;
    aliasing.returns.end = rlvc_replay_freeze(&replay);
    aliasing.values = &values;
    aliasing.kind = RLVC_TARGET_SUCCESSOR;
}

static void count_plainly(void) {
    memset(reward, 0, sizeof reward);
    memset(transitions, 0, sizeof transitions);
    memset(tried, 0, sizeof tried);
    for (uint32_t position = 0; position < aliasing.returns.end; position++) {
        uint32_t slot = rlvc_replay_slot(&replay, position);
        if (!(replay.flags[slot] & RLVC_SLOT_STORED))
            continue;
        uint32_t pair = replay.label[slot] * HISTORY_ACTIONS + replay.action[slot];
        uint32_t next = rlvc_replay_linked(&replay, slot)
                            ? replay.label[rlvc_replay_next(&replay, slot)]
                            : CLASSES;
        reward[pair] += (double)replay.reward[slot];
        transitions[pair][next] += 1.0;
        tried[pair] += 1.0;
    }
}

static void build_model(uint32_t budget) {
    rlvc_model_cursor model;
    rlvc_model_begin(&model, PAIRS);
    while (!model.done) {
        uint32_t used = rlvc_model_step(&model, &aliasing, &values, rows, scratch, budget);
        assert_in_range(used, 1, budget);
    }
}

static void test_model(void **state) {
    (void)state;
    const uint32_t budgets[] = {RLVC_BUDGET_MIN, 97, RLVC_BUDGET_UNBOUNDED};
    for (uint32_t i = 0; i < 12u; i++) {
        make_values();
        make_database(i, 100u * i, 1);
        build_model(budgets[i % 3u]);
        count_plainly();
        for (uint32_t pair = 0; pair < PAIRS; pair++) {
            double left = tried[pair];
            uint32_t last = 0;
            for (uint32_t t = values.begin.transition[pair]; t < values.begin.transition[pair + 1u];
                 t++) {
                uint32_t next =
                    rows.transition[t].next == RLVC_NO_CLASS ? CLASSES : rows.transition[t].next;
                assert_true((double)rows.transition[t].count == transitions[pair][next]);
                assert_true(t == values.begin.transition[pair] || rows.transition[t].next > last);
                last = rows.transition[t].next;
                left -= (double)rows.transition[t].count;
            }
            assert_true(left == 0.0);
            assert_true((double)values.tried[pair] == tried[pair]);
            if (tried[pair] > 0.0)
                assert_true(fabs((double)values.pair.reward[pair] - reward[pair] / tried[pair]) <
                            1e-5);
        }
    }
}

static const uint8_t kinds[] = {RLVC_SOLVER_VALUE_ITERATION, RLVC_SOLVER_POLICY_ITERATION};
#define KINDS 2u

/* V by value iteration in double, to the last bit; of classes that do not end, if it is known which
 * do, it stays as it is. */
static void solve_plainly(double v[CLASSES], double discount, const int *ends) {
    for (int sweep = 0; sweep < 20000; sweep++)
        for (uint32_t c = 0; c < CLASSES; c++) {
            if (ends && !ends[c])
                continue;
            double best = NOTHING;
            for (uint32_t a = 0; a < HISTORY_ACTIONS; a++) {
                uint32_t pair = c * HISTORY_ACTIONS + a;
                double q = 0.0;
                for (uint32_t next = 0; next < CLASSES; next++)
                    q += transitions[pair][next] * v[next];
                q = (reward[pair] + discount * q) / (tried[pair] > 0.0 ? tried[pair] : 1.0);
                if (tried[pair] > 0.0)
                    best = fmax(best, q);
            }
            v[c] = best == NOTHING ? v[c] : best;
        }
}

static rlvc_solver_cursor solve(uint8_t kind, float discount, float tolerance, uint32_t sweeps,
                                uint32_t slice) {
    rlvc_solver_cursor solver;
    const rlvc_solver_input input = {rows.transition, CLASSES, sweeps, discount, tolerance};
    rlvc_solver_begin(&solver, kind);
    while (!solver.done)
        assert_in_range(rlvc_solver_step(&solver, &input, &values, slice), 1, slice);
    return solver;
}

static void check_solution(uint32_t seed, uint8_t kind, float discount) {
    double v[CLASSES] = {0.0};
    float first[CLASSES];
    const float tolerance = 1e-3f;
    for (uint32_t slice = 1; slice < 1000u; slice = slice * 9u + 1u) {
        make_values();
        build_model(RLVC_BUDGET_MIN);
        rlvc_solver_cursor solver = solve(kind, discount, tolerance, 100000, slice);
        assert_true(solver.sweeps < 100000);
        memcpy(slice == 1u ? first : values.value, values.value, sizeof first);
        assert_memory_equal(values.value, first, sizeof first);
    }
    solve_plainly(v, (double)discount, NULL);
    for (uint32_t c = 0; c < CLASSES; c++) {
        double error = fabs((double)values.value[c] - v[c]);
        double horizon = 1.0 / (1.0 - (double)discount);
        double allowed = (double)tolerance + 4e-7 * fabs(v[c]) * (horizon + 10.0);
        /* An action that is worse by no more than the tolerance stays, at each step of the way. */
        if (kind == RLVC_SOLVER_POLICY_ITERATION)
            allowed += (double)tolerance * horizon;
        if (!(error <= allowed))
            fail_msg("seed %u, solver %u, discount %g: V(%u) is %.9g, not %.9g", seed, kind,
                     (double)discount, c, (double)values.value[c], v[c]);
    }
}

static void test_solvers(void **state) {
    (void)state;
    const float discounts[] = {0.0f, 0.5f, 0.9f, 0.99f};
    for (uint32_t seed = 1; seed < 6u; seed++) {
        make_values();
        make_database(seed, seed == 1 ? 12u : 80u * seed, 1);
        count_plainly();
        for (uint32_t i = 0; i < 4u * KINDS; i++)
            check_solution(seed, kinds[i % KINDS], discounts[i / KINDS]);
    }
}

/* Without discount only what episodes bound is bounded; here all of them end. */
static void test_no_discount(void **state) {
    (void)state;
    for (uint32_t i = 0; i < KINDS; i++) {
        uint8_t kind = kinds[i];
        double v[CLASSES] = {0.0};
        make_values();
        make_database(9, 300, 0);
        for (uint32_t slot = 0; slot < replay.slots; slot++)
            replay.reward[slot] = -1.0f;
        count_plainly();
        build_model(RLVC_BUDGET_UNBOUNDED);
        rlvc_solver_cursor solver = solve(kind, 1.0f, 1e-4f, 5000, 7);
        solve_plainly(v, 1.0, NULL);
        assert_true(solver.residual <= 1e-4f);
        for (uint32_t c = 0; c < CLASSES; c++)
            assert_true(fabs((double)values.value[c] - v[c]) < 0.02);
    }
}

/* A random model in which classes 5 and 6 lead to each other only, at 2 a step, and others to any
 * class or to an end. */
static void make_endless(uint32_t seed, float step) {
    rlvc_rng rng;
    uint32_t packed = 0;
    rlvc_rng_seed(&rng, seed);
    memset(transitions, 0, sizeof transitions);
    for (uint32_t pair = 0; pair < PAIRS; pair++) {
        const int caught = pair / HISTORY_ACTIONS >= 5u;
        values.begin.transition[pair] = packed;
        values.pair.reward[pair] = caught ? 2.0f * step : step * rlvc_rng_uniform(&rng);
        values.tried[pair] = caught || rlvc_rng_below(&rng, 4) > 0 ? 4 : 0;
        for (uint32_t i = 0; i < values.tried[pair]; i++) {
            const uint32_t to = caught ? 5u + i % 2u : (pair + 1u + rlvc_rng_below(&rng, 3)) % 8u;
            transitions[pair][to] += 1.0;
        }
        for (uint32_t to = 0; to <= CLASSES; to++) {
            if (transitions[pair][to] > 0.0) {
                samples[packed].key = to == CLASSES ? RLVC_NO_CLASS : to; /* next, and count */
                samples[packed++].slot = (uint32_t)transitions[pair][to];
            }
        }
        tried[pair] = (double)values.tried[pair];
        reward[pair] = (double)values.pair.reward[pair] * tried[pair];
        rlvc_values_note_reward(&values, pair);
    }
    values.begin.transition[PAIRS] = packed;
}

/* Can an end be reached from a class, by the dense tables? One where nothing was tried is taken for
 * one, as its value stays. */
static void find_ends(int ends[CLASSES + 1u]) {
    memset(ends, 0, (CLASSES + 1u) * sizeof *ends);
    ends[CLASSES] = 1;
    for (uint32_t c = 0; c < CLASSES; c++) {
        double all = 0.0;
        for (uint32_t a = 0; a < HISTORY_ACTIONS; a++)
            all += tried[c * HISTORY_ACTIONS + a];
        ends[c] = all == 0.0;
    }
    for (uint32_t i = 0; i < CLASSES; i++)
        for (uint32_t pair = 0; pair < PAIRS; pair++)
            for (uint32_t to = 0; to <= CLASSES; to++)
                ends[pair / HISTORY_ACTIONS] |= transitions[pair][to] > 0.0 && ends[to];
}

/* Without a discount a class that cannot end is held at the bound, and the others settle, to what
 * a solver in double makes of them that is told which those are. */
static void test_endless(void **state) {
    (void)state;
    const float steps[] = {-1.0f, 1.0f, 0.0f};
    uint32_t settled = 0;
    for (uint32_t i = 0; i < 40u * KINDS; i++) {
        const float step = steps[i / KINDS % 3u];
        double v[CLASSES] = {0.0};
        int ends[CLASSES + 1u];
        make_values();
        make_endless(i, step);
        find_ends(ends);
        rlvc_solver_cursor solver = solve(kinds[i % KINDS], 1.0f, 1e-4f, 2000, 1u + i % 9u);
        for (uint32_t c = 0; c < CLASSES; c++)
            v[c] = ends[c] ? 0.0 : 2000.0 * (double)step;
        solve_plainly(v, 1.0, ends);
        assert_int_equal(solver.endless, step != 0.0f);
        assert_true((rlvc_solver_residual(&solver) == RLVC_RESIDUAL_ENDLESS) == solver.endless);
        settled += solver.sweeps < 2000u;
        for (uint32_t c = 0; c < CLASSES && step <= 0.0f && solver.sweeps < 2000u; c++) {
            if (!(fabs((double)values.value[c] - v[c]) < 0.02 - 1e-3 * v[c]))
                fail_msg("model %u, class %u: %g, not %g", i, c, (double)values.value[c], v[c]);
        }
        for (uint32_t c = 0; c < CLASSES; c++)
            assert_in_range((int)fabsf(values.value[c]), 0, 2000);
    }
    assert_true(settled > 70u); /* of 80 */
}

/* A tolerance that binary32 cannot reach, and sweeps that run out. */
static void test_the_end(void **state) {
    (void)state;
    make_values();
    make_database(4, 300, 0);
    build_model(RLVC_BUDGET_UNBOUNDED);
    for (uint32_t i = 0; i < KINDS; i++) {
        uint8_t kind = kinds[i];
        assert_in_range(solve(kind, 0.99f, 1e-30f, INT32_MAX, 1000).sweeps, 10, 5000);
        for (uint32_t sweeps = 1; sweeps < 5u; sweeps++) {
            make_values();
            build_model(RLVC_BUDGET_UNBOUNDED);
            rlvc_solver_cursor solver = solve(kind, 0.99f, 1e-3f, sweeps, 1);
            assert_int_equal(solver.sweeps, sweeps);
            assert_true(solver.residual > 0.0f);
        }
    }
}

/* What was learnt from interactions that have left the ring stays. */
static void test_forgotten_interactions(void **state) {
    (void)state;
    make_values();
    history_init(&list, &replay, CAPACITY);
    aliasing.returns.end = rlvc_replay_freeze(&replay);
    values.q[4] = 12.0f;
    values.tried[4] = 3;
    build_model(RLVC_BUDGET_MIN);
    for (uint32_t i = 0; i < KINDS; i++) {
        solve(kinds[i], 0.9f, 1e-3f, 100, 3);
        assert_float_equal(values.q[4], 12.0f, 0.0f);
        assert_int_equal(values.tried[4], 3);
        assert_float_equal(values.value[1], 12.0f, 0.0f);
        assert_float_equal(values.value[2], 0.0f, 0.0f);
    }
}

/* ------------------------------------------------------------------ what was little tried */

static uint8_t count[PAIRS];
static uint8_t to_novel[CLASSES];
static rlvc_explorer explorer = {count, to_novel, 0, RLVC_NO_ACTION};

static rlvc_novelty_cursor find_novelty(uint32_t max_sweeps, uint32_t slice) {
    rlvc_novelty_cursor novelty;
    const rlvc_solver_input input = {rows.transition, CLASSES, max_sweeps, 0.9f, 1e-3f};
    rlvc_novelty_begin(&novelty, &input, &values, aliasing.returns.end);
    while (!novelty.done)
        assert_in_range(rlvc_novelty_step(&novelty, &input, &values, &replay, &explorer, slice), 1,
                        slice);
    return novelty;
}

/* The chance that an episode begins where none has begun. */
static double plain_chance(void) {
    double begun[CLASSES] = {0.0}, episodes = 0.0, once = 0.0;
    for (uint32_t position = 1; position < aliasing.returns.end; position++) {
        if (rlvc_replay_linked(&replay, rlvc_replay_slot(&replay, position - 1u)))
            continue;
        begun[replay.label[rlvc_replay_slot(&replay, position)]] += 1.0;
        episodes += 1.0;
    }
    for (uint32_t c = 0; c < CLASSES; c++)
        once += begun[c] == 1.0 ? 1.0 : 0.0;
    return episodes > 0.0 ? once / episodes : 0.0;
}

static double plain_nearness(uint32_t pair, const double u[CLASSES]) {
    double sum = transitions[pair][CLASSES] * plain_chance();
    for (uint32_t next = 0; next < CLASSES; next++)
        sum += transitions[pair][next] * u[next];
    return tried[pair] < (double)explorer.min_tried ? 1.0 : 0.95 * sum / tried[pair];
}

/* What is found is at most the true nearness, and no more below it than ignored changes add up
 * to. */
static void check_nearness(uint32_t seed) {
    const double ignored = 0.001 / (1.0 - 0.95);
    double u[CLASSES] = {0.0};
    for (int sweep = 0; sweep < 500; sweep++)
        for (uint32_t c = 0; c < CLASSES; c++)
            for (uint32_t a = 0; a < HISTORY_ACTIONS; a++)
                u[c] = fmax(u[c], plain_nearness(c * HISTORY_ACTIONS + a, u));
    for (uint32_t c = 0; c < CLASSES; c++) {
        double found = (double)values.pair.nearness[c];
        int leads = to_novel[c] != RLVC_NO_ACTION;
        int right = leads == (found > 0.001 && found < 1.0);
        if (leads)
            right = right && to_novel[c] < HISTORY_ACTIONS &&
                    plain_nearness(c * HISTORY_ACTIONS + to_novel[c], u) >= u[c] - ignored;
        if (!right || found > u[c] + 1e-5 || found < u[c] - ignored)
            fail_msg("seed %u, m = %u: class %u is at %g by action %u, not at %g", seed,
                     explorer.min_tried, c, found, to_novel[c], u[c]);
        for (uint32_t a = 0; a < HISTORY_ACTIONS; a++) {
            uint32_t pair = c * HISTORY_ACTIONS + a;
            assert_int_equal(count[pair], tried[pair] < 255.0 ? (int)tried[pair] : 255);
        }
    }
}

static void test_novelty(void **state) {
    (void)state;
    uint32_t leading = 0, others = 0, new_starts = 0;
    for (uint32_t seed = 1; seed < 9u; seed++) {
        make_values();
        make_database(seed, seed == 8u ? 399 : 40u * seed, seed % 2u == 0);
        if (seed < 4u) /* few episodes */
            make_database(seed, 12u * seed, 0);
        count_plainly();
        new_starts += plain_chance() > 0.0;
        for (uint32_t m = 0; m < 30u; m += 1u + m / 4u) {
            float first[CLASSES];
            explorer.min_tried = (uint8_t)m;
            for (uint32_t slice = 1; slice < 1000u; slice = slice * 9u + 1u) {
                build_model(RLVC_BUDGET_MIN);
                rlvc_novelty_cursor novelty = find_novelty(10000, slice);
                assert_true(novelty.sweeps < 10000);
                memcpy(slice == 1u ? first : values.pair.nearness, values.pair.nearness,
                       sizeof first);
                assert_memory_equal(values.pair.nearness, first, sizeof first);
            }
            check_nearness(seed);
            for (uint32_t c = 0; c < CLASSES; c++) {
                leading += to_novel[c] != RLVC_NO_ACTION;
                others += to_novel[c] == RLVC_NO_ACTION;
            }
        }
    }
    assert_true(leading > 5 && others > 50 && new_starts > 1);
}

/* Sweeps run out; and a table of counts that is not there is not written. */
static void test_novelty_briefly(void **state) {
    (void)state;
    make_values();
    make_database(4, 300, 0);
    count_plainly();
    explorer.min_tried = 14;
    memset(count, 77, sizeof count);
    explorer.count = NULL;
    for (uint32_t sweeps = 1; sweeps < 3u; sweeps++) {
        build_model(RLVC_BUDGET_UNBOUNDED);
        assert_int_equal(find_novelty(sweeps, 5).sweeps, sweeps);
    }
    explorer.count = count;
    for (uint32_t pair = 0; pair < PAIRS; pair++)
        assert_int_equal(count[pair], 77);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_model),       cmocka_unit_test(test_solvers),
        cmocka_unit_test(test_no_discount), cmocka_unit_test(test_endless),
        cmocka_unit_test(test_the_end),     cmocka_unit_test(test_forgotten_interactions),
        cmocka_unit_test(test_novelty),     cmocka_unit_test(test_novelty_briefly),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
