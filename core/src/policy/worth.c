/* SPDX-License-Identifier: MIT */
/* What policies are worth in the model: see worth.h. */
#include "rlvc/float_rules.h"

#include "worth.h"

#include <string.h>

#define TIE 5.0e-7f  /* what the errors of two equal Q may add up to, of their size */
#define KEPT 1.0e-5f /* what those of a whole way may */

/* Two actions that were tried less often look alike by chance, where what follows is random. */
#define TIE_TRIED 3u

/* exp(-16) is less than binary32 resolves: by then a sweep knows nothing of the first values. */
#define SWEEPS 16.0f

static float magnitude(float x) {
    return x < 0.0f ? -x : x;
}

void rlvc_worth_carve(rlvc_worth *worth, rlvc_arena *arena, const rlvc_agent *agent) {
    rlvc_config config = agent->config;
    config.classes = agent->tree.classes;
    worth->agent = agent;
    rlvc_values_carve(&worth->model, arena, &config);
    worth->rows.sample = rlvc_arena_carve(arena, agent->replay.slots, sizeof *worth->rows.sample);
    worth->least = rlvc_arena_carve(arena, config.classes, sizeof *worth->least);
    worth->taken = rlvc_arena_carve(arena, config.classes, sizeof *worth->taken);
    worth->scratch = rlvc_arena_carve_bytes(arena, RLVC_SORT_SCRATCH_BYTES);
}

/* ------------------------------------------------------------------ the model */

/* Positions whose percepts, and what follows them, have labels: none while a step is under way, in
 * which labels wait for splits. */
static uint32_t labelled(const rlvc_agent *agent) {
    const rlvc_replay *replay = &agent->replay;
    uint32_t end = 0;
    if (agent->learner.phase != RLVC_PHASE_IDLE)
        return 0;
    while (end < replay->count && replay->label[rlvc_replay_slot(replay, end)] != RLVC_NO_CLASS)
        end++;
    if (end > 0 && rlvc_replay_linked(replay, rlvc_replay_slot(replay, end - 1u)))
        end--; /* what follows is new */
    return end;
}

static void make_model(rlvc_worth *worth) {
    const rlvc_agent *agent = worth->agent;
    const rlvc_target_input input = {
        {&agent->replay, labelled(agent), 0, 0.0f, 0}, &worth->model, 0.0f, RLVC_TARGET_SUCCESSOR};
    rlvc_model_cursor model;
    rlvc_model_begin(&model, agent->tree.classes * agent->config.actions);
    while (!model.done)
        (void)rlvc_model_step(&model, &input, &worth->model, worth->rows, worth->scratch,
                              RLVC_BUDGET_UNBOUNDED);
}

/* What the agent knows, for where the model knows nothing. */
static void copy_values(rlvc_worth *worth) {
    const rlvc_values *values = &worth->agent->values;
    const size_t pairs = rlvc_values_pair(values, worth->agent->tree.classes, 0);
    memcpy(worth->model.q, values->q, pairs * sizeof *values->q);
    memcpy(worth->model.tried, values->tried, pairs * sizeof *values->tried);
}

/* ------------------------------------------------------------------ evaluating */

/* Q of a pair, if value[] is what follows. Where one class alone follows there is no mean to be
 * rounded, so that equal ways are worth exactly the same. */
static float back_up(const rlvc_worth *worth, size_t pair, const float *value) {
    const uint32_t end = worth->model.begin.transition[pair + 1u];
    uint32_t at = worth->model.begin.transition[pair];
    const uint32_t next = at < end ? worth->rows.transition[at].next : RLVC_NO_CLASS;
    float mean = next == RLVC_NO_CLASS ? 0.0f : value[next];
    rlvc_sum sum;
    if (at == end)
        return worth->model.q[pair];
    if (end - at > 1u) {
        rlvc_sum_clear(&sum);
        (void)rlvc_model_add(&sum, worth->rows.transition, &at, end, end - at, value, 0.0f);
        mean = rlvc_sum_mean(&sum);
    }
    return worth->model.pair.reward[pair] + worth->agent->config.discount * mean;
}

/* The size of the terms that make up Q of a pair in a class, which its rounding goes by. */
static float size_of(const rlvc_worth *worth, uint32_t class_id, size_t pair) {
    const float value = magnitude(worth->model.value[class_id]);
    const float reward = magnitude(worth->model.pair.reward[pair]);
    return value > reward ? value : reward;
}

