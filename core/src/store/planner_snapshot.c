/* SPDX-License-Identifier: MIT */
/* What a planner's snapshot holds, in order: see SPEC.md.
 *
 * It is made between two steps of learning, so that no cursor is in it. Each part is one function
 * that passes its fields through a stream, whichever way that goes. Where what is loaded decides
 * how much there is to come, it is checked at once; the rest is checked at the end
 * (planner_check.h). */
#include "rlvc/float_rules.h"

#include "planner_check.h"
#include "planner_snapshot.h"

#include <string.h>

/* ------------------------------------------------------------------ the parts */

static void pass_config(rlvc_stream *s, uint32_t *components, rlvc_config *config) {
    rlvc_stream_u32(s, components);
    rlvc_stream_u32(s, &config->actions);
    rlvc_stream_u32(s, &config->capacity);
    rlvc_stream_u32(s, &config->sample);
    rlvc_stream_u32(s, &config->model_leaves);
    rlvc_stream_u32(s, &config->leaves);
    rlvc_stream_u32(s, &config->horizon);
    rlvc_stream_u32(s, &config->random);
    rlvc_stream_u32(s, &config->candidates);
    rlvc_stream_u32(s, &config->patience);
    rlvc_stream_u32(s, &config->seed);
}

#define FIRST_VERSION_STARTS 32u /* first percepts in a snapshot of the first version */

static void pass_floats(rlvc_stream *s, float *number, uint32_t count) {
    for (uint32_t i = 0; i < count; i++)
        rlvc_stream_float(s, number + i);
}

static void pass_counters(rlvc_stream *s, rlvc_planner *planner) {
    uint32_t *field[] = {&planner->starts,   &planner->commons,   &planner->steps,
                         &planner->episodes, &planner->longest,   &planner->fitted,
                         &planner->explored, &planner->new_cells, &planner->counter,
                         &planner->searched, &planner->failures,  &planner->fits,
                         &planner->searches, &planner->candidates};
    rlvc_stream_u64(s, &planner->rng.state);
    for (uint32_t i = 0; i < sizeof field / sizeof field[0]; i++)
        rlvc_stream_u32(s, field[i]);
    rlvc_stream_float(s, &planner->earned);
    rlvc_stream_float(s, &planner->least);
    rlvc_stream_float(s, &planner->most);
    rlvc_stream_u8(s, &planner->gainful);
    rlvc_stream_u8(s, &planner->open);
    rlvc_stream_u8(s, &planner->due);
}

/* A row without an interaction holds what was there before it: that is passed as zeros. */
static void pass_row(rlvc_stream *s, rlvc_experience *experience, uint32_t row) {
    int stored = s->mode == RLVC_STREAM_LOAD || experience->end[row] != RLVC_ROW_LAST;
    float reward = stored ? experience->reward[row] : 0.0f;
    uint8_t action = stored ? experience->action[row] : 0u;
    pass_floats(s, experience->percept + (size_t)row * experience->components,
                experience->components);
    rlvc_stream_float(s, &reward);
    rlvc_stream_u8(s, &action);
    rlvc_stream_u8(s, experience->end + row);
    if (s->mode == RLVC_STREAM_LOAD) {
        experience->reward[row] = reward;
        experience->action[row] = action;
    }
}

static int pass_experience(rlvc_stream *s, rlvc_experience *experience) {
    rlvc_stream_u32(s, &experience->head);
    rlvc_stream_u32(s, &experience->count);
    rlvc_stream_u32(s, &experience->total);
    if (experience->head >= experience->rows || experience->count > experience->rows)
        return 0;
    pass_floats(s, experience->low, experience->components);
    pass_floats(s, experience->high, experience->components);
    for (uint32_t i = 0; i < experience->count; i++)
        pass_row(s, experience, rlvc_experience_row(experience, i));
    return 1;
}

