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

/* Decided when the library is built, where no model is large. */
#define HAS_LARGE (RLVC_CLASSES_MAX > RLVC_CLASSES_SMALL)
#define EVALUATES(solver) (HAS_LARGE && (solver)->evaluating)
#define GOES_BACK(solver) (HAS_LARGE && (solver)->backwards)

/* Between two sweeps by all actions of a large model. An even number, so that those go there and
 * back, too. */
#define EVALUATIONS 8u

/* Begins a class in a sweep. */
static void open_class(rlvc_solver_cursor *solver, const rlvc_values *values) {
    const uint32_t c = solver->class_id;
    solver->action = EVALUATES(solver) ? values->trial[c] : 0u;
    solver->transition = values->begin.transition[rlvc_values_pair(values, c, solver->action)];
}

static int is_large(const rlvc_solver_cursor *solver, const rlvc_solver_input *input) {
    return HAS_LARGE && input->classes > RLVC_CLASSES_SMALL &&
           !(HAS_IMPROVING && solver->improve) &&
           (!RLVC_HAS_UNDISCOUNTED || input->discount < 1.0f);
}

/* What kind of sweep this one is follows from its number. */
static void choose_sweep(rlvc_solver_cursor *solver, const rlvc_solver_input *input) {
    if (HAS_LARGE) {
        const int large = is_large(solver, input);
        solver->large = (uint8_t)large;
        solver->evaluating = large && solver->sweeps % (EVALUATIONS + 1u) != 0;
        solver->backwards = large && solver->sweeps % 2u != 0;
    }
}

static void restart(rlvc_solver_cursor *solver, const rlvc_solver_input *input,
                    const rlvc_values *values, uint8_t phase) {
    choose_sweep(solver, input);
    solver->phase = phase;
    solver->class_id = GOES_BACK(solver) ? input->classes - 1u : 0u;
    open_class(solver, values);
}

