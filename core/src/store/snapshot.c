/* SPDX-License-Identifier: MIT */
/* What a snapshot of an agent of classes holds, in order: see SPEC.md.
 *
 * Each part is one function that passes its fields through a stream, whichever way that goes. Where
 * what is loaded decides how much there is to come, it is checked at once; the rest is checked at
 * the end. */
#include "rlvc/float_rules.h"

#include "rlvc/snapshot.h"

#include "../agent/state.h"
#include "cursor_marks.h"
#include "planner_snapshot.h"
#include "two_slot.h"
#include <string.h>

/* ------------------------------------------------------------------ the parts */

/* Bytes of fields that the config had in an earlier release.
 * @return 0 if one of them is not 0: no config of this release is the same. */
static int pass_reserved(rlvc_stream *s, uint32_t bytes) {
    uint8_t all = 0;
    for (uint32_t i = 0; i < bytes; i++) {
        uint8_t byte = 0;
        rlvc_stream_u8(s, &byte);
        all |= byte;
    }
    return all == 0;
}

/* @return 0 if a reserved byte is not 0. */
static int pass_config(rlvc_stream *s, rlvc_config *config) {
    int known = 1;
    rlvc_stream_u32(s, &config->actions);
    rlvc_stream_u32(s, &config->capacity);
    rlvc_stream_u32(s, &config->classes);
    rlvc_stream_u32(s, &config->features_at_once);
    rlvc_stream_u32(s, &config->min_samples);
    rlvc_stream_u32(s, &config->max_sweeps);
    rlvc_stream_u32(s, &config->seed);
    rlvc_stream_u8(s, &config->criterion);
    rlvc_stream_u8(s, &config->score);
    rlvc_stream_u8(s, &config->solver);
    known &= pass_reserved(s, 1); /* untried */
    rlvc_stream_u8(s, &config->continuing);
    rlvc_stream_u8(s, &config->successors);
    rlvc_stream_u8(s, &config->explore);
    rlvc_stream_u8(s, &config->dependence);
    rlvc_stream_float(s, &config->discount);
    rlvc_stream_float(s, &config->epsilon);
    rlvc_stream_float(s, &config->alpha);
    rlvc_stream_float(s, &config->alpha_known);
    rlvc_stream_float(s, &config->tolerance);
    rlvc_stream_float(s, &config->learning_rate);
    rlvc_stream_float(s, &config->smallest_effect);
    return known;
}

/* Whose snapshot it is.
 * @return 0 if a reserved byte is not 0. */
static int pass_identity(rlvc_stream *s, uint32_t *percept_bytes, uint32_t *feature_bytes,
                         rlvc_config *config) {
    rlvc_stream_u32(s, percept_bytes);
    rlvc_stream_u32(s, feature_bytes);
    return pass_config(s, config);
}

static void pass_counters(rlvc_stream *s, rlvc_agent *agent) {
    rlvc_stream_u64(s, &agent->interactions);
    rlvc_stream_u64(s, &agent->rng.state);
    rlvc_stream_u32(s, &agent->step);
    rlvc_stream_u32(s, &agent->run);
    rlvc_stream_u32(s, &agent->last_split);
    rlvc_stream_u32(s, &agent->refused);
    rlvc_stream_u32(s, &agent->sweeps);
    rlvc_stream_float(s, &agent->residual);
}

/* A slot without an interaction holds what was there before it: that is passed as zeros. */
static void pass_slot(rlvc_stream *s, rlvc_replay *replay, uint32_t words, uint32_t slot) {
    float reward = 0.0f;
    uint8_t action = 0;
    if (s->mode != RLVC_STREAM_LOAD && (replay->flags[slot] & RLVC_SLOT_STORED)) {
        reward = replay->reward[slot];
        action = replay->action[slot];
    }
    rlvc_stream_record(s, replay->percept + (size_t)slot * replay->percept_bytes,
                       replay->percept_bytes, words, 0);
    rlvc_stream_float(s, &reward);
    rlvc_stream_u16(s, &replay->label[slot]);
    rlvc_stream_u8(s, &action);
    rlvc_stream_u8(s, &replay->flags[slot]);
    if (s->mode == RLVC_STREAM_LOAD) {
        replay->reward[slot] = reward;
        replay->action[slot] = action;
    }
}

