/* SPDX-License-Identifier: MIT */
/* Value iteration and policy iteration: see value_iteration.h. */
#include "rlvc/float_rules.h"

#include "value_iteration.h"

#include "model.h"

#include "../base/float_math.h"
#include "../samples/replay.h"
#include "../base/solver_select.h"
#include <float.h>
#include <string.h>

enum { SWEEP, IMPROVE };

#define HAS_IMPROVING RLVC_HAS_SOLVER(RLVC_SOLVER_POLICY_ITERATION)

static void restart(rlvc_solver_cursor *solver, uint8_t phase) {
    solver->phase = phase;
    solver->class_id = 0;
    solver->action = 0;
    solver->transition = 0;
    rlvc_sum_clear(&solver->sum);
}

void rlvc_solver_begin(rlvc_solver_cursor *solver, uint8_t kind) {
    const int improve = HAS_IMPROVING && kind == RLVC_SOLVER_POLICY_ITERATION;
    memset(solver, 0, sizeof *solver);
    solver->improve = (uint8_t)improve;
    restart(solver, improve ? IMPROVE : SWEEP);
}

static float magnitude(float x) {
    return x < 0.0f ? -x : x;
}

/* Has the sweep that ended settled V, as the head of value_iteration.h tells? */
static int settled(const rlvc_solver_cursor *solver, const rlvc_solver_input *input) {
    float gamma = input->discount;
    float enough = input->tolerance;
    float resolution = 4.0e-7f * solver->largest; /* of binary32: some 4 units in the last place */
    if (gamma > 0.0f && gamma < 1.0f)
        enough = enough * (1.0f - gamma) / gamma;
    return solver->residual <= enough || solver->residual <= resolution;
}

/* Ends a sweep, or begins the next. */
static void end_sweep(rlvc_solver_cursor *solver, const rlvc_solver_input *input) {
    const int improve = HAS_IMPROVING && solver->improve;
    solver->sweeps++;
    if (solver->sweeps >= input->max_sweeps || (settled(solver, input) && !improve)) {
        solver->done = 1;
    } else if (improve && settled(solver, input)) {
        solver->changed = 0;
        restart(solver, IMPROVE);
    } else {
        solver->residual = 0.0f;
        solver->largest = 0.0f;
        solver->endless = 0;
        restart(solver, SWEEP);
    }
}

/* V as it may be without a discount: see the head of value_iteration.h. */
static float bounded(rlvc_solver_cursor *solver, const rlvc_solver_input *input,
                     const rlvc_values *values, float value) {
    const float most = 0.5f * (float)input->max_sweeps * values->reward_most;
    if (!RLVC_HAS_UNDISCOUNTED || input->discount < 1.0f || magnitude(value) < most || most == 0.0f)
        return value;
    solver->endless = 1;
    return value < 0.0f ? -most : most;
}

/* V(c), once every Q(c, a) of the class is there, whose greatest is `best`. */
static void back_up(rlvc_solver_cursor *solver, const rlvc_solver_input *input, rlvc_values *values,
                    float best) {
    uint32_t c = solver->class_id;
    float before = values->value[c];
    float after = best;
    if (HAS_IMPROVING && solver->improve) {
        size_t pair = rlvc_values_pair(values, c, values->trial[c]);
        after = rlvc_values_counts(values, pair) ? values->q[pair] : before;
    }
    after = bounded(solver, input, values, after);
    values->value[c] = after;
    float change = magnitude(after - before);
    solver->largest = magnitude(after) > solver->largest ? magnitude(after) : solver->largest;
    solver->action = 0;
    solver->residual = change > solver->residual ? change : solver->residual;
    if (++solver->class_id == input->classes)
        end_sweep(solver, input);
}

/* Part of a sweep: adds transitions, or completes a pair. */
static uint32_t sweep(rlvc_solver_cursor *solver, const rlvc_solver_input *input,
                      rlvc_values *values, uint32_t budget) {
    size_t pair = rlvc_values_pair(values, solver->class_id, solver->action);
    if (solver->transition < values->begin.transition[pair + 1u])
        return rlvc_model_add(&solver->sum, input->transition, &solver->transition,
                              values->begin.transition[pair + 1u], budget, values->value);
    if (values->begin.transition[pair] < values->begin.transition[pair + 1u])
        values->q[pair] = values->pair.reward[pair] + input->discount * rlvc_sum_mean(&solver->sum);
    else if (values->tried[pair] == 0)
        values->q[pair] = 0.0f;
    rlvc_sum_clear(&solver->sum);
    if (++solver->action == values->actions)
        back_up(solver, input, values, rlvc_values_best(values, solver->class_id));
    return 1;
}

/* The mean value of what follows a pair, by transitions [at, end): as rlvc_model_add makes it. The
 * first term needs no compensation. */
static float mean_value(const rlvc_transition *transition, uint32_t at, uint32_t end,
                        const float *value) {
    rlvc_sum sum = {0.0f, 0.0f, 0u};
    for (uint32_t i = at; i < end; i++) {
        const uint32_t next = transition[i].next;
        const float term = next == RLVC_NO_CLASS ? 0.0f : value[next];
        if (i > at) {
            rlvc_sum_add(&sum, term, transition[i].count);
        } else {
            sum.sum = term * (float)transition[i].count + 0.0f; /* not -0 */
            sum.weight = transition[i].count;
        }
    }
    return rlvc_sum_mean(&sum);
}

/* All of a class at once, where the budget allows it: the same arithmetic, without what it takes to
 * stop between two transitions. */