static int pass_model_tree(rlvc_stream *s, const rlvc_dynamics *dynamics, rlvc_model_tree *tree) {
    rlvc_stream_float(s, &tree->mean);
    rlvc_stream_float(s, &tree->scale);
    rlvc_stream_u16(s, &tree->terms);
    rlvc_stream_u16(s, &tree->leaves);
    if (!rlvc_planner_check_terms(dynamics, tree))
        return 0;
    for (uint32_t k = 0; k + 1u < 2u * tree->leaves; k++) {
        rlvc_stream_float(s, &tree->node[k].cut);
        rlvc_stream_u16(s, &tree->node[k].test);
        rlvc_stream_u16(s, &tree->node[k].child);
    }
    for (uint32_t leaf = 0; leaf < tree->leaves; leaf++) {
        rlvc_stream_float(s, &tree->leaf[leaf].low);
        rlvc_stream_float(s, &tree->leaf[leaf].high);
        rlvc_stream_float(s, &tree->leaf[leaf].noise);
        pass_floats(s, rlvc_model_tree_coefficients(tree, leaf), tree->terms);
    }
    return 1;
}

/* Only the nodes that can be reached: the others hold what was there before. */
static int pass_ending(rlvc_stream *s, rlvc_ending *ending, uint32_t components) {
    uint32_t nodes = 1;
    for (uint32_t k = 0; k < nodes; k++) {
        rlvc_ending_node *node = ending->node + k;
        rlvc_stream_float(s, &node->cut);
        rlvc_stream_float(s, &node->probability);
        rlvc_stream_float(s, &node->reward);
        rlvc_stream_u16(s, &node->component);
        rlvc_stream_u16(s, &node->child);
        if (!rlvc_planner_check_ending(ending, k, components))
            return 0;
        if (node->component != RLVC_ENDING_LEAF && nodes < node->child + 2u)
            nodes = node->child + 2u;
    }
    return 1;
}

static int pass_dynamics(rlvc_stream *s, rlvc_dynamics *dynamics) {
    uint32_t components = dynamics->basis.components;
    pass_floats(s, dynamics->basis.mean, components);
    pass_floats(s, dynamics->basis.scale, components);
    pass_floats(s, dynamics->low, components);
    pass_floats(s, dynamics->high, components);
    rlvc_stream_float(s, &dynamics->reward_low);
    rlvc_stream_float(s, &dynamics->reward_high);
    for (uint32_t k = 0; k <= components; k++)
        if (!pass_model_tree(s, dynamics, dynamics->tree + k))
            return 0;
    return pass_ending(s, &dynamics->ending, components);
}

static int pass_models(rlvc_stream *s, rlvc_planner *planner) {
    for (uint32_t k = 0; k < RLVC_ROLLOUT_MODELS; k++)
        if (!pass_dynamics(s, planner->model + k))
            return 0;
    return 1;
}

static int pass_small_tree(rlvc_stream *s, rlvc_small_tree *tree) {
    rlvc_stream_u8(s, &tree->nodes);
    if (tree->nodes > RLVC_SMALL_NODES_MAX)
        return 0;
    tree->leaves = (uint8_t)((tree->nodes + 1u) / 2u);
    for (uint32_t k = 0; k < tree->nodes; k++) {
        rlvc_stream_float(s, &tree->node[k].cut);
        rlvc_stream_u16(s, &tree->node[k].component);
        rlvc_stream_u8(s, &tree->node[k].child);
        rlvc_stream_u8(s, &tree->node[k].action);
    }
    return 1;
}

static int pass_trial(rlvc_stream *s, rlvc_archive *archive, uint32_t policy) {
    rlvc_trial *trial = archive->trial + policy;
    if (!pass_small_tree(s, &trial->tree))
        return 0;
    rlvc_stream_float(s, &trial->promise);
    rlvc_stream_float(s, &trial->score);
    rlvc_stream_u32(s, &trial->serial);
    rlvc_stream_u32(s, &trial->episodes);
    rlvc_stream_u32(s, &trial->valued);
    rlvc_stream_u8(s, &trial->promise_known);
    for (uint32_t e = 0; e < rlvc_trial_kept(trial); e++) {
        rlvc_stream_float(s, &trial->earned[e]);
        rlvc_stream_float(s, &trial->promised[e]);
        pass_floats(s, rlvc_archive_start(archive, policy, e), archive->components);
    }
    return 1;
}

