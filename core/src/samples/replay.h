/* SPDX-License-Identifier: MIT */
/* The database of interactions <s_t, a_t, r_{t+1}, s_{t+1}, e_t> (section 4.2.1): a ring of slots.
 *
 * A slot holds a percept s_t and, after the action, the rest of the interaction. Slots are in order
 * of time; position 0 is the oldest. The percept of position p + 1 is s' of the interaction at p,
 * so that two successive interactions share it, except where the interaction at p was terminated:
 * then there is no s', and p + 1 begins another episode. A truncated or interrupted episode ends
 * with a slot that holds its last s' and no interaction.
 *
 * Invariants: every slot with an interaction that was not terminated has a successor; a slot
 * without one is the s' of the slot before it, or the current percept; position 0 holds an
 * interaction or is the only slot; the current percept, if there is one (open), is at the last
 * position. */
#ifndef RLVC_SRC_REPLAY_H
#define RLVC_SRC_REPLAY_H

#include "../base/arena.h"

#define RLVC_NO_CLASS UINT16_MAX

/* flags of a slot */
#define RLVC_SLOT_STORED 1u     /* holds an interaction */
#define RLVC_SLOT_EXPLOITED 2u  /* e_t: its action was exploitation */
#define RLVC_SLOT_TERMINATED 4u /* it has no s' */

typedef struct rlvc_replay {
    unsigned char *percept; /* [slots][percept_bytes] */
    float *reward;          /* [slots] */
    uint16_t *label;        /* [slots] class of the percept, or RLVC_NO_CLASS; kept by learning */
    uint8_t *action;        /* [slots] */
    uint8_t *flags;         /* [slots] */
    uint32_t slots;         /* config.capacity + 1 */
    uint32_t percept_bytes;
    uint32_t head;   /* the slot at position 0 */
    uint32_t count;  /* slots in use */
    uint32_t stored; /* of these, with an interaction */
    uint32_t frozen; /* positions [0, frozen) are being learnt from and stay */
    uint8_t open;    /* the last position is the current percept */
} rlvc_replay;

/* Carves the arrays and makes the ring empty. O(1). */
void rlvc_replay_carve(rlvc_replay *replay, rlvc_arena *arena, const rlvc_config *config,
                       uint32_t percept_bytes);

/* The slot at a position in [0, count). O(1). */
static inline uint32_t rlvc_replay_slot(const rlvc_replay *replay, uint32_t position) {
    uint32_t to_end = replay->slots - replay->head;
    //@ split to_end;
    return position < to_end ? replay->head + position : position - to_end;
}

static inline const unsigned char *rlvc_replay_percept(const rlvc_replay *replay, uint32_t slot) {
    return replay->percept + (size_t)slot * replay->percept_bytes;
}

/* Does the slot hold an interaction whose s' is the percept of the next slot? O(1). */
static inline int rlvc_replay_linked(const rlvc_replay *replay, uint32_t slot) {
    return (replay->flags[slot] & (RLVC_SLOT_STORED | RLVC_SLOT_TERMINATED)) == RLVC_SLOT_STORED;
}

/* The slot after one that is linked. O(1). */
static inline uint32_t rlvc_replay_next(const rlvc_replay *replay, uint32_t slot) {
    return slot + 1u == replay->slots ? 0 : slot + 1u;
}

/* Starts an episode: the percept becomes the current one; an open episode is interrupted.
 * @return RLVC_OK; RLVC_E_BUSY: there is no room but frozen room. O(percept_bytes). */
rlvc_status rlvc_replay_begin(rlvc_replay *replay, const void *percept);

/* Whether rlvc_replay_append has room for the next percept. O(1). */
int rlvc_replay_has_room(const rlvc_replay *replay);

/* Stores what came of the current percept; needs an open ring, and room unless terminated.
 * O(percept_bytes). */
void rlvc_replay_append(rlvc_replay *replay, rlvc_choice choice, float reward, const void *next,
                        uint8_t end);

/* Freezes what is stored now: it will not leave until `frozen` is 0 again. An interaction observed
 * later is not part of it, though its percept may be, as the s' of the last one that is.
 * @return the end: interactions at positions [0, end) are the frozen ones. O(1). */
uint32_t rlvc_replay_freeze(rlvc_replay *replay);

/* Forgets everything but the current percept, and thaws. O(1). */
void rlvc_replay_clear(rlvc_replay *replay);

/* @return 1 if every invariant holds. O(slots). */
int rlvc_replay_check(const rlvc_replay *replay, uint32_t actions, uint32_t classes);

#endif