/* @return 0 if what was loaded does not fit. */
static int pass_replay(rlvc_stream *s, rlvc_agent *agent) {
    rlvc_replay *replay = &agent->replay;
    rlvc_stream_u32(s, &replay->head);
    rlvc_stream_u32(s, &replay->count);
    rlvc_stream_u32(s, &replay->stored);
    rlvc_stream_u32(s, &replay->frozen);
    rlvc_stream_u8(s, &replay->open);
    if (replay->head >= replay->slots || replay->count > replay->slots)
        return 0;
    for (uint32_t position = 0; position < replay->count; position++)
        pass_slot(s, replay, agent->domain.percept_words, rlvc_replay_slot(replay, position));
    return 1;
}

static int is_number(float x) {
    return x - x == 0.0f;
}

static int split_is_sound(const rlvc_agent *agent, const rlvc_split *about, uint32_t j) {
    return about->class_id <= j && about->step <= agent->step &&
           about->action <= agent->config.actions + 1u && is_number(about->log_tests) &&
           is_number(about->score) && is_number(about->log_p);
}

/* The tree is built of its splits, so that its nodes need not be passed, nor believed. */
static int pass_tree(rlvc_stream *s, rlvc_agent *agent) {
    rlvc_tree *tree = &agent->tree;
    uint32_t classes = tree->classes;
    int loading = s->mode == RLVC_STREAM_LOAD;
    rlvc_stream_u32(s, &classes);
    if (classes < 1u || classes > tree->classes_max)
        return 0;
    for (uint32_t j = 0; j + 1u < classes; j++) {
        rlvc_split *about = &tree->split[j].about;
        rlvc_stream_u32(s, &about->class_id);
        rlvc_stream_u32(s, &about->step);
        rlvc_stream_u32(s, &about->action);
        rlvc_stream_u32(s, &about->samples);
        rlvc_stream_float(s, &about->log_tests);
        rlvc_stream_float(s, &about->score);
        rlvc_stream_float(s, &about->log_p);
        rlvc_stream_record(s, rlvc_tree_feature(tree, j), tree->feature_bytes,
                           agent->domain.feature_words, agent->domain.feature_halves);
        if (loading && !split_is_sound(agent, about, j))
            return 0;
    }
    if (loading)
        rlvc_tree_build(tree, classes);
    return 1;
}

static void pass_values(rlvc_stream *s, rlvc_agent *agent) {
    rlvc_values *values = &agent->values;
    for (uint32_t c = 0; c < agent->tree.classes; c++) {
        rlvc_stream_float(s, &values->value[c]);
        rlvc_stream_u8(s, &values->policy[c]);
        rlvc_stream_u8(s, &values->trial[c]);
        rlvc_stream_u16(s, &agent->pending[c]);
        for (uint32_t a = 0; a < values->actions; a++) {
            size_t pair = rlvc_values_pair(values, c, a);
            rlvc_stream_float(s, &values->q[pair]);
            rlvc_stream_float(s, &values->pair.reward[pair]);
            rlvc_stream_u32(s, &values->tried[pair]);
        }
    }
}

static void pass_explorer(rlvc_stream *s, rlvc_agent *agent) {
    rlvc_explorer *explorer = &agent->explorer;
    rlvc_stream_u8(s, &explorer->min_tried);
    rlvc_stream_u8(s, &explorer->last);
    rlvc_stream_bytes(s, explorer->to_novel, agent->tree.classes);
    rlvc_stream_bytes(s, explorer->count, agent->tree.classes * agent->config.actions);
}

/* Between two steps a learner has nothing to tell: zeros. */
static void pass_learner(rlvc_stream *s, rlvc_learner *learner, rlvc_cursor_mark *mark) {
    uint8_t phase = learner->phase;
    uint8_t flags = phase ? (uint8_t)(learner->searching + 2u * learner->failed) : 0;
    uint32_t *field[] = {&learner->end,    &learner->at,     &learner->walk.node, &learner->classes,
                         &learner->rounds, &learner->splits, &learner->made};
    rlvc_stream_u8(s, &phase);
    rlvc_stream_u8(s, &flags);
    for (uint32_t i = 0; i < sizeof field / sizeof field[0]; i++) {
        uint32_t number = phase ? *field[i] : 0;
        rlvc_stream_u32(s, &number);
        if (s->mode == RLVC_STREAM_LOAD)
            *field[i] = number;
    }
    for (uint32_t i = 0; i < RLVC_CURSOR_MARK_WORDS; i++)
        rlvc_stream_u32(s, &mark->word[i]);
    if (s->mode == RLVC_STREAM_LOAD) {
        learner->phase = phase;
        learner->searching = flags & (uint8_t)~2u;
        learner->failed = flags >> 1 & 1u;
    }
}