static int pass_archive(rlvc_stream *s, rlvc_archive *archive) {
    rlvc_stream_u32(s, &archive->count);
    rlvc_stream_u32(s, &archive->added);
    rlvc_stream_float(s, &archive->beta);
    rlvc_stream_float(s, &archive->common);
    rlvc_stream_float(s, &archive->deviation);
    if (archive->count > RLVC_ARCHIVE_POLICIES)
        return 0;
    for (uint32_t i = 0; i < archive->count; i++)
        if (!pass_trial(s, archive, i))
            return 0;
    return 1;
}

static int pass_acting(rlvc_stream *s, rlvc_acting *acting) {
    rlvc_stream_u32(s, &acting->trial);
    rlvc_stream_u32(s, &acting->serial);
    rlvc_stream_u8(s, &acting->why);
    return pass_small_tree(s, &acting->tree);
}

/* All that comes after the config, with room for `starts` first percepts.
 * @return 0 if what was loaded does not fit. */
static int pass_state(rlvc_stream *s, rlvc_planner *planner, uint32_t starts) {
    uint32_t components = planner->components;
    pass_counters(s, planner);
    if (!pass_experience(s, &planner->experience) ||
        (planner->fitted > 0 && !pass_models(s, planner)) || !pass_archive(s, &planner->archive) ||
        !pass_acting(s, &planner->acting) || !pass_acting(s, &planner->next))
        return 0;
    pass_floats(s, planner->start, starts * components);
    pass_floats(s, planner->common, starts * components);
    pass_floats(s, planner->now, components);
    rlvc_stream_bytes(s, planner->cells, planner->cells_bytes);
    return 1;
}

/* ------------------------------------------------------------------ sizes */

#define FIXED_BYTES 2048u
#define TREE_BYTES (1u + RLVC_SMALL_NODES_MAX * 8u)

/* The most that a snapshot can take. 64 bits hold it for every config. */
static uint64_t largest(const rlvc_config *config, uint32_t components) {
    uint64_t d = components, unit = RLVC_STORE_UNIT;
    uint64_t leaf = 28u + 4u * (uint64_t)rlvc_basis_full(components, config->actions);
    uint64_t size = FIXED_BYTES + (uint64_t)config->capacity * (4u * d + 6u);
    size += RLVC_ROLLOUT_MODELS * (d + 1u) * (12u + config->model_leaves * leaf);
    size += RLVC_ARCHIVE_POLICIES * (TREE_BYTES + 21u + RLVC_ARCHIVE_EPISODES * (8u + 4u * d));
    size += 2u * TREE_BYTES + (2u * RLVC_PLANNER_STARTS + 11u) * 4u * d;
    size += (uint64_t)rlvc_cells_pairs(components) * RLVC_CELLS_BYTES;
    return (size + unit - 1u) / unit * unit;
}

rlvc_status rlvc_planner_snapshot_size(const rlvc_config *config, const rlvc_domain *domain,
                                       uint32_t *bytes) {
    if (!bytes)
        return RLVC_E_NULL;
    *bytes = 0;
    rlvc_status status = rlvc_config_status(config, domain);
    if (status != RLVC_OK)
        return status;
    uint64_t size = largest(config, rlvc_planner_components(domain));
    if (size > RLVC_SLOT_BYTES_MAX)
        return RLVC_E_MEMORY;
    *bytes = (uint32_t)size;
    return RLVC_OK;
}

/* ------------------------------------------------------------------ saving and loading */

static void pass_planner(rlvc_stream *s, rlvc_planner *planner) {
    pass_config(s, &planner->components, &planner->config);
    (void)pass_state(s, planner, RLVC_PLANNER_STARTS);
}

static rlvc_status save(rlvc_planner *planner, const rlvc_store *store) {
    rlvc_two_slot slot;
    rlvc_stream stream;
    rlvc_status status = rlvc_two_slot_next(store, &slot);
    if (status != RLVC_OK)
        return status;
    rlvc_stream_count(&stream);
    pass_planner(&stream, planner);
    slot.version = RLVC_PLANNER_SNAPSHOT_VERSION;
    slot.bytes = (uint32_t)rlvc_stream_size(&stream);
    rlvc_stream_save(&stream, store, &slot);
    pass_planner(&stream, planner);
    return rlvc_stream_end(&stream);
}

