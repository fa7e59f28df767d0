/* SPDX-License-Identifier: MIT */
/* What the ring of interactions should hold, as a plain list. Include after cmocka.h.
 *
 * The ring keeps the newest interactions that fit. Each takes the room of a percept, one whose
 * episode was truncated or torn after it takes the room of its s' too, and so does the current
 * percept. Percepts are numbers here, each new one the next. */
#ifndef RLVC_TESTS_HISTORY_H
#define RLVC_TESTS_HISTORY_H

#include "block.h"
#include "samples/replay.h"
#include "base/rng.h"

#include <string.h>

#define HISTORY_MAX 1024u
#define HISTORY_ACTIONS 3u

typedef struct history_item {
    uint32_t percept;
    uint32_t next; /* s'; 0 after a terminated one */
    float reward;
    rlvc_choice choice;
    uint8_t end;
    uint8_t torn;
} history_item;

typedef struct history {
    history_item item[HISTORY_MAX];
    uint32_t count;
    uint32_t current; /* percept, or 0 */
    uint32_t percepts;
    uint32_t slots;
    uint8_t frozen; /* nothing may leave */
} history;

static inline void history_clear(history *list) {
    list->count = 0;
    list->frozen = 0;
}

static inline uint32_t history_room(const history_item *item) {
    return item->torn || item->end == RLVC_TRUNCATED ? 2u : 1u;
}

/* Lets the oldest leave until the rest fits; 0 if that would be one that is frozen. */
static inline int history_fit(history *list) {
    uint32_t leave = 0, room = list->current != 0;
    for (uint32_t i = 0; i < list->count; i++)
        room += history_room(&list->item[i]);
    for (; room > list->slots; leave++)
        room -= history_room(&list->item[leave]);
    if (leave > 0 && list->frozen)
        return 0;
    list->count -= leave;
    memmove(list->item, list->item + leave, list->count * sizeof *list->item);
    return 1;
}

/* Both return 0, and nothing has happened, if there is no room. */
static inline int history_begin(history *list) {
    static history before;
    before = *list;
    history_item *last = list->count > 0 ? &list->item[list->count - 1u] : NULL;
    if (list->current != 0 && last && last->end == RLVC_GOES_ON)
        last->torn = 1;
    list->current = ++list->percepts;
    if (history_fit(list))
        return 1;
    *list = before;
    return 0;
}

static inline int history_append(history *list, rlvc_choice choice, float reward, uint8_t end) {
    static history before;
    before = *list;
    history_item made = {list->current, 0, reward, choice, end, 0};
    if (end != RLVC_TERMINATED)
        made.next = ++list->percepts;
    list->current = end == RLVC_GOES_ON ? made.next : 0;
    list->item[list->count++] = made;
    if (history_fit(list))
        return 1;
    *list = before;
    return 0;
}

/* Whether the window may go on from an item to the next. */
static inline int history_links(const history_item *item, int continuing) {
    return (item->end == RLVC_GOES_ON && !item->torn) ||
           (item->end == RLVC_TERMINATED && continuing);
}

static inline uint32_t history_percept_at(const rlvc_replay *replay, uint32_t position) {
    uint32_t percept;
    memcpy(&percept, rlvc_replay_percept(replay, rlvc_replay_slot(replay, position)),
           sizeof percept);
    return percept;
}

/* Fails unless the ring holds the list, in this order and nothing else. */
static inline void history_compare(const history *list, const rlvc_replay *replay) {
    uint32_t position = 0;
    assert_true(rlvc_replay_check(replay, HISTORY_ACTIONS, 1));
    assert_int_equal(replay->stored, list->count);
    for (uint32_t i = 0; i < list->count; i++) {
        const history_item *item = &list->item[i];
        uint32_t slot = rlvc_replay_slot(replay, position);
        uint8_t flags =
            (uint8_t)(RLVC_SLOT_STORED | (item->choice.exploited ? RLVC_SLOT_EXPLOITED : 0u) |
                      (item->end == RLVC_TERMINATED ? RLVC_SLOT_TERMINATED : 0u));
        assert_int_equal(history_percept_at(replay, position), item->percept);
        assert_int_equal(replay->flags[slot], flags);
        assert_int_equal(replay->action[slot], item->choice.action);
        assert_memory_equal(&replay->reward[slot], &item->reward, sizeof item->reward);
        assert_int_equal(rlvc_replay_linked(replay, slot), item->end != RLVC_TERMINATED);
        if (item->next != 0)
            assert_int_equal(history_percept_at(replay, position + 1u), item->next);
        position += history_room(item);
    }
    assert_int_equal(replay->open, list->current != 0);
    if (list->current != 0)
        assert_int_equal(history_percept_at(replay, position), list->current);
    assert_int_equal(replay->count, position + replay->open);
}

/* A ring with room for `capacity` interactions, in memory that lasts until the next is made. */
static inline void history_init(history *list, rlvc_replay *replay, uint32_t capacity) {
    static uint64_t block[HISTORY_MAX * 2u + 64u];
    static const history empty;
    rlvc_arena arena = {(unsigned char *)block, 0};
    rlvc_config config;
    memset(&config, 0, sizeof config);
    config.capacity = capacity;
    block_fill(block, 0xa5, sizeof block);
    rlvc_replay_carve(replay, &arena, &config, sizeof(uint32_t));
    assert_true(arena.used <= sizeof block);
    *list = empty;
    list->slots = capacity + 1u;
}

/* Does the same to both: begins, or stores an interaction, which ends as `end` says. */
static inline void history_do_begin(history *list, rlvc_replay *replay) {
    uint32_t percept = list->percepts + 1u;
    int room = history_begin(list);
    assert_int_equal(rlvc_replay_begin(replay, &percept), room ? RLVC_OK : RLVC_E_BUSY);
}

static inline void history_do_append(history *list, rlvc_replay *replay, rlvc_choice choice,
                                     float reward, uint8_t end) {
    uint32_t next = list->percepts + 1u;
    int room = history_append(list, choice, reward, end);
    assert_int_equal(end == RLVC_TERMINATED || rlvc_replay_has_room(replay), room);
    if (room)
        rlvc_replay_append(replay, choice, reward, end == RLVC_TERMINATED ? NULL : &next, end);
}

/* A random interaction after a random beginning where one is needed. */
static inline void history_do_random(history *list, rlvc_replay *replay, rlvc_rng *rng,
                                     uint32_t exploited_of_8) {
    static const uint8_t ends[8] = {RLVC_GOES_ON, RLVC_GOES_ON,    RLVC_GOES_ON,    RLVC_GOES_ON,
                                    RLVC_GOES_ON, RLVC_TERMINATED, RLVC_TERMINATED, RLVC_TRUNCATED};
    rlvc_choice choice;
    if (list->current == 0 || rlvc_rng_below(rng, 16u) == 0)
        history_do_begin(list, replay);
    if (list->current == 0)
        return;
    choice.action = (uint8_t)rlvc_rng_below(rng, HISTORY_ACTIONS);
    choice.exploited = rlvc_rng_below(rng, 8u) < exploited_of_8;
    float reward = rlvc_rng_uniform(rng) * 20.0f - 10.0f;
    history_do_append(list, replay, choice, reward, ends[rlvc_rng_below(rng, 8u)]);
}

#endif
