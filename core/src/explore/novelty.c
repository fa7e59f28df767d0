/* SPDX-License-Identifier: MIT */
/* How near a class is to what was little tried: see novelty.h. */
#include "novelty.h"

#include "../samples/replay.h"

#define SEEK_DISCOUNT 0.95f
#define OUT_OF_REACH 0.001f

static void begin_class(rlvc_seeking *seeking) {
    seeking->best = 0.0f;
    seeking->lead = 0;
    seeking->action = 0;
}

static void begin_sweep(rlvc_seeking *seeking) {
    seeking->largest = 0.0f;
    seeking->class_id = 0;
    seeking->transition = 0;
    rlvc_sum_clear(&seeking->sum);
    begin_class(seeking);
}

void rlvc_seeking_begin(rlvc_seeking *seeking, const rlvc_solving *solving, rlvc_values *values) {
    for (uint32_t c = 0; c < solving->classes; c++)
        values->reward[c] = 0.0f;
    seeking->sweeps = 0;
    seeking->done = 0;
    begin_sweep(seeking);
}

/* U(c), once every U(c, a) of the class is there. */
static void close_class(rlvc_seeking *seeking, const rlvc_solving *solving, float *near_by,
                        rlvc_explorer *explorer) {
    uint32_t c = seeking->class_id;
    float change = seeking->best - near_by[c];
    seeking->largest = change > seeking->largest ? change : seeking->largest;
    near_by[c] = seeking->best;
    int leads = seeking->best > OUT_OF_REACH && seeking->best < 1.0f;
    explorer->lead[c] = leads ? seeking->lead : (uint8_t)RLVC_NO_ACTION;
    begin_class(seeking);
    if (++seeking->class_id < solving->classes)
        return;
    seeking->sweeps++;
    seeking->done = seeking->largest <= OUT_OF_REACH || seeking->sweeps >= solving->max_sweeps;
    begin_sweep(seeking);
}

/* U(c, a), once all its transitions are added. */
static void close_pair(rlvc_seeking *seeking, const rlvc_solving *solving,
                       const rlvc_values *values, rlvc_explorer *explorer) {
    size_t pair = rlvc_values_pair(values, seeking->class_id, seeking->action);
    uint32_t n = seeking->sum.weight;
    float u = n < explorer->least ? 1.0f : SEEK_DISCOUNT * rlvc_sum_mean(&seeking->sum);
    if (seeking->sweeps == 0 && explorer->seen)
        explorer->seen[pair] = (uint8_t)(n < UINT8_MAX ? n : UINT8_MAX);
    if (u > seeking->best) {
        seeking->best = u;
        seeking->lead = (uint8_t)seeking->action;
    }
    rlvc_sum_clear(&seeking->sum);
    if (++seeking->action == values->actions)
        close_class(seeking, solving, values->reward, explorer);
}

uint32_t rlvc_seeking_step(rlvc_seeking *seeking, const rlvc_solving *solving, rlvc_values *values,
                           rlvc_explorer *explorer, uint32_t budget) {
    uint32_t used = 0;
    for (; used < budget && !seeking->done; used++) {
        size_t pair = rlvc_values_pair(values, seeking->class_id, seeking->action);
        if (seeking->transition == values->first[pair + 1u]) {
            close_pair(seeking, solving, values, explorer);
            continue;
        }
        const rlvc_sample *to = &solving->transition[seeking->transition++];
        rlvc_sum_add(&seeking->sum, to->key == RLVC_NO_CLASS ? 0.0f : values->reward[to->key],
                     to->slot);
    }
    return used;
}

void rlvc_seeking_mark(const rlvc_seeking *seeking, uint32_t word[4]) {
    word[0] = seeking->sweeps;
    word[1] = seeking->class_id;
    word[2] = seeking->action;
    word[3] = seeking->transition;
}
