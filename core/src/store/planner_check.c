/* SPDX-License-Identifier: MIT */
/* Does what was loaded into a planner hold together: see planner_check.h. */
#include "rlvc/float_rules.h"

#include "planner_check.h"

/* Sums of rewards, and what a model makes of them, are far below. */
#define NUMBER_MOST 1e30f

static int within(float x, float most) {
    return x >= -most && x <= most; /* false for a NaN */
}

static int are_numbers(const float *number, uint32_t count, float most) {
    for (uint32_t i = 0; i < count; i++)
        if (!within(number[i], most))
            return 0;
    return 1;
}

/* ------------------------------------------------------------------ the ring */

static int row_is_sound(const rlvc_planner *planner, uint32_t row) {
    const rlvc_experience *experience = &planner->experience;
    return experience->end[row] <= RLVC_ROW_LAST &&
           experience->action[row] < planner->config.actions &&
           within(experience->reward[row], RLVC_REWARD_MAX) &&
           are_numbers(rlvc_experience_percept(experience, row), experience->components,
                       RLVC_PLANNER_NUMBER_MAX);
}

static int experience_is_sound(const rlvc_planner *planner) {
    const rlvc_experience *experience = &planner->experience;
    uint32_t components = experience->components;
    for (uint32_t i = 0; i < experience->count; i++)
        if (!row_is_sound(planner, rlvc_experience_row(experience, i)))
            return 0;
    return (experience->count == 0 || experience->end[experience->head] == RLVC_ROW_LAST) &&
           are_numbers(experience->low, components, RLVC_PLANNER_NUMBER_MAX) &&
           are_numbers(experience->high, components, RLVC_PLANNER_NUMBER_MAX);
}

/* ------------------------------------------------------------------ the model */

int rlvc_planner_check_terms(const rlvc_dynamics *dynamics, const rlvc_model_tree *tree) {
    const rlvc_basis *basis = &dynamics->basis;
    int known = tree->terms == 0 || tree->terms == dynamics->terms_max ||
                tree->terms == rlvc_basis_short(basis->components, basis->actions);
    return known && tree->leaves >= 1u && tree->leaves <= dynamics->leaves_max;
}

static int model_node_is_sound(const rlvc_dynamics *dynamics, const rlvc_model_tree *tree,
                               uint32_t k) {
    const rlvc_model_node *node = tree->node + k;
    if (node->test == RLVC_MODEL_LEAF)
        return node->child < tree->leaves;
    return node->test < dynamics->basis.components + dynamics->basis.actions && node->child > k &&
           node->child + 2u < 2u * tree->leaves && within(node->cut, NUMBER_MOST);
}

static int model_tree_is_sound(const rlvc_dynamics *dynamics, const rlvc_model_tree *tree) {
    for (uint32_t k = 0; k + 1u < 2u * tree->leaves; k++)
        if (!model_node_is_sound(dynamics, tree, k))
            return 0;
    for (uint32_t i = 0; i < tree->leaves; i++) {
        const rlvc_model_leaf *leaf = tree->leaf + i;
        if (!within(leaf->low, NUMBER_MOST) || !within(leaf->high, NUMBER_MOST) ||
            !within(leaf->noise, NUMBER_MOST) ||
            !are_numbers(rlvc_model_tree_coefficients(tree, i), tree->terms, NUMBER_MOST))
            return 0;
    }
    return within(tree->mean, NUMBER_MOST) && within(tree->scale, NUMBER_MOST);
}

int rlvc_planner_check_ending(const rlvc_ending *ending, uint32_t k, uint32_t components) {
    const rlvc_ending_node *node = ending->node + k;
    int leads_on =
        node->component < components && node->child > k && node->child + 1u < RLVC_ENDING_NODES;
    return (leads_on || node->component == RLVC_ENDING_LEAF) && node->probability >= 0.0f &&
           node->probability <= 1.0f && within(node->cut, NUMBER_MOST) &&
           within(node->reward, NUMBER_MOST);
}

static int dynamics_are_sound(const rlvc_dynamics *dynamics) {
    const rlvc_basis *basis = &dynamics->basis;
    for (uint32_t i = 0; i < basis->components; i++)
        if (!(basis->scale[i] > 0.0f))
            return 0;
    for (uint32_t k = 0; k <= basis->components; k++)
        if (!model_tree_is_sound(dynamics, dynamics->tree + k))
            return 0;
    return are_numbers(basis->mean, basis->components, NUMBER_MOST) &&
           are_numbers(basis->scale, basis->components, NUMBER_MOST) &&
           are_numbers(dynamics->low, basis->components, NUMBER_MOST) &&
           are_numbers(dynamics->high, basis->components, NUMBER_MOST) &&
           within(dynamics->reward_low, NUMBER_MOST) && within(dynamics->reward_high, NUMBER_MOST);
}

