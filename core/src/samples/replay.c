/* SPDX-License-Identifier: MIT */
/* The ring of interactions: see replay.h for its invariants. */
#include "rlvc/float_rules.h"

#include "replay.h"

#include "../base/assert.h"
#include <string.h>

void rlvc_replay_carve(rlvc_replay *replay, rlvc_arena *arena, const rlvc_config *config,
                       uint32_t percept_bytes) {
    uint32_t slots = config->capacity + 1u;
    replay->percept = rlvc_arena_carve(arena, slots, percept_bytes);
    replay->reward = rlvc_arena_carve(arena, slots, sizeof *replay->reward);
    replay->label = rlvc_arena_carve(arena, slots, sizeof *replay->label);
    replay->action = rlvc_arena_carve(arena, slots, sizeof *replay->action);
    replay->flags = rlvc_arena_carve(arena, slots, sizeof *replay->flags);
    replay->slots = slots;
    replay->percept_bytes = percept_bytes;
    replay->head = 0;
    replay->count = 0;
    replay->stored = 0;
    replay->frozen = 0;
    replay->open = 0;
}

static int has_interaction(const rlvc_replay *replay, uint32_t position) {
    return replay->flags[rlvc_replay_slot(replay, position)] & RLVC_SLOT_STORED;
}

int rlvc_replay_has_room(const rlvc_replay *replay) {
    return replay->count < replay->slots || replay->frozen == 0;
}

static void drop_oldest(rlvc_replay *replay) {
    replay->stored -= replay->flags[replay->head] & RLVC_SLOT_STORED;
    replay->head = rlvc_replay_next(replay, replay->head);
    replay->count--;
}

/* Lets the oldest interaction leave if the ring is full, and with it the last s' of its episode if
 * that would be left alone. */
static void make_room(rlvc_replay *replay) {
    if (replay->count < replay->slots)
        return;
    drop_oldest(replay);
    if (replay->count > (uint32_t)replay->open && !has_interaction(replay, 0))
        drop_oldest(replay);
}

/* Puts a percept at the end of a ring that has room. */
static void push(rlvc_replay *replay, const void *percept) {
    make_room(replay);
    uint32_t slot = rlvc_replay_slot(replay, replay->count++);
    memcpy(replay->percept + (size_t)slot * replay->percept_bytes, percept, replay->percept_bytes);
    replay->flags[slot] = 0;
    replay->label[slot] = RLVC_NO_CLASS;
}

rlvc_status rlvc_replay_begin(rlvc_replay *replay, const void *percept) {
    /* An open percept that is no interaction's s' is not needed: the new one takes its place. */
    if (replay->open &&
        (replay->count == 1 ||
         !rlvc_replay_linked(replay, rlvc_replay_slot(replay, replay->count - 2)))) {
        RLVC_ASSERT(replay->count > replay->frozen);
        replay->count--;
        replay->open = 0;
    }
    if (!rlvc_replay_has_room(replay))
        return RLVC_E_BUSY;
    replay->open = 0;
    push(replay, percept);
    replay->open = 1;
    return RLVC_OK;
}

void rlvc_replay_append(rlvc_replay *replay, rlvc_choice choice, float reward, const void *next,
                        uint8_t end) {
    RLVC_ASSERT(replay->open && (end == RLVC_TERMINATED || rlvc_replay_has_room(replay)));
    if (end != RLVC_TERMINATED)
        make_room(replay);
    uint32_t slot = rlvc_replay_slot(replay, replay->count - 1);
    replay->action[slot] = choice.action;
    replay->reward[slot] = reward;
    replay->flags[slot] =
        (uint8_t)(RLVC_SLOT_STORED | (choice.exploited ? RLVC_SLOT_EXPLOITED : 0u) |
                  (end == RLVC_TERMINATED ? RLVC_SLOT_TERMINATED : 0u));
    replay->stored++;
    if (end != RLVC_TERMINATED)
        push(replay, next);
    replay->open = end == RLVC_GOES_ON;
}

uint32_t rlvc_replay_freeze(rlvc_replay *replay) {
    uint32_t end = replay->count - replay->open;
    int awaited = end > 0 && rlvc_replay_linked(replay, rlvc_replay_slot(replay, end - 1));
    replay->frozen = end + ((replay->open && awaited) ? 1u : 0u);
    return end;
}

void rlvc_replay_clear(rlvc_replay *replay) {
    if (replay->open)
        replay->head = rlvc_replay_slot(replay, replay->count - 1);
    replay->count = replay->open;
    replay->stored = 0;
    replay->frozen = 0;
}

static int reward_is_sound(float reward) {
    return reward >= -RLVC_REWARD_MAX && reward <= RLVC_REWARD_MAX;
}

static int slot_is_sound(const rlvc_replay *replay, uint32_t position, uint32_t actions,
                         uint32_t classes) {
    uint32_t slot = rlvc_replay_slot(replay, position);
    int last = position + 1 == replay->count;
    int current = last && replay->open;
    if (replay->label[slot] != RLVC_NO_CLASS && replay->label[slot] >= classes)
        return 0;
    if (!(replay->flags[slot] & RLVC_SLOT_STORED))
        return current ||
               (position > 0 && rlvc_replay_linked(replay, rlvc_replay_slot(replay, position - 1)));
    if (current || replay->action[slot] >= actions || !reward_is_sound(replay->reward[slot]))
        return 0;
    return !last || !rlvc_replay_linked(replay, slot);
}

int rlvc_replay_check(const rlvc_replay *replay, uint32_t actions, uint32_t classes) {
    if (replay->head >= replay->slots || replay->count > replay->slots || replay->open > 1 ||
        replay->open > replay->count || replay->frozen > replay->count)
        return 0;
    uint32_t stored = 0;
    for (uint32_t position = 0; position < replay->count; position++) {
        if (!slot_is_sound(replay, position, actions, classes))
            return 0;
        stored += has_interaction(replay, position) ? 1u : 0u;
    }
    return stored == replay->stored;
}