void rlvc_solver_begin(rlvc_solver_cursor *solver, uint8_t kind) {
    const int improve = HAS_IMPROVING && kind == RLVC_SOLVER_POLICY_ITERATION;
    memset(solver, 0, sizeof *solver);
    solver->improve = (uint8_t)improve;
    solver->phase = improve ? IMPROVE : SWEEP;
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
static void end_sweep(rlvc_solver_cursor *solver, const rlvc_solver_input *input,
                      const rlvc_values *values) {
    const int improve = HAS_IMPROVING && solver->improve;
    solver->sweeps++;
    if (solver->sweeps >= input->max_sweeps ||
        (settled(solver, input) && !improve && !EVALUATES(solver))) {
        solver->done = 1;
    } else if (improve && settled(solver, input)) {
        solver->changed = 0;
        restart(solver, input, values, IMPROVE);
    } else {
        solver->residual = 0.0f;
        solver->largest = 0.0f;
        solver->endless = 0;
        restart(solver, input, values, SWEEP);
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

/* V(c) := Q(c, action), once what the sweep backs up of the class is there; and goes on.
 * @return 1: that was the last class. */
static inline int back_up(rlvc_solver_cursor *solver, const rlvc_solver_input *input,
                          const rlvc_values *values, uint32_t action) {
    const uint32_t c = solver->class_id;
    const size_t pair = rlvc_values_pair(values, c, action);
    const float before = values->value[c];
    const float after =
        bounded(solver, input, values, rlvc_values_counts(values, pair) ? values->q[pair] : before);
    const float change = magnitude(after - before);
    values->value[c] = after;
    if (HAS_LARGE && solver->large && !solver->evaluating)
        values->trial[c] = (uint8_t)action;
    solver->largest = magnitude(after) > solver->largest ? magnitude(after) : solver->largest;
    solver->residual = change > solver->residual ? change : solver->residual;
    if (c == (GOES_BACK(solver) ? 0u : input->classes - 1u))
        return 1;
    solver->class_id = GOES_BACK(solver) ? c - 1u : c + 1u;
    open_class(solver, values);
    return 0;
}

/* Is V(c) that of one action, whatever the others are worth? */
static int keeps_policy(const rlvc_solver_cursor *solver) {
    return (HAS_IMPROVING && solver->improve) || EVALUATES(solver);
}

/* Adds what transitions [at, end) lead to, as a plain sum: what an evaluation adds. */
static void add_plainly(rlvc_sum *sum, const rlvc_transition *transition, uint32_t at, uint32_t end,
                        const float *value) {
    for (uint32_t i = at; i < end; i++) {
        const uint32_t next = transition[i].next;
        sum->sum += (next == RLVC_NO_CLASS ? 0.0f : value[next]) * (float)transition[i].count;
        sum->weight += transition[i].count;
    }
}

/* Adds some of the transitions of the pair at work, up to `end`. @return how many. */
static uint32_t add_transitions(rlvc_solver_cursor *solver, const rlvc_solver_input *input,
                                const rlvc_values *values, uint32_t end, uint32_t budget) {
    const uint32_t from = solver->transition;
    if (!EVALUATES(solver))
        return rlvc_model_add(&solver->sum, input->transition, &solver->transition, end, budget,
                              values->value, 0.0f);
    solver->transition = end - from < budget ? end : from + budget;
    add_plainly(&solver->sum, input->transition, from, solver->transition, values->value);
    return solver->transition - from;
}

/* Part of a sweep: adds transitions, or completes a pair. */
static uint32_t sweep(rlvc_solver_cursor *solver, const rlvc_solver_input *input,
                      rlvc_values *values, uint32_t budget) {
    const uint32_t c = solver->class_id;
    size_t pair = rlvc_values_pair(values, c, solver->action);
    const uint32_t end = values->begin.transition[pair + 1u];
    if (solver->transition < end)
        return add_transitions(solver, input, values, end, budget);
    if (values->begin.transition[pair] < end)
        values->q[pair] = values->pair.reward[pair] + input->discount * rlvc_sum_mean(&solver->sum);
    else if (values->tried[pair] == 0)
        values->q[pair] = 0.0f;
    rlvc_sum_clear(&solver->sum);
    if ((EVALUATES(solver) || ++solver->action == values->actions) &&
        back_up(solver, input, values,
                keeps_policy(solver) ? values->trial[c] : rlvc_values_greedy(values, c)))
        end_sweep(solver, input, values);
    return 1;
}

/* The mean value of what follows a pair, by transitions [at, end). */
static float mean_value(const rlvc_transition *transition, uint32_t at, uint32_t end,
                        const float *value) {
    const rlvc_sum sum = rlvc_model_sum(transition, at, end, value, 0.0f);
    return rlvc_model_mean(&sum);
}

/* How many of a class's pairs the sweep backs up; the first is of solver->action. */
static inline uint32_t pairs_of(const rlvc_solver_cursor *solver, const rlvc_values *values) {
    return EVALUATES(solver) ? 1u : values->actions;
}

/* The units of the class at work, if the sweep is at its beginning and the budget allows them; else
 * 0. */
static inline uint32_t whole_class(const rlvc_solver_cursor *solver, const rlvc_values *values,
                                   uint32_t budget) {
    const uint32_t pairs = pairs_of(solver, values);
    const uint32_t *begin =
        values->begin.transition + rlvc_values_pair(values, solver->class_id, solver->action);
    if (!EVALUATES(solver) && solver->action > 0)
        return 0; /* in its midst: of the last class there are not that many pairs from here on */
    const uint32_t units = begin[pairs] - begin[0] + pairs;
    return solver->transition == begin[0] && budget >= units ? units : 0u;
}

/* Backs up the greedy action of the class at work. @return that. */
static inline uint32_t evaluate_class(const rlvc_solver_cursor *solver,
                                      const rlvc_solver_input *input, const rlvc_values *values) {
    const size_t pair = rlvc_values_pair(values, solver->class_id, solver->action);
    const uint32_t at = values->begin.transition[pair], end = values->begin.transition[pair + 1u];
    rlvc_sum sum = {0.0f, 0.0f, 0u};
    add_plainly(&sum, input->transition, at, end, values->value);
    if (at < end)
        values->q[pair] = values->pair.reward[pair] + input->discount * rlvc_model_mean(&sum);
    else if (values->tried[pair] == 0)
        values->q[pair] = 0.0f;
    return solver->action;
}

/* Backs up all actions of the class at work. @return the one that V(c) is of. */
static inline uint32_t sweep_class(const rlvc_solver_cursor *solver, const rlvc_solver_input *input,
                                   const rlvc_values *values) {
    const uint32_t *begin = values->begin.transition;
    const size_t first = rlvc_values_pair(values, solver->class_id, solver->action);
    const size_t end = first + values->actions;
    uint32_t greedy = values->policy[solver->class_id];
    float best = 0.0f;
    int any = 0;
    for (size_t pair = first; pair < end; pair++) {
        float q = values->tried[pair] == 0 ? 0.0f : values->q[pair];
        if (begin[pair] < begin[pair + 1u])
            q = values->pair.reward[pair] +
                input->discount *
                    mean_value(input->transition, begin[pair], begin[pair + 1u], values->value);
        values->q[pair] = q;
        if (values->tried[pair] > 0 && (!any || q > best)) {
            best = q;
            greedy = (uint32_t)(pair - first);
            any = 1;
        }
    }
    return HAS_IMPROVING && solver->improve ? values->trial[solver->class_id] : greedy;
}

/* As many whole classes of a sweep as the budget allows: the same arithmetic, without what it takes
 * to stop between two transitions, and with a copy of the cursor, for the registers.
 * @return the units; 0: not one. */
static uint32_t sweep_classes(rlvc_solver_cursor *solver, const rlvc_solver_input *input,
                              const rlvc_values *values, uint32_t budget) {
    rlvc_solver_cursor now = *solver;
    uint32_t used = 0, units = whole_class(&now, values, budget);
    int ended = 0;
    while (units > 0) {
        used += units;
        ended = back_up(&now, input, values,
                        EVALUATES(&now) ? evaluate_class(&now, input, values)
                                        : sweep_class(&now, input, values));
        units = ended ? 0u : whole_class(&now, values, budget - used);
    }
    *solver = now;
    if (ended)
        end_sweep(solver, input, values);
    return used;
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
        restart(solver, input, values, SWEEP);
    else
        solver->done = 1;
    solver->residual = solver->done ? solver->residual : 0.0f;
    solver->largest = 0.0f;
}

/* Works on the phase; returns the work. */
static uint32_t step_phase(rlvc_solver_cursor *solver, const rlvc_solver_input *input,
                           rlvc_values *values, uint32_t budget) {
    if (!HAS_IMPROVING || solver->phase == SWEEP) {
        const uint32_t used = RLVC_AT_ONCE ? sweep_classes(solver, input, values, budget) : 0u;
        return used > 0 ? used : sweep(solver, input, values, budget);
    }
    improve(solver, input, values);
    return 1;
}

uint32_t rlvc_solver_step(rlvc_solver_cursor *solver, const rlvc_solver_input *input,
                          rlvc_values *values, uint32_t budget) {
    uint32_t used = 0;
    choose_sweep(solver, input); /* of a cursor that has just begun, or was restored */
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
