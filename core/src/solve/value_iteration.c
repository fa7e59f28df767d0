/* SPDX-License-Identifier: MIT */
/* Value iteration, policy iteration and prioritized sweeping: see value_iteration.h. */
#include "value_iteration.h"

#include "../base/float_math.h"
#include "../samples/replay.h"
#include "../base/solver_select.h"
#include <float.h>
#include <string.h>

/* Prioritized: GATHER, PREPARE, then CHOOSE, SWEEP and SPREAD for each class that is backed up;
 * CLEAR. */
enum { SWEEP, IMPROVE, GATHER, PREPARE, CHOOSE, SPREAD, CLEAR };

#define HAS_IMPROVING RLVC_HAS_SOLVER(RLVC_SOLVER_POLICY_ITERATION)
#define HAS_PRIORITIZED RLVC_HAS_SOLVER(RLVC_SOLVER_PRIORITIZED)

#define INFINITE 0x7f80u /* priorities from here on are not known more exactly */
#define UNKNOWN UINT16_MAX
#define AN_EIGHTH (3u << 7) /* between the priorities x and x / 8 */

static void restart(rlvc_solver *solver, uint8_t phase) {
    solver->phase = phase;
    solver->class_id = 0;
    solver->action = 0;
    solver->transition = 0;
    rlvc_sum_clear(&solver->sum);
}

void rlvc_solver_begin(rlvc_solver *solver, uint8_t kind) {
    const int improve = HAS_IMPROVING && kind == RLVC_SOLVER_POLICY_ITERATION;
    const int prioritized = HAS_PRIORITIZED && kind == RLVC_SOLVER_PRIORITIZED;
    memset(solver, 0, sizeof *solver);
    solver->prioritized = (uint8_t)prioritized;
    solver->improve = (uint8_t)improve;
    if (prioritized)
        rlvc_predecessors_begin(&solver->predecessors);
    restart(solver, prioritized ? GATHER : improve ? IMPROVE : SWEEP);
}

static float magnitude(float x) {
    return x < 0.0f ? -x : x;
}

/* `enough`, or what binary32 can resolve: some 4 units in the last place. */
static float resolved(const rlvc_solver *solver, float enough) {
    float resolution = 4.0e-7f * solver->largest;
    return enough > resolution ? enough : resolution;
}

/* Has the sweep that ended settled V, as the head of value_iteration.h tells? */
static int settled(const rlvc_solver *solver, const rlvc_solving *solving) {
    float gamma = solving->discount;
    float enough = solving->tolerance;
    if (gamma > 0.0f && gamma < 1.0f)
        enough = enough * (1.0f - gamma) / gamma;
    return solver->residual <= resolved(solver, enough);
}

/* Ends a sweep, or begins the next. */
static void end_sweep(rlvc_solver *solver, const rlvc_solving *solving) {
    const int improve = HAS_IMPROVING && solver->improve;
    solver->sweeps++;
    if (solver->sweeps >= solving->max_sweeps || (settled(solver, solving) && !improve)) {
        solver->done = 1;
    } else if (improve && settled(solver, solving)) {
        solver->changed = 0;
        restart(solver, IMPROVE);
    } else {
        solver->residual = 0.0f;
        solver->largest = 0.0f;
        restart(solver, SWEEP);
    }
}

/* How many transitions there are. */
static uint32_t transitions(const rlvc_solving *solving, const rlvc_values *values) {
    return values->first[rlvc_values_pair(values, solving->classes, 0)];
}

/* The predecessors of a class. */
static const rlvc_sample *group_of(const rlvc_solving *solving, const rlvc_values *values,
                                   uint32_t class_id) {
    return rlvc_predecessors_of(solving->transition, transitions(solving, values), class_id);
}

/* V(c), once every Q(c, a) of the class is there. */
static void back_up(rlvc_solver *solver, const rlvc_solving *solving, rlvc_values *values) {
    uint32_t c = solver->class_id;
    float before = values->value[c];
    float after = rlvc_values_best(values, c);
    if (HAS_IMPROVING && solver->improve) {
        size_t pair = rlvc_values_pair(values, c, values->trial[c]);
        after = rlvc_values_counts(values, pair) ? values->q[pair] : before;
    }
    values->value[c] = after;
    float change = magnitude(after - before);
    solver->largest = magnitude(after) > solver->largest ? magnitude(after) : solver->largest;
    solver->action = 0;
    if (HAS_PRIORITIZED && solver->turned) {
        solver->residual = change;
        solver->transition = group_of(solving, values, c)->key;
        solver->phase = SPREAD;
        return;
    }
    solver->residual = change > solver->residual ? change : solver->residual;
    if (++solver->class_id == solving->classes)
        end_sweep(solver, solving);
}

