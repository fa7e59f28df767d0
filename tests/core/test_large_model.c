/* SPDX-License-Identifier: MIT */
/* Value iteration on models of more classes than RLVC_CLASSES_SMALL, whose sweeps go there and back
 * and mostly by one action, against plain value iteration in double. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "base/rng.h"
#include "samples/replay.h"
#include "solve/value_iteration.h"

#include <string.h>

#define CLASSES (RLVC_CLASSES_SMALL + 88u)
#define ACTIONS 3u
#define PAIRS (CLASSES * ACTIONS)
#define BRANCHES 3u /* of a pair, at most */
#define PERIOD 9u   /* sweeps: one by all actions, and eight by the greedy ones */

static rlvc_transition transition[PAIRS * BRANCHES];
static uint32_t begin[PAIRS + 1u], tried[PAIRS];
static float q[PAIRS], reward[PAIRS], value[CLASSES];
static uint8_t policy[CLASSES], trial[CLASSES];
static rlvc_values values;

/* A random model. Pairs lead to classes near by or to an end; some were never tried, of some all
 * interactions have left the ring, and in some classes nothing is known at all. */
static void make_model(uint32_t seed) {
    rlvc_rng rng;
    uint32_t packed = 0;
    rlvc_rng_seed(&rng, seed);
    for (uint32_t pair = 0; pair < PAIRS; pair++) {
        const uint32_t c = pair / ACTIONS, kind = c % 50u == 7u ? 0u : rlvc_rng_below(&rng, 20);
        begin[pair] = packed;
        tried[pair] = kind > 0;
        q[pair] = kind == 1 ? -30.0f : 0.0f; /* what was learnt before */
        reward[pair] = kind < 2 ? 0.0f : -rlvc_rng_uniform(&rng);
        for (uint32_t i = 0; kind > 1 && i < 1u + kind % BRANCHES; i++) {
            const uint32_t to = (c + CLASSES - 5u + 5u * i + rlvc_rng_below(&rng, 5)) % CLASSES;
            transition[packed].next = kind == 19 && i == 0 ? RLVC_NO_CLASS : to;
            transition[packed++].count = 1u + rlvc_rng_below(&rng, 9);
        }
    }
    begin[PAIRS] = packed;
    memset(value, 0, sizeof value);
    memset(policy, 0, sizeof policy);
    memset(trial, 0, sizeof trial);
    memset(&values, 0, sizeof values);
    values.pair.reward = reward;
    values.begin.transition = begin;
    values.q = q;
    values.value = value;
    values.tried = tried;
    values.policy = policy;
    values.trial = trial;
    values.actions = ACTIONS;
    values.reward_most = 1.0f;
}

static double exact_q(const double *v, uint32_t pair, double discount) {
    double sum = 0.0, weight = 0.0;
    for (uint32_t i = begin[pair]; i < begin[pair + 1u]; i++) {
        const uint32_t next = transition[i].next;
        sum += (double)transition[i].count * (next == RLVC_NO_CLASS ? 0.0 : v[next]);
        weight += (double)transition[i].count;
    }
    return weight > 0.0 ? (double)reward[pair] + discount * sum / weight : (double)q[pair];
}

static void solve_plainly(double *v, double discount, int sweeps) {
    memset(v, 0, CLASSES * sizeof *v);
    for (int sweep = 0; sweep < sweeps; sweep++) {
        for (uint32_t c = 0; c < CLASSES; c++) {
            double best = -1e300;
            for (uint32_t pair = c * ACTIONS; pair < (c + 1u) * ACTIONS; pair++)
                if (tried[pair] > 0)
                    best = fmax(best, exact_q(v, pair, discount));
            v[c] = best > -1e300 ? best : v[c];
        }
    }
}

/* Solves in slices; if `marks`, each begins with a cursor that a mark was made of. */
static rlvc_solver_cursor solve(const rlvc_solver_input *input, uint8_t kind, uint32_t slice,
                                int marks) {
    rlvc_solver_cursor solver;
    rlvc_solver_begin(&solver, kind);
    while (!solver.done) {
        assert_in_range(rlvc_solver_step(&solver, input, &values, slice), 1, slice);
        if (marks && !solver.done) {
            uint32_t word[10];
            rlvc_solver_mark(&solver, word);
            rlvc_solver_begin(&solver, kind);
            assert_true(rlvc_solver_restore(&solver, input, &values, word));
        }
    }
    return solver;
}

