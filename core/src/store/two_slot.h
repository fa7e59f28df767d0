/* SPDX-License-Identifier: MIT */
/* The two slots of a store, and the bytes of one snapshot as a stream.
 *
 * A snapshot is a head of 16 bytes (the letters RLVS, version, sequence number, bytes in all), its
 * content, zeros, and in its last four bytes the CRC of all before them. It is whole if the CRC is
 * right. Of two whole snapshots the one with the higher sequence number is the newer. Writing uses
 * the slot that does not hold the newest whole one. So a write never touches the snapshot to fall
 * back on, and the order of writes within a slot does not matter. */
#ifndef RLVC_SRC_TWO_SLOT_H
#define RLVC_SRC_TWO_SLOT_H

#include "rlvc/snapshot.h"

typedef struct rlvc_two_slot {
    uint32_t index;
    uint32_t version;
    uint32_t sequence;
    uint32_t bytes;
} rlvc_two_slot;

/* Is this a store whose slots hold `min_bytes`? O(1).
 * @return RLVC_OK; RLVC_E_NULL: no store, or a callback is missing; RLVC_E_RANGE: slot_bytes. */
rlvc_status rlvc_two_slot_check(const rlvc_store *store, uint64_t min_bytes);

/* Finds the newest whole snapshot; reads it from end to end.
 * @return RLVC_OK; RLVC_E_STORE; RLVC_E_EMPTY: neither slot begins as one; RLVC_E_DAMAGED. */
rlvc_status rlvc_two_slot_newest(const rlvc_store *store, rlvc_two_slot *slot);

/* Where the next snapshot goes: not over the newest whole one. Its version and bytes are the
 * caller's to set.
 * @return RLVC_OK; RLVC_E_STORE. */
rlvc_status rlvc_two_slot_next(const rlvc_store *store, rlvc_two_slot *slot);

enum { RLVC_STREAM_COUNT, RLVC_STREAM_SAVE, RLVC_STREAM_LOAD };

/* The content of a snapshot on its way: the same calls, in the same order, count it, save it and
 * load it, so that the three cannot differ. The first failure sticks. */
typedef struct rlvc_stream {
    const rlvc_store *store;
    uint32_t base; /* offset of the slot */
    uint32_t size; /* of the snapshot, in bytes */
    uint64_t at;   /* bytes passed so far */
    uint32_t crc;
    rlvc_status status;
    uint8_t mode;
    unsigned char unit[RLVC_STORE_UNIT]; /* the bytes about `at`, from a multiple of it on */
} rlvc_stream;

/* Begins to count. */
void rlvc_stream_count(rlvc_stream *stream);

/* Bytes that a snapshot takes whose content was counted. */
uint64_t rlvc_stream_size(const rlvc_stream *stream);

/* Begins to save into a slot: erases it and passes the head. */
void rlvc_stream_save(rlvc_stream *stream, const rlvc_store *store, const rlvc_two_slot *slot);

/* Begins to load from a slot: passes the head, which is looked at no more. */
void rlvc_stream_load(rlvc_stream *stream, const rlvc_store *store, const rlvc_two_slot *slot);

/* Passes `bytes` bytes. What is loaded after a failure are zeros. */
void rlvc_stream_bytes(rlvc_stream *stream, void *data, uint32_t bytes);

/* Passes a record that begins with `words` numbers of 4 bytes, as this target keeps them, and
 * `halves` of 2 bytes, as far as they are within it. */
void rlvc_stream_record(rlvc_stream *stream, void *record, uint32_t bytes, uint32_t words,
                        uint32_t halves);

/* Pass a number, by its type. */
void rlvc_stream_u8(rlvc_stream *stream, uint8_t *number);
void rlvc_stream_u16(rlvc_stream *stream, uint16_t *number);
void rlvc_stream_u32(rlvc_stream *stream, uint32_t *number);
void rlvc_stream_u64(rlvc_stream *stream, uint64_t *number);
void rlvc_stream_float(rlvc_stream *stream, float *number);

/* Passes the zeros and the CRC; saving ends with sync().
 * @return RLVC_OK; RLVC_E_STORE; RLVC_E_DAMAGED: what was loaded is not a whole snapshot of this
 * content. */
rlvc_status rlvc_stream_end(rlvc_stream *stream);

#endif