/* All that comes after the identity. */
static int pass_state(rlvc_stream *s, rlvc_agent *agent, rlvc_cursor_mark *mark) {
    pass_counters(s, agent);
    if (!pass_replay(s, agent) || !pass_tree(s, agent))
        return 0;
    pass_values(s, agent);
    pass_explorer(s, agent);
    pass_learner(s, &agent->learner, mark);
    return 1;
}

static void pass_agent(rlvc_stream *s, rlvc_agent *agent) {
    rlvc_cursor_mark mark;
    rlvc_cursor_marks_take(agent, &mark);
    (void)pass_identity(s, &agent->domain.percept_bytes, &agent->domain.feature_bytes,
                        &agent->config);
    (void)pass_state(s, agent, &mark);
}

/* ------------------------------------------------------------------ sizes */

/* The most that a snapshot can take. 64 bits hold it for every config. */
static uint64_t largest(const rlvc_config *config, const rlvc_domain *domain) {
    uint64_t classes = config->classes, unit = RLVC_STORE_UNIT;
    uint64_t size = RLVC_SNAPSHOT_FIXED_BYTES;
    size += ((uint64_t)config->capacity + 1u) * (domain->percept_bytes + 8u);
    size += (classes - 1u) * (domain->feature_bytes + 28u);
    size += classes * 9u + classes * config->actions * 13u;
    return (size + unit - 1u) / unit * unit;
}

rlvc_status rlvc_classes_snapshot_size(const rlvc_config *config, const rlvc_domain *domain,
                                       uint32_t *bytes) {
    if (!bytes)
        return RLVC_E_NULL;
    *bytes = 0;
    rlvc_status status = rlvc_config_status(config, domain);
    if (status != RLVC_OK)
        return status;
    uint64_t size = largest(config, domain);
    if (size > RLVC_SLOT_BYTES_MAX)
        return RLVC_E_MEMORY;
    *bytes = (uint32_t)size;
    return RLVC_OK;
}

/* ------------------------------------------------------------------ saving */

static rlvc_status save(rlvc_agent *agent, const rlvc_store *store) {
    rlvc_two_slot slot;
    rlvc_status status = rlvc_two_slot_next(store, &slot);
    if (status != RLVC_OK)
        return status;
    rlvc_stream stream;
    rlvc_stream_count(&stream);
    pass_agent(&stream, agent);
    slot.version = RLVC_SNAPSHOT_VERSION;
    slot.bytes = (uint32_t)rlvc_stream_size(&stream);
    rlvc_stream_save(&stream, store, &slot);
    pass_agent(&stream, agent);
    return rlvc_stream_end(&stream);
}

rlvc_status rlvc_classes_save(rlvc_agent *agent, const rlvc_store *store) {
    if (!agent)
        return RLVC_E_NULL;
    if (agent->busy)
        return RLVC_E_REENTERED;
    rlvc_status status = rlvc_two_slot_check(store, largest(&agent->config, &agent->domain));
    if (status != RLVC_OK)
        return status;
    agent->busy = 1;
    status = save(agent, store);
    agent->busy = 0;
    return status;
}

/* ------------------------------------------------------------------ loading */

/* Opens a snapshot. Its config takes the place of info's. */
static rlvc_status open_slot(const rlvc_store *store, const rlvc_two_slot *slot,
                             rlvc_stream *stream, rlvc_snapshot_info *info) {
    if (slot->version != RLVC_SNAPSHOT_VERSION)
        return RLVC_E_VERSION;
    rlvc_stream_load(stream, store, slot);
    /* What is read is passed by value first. */
    info->percept_bytes = info->feature_bytes = 0;
    int known = pass_identity(stream, &info->percept_bytes, &info->feature_bytes, &info->config);
    if (stream->status != RLVC_OK)
        return stream->status;
    return known ? RLVC_OK : RLVC_E_MISMATCH;
}

/* Is every slot one that rlvc_replay_append makes? */
static int flags_are_sound(const rlvc_replay *replay) {
    for (uint32_t position = 0; position < replay->count; position++) {
        uint8_t flags = replay->flags[rlvc_replay_slot(replay, position)];
        if (flags > (RLVC_SLOT_STORED | RLVC_SLOT_EXPLOITED | RLVC_SLOT_TERMINATED) ||
            (flags != 0 && !(flags & RLVC_SLOT_STORED)))
            return 0;
    }
    return 1;
}

static int within(float x, float most) {
    return x >= -most && x <= most;
}