static void check_values(const double *v, double allowed, uint32_t seed, double discount) {
    for (uint32_t c = 0; c < CLASSES; c++) {
        if (!(fabs((double)value[c] - v[c]) <= allowed))
            fail_msg("seed %u, discount %g: V(%u) is %.9g, not %.9g", seed, discount, c,
                     (double)value[c], v[c]);
    }
}

/* The values are within the tolerance, and the same bits whatever the slices and where a snapshot
 * was between. The last sweep is one by all actions: each Q is that of the V it goes with. */
static void test_values(void **state) {
    (void)state;
    static double v[CLASSES];
    static float first[CLASSES], first_q[PAIRS];
    const float discounts[] = {0.5f, 0.9f, 0.99f};
    for (uint32_t seed = 1; seed < 7u; seed++) {
        const float discount = discounts[seed % 3u];
        const rlvc_solver_input input = {transition, CLASSES, 100000, discount, 1e-3f};
        for (uint32_t slice = 1; slice < 3000000u; slice = slice * 13u + 1u) {
            make_model(seed);
            rlvc_solver_cursor solver = solve(&input, RLVC_SOLVER_VALUE_ITERATION, slice, 1);
            assert_int_equal(solver.sweeps % PERIOD, 1);
            memcpy(slice == 1u ? first : value, value, sizeof first);
            assert_memory_equal(value, first, sizeof first);
            memcpy(slice == 1u ? first_q : q, q, sizeof first_q);
            assert_memory_equal(q, first_q, sizeof first_q);
        }
        solve_plainly(v, (double)discount, discount > 0.95f ? 3000 : 400);
        check_values(v, 2e-3, seed, (double)discount);
        for (uint32_t pair = 0; pair < PAIRS; pair++)
            assert_true(tried[pair] > 0 || q[pair] == 0.0f);
        for (uint32_t pair = 0; pair < PAIRS; pair++)
            assert_true(fabs((double)q[pair] - exact_q(v, pair, (double)discount)) <= 3e-3);
    }
}

/* The fourth sweep of the second period is the last that is allowed, and backs up one action. */
static void test_sweeps_run_out(void **state) {
    (void)state;
    for (uint32_t slice = 5; slice < 3000000u; slice *= 600000u) {
        const rlvc_solver_input input = {transition, CLASSES, PERIOD + 4u, 0.99f, 1e-3f};
        make_model(1);
        assert_int_equal(solve(&input, RLVC_SOLVER_VALUE_ITERATION, slice, 0).sweeps, PERIOD + 4u);
    }
}

/* Where every sweep is by all actions, from the first class to the last: without a discount, by
 * policy iteration, and where there are no more classes than that. */
static void test_plain_sweeps(void **state) {
    (void)state;
    const rlvc_solver_input endless = {transition, CLASSES, 3, 1.0f, 1e-3f};
    const rlvc_solver_input discounted = {transition, CLASSES, 3, 0.9f, 1e-3f};
    const rlvc_solver_input small = {transition, RLVC_CLASSES_SMALL, 3, 0.9f, 1e-3f};
    const struct {
        const rlvc_solver_input *input;
        uint8_t kind;
    } cases[] = {{&endless, RLVC_SOLVER_VALUE_ITERATION},
                 {&discounted, RLVC_SOLVER_POLICY_ITERATION},
                 {&small, RLVC_SOLVER_VALUE_ITERATION}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        make_model(2);
        rlvc_solver_cursor solver;
        rlvc_solver_begin(&solver, cases[i].kind);
        while (!solver.done) {
            (void)rlvc_solver_step(&solver, cases[i].input, &values, 1);
            assert_false(solver.evaluating || solver.backwards);
        }
        assert_int_equal(solver.sweeps, 3);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_values),
        cmocka_unit_test(test_sweeps_run_out),
        cmocka_unit_test(test_plain_sweeps),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