/* Adds the values of up to `budget` of the pair's transitions that are left. */
static uint32_t add_transitions(rlvc_solver *solver, const rlvc_solving *solving,
                                const rlvc_values *values, uint32_t end, uint32_t budget) {
    rlvc_sum sum = solver->sum;
    uint32_t from = solver->transition;
    uint32_t to = end - from < budget ? end : from + budget;
    for (uint32_t i = from; i < to; i++) {
        uint32_t next = solving->transition[i].key; /* nothing is to be had after the end */
        rlvc_sum_add(&sum, next == RLVC_NO_CLASS ? 0.0f : values->value[next],
                     solving->transition[i].slot);
    }
    solver->sum = sum;
    solver->transition = to;
    return to - from;
}

/* Part of a sweep: adds transitions, or completes a pair. */
static uint32_t sweep(rlvc_solver *solver, const rlvc_solving *solving, rlvc_values *values,
                      uint32_t budget) {
    size_t pair = rlvc_values_pair(values, solver->class_id, solver->action);
    if (solver->transition < values->first[pair + 1u])
        return add_transitions(solver, solving, values, values->first[pair + 1u], budget);
    if (values->first[pair] < values->first[pair + 1u])
        values->q[pair] = values->reward[pair] + solving->discount * rlvc_sum_mean(&solver->sum);
    else if (values->tried[pair] == 0)
        values->q[pair] = values->optimistic ? values->optimistic_value : 0.0f;
    rlvc_sum_clear(&solver->sum);
    if (++solver->action == values->actions)
        back_up(solver, solving, values);
    return 1;
}

/* Makes the policy of one class greedy. An action must be better than the present one by more than
 * what the values are uncertain by, or two that are equally good could take turns for ever. */
static void improve(rlvc_solver *solver, const rlvc_solving *solving, rlvc_values *values) {
    uint32_t c = solver->class_id;
    uint32_t greedy = rlvc_values_greedy(values, c);
    size_t now = rlvc_values_pair(values, c, values->trial[c]);
    float better = values->q[rlvc_values_pair(values, c, greedy)] - values->q[now];
    int first_time = solver->sweeps == 0 || !rlvc_values_counts(values, now);
    if (greedy != values->trial[c] && (first_time || better > solving->tolerance)) {
        values->trial[c] = (uint8_t)greedy;
        solver->changed = 1;
    }
    if (++solver->class_id < solving->classes)
        return;
    if (solver->changed || solver->sweeps == 0)
        restart(solver, SWEEP);
    else
        solver->done = 1;
    solver->residual = solver->done ? solver->residual : 0.0f;
    solver->largest = 0.0f;
}

/* ------------------------------------------------------------------ prioritized sweeping */

/* The bound that a priority stands for. */
static float bound_of(uint16_t priority) {
    return rlvc_float_of((uint32_t)(priority < INFINITE ? priority : INFINITE - 1u) << 16);
}

/* Takes a step on the predecessors; value iteration if there is no room for them. */
static void gather(rlvc_solver *solver, const rlvc_solving *solving, const rlvc_values *values) {
    const rlvc_turning turning = {values, solving->transition, solving->classes,
                                  transitions(solving, values), solving->discount};
    if (!rlvc_predecessors_fit(turning.transitions, solving->classes, solving->slots)) {
        restart(solver, CLEAR);
        return;
    }
    rlvc_predecessors_step(&solver->predecessors, &turning);
    solver->turned = solver->predecessors.done;
    if (solver->turned)
        restart(solver, PREPARE);
}

/* Gives a class the priority that it has in the beginning, or in the end (before value iteration,
 * for want of room). */