/* Are the values within what learning can make of rewards, so that it overflows no sum? Without an
 * incremental solver the pairs hold mean rewards, or what is nearer to 0. */
static int values_are_sound(const rlvc_agent *agent) {
    const rlvc_values *values = &agent->values;
    const uint32_t pairs = agent->tree.classes * agent->config.actions;
    const float most =
        rlvc_is_incremental(&agent->config) ? RLVC_VALUE_MAX : 2.0f * RLVC_REWARD_MAX;
    for (uint32_t c = 0; c < agent->tree.classes; c++) {
        if (!within(values->value[c], RLVC_VALUE_MAX))
            return 0;
    }
    for (uint32_t pair = 0; pair < pairs; pair++) {
        if (!within(values->q[pair], RLVC_VALUE_MAX) || !within(values->pair.reward[pair], most))
            return 0;
    }
    return 1;
}

static int counters_are_sound(const rlvc_agent *agent) {
    return agent->run <= agent->step && agent->last_split <= agent->step &&
           agent->sweeps <= agent->config.max_sweeps && is_number(agent->residual) &&
           agent->interactions >= agent->replay.stored;
}

/* Does everything that was loaded hold together? */
static int is_sound(rlvc_agent *agent) {
    return flags_are_sound(&agent->replay) && values_are_sound(agent) &&
           counters_are_sound(agent) && rlvc_classes_check(agent) == RLVC_OK &&
           rlvc_cursor_marks_check(agent);
}

/* Fills a new agent. */
static rlvc_status load(rlvc_stream *stream, rlvc_agent *agent) {
    rlvc_cursor_mark mark = {{0}}; /* what is read is passed by value first */
    int fits = pass_state(stream, agent, &mark);
    if (stream->status != RLVC_OK)
        return stream->status;
    if (!fits)
        return RLVC_E_DAMAGED;
    rlvc_status status = rlvc_stream_end(stream);
    if (status != RLVC_OK)
        return status;
    if (!is_sound(agent))
        return RLVC_E_DAMAGED;
    agent->busy = 1;
    status = rlvc_cursor_marks_resume(agent, &mark);
    agent->busy = 0;
    /* A callback that goes on failing must not cost the agent its life. */
    return status == RLVC_E_CALLBACK ? rlvc_learn_abandon(agent) : status;
}

rlvc_status rlvc_classes_load(const rlvc_config *config, const rlvc_domain *domain, void *memory,
                              size_t bytes, const rlvc_store *store, rlvc_agent **agent) {
    if (!agent)
        return RLVC_E_NULL;
    *agent = NULL;
    uint32_t min_bytes = 0;
    rlvc_status status = rlvc_classes_snapshot_size(config, domain, &min_bytes);
    if (status == RLVC_OK)
        status = memory ? rlvc_two_slot_check(store, min_bytes) : RLVC_E_NULL;
    rlvc_stream stream;
    rlvc_two_slot slot;
    rlvc_snapshot_info info;
    if (status == RLVC_OK)
        status = rlvc_two_slot_newest(store, &slot);
    if (status != RLVC_OK)
        return status;
    info.config = *config;
    status = open_slot(store, &slot, &stream, &info);
    if (status != RLVC_OK)
        return status;
    if (info.percept_bytes != domain->percept_bytes ||
        info.feature_bytes != domain->feature_bytes ||
        memcmp(&info.config, config, RLVC_CONFIG_BYTES) != 0)
        return RLVC_E_MISMATCH;
    rlvc_agent *made;
    status = rlvc_classes_init(config, domain, memory, bytes, &made);
    if (status != RLVC_OK)
        return status;
    status = load(&stream, made);
    if (status == RLVC_OK)
        *agent = made;
    return status;
}

rlvc_status rlvc_snapshot_peek(const rlvc_store *store, rlvc_snapshot_info *info) {
    if (!info)
        return RLVC_E_NULL;
    rlvc_status status = rlvc_two_slot_check(store, RLVC_STORE_UNIT);
    rlvc_stream stream;
    rlvc_two_slot slot;
    if (status == RLVC_OK)
        status = rlvc_two_slot_newest(store, &slot);
    if (status != RLVC_OK)
        return status;
    info->version = slot.version;
    info->sequence = slot.sequence;
    info->slot = slot.index;
    info->bytes = slot.bytes;
    memset(&info->config, 0, sizeof info->config);
    if (RLVC_HAS_PLANNER && rlvc_planner_snapshot_known(slot.version))
        return rlvc_planner_open_slot(store, &slot, &stream, info);
    return open_slot(store, &slot, &stream, info);
}