static int models_are_sound(const rlvc_planner *planner) {
    for (uint32_t k = 0; k < RLVC_ROLLOUT_MODELS; k++)
        if (!dynamics_are_sound(planner->model + k))
            return 0;
    return 1;
}

/* ------------------------------------------------------------------ policies */

/* A tree in the order that the search makes: the j-th test's children are 2j + 1 and 2j + 2. */
static int small_tree_is_sound(const rlvc_planner *planner, const rlvc_small_tree *tree) {
    uint32_t tests = 0;
    if (tree->nodes % 2u == 0 || tree->leaves > planner->config.leaves)
        return 0;
    for (uint32_t k = 0; k < tree->nodes; k++) {
        const rlvc_small_node *node = tree->node + k;
        if (!within(node->cut, NUMBER_MOST) || node->action >= planner->config.actions)
            return 0;
        if (node->component == RLVC_SMALL_LEAF)
            continue;
        if (node->component >= planner->components || node->child != 2u * tests + 1u ||
            node->child <= k)
            return 0;
        tests++;
    }
    return tests + 1u == tree->leaves;
}

static int trial_is_sound(const rlvc_planner *planner, const rlvc_trial *trial, uint32_t policy) {
    const rlvc_archive *archive = &planner->archive;
    uint32_t kept = rlvc_trial_kept(trial);
    return small_tree_is_sound(planner, &trial->tree) && within(trial->promise, NUMBER_MOST) &&
           within(trial->score, NUMBER_MOST) && trial->valued <= kept &&
           are_numbers(trial->earned, kept, NUMBER_MOST) &&
           are_numbers(trial->promised, kept, NUMBER_MOST) &&
           are_numbers(rlvc_archive_start(archive, policy, 0), kept * archive->components,
                       RLVC_PLANNER_NUMBER_MAX);
}

static int archive_is_sound(const rlvc_planner *planner) {
    const rlvc_archive *archive = &planner->archive;
    for (uint32_t i = 0; i < archive->count; i++)
        if (!trial_is_sound(planner, archive->trial + i, i))
            return 0;
    return within(archive->beta, 1.0f) && within(archive->common, NUMBER_MOST) &&
           within(archive->deviation, NUMBER_MOST);
}

static int acting_is_sound(const rlvc_planner *planner, const rlvc_acting *acting) {
    if (acting->why == RLVC_PLANNER_RANDOM && acting->tree.nodes == 0)
        return 1;
    return acting->why <= RLVC_PLANNER_AGAIN && acting->trial < RLVC_ARCHIVE_POLICIES &&
           small_tree_is_sound(planner, &acting->tree);
}

/* ------------------------------------------------------------------ all of it */

/* What has happened, and in what order: percepts, interactions, the first fit, policies. */
static int order_is_sound(const rlvc_planner *planner) {
    const rlvc_experience *experience = &planner->experience;
    int begun = planner->starts > 0 && experience->count > 0;
    int nothing = experience->total == 0 && !planner->open && !planner->due;
    int fitted = planner->fitted > 0;
    return (begun || nothing) && planner->fitted <= experience->total &&
           (fitted ? planner->commons > 0 : planner->archive.count == 0);
}

static int counters_are_sound(const rlvc_planner *planner) {
    return planner->gainful <= 1u && planner->open <= 1u && planner->due <= 1u &&
           planner->commons <= RLVC_PLANNER_STARTS &&
           (!planner->open || planner->steps < planner->config.horizon) &&
           within(planner->earned, NUMBER_MOST) && within(planner->least, NUMBER_MOST) &&
           within(planner->most, NUMBER_MOST);
}

static int starts_are_sound(const rlvc_planner *planner) {
    uint32_t components = planner->components;
    uint32_t count = RLVC_PLANNER_STARTS * components;
    return are_numbers(planner->start, count, RLVC_PLANNER_NUMBER_MAX) &&
           are_numbers(planner->common, count, RLVC_PLANNER_NUMBER_MAX) &&
           are_numbers(planner->now, components, RLVC_PLANNER_NUMBER_MAX);
}

int rlvc_planner_is_sound(const rlvc_planner *planner) {
    return counters_are_sound(planner) && order_is_sound(planner) && experience_is_sound(planner) &&
           (planner->fitted == 0 || models_are_sound(planner)) && archive_is_sound(planner) &&
           acting_is_sound(planner, &planner->acting) && acting_is_sound(planner, &planner->next) &&
           starts_are_sound(planner);
}