static void set_priority(rlvc_solver *solver, const rlvc_solving *solving) {
    solving->priority[solver->class_id] = solver->phase == PREPARE ? UNKNOWN : 0;
    if (++solver->class_id < solving->classes)
        return;
    if (solver->phase == PREPARE)
        restart(solver, CHOOSE);
    else if (solver->turned)
        solver->done = 1;
    else
        restart(solver, SWEEP);
}

/* Ends a solution of which `priority` is left. */
static void finish(rlvc_solver *solver, uint16_t priority) {
    solver->residual = bound_of(priority);
    restart(solver, CLEAR);
}

/* Goes on to the next class; after the last to the next pass, or to the end. */
static void leave(rlvc_solver *solver, const rlvc_solving *solving) {
    solver->phase = CHOOSE;
    if (++solver->class_id < solving->classes)
        return;
    float gamma = solving->discount;
    float enough = gamma < 1.0f ? solving->tolerance * (1.0f - gamma) : solving->tolerance;
    uint16_t least = (uint16_t)(rlvc_bits_of(resolved(solver, enough)) >> 16);
    if (solver->highest <= least) {
        solver->sweeps += solver->backups > 0;
        finish(solver, solver->highest);
        return;
    }
    solver->level =
        solver->highest > least + AN_EIGHTH ? (uint16_t)(solver->highest - AN_EIGHTH) : least;
    solver->highest = 0;
    restart(solver, CHOOSE);
}

static void raise_highest(rlvc_solver *solver, uint16_t priority) {
    solver->highest = priority > solver->highest ? priority : solver->highest;
}

/* Backs the class up, or passes it by. */
static void choose(rlvc_solver *solver, const rlvc_solving *solving, const rlvc_values *values) {
    uint16_t *priority = &solving->priority[solver->class_id];
    if (*priority <= solver->level) {
        raise_highest(solver, *priority);
        leave(solver, solving);
        return;
    }
    if (solver->backups == solving->classes) {
        solver->backups = 0;
        if (++solver->sweeps >= solving->max_sweeps) {
            finish(solver, *priority);
            return;
        }
    }
    solver->backups++;
    *priority = 0;
    solver->transition = values->first[rlvc_values_pair(values, solver->class_id, 0)];
    solver->phase = SWEEP;
}

/* Tells one predecessor of the class that its V has changed. */
static void spread(rlvc_solver *solver, const rlvc_solving *solving, const rlvc_values *values) {
    const rlvc_sample *group = group_of(solving, values, solver->class_id);
    if (solver->transition == group->slot || solver->residual == 0.0f) {
        leave(solver, solving);
        return;
    }
    const rlvc_sample *predecessor = &solving->transition[solver->transition++];
    uint16_t *priority = &solving->priority[predecessor->key];
    if (*priority < INFINITE) {
        float more = rlvc_float_of(predecessor->slot) * solver->residual;
        *priority = (uint16_t)((rlvc_bits_of(bound_of(*priority) + more) >> 16) + 1u);
        raise_highest(solver, *priority);
    }
}

/* Takes a step of a phase that only prioritized sweeping has. */
static void step_prioritized(rlvc_solver *solver, const rlvc_solving *solving,
                             const rlvc_values *values) {
    switch (solver->phase) {
    case GATHER:
        gather(solver, solving, values);
        break;
    case CHOOSE:
        choose(solver, solving, values);
        break;
    case SPREAD:
        spread(solver, solving, values);
        break;
    default:
        set_priority(solver, solving);
        break;
    }
}

/* ------------------------------------------------------------------ all of them */

/* Works on the phase; returns the work. */
static uint32_t step_phase(rlvc_solver *solver, const rlvc_solving *solving, rlvc_values *values,
                           uint32_t budget) {
    if (HAS_PRIORITIZED && solver->phase > IMPROVE)
        step_prioritized(solver, solving, values);
    else if (HAS_IMPROVING && solver->phase == IMPROVE)
        improve(solver, solving, values);
    else
        return sweep(solver, solving, values, budget);
    return 1;
}

uint32_t rlvc_solver_step(rlvc_solver *solver, const rlvc_solving *solving, rlvc_values *values,
                          uint32_t budget) {
    uint32_t used = 0;
    while (used < budget && !solver->done)
        used += step_phase(solver, solving, values, budget - used);
    return used;
}