rlvc_status rlvc_planner_save(rlvc_agent *agent, const rlvc_store *store) {
    rlvc_planner *planner;
    rlvc_status status = rlvc_planner_of(agent, &planner);
    if (status == RLVC_OK)
        status = rlvc_two_slot_check(store, largest(&planner->config, planner->components));
    if (status == RLVC_OK && planner->learning)
        status = RLVC_E_BUSY;
    if (status != RLVC_OK)
        return status;
    planner->busy = 1;
    status = save(planner, store);
    planner->busy = 0;
    return status;
}

rlvc_status rlvc_planner_open_slot(const rlvc_store *store, const rlvc_two_slot *slot,
                                   rlvc_stream *stream, rlvc_snapshot_info *info) {
    uint32_t components = 0;
    if (!rlvc_planner_snapshot_known(slot->version))
        return RLVC_E_VERSION;
    rlvc_stream_load(stream, store, slot);
    pass_config(stream, &components, &info->config);
    info->percept_bytes = RLVC_THRESHOLDS_PERCEPT_BYTES(components);
    info->feature_bytes = RLVC_THRESHOLDS_FEATURE_BYTES;
    return stream->status;
}

/* Fills a new planner. Of the first version's few first percepts all are the newest ones. */
static rlvc_status load(rlvc_stream *stream, rlvc_planner *planner, uint32_t version) {
    uint32_t starts =
        version == RLVC_PLANNER_SNAPSHOT_FIRST ? FIRST_VERSION_STARTS : RLVC_PLANNER_STARTS;
    int fits = pass_state(stream, planner, starts);
    if (starts < RLVC_PLANNER_STARTS && planner->starts > starts)
        planner->starts = starts;
    if (stream->status != RLVC_OK)
        return stream->status;
    if (!fits)
        return RLVC_E_DAMAGED;
    rlvc_status status = rlvc_stream_end(stream);
    if (status != RLVC_OK)
        return status;
    return rlvc_planner_is_sound(planner) ? RLVC_OK : RLVC_E_DAMAGED;
}

rlvc_status rlvc_planner_load(const rlvc_config *config, const rlvc_domain *domain, void *memory,
                              size_t bytes, const rlvc_store *store, rlvc_agent **agent) {
    uint32_t min_bytes = 0;
    rlvc_snapshot_info info;
    rlvc_two_slot slot;
    rlvc_stream stream;
    rlvc_agent *made;
    if (!agent)
        return RLVC_E_NULL;
    *agent = NULL;
    rlvc_status status = rlvc_planner_snapshot_size(config, domain, &min_bytes);
    if (status == RLVC_OK)
        status = rlvc_two_slot_check(store, min_bytes);
    if (status == RLVC_OK)
        status = rlvc_two_slot_newest(store, &slot);
    if (status != RLVC_OK)
        return status;
    info.config = *config;
    status = rlvc_planner_open_slot(store, &slot, &stream, &info);
    if (status == RLVC_OK && (info.percept_bytes != domain->percept_bytes ||
                              memcmp(&info.config, config, RLVC_CONFIG_BYTES) != 0))
        status = RLVC_E_MISMATCH;
    if (status == RLVC_OK)
        status = rlvc_planner_init(config, domain, memory, bytes, &made);
    if (status == RLVC_OK)
        status = load(&stream, (rlvc_planner *)(void *)made, slot.version);
    if (status == RLVC_OK)
        *agent = made;
    return status;
}

rlvc_status rlvc_planner_check(rlvc_agent *agent) {
    rlvc_planner *planner;
    rlvc_status status = rlvc_planner_of(agent, &planner);
    if (status == RLVC_OK && planner->learning)
        status = RLVC_E_BUSY;
    if (status == RLVC_OK && !rlvc_planner_is_sound(planner))
        status = RLVC_E_MEMORY;
    return status;
}
