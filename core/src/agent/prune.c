/* SPDX-License-Identifier: MIT */
/* Pruning: removing useless tests from the tree (section 7, "techniques to remove learned features
 * that are subsequently proved useless"): see rlvc_prune.
 *
 * Splits are looked at from the newest to the oldest, and so each after all that are below it. One
 * whose two sides are single classes by then, which agree, is undone: the class that it made, j +
 * 1, becomes again part of the one that it was split from, and what is known of both is put
 * together. As the layout of the tree is its history (tree.h), the splits that are left, in their
 * order, make a tree of their own: they are grown again in place, and their classes numbered anew.
 *
 * Of the tables that lie idle between two learning steps, `pair` and `begin` hold the spread of
 * the targets, and `pending` what becomes of each class. */
#include "rlvc/float_rules.h"

#include "learn.h"
#include "q_variance.h"
#include "state.h"
#include <string.h>

typedef struct pruner {
    rlvc_agent *agent;
    rlvc_q_variance variance;
    uint16_t *gone; /* [classes] 1: split j, which made class j + 1, is undone; then the classes'
                       new numbers */
    float tolerance;
    float deviations;
} pruner;

static float square(float x) {
    return x * x;
}

/* Can the difference of two pairs' Q be chance? */
static int is_chance(const pruner *p, size_t one, size_t other, float difference) {
    const uint32_t enough = p->agent->config.min_samples;
    if (p->variance.count[one] < enough || p->variance.count[other] < enough)
        return 0;
    return square(difference) <= square(p->deviations) * (rlvc_q_variance_of(&p->variance, one) +
                                                          rlvc_q_variance_of(&p->variance, other));
}

/* Do two classes act alike, and is each action worth as much in both, as far as is known? */
static int agree(const pruner *p, uint32_t c, uint32_t d) {
    const rlvc_values *values = &p->agent->values;
    if (values->policy[c] != values->policy[d])
        return 0;
    for (uint32_t a = 0; a < values->actions; a++) {
        const size_t one = rlvc_values_pair(values, c, a), other = rlvc_values_pair(values, d, a);
        const float difference = values->q[one] - values->q[other];
        if ((values->tried[one] > 0) != (values->tried[other] > 0))
            return 0;
        if (values->tried[one] > 0 && square(difference) > square(p->tolerance) &&
            !is_chance(p, one, other, difference))
            return 0;
    }
    return 1;
}

/* Puts what is known of class d to that of class c. */
static void put_together(pruner *p, uint32_t c, uint32_t d) {
    rlvc_values *values = &p->agent->values;
    for (uint32_t a = 0; a < values->actions; a++) {
        const size_t one = rlvc_values_pair(values, c, a), other = rlvc_values_pair(values, d, a);
        const uint32_t tried = values->tried[one] + values->tried[other];
        if (tried == 0)
            continue;
        const float q = values->q[one] + (values->q[other] - values->q[one]) *
                                             ((float)values->tried[other] / (float)tried);
        p->variance.squares[one] += p->variance.squares[other] +
                                    (float)p->variance.count[one] * square(values->q[one] - q) +
                                    (float)p->variance.count[other] * square(values->q[other] - q);
        p->variance.count[one] += p->variance.count[other];
        values->q[one] = q;
        values->tried[one] = tried;
    }
    values->value[c] = rlvc_values_best(values, c);
    rlvc_explorer_join(&p->agent->explorer, values->actions, c, d);
}

/* Is a node a leaf by now? */
static int is_single(const pruner *p, uint32_t node) {
    const rlvc_tree *tree = &p->agent->tree;
    return rlvc_tree_is_leaf(tree, node) || p->gone[rlvc_tree_split_of(tree, node) + 1u];
}

