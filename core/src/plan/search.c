/* SPDX-License-Identifier: MIT */
/* The search for a small tree: see search.h. */
#include "rlvc/float_rules.h"

#include "search.h"

#include "../base/solver_select.h"

#include <string.h>

#define LAG 0.05f
#define LAG_STARTS 4u
#define LEAF_PRICE 0.002f
#define GAIN_LEAST 0.001f

#define STEPS_A_CANDIDATE 2500u
#define MOVE_UNITS 256u

static float absolute(float x) {
    return x < 0.0f ? -x : x;
}

/* Begins the candidate's next rollout. */
static void open_rollout(rlvc_search_cursor *search) {
    const rlvc_search_input *in = &search->in;
    const float *start = in->start + (size_t)search->start * in->rollout.model->basis.components;
    rlvc_rollout_begin(&search->rollout, &in->rollout, start, search->start);
}

static void open_candidate(rlvc_search_cursor *search) {
    search->start = 0;
    search->sum = search->reference_sum = 0.0f;
    search->rolling = 1;
    memset(search->candidate_visits, 0, sizeof search->candidate_visits);
    if (search->in.rollout.fresh)
        memcpy(search->in.rollout.fresh, search->in.known, search->in.cells_bytes);
    open_rollout(search);
}

void rlvc_search_begin(rlvc_search_cursor *search, const rlvc_search_input *in,
                       const rlvc_small_tree *tree) {
    float *s = search->rollout.s;
    rlvc_reach reach[2];
    memcpy(reach, search->reach, sizeof reach);
    memset(search, 0, sizeof *search);
    memcpy(search->reach, reach, sizeof reach);
    search->rollout.s = s;
    search->in = *in;
    search->tree = *tree;
    search->candidate = *tree;
    search->first = 1;
    open_candidate(search);
}

/* The candidate takes the place of the tree in hand. */
static void accept(rlvc_search_cursor *search, float mean) {
    search->tree = search->candidate;
    search->best = mean;
    memcpy(search->reference, search->earned, sizeof search->reference);
    memcpy(search->visits, search->candidate_visits, sizeof search->visits);
    search->hand ^= 1u;
}

static void end_of_candidate(rlvc_search_cursor *search) {
    float mean = search->sum / (float)search->in.starts;
    search->rolling = 0;
    if (search->first) {
        search->first = 0;
        search->price = LEAF_PRICE * absolute(mean);
        accept(search, mean);
        return;
    }
    float price = 0.5f * (search->price + LEAF_PRICE * (absolute(search->best) + 1e-3f));
    float value = mean - price * (float)search->candidate.leaves;
    float bar = search->best - price * (float)search->tree.leaves;
    if (value < bar)
        return;
    if (value > bar + GAIN_LEAST * absolute(search->best))
        search->gained = search->tried;
    accept(search, mean);
}

/* Is the candidate so far behind that it is not worth another rollout? */
static int lags(const rlvc_search_cursor *search) {
    float margin = LAG * absolute(search->best) + 1e-6f;
    return !search->first && search->start >= LAG_STARTS &&
           search->sum < search->reference_sum - margin * (float)search->start;
}

static void end_of_rollout(rlvc_search_cursor *search) {
    const rlvc_search_input *in = &search->in;
    float earned = in->rollout.fresh ? search->rollout.novelty : search->rollout.total;
    search->earned[search->start] = earned;
    search->sum += earned;
    search->reference_sum += search->reference[search->start];
    search->start++;
    if (search->start == in->starts) {
        end_of_candidate(search);
    } else if (lags(search)) {
        search->rolling = 0;
    } else {
        open_rollout(search);
    }
}

/* Candidates without gain after which the search ends. */
static uint32_t patience_of(const rlvc_search_cursor *search) {
    const rlvc_search_input *in = &search->in;
    float most = in->rollout.model->reward_high * (float)in->rollout.horizon;
    int saturated = !in->rollout.fresh && most > 0.0f && search->best >= 0.999f * most;
    return saturated ? in->patience / 4u : in->patience;
}

static int differs(const rlvc_small_tree *a, const rlvc_small_tree *b) {
    return a->nodes != b->nodes || memcmp(a->node, b->node, a->nodes * sizeof *a->node) != 0;
}

static void next_candidate(rlvc_search_cursor *search) {
    const rlvc_search_input *in = &search->in;
    rlvc_rng rng;
    if (search->tried == in->candidates || search->steps >= in->candidates * STEPS_A_CANDIDATE ||
        search->tried - search->gained >= patience_of(search)) {
        search->done = 1;
        return;
    }
    rlvc_rng_seed(&rng, in->seed + ++search->tried * UINT32_C(0x85ebca6b));
    if (rlvc_moves_make(&in->moves, &search->tree, search->visits, &rng, &search->candidate) &&
        differs(&search->candidate, &search->tree))
        open_candidate(search);
}

/* Is reach there, and of use? Novelty depends on all rollouts before. */
static int remembers(const rlvc_search_cursor *search) {
    return RLVC_AT_ONCE && search->reach[0].box && !search->in.rollout.fresh;
}

/* Is the rollout that begins known to be that of the tree in hand, and would it end within so many
 * steps of the model? */
static int repeats(rlvc_search_cursor *search, uint32_t most) {
    const rlvc_reach *hand = search->reach + search->hand;
    uint32_t start = search->start;
    return !search->first && hand->steps[start] <= most &&
           rlvc_reach_repeats(hand, &search->tree, start, &search->candidate,
                              search->reach + (search->hand ^ 1u), search->candidate_visits);
}

/* One step of the rollout, or at its beginning all of them, up to `most`, if they are known.
 * @return how many. */
static uint32_t roll(rlvc_search_cursor *search, uint32_t most) {
    rlvc_rollout *rollout = &search->rollout;
    if (rollout->step == 0 && remembers(search)) {
        rlvc_reach *reach = search->reach + (search->hand ^ 1u);
        if (repeats(search, most)) {
            rollout->total = search->reference[search->start];
            rollout->done = 1;
            return reach->steps[search->start];
        }
        rlvc_reach_clear(reach, search->start);
        rollout->box = rlvc_reach_boxes(reach, search->start);
    }
    rlvc_rollout_step(rollout, &search->in.rollout, &search->candidate, search->candidate_visits);
    if (rollout->done && rollout->box)
        search->reach[search->hand ^ 1u].steps[search->start] = rollout->step;
    return 1;
}

uint32_t rlvc_search_step(rlvc_search_cursor *search, uint32_t budget) {
    uint32_t spent = 0, units = rlvc_rollout_units(search->in.rollout.model);
    while (spent < budget && !search->done) {
        if (!search->rolling) {
            next_candidate(search);
            spent += MOVE_UNITS;
        } else {
            uint32_t steps = roll(search, (budget - spent - 1u) / units + 1u);
            search->steps += steps;
            spent += steps * units;
            if (search->rollout.done)
                end_of_rollout(search);
        }
    }
    return spent;
}