/* The least Q of what is taken in a class. */
static float worst_of(const rlvc_worth *worth, uint32_t class_id, const float *value) {
    const size_t first = rlvc_values_pair(&worth->model, class_id, 0);
    const uint32_t own = worth->agent->values.policy[class_id];
    const int knows = rlvc_values_counts(&worth->model, first + own);
    float least = knows ? back_up(worth, first + own, value) : value[class_id];
    for (uint32_t a = 0; knows && a < worth->model.actions; a++) {
        if (a != own && a < 64u && worth->taken[class_id] >> a & 1u) {
            const float q = back_up(worth, first + a, value);
            least = q < least ? q : least;
        }
    }
    return least;
}

/* After so many sweeps nothing is left of the values that they began with. */
static uint32_t enough_sweeps(const rlvc_config *config) {
    const float forgotten = 1.0f - config->discount; /* in a sweep */
    return forgotten * (float)config->max_sweeps > SWEEPS ? (uint32_t)(SWEEPS / forgotten)
                                                          : config->max_sweeps;
}

/* Sweeps, from the agent's V, until value[] is that of the policy. Without a discount it may go on
 * to change; then it is what so many steps are worth, the same number for each policy. */
static void evaluate(const rlvc_worth *worth, float *value) {
    const uint32_t classes = worth->agent->tree.classes;
    uint32_t sweeps = enough_sweeps(&worth->agent->config);
    int changed = 1;
    memcpy(value, worth->agent->values.value, classes * sizeof *value);
    for (; changed && sweeps > 0; sweeps--) {
        changed = 0;
        for (uint32_t c = 0; c < classes; c++) {
            const float before = value[c];
            value[c] = worst_of(worth, c, value);
            changed |= value[c] != before;
        }
    }
}

void rlvc_worth_begin(rlvc_worth *worth) {
    rlvc_values *model = &worth->model;
    const size_t pairs = rlvc_values_pair(model, worth->agent->tree.classes, 0);
    float largest = 0.0f, smallest = 0.0f;
    int any = 0;
    copy_values(worth);
    make_model(worth);
    rlvc_worth_take_none(worth);
    evaluate(worth, model->value);
    for (size_t pair = 0; pair < pairs; pair++) {
        model->q[pair] = back_up(worth, pair, model->value);
        if (!rlvc_values_counts(model, pair))
            continue;
        largest = !any || model->q[pair] > largest ? model->q[pair] : largest;
        smallest = !any || model->q[pair] < smallest ? model->q[pair] : smallest;
        any = 1;
    }
    worth->spread = largest - smallest;
}

uint64_t rlvc_worth_allowed(const rlvc_worth *worth, uint32_t class_id, float loss) {
    const rlvc_values *model = &worth->model;
    const size_t first = rlvc_values_pair(model, class_id, 0);
    const uint32_t own = worth->agent->values.policy[class_id];
    uint64_t actions = (uint64_t)1 << own;
    for (uint32_t a = 0; a < model->actions; a++) {
        const float rounding = TIE * size_of(worth, class_id, first + a);
        if (model->tried[first + own] >= TIE_TRIED && model->tried[first + a] >= TIE_TRIED &&
            model->q[first + a] >= model->value[class_id] - loss - rounding)
            actions |= (uint64_t)1 << a;
    }
    return actions;
}

void rlvc_worth_take_none(rlvc_worth *worth) {
    memset(worth->taken, 0, worth->agent->tree.classes * sizeof *worth->taken);
}

void rlvc_worth_take(rlvc_worth *worth, uint32_t class_id, uint32_t action) {
    worth->taken[class_id] |= (uint64_t)1 << action;
}

int rlvc_worth_is_kept(rlvc_worth *worth, float loss) {
    const uint32_t classes = worth->agent->tree.classes;
    const float *value = worth->model.value;
    int kept = 1;
    evaluate(worth, worth->least);
    for (uint32_t c = 0; c < classes; c++) {
        const size_t own = rlvc_values_pair(&worth->model, c, worth->agent->values.policy[c]);
        const float rounding = KEPT * size_of(worth, c, own);
        kept &= worth->least[c] >= value[c] - loss - rounding;
    }
    return kept;
}

float rlvc_worth_mean(const rlvc_worth *worth, const float *value) {
    rlvc_sum sum;
    rlvc_sum_clear(&sum);
    for (uint32_t c = 0; c < worth->agent->tree.classes; c++) {
        for (uint32_t a = 0; a < worth->model.actions; a++)
            rlvc_sum_add(&sum, value[c], worth->model.tried[rlvc_values_pair(&worth->model, c, a)]);
    }
    return rlvc_sum_mean(&sum);
}