static uint32_t sweep_class(rlvc_solver_cursor *solver, const rlvc_solver_input *input,
                            rlvc_values *values) {
    const uint32_t *begin = values->begin.transition;
    const size_t first = rlvc_values_pair(values, solver->class_id, 0);
    const size_t last = first + values->actions;
    float best = values->value[solver->class_id];
    int any = 0;
    for (size_t pair = first; pair < last; pair++) {
        float q = values->tried[pair] == 0 ? 0.0f : values->q[pair];
        if (begin[pair] < begin[pair + 1u])
            q = values->pair.reward[pair] +
                input->discount *
                    mean_value(input->transition, begin[pair], begin[pair + 1u], values->value);
        values->q[pair] = q;
        if (values->tried[pair] > 0 && (!any || q > best)) {
            best = q;
            any = 1;
        }
    }
    solver->transition = begin[last];
    back_up(solver, input, values, best);
    return begin[last] - begin[first] + values->actions;
}

/* Makes the policy of one class greedy. An action must be better than the present one by more than
 * what the values are uncertain by, or two that are equally good could take turns for ever. */
static void improve(rlvc_solver_cursor *solver, const rlvc_solver_input *input,
                    rlvc_values *values) {
    uint32_t c = solver->class_id;
    uint32_t greedy = rlvc_values_greedy(values, c);
    size_t now = rlvc_values_pair(values, c, values->trial[c]);
    float better = values->q[rlvc_values_pair(values, c, greedy)] - values->q[now];
    int first_time = solver->sweeps == 0 || !rlvc_values_counts(values, now);
    if (greedy != values->trial[c] && (first_time || better > input->tolerance)) {
        values->trial[c] = (uint8_t)greedy;
        solver->changed = 1;
    }
    if (++solver->class_id < input->classes)
        return;
    if (solver->changed || solver->sweeps == 0)
        restart(solver, SWEEP);
    else
        solver->done = 1;
    solver->residual = solver->done ? solver->residual : 0.0f;
    solver->largest = 0.0f;
}

/* Is the cursor at the beginning of a class that the budget is enough for? */
static int is_whole(const rlvc_solver_cursor *solver, const rlvc_values *values, uint32_t budget) {
    const size_t first = rlvc_values_pair(values, solver->class_id, 0);
    const uint32_t end = values->begin.transition[first + values->actions];
    return solver->action == 0 && solver->transition == values->begin.transition[first] &&
           budget >= end - solver->transition + values->actions;
}

/* Works on the phase; returns the work. */
static uint32_t step_phase(rlvc_solver_cursor *solver, const rlvc_solver_input *input,
                           rlvc_values *values, uint32_t budget) {
    if (!HAS_IMPROVING || solver->phase == SWEEP)
        return RLVC_AT_ONCE && is_whole(solver, values, budget)
                   ? sweep_class(solver, input, values)
                   : sweep(solver, input, values, budget);
    improve(solver, input, values);
    return 1;
}

uint32_t rlvc_solver_step(rlvc_solver_cursor *solver, const rlvc_solver_input *input,
                          rlvc_values *values, uint32_t budget) {
    uint32_t used = 0;
    while (used < budget && !solver->done)
        used += step_phase(solver, input, values, budget - used);
    return used;
}

void rlvc_solver_mark(const rlvc_solver_cursor *solver, uint32_t word[10]) {
    word[0] = solver->phase | (uint32_t)solver->changed << 8 | (uint32_t)solver->endless << 16;
    word[1] = solver->class_id;
    word[2] = solver->action;
    word[3] = solver->transition;
    word[4] = solver->sweeps;
    word[5] = rlvc_bits_of(solver->residual);
    word[6] = rlvc_bits_of(solver->largest);
    word[7] = rlvc_bits_of(solver->sum.sum);
    word[8] = rlvc_bits_of(solver->sum.rest);
    word[9] = (uint32_t)solver->sum.weight; /* of samples in a ring */
}

/* Is the cursor that words gave within the model? */
static int is_within(const rlvc_solver_cursor *solver, const rlvc_solver_input *input,
                     const rlvc_values *values) {
    if (solver->class_id >= input->classes || solver->action >= values->actions ||
        solver->sweeps >= input->max_sweeps)
        return 0;
    size_t pair = rlvc_values_pair(values, solver->class_id, solver->action);
    return solver->phase != SWEEP || (solver->transition >= values->begin.transition[pair] &&
                                      solver->transition <= values->begin.transition[pair + 1u]);
}

int rlvc_solver_restore(rlvc_solver_cursor *solver, const rlvc_solver_input *input,
                        const rlvc_values *values, const uint32_t word[10]) {
    solver->phase = (uint8_t)(word[0] & 255u);
    solver->changed = (uint8_t)(word[0] >> 8);
    solver->endless = (uint8_t)(word[0] >> 16);
    solver->class_id = word[1];
    solver->action = word[2];
    solver->transition = word[3];
    solver->sweeps = word[4];
    solver->residual = rlvc_float_of(word[5]);
    solver->largest = rlvc_float_of(word[6]);
    solver->sum.sum = rlvc_float_of(word[7]);
    solver->sum.rest = rlvc_float_of(word[8]);
    solver->sum.weight = word[9];
    for (uint32_t i = 5; i < 7; i++) {
        if (!(magnitude(rlvc_float_of(word[i])) <= FLT_MAX))
            return 0;
    }
    for (uint32_t i = 7; i < 9; i++) { /* of a sum of values */
        if (!(magnitude(rlvc_float_of(word[i])) <= RLVC_VALUE_MAX * (float)word[9]))
            return 0;
    }
    return word[9] <= INT32_MAX && solver->phase <= solver->improve &&
           solver->changed <= solver->improve && solver->endless <= 1 && word[0] >> 24 == 0 &&
           is_within(solver, input, values);
}