void rlvc_solver_mark(const rlvc_solver *solver, uint32_t word[10]) {
    word[0] = solver->phase | (uint32_t)solver->changed << 8 | (uint32_t)solver->backups << 16;
    word[1] = solver->class_id | (uint32_t)solver->level << 16;
    word[2] = solver->action | (uint32_t)solver->highest << 16;
    word[3] = solver->transition;
    word[4] = solver->sweeps;
    word[5] = rlvc_bits_of(solver->residual);
    word[6] = rlvc_bits_of(solver->largest);
    word[7] = rlvc_bits_of(solver->sum.sum);
    word[8] = rlvc_bits_of(solver->sum.rest);
    word[9] = solver->sum.weight;
    if (solver->phase == GATHER) {
        word[0] |= (uint32_t)solver->predecessors.phase << 8;
        word[1] = solver->predecessors.at;
        word[2] = solver->predecessors.pair;
        word[3] = solver->predecessors.place;
    }
}

/* May the solver, which knows whether there are predecessors, be in the phase that words gave? */
static int phase_is_possible(const rlvc_solver *solver) {
    if (solver->turned)
        return solver->phase == SWEEP || (solver->phase >= PREPARE && solver->phase <= CLEAR);
    return solver->phase <= solver->improve || (solver->phase == CLEAR && solver->prioritized);
}

/* Is what words gave to prioritized sweeping in order, and nothing given to the others? Zeros must
 * stand where they will not be put any more. */
static int priorities_are_possible(const rlvc_solver *solver, const rlvc_solving *solving) {
    if (!solver->turned && (solver->backups || solver->level || solver->highest))
        return 0;
    uint32_t clear = solver->phase == CLEAR ? solver->class_id : solving->classes;
    if (!solver->prioritized || (solver->turned && solver->phase != CLEAR))
        clear = 0;
    for (uint32_t c = 0; c < clear; c++) {
        if (solving->priority[c])
            return 0;
    }
    return solver->backups <= solving->classes;
}

/* Is the cursor that words gave within the model? */
static int is_within(const rlvc_solver *solver, const rlvc_solving *solving,
                     const rlvc_values *values) {
    uint32_t end = solver->turned && solver->phase == CLEAR ? 1u : 0u; /* all sweeps may be over */
    if (solver->class_id >= solving->classes || solver->action >= values->actions ||
        solver->sweeps >= solving->max_sweeps + end)
        return 0;
    size_t pair = rlvc_values_pair(values, solver->class_id, solver->action);
    if (solver->phase == SPREAD) {
        const rlvc_sample *group = group_of(solving, values, solver->class_id);
        return solver->transition >= group->key && solver->transition <= group->slot;
    }
    return solver->phase != SWEEP || (solver->transition >= values->first[pair] &&
                                      solver->transition <= values->first[pair + 1u]);
}

int rlvc_solver_restore(rlvc_solver *solver, const rlvc_solving *solving, const rlvc_values *values,
                        const uint32_t word[10]) {
    uint32_t here[10];
    while (solver->phase == GATHER) {
        rlvc_solver_mark(solver, here);
        if (memcmp(here, word, sizeof here) == 0)
            return 1;
        gather(solver, solving, values);
    }
    solver->phase = (uint8_t)(word[0] & 255u);
    solver->changed = (uint8_t)(word[0] >> 8);
    solver->backups = (uint16_t)(word[0] >> 16);
    solver->class_id = word[1] & 0xffffu;
    solver->level = (uint16_t)(word[1] >> 16);
    solver->action = word[2] & 0xffffu;
    solver->highest = (uint16_t)(word[2] >> 16);
    solver->transition = word[3];
    solver->sweeps = word[4];
    solver->residual = rlvc_float_of(word[5]);
    solver->largest = rlvc_float_of(word[6]);
    solver->sum.sum = rlvc_float_of(word[7]);
    solver->sum.rest = rlvc_float_of(word[8]);
    solver->sum.weight = word[9];
    for (uint32_t i = 5; i < 9; i++) {
        if (!(magnitude(rlvc_float_of(word[i])) <= FLT_MAX))
            return 0;
    }
    return phase_is_possible(solver) && solver->changed <= solver->improve &&
           is_within(solver, solving, values) && priorities_are_possible(solver, solving);
}