static uint32_t undo_splits(pruner *p) {
    const rlvc_tree *tree = &p->agent->tree;
    uint32_t undone = 0;
    for (uint32_t j = tree->classes - 1u; j-- > 0;) {
        const uint32_t c = tree->split[j].about.class_id;
        if (is_single(p, 2u * j + 1u) && is_single(p, 2u * j + 2u) && agree(p, c, j + 1u)) {
            put_together(p, c, j + 1u);
            p->gone[j + 1u] = 1;
            undone++;
        }
    }
    return undone;
}

/* Moves what is known of the classes that are left together; gone[] becomes each class's new
 * number. */
static void number_classes(pruner *p) {
    const rlvc_tree *tree = &p->agent->tree;
    rlvc_values *values = &p->agent->values;
    uint32_t left = 0;
    for (uint32_t c = 1; c < tree->classes; c++) {
        if (p->gone[c]) {
            p->gone[c] = p->gone[tree->split[c - 1u].about.class_id];
            continue;
        }
        left++;
        p->gone[c] = (uint16_t)left;
        rlvc_values_inherit(values, left, c);
        rlvc_explorer_inherit(&p->agent->explorer, values->actions, left, c);
    }
}

/* Builds the tree of the splits that are left. None comes to stand behind where it stood. */
static void build_again(pruner *p) {
    rlvc_agent *agent = p->agent;
    rlvc_tree *tree = &agent->tree;
    uint32_t left = 0;
    agent->last_split = 0;
    for (uint32_t j = 0; j + 1u < tree->classes; j++) {
        if (p->gone[j + 1u] != left + 1u)
            continue;
        rlvc_split *about = &tree->split[left].about;
        *about = tree->split[j].about;
        about->class_id = p->gone[about->class_id];
        memmove(rlvc_tree_feature(tree, left), rlvc_tree_feature(tree, j), tree->feature_bytes);
        agent->last_split = about->step;
        left++;
    }
    rlvc_tree_build(tree, left + 1u);
}

static void label_again(pruner *p) {
    rlvc_replay *replay = &p->agent->replay;
    for (uint32_t position = 0; position < replay->count; position++) {
        uint16_t *label = &replay->label[rlvc_replay_slot(replay, position)];
        if (*label != RLVC_NO_CLASS)
            *label = p->gone[*label];
    }
}

/* Without the label of its last interaction the next step tests the classes again. */
static void forget_last(rlvc_replay *replay) {
    const uint32_t end = replay->count - replay->open;
    replay->label[rlvc_replay_slot(replay, end - (uint32_t)(end > 0))] = RLVC_NO_CLASS;
}

rlvc_status rlvc_prune(rlvc_agent *agent, float tolerance, float deviations, uint32_t *undone) {
    if (!agent)
        return RLVC_E_NULL;
    if (rlvc_agent_plans(agent))
        return RLVC_E_MISMATCH;
    if (agent->busy)
        return RLVC_E_REENTERED;
    if (!undone)
        return RLVC_E_NULL;
    if (!(tolerance >= 0.0f && tolerance <= RLVC_REWARD_MAX) ||
        !(deviations >= 0.0f && deviations <= 1000.0f))
        return RLVC_E_RANGE;
    if (agent->learner.phase != RLVC_PHASE_IDLE)
        return RLVC_E_BUSY;
    const uint32_t classes = agent->tree.classes;
    pruner p = {agent,
                {agent->values.pair.squares, agent->values.begin.targets},
                agent->pending,
                tolerance,
                deviations};
    rlvc_q_variance_measure(&p.variance, &agent->replay, &agent->values, agent->config.discount,
                            classes);
    memset(p.gone, 0, classes * sizeof *p.gone);
    *undone = undo_splits(&p);
    number_classes(&p);
    build_again(&p);
    label_again(&p);
    if (*undone > 0)
        forget_last(&agent->replay);
    memset(p.gone, 0, classes * sizeof *p.gone);
    memset(agent->values.pair.reward, 0,
           (size_t)classes * agent->config.actions * sizeof *agent->values.pair.reward);
    return RLVC_OK;
}
