/* SPDX-License-Identifier: MIT */
/* The log of interactions.
 *
 * A record is a mark, a byte of kind and flags, a sequence number, a content whose length follows
 * from these, and the CRC of all before it (SPEC.md). The reader takes what begins with the mark
 * for a record until that proves wrong; then it goes on looking one byte later, in what it has
 * already read, so that no whole record is ever lost to a false beginning. */
#include "rlvc/log.h"

#include "../base/bytes.h"
#include "../base/crc.h"
#include <string.h>

#define MARK 0xa5u
#define HEAD_BYTES 4u /* mark, kind, sequence */
#define CRC_BYTES 4u
#define HEADER_BYTES 8u      /* version, actions, percept_bytes */
#define INTERACTION_BYTES 5u /* action, reward */
#define PERCEPT_BYTES_MAX (1u << 20)

/* The byte of kind: RLVC_LOG_*, and of an interaction also */
#define KIND_MASK 3u
#define EXPLOITED 4u
#define END_SHIFT 3u /* RLVC_GOES_ON and so on */

static int sizes_are_sound(uint32_t percept_bytes, uint32_t actions) {
    return percept_bytes >= 1u && percept_bytes <= PERCEPT_BYTES_MAX && actions >= 1u &&
           actions <= 255u;
}

static int reward_is_sound(float reward) {
    return reward >= -RLVC_REWARD_MAX && reward <= RLVC_REWARD_MAX;
}

/* ------------------------------------------------------------------ writing */

/* Writes a record: its head and `count` bytes of content at `bytes` (with HEAD_BYTES free before
 * them), then a percept, if any. The sequence number goes on also if that fails, for a reader to
 * see it. */
static rlvc_status put(rlvc_log_writer *writer, uint32_t kind, unsigned char *record,
                       uint32_t count, const void *percept) {
    unsigned char end[CRC_BYTES];
    uint32_t head = HEAD_BYTES + count;
    record[0] = MARK;
    record[1] = (unsigned char)kind;
    rlvc_put(record + 2, writer->sequence, 2);
    writer->sequence = (uint16_t)(writer->sequence + 1u);
    uint32_t crc = rlvc_crc(0, record, head);
    if (percept)
        crc = rlvc_crc(crc, percept, writer->percept_bytes);
    rlvc_put(end, crc, CRC_BYTES);
    if (writer->write(writer->ctx, record, head) != 0)
        return RLVC_E_CALLBACK;
    if (percept && writer->write(writer->ctx, percept, writer->percept_bytes) != 0)
        return RLVC_E_CALLBACK;
    return writer->write(writer->ctx, end, CRC_BYTES) == 0 ? RLVC_OK : RLVC_E_CALLBACK;
}

rlvc_status rlvc_log_open(rlvc_log_writer *writer, uint32_t percept_bytes, uint32_t actions,
                          int (*write)(void *ctx, const void *bytes, uint32_t count), void *ctx) {
    unsigned char record[HEAD_BYTES + HEADER_BYTES];
    if (!writer || !write)
        return RLVC_E_NULL;
    if (!sizes_are_sound(percept_bytes, actions))
        return RLVC_E_RANGE;
    writer->write = write;
    writer->ctx = ctx;
    writer->percept_bytes = percept_bytes;
    writer->sequence = 0;
    writer->actions = (uint8_t)actions;
    rlvc_put(record + HEAD_BYTES, RLVC_LOG_VERSION, 2);
    rlvc_put(record + HEAD_BYTES + 2, actions, 2);
    rlvc_put(record + HEAD_BYTES + 4, percept_bytes, 4);
    return put(writer, RLVC_LOG_HEADER, record, HEADER_BYTES, NULL);
}

rlvc_status rlvc_log_begin(rlvc_log_writer *writer, const void *percept) {
    unsigned char record[HEAD_BYTES];
    if (!writer || !percept)
        return RLVC_E_NULL;
    return put(writer, RLVC_LOG_BEGIN, record, 0, percept);
}

rlvc_status rlvc_log_observe(rlvc_log_writer *writer, rlvc_choice choice, float reward,
                             const void *next, uint8_t end) {
    unsigned char record[HEAD_BYTES + INTERACTION_BYTES];
    uint32_t bits;
    if (!writer || (!next && end != RLVC_TERMINATED))
        return RLVC_E_NULL;
    if (end > RLVC_TRUNCATED || choice.action >= writer->actions || choice.exploited > 1)
        return RLVC_E_RANGE;
    if (!reward_is_sound(reward))
        return RLVC_E_REWARD;
    memcpy(&bits, &reward, sizeof bits);
    record[HEAD_BYTES] = choice.action;
    rlvc_put(record + HEAD_BYTES + 1, bits, 4);
    uint32_t kind =
        RLVC_LOG_OBSERVE | (choice.exploited ? EXPLOITED : 0u) | (uint32_t)end << END_SHIFT;
    return put(writer, kind, record, INTERACTION_BYTES, end == RLVC_TERMINATED ? NULL : next);
}

/* ------------------------------------------------------------------ reading */

rlvc_status rlvc_log_read(rlvc_log_reader *reader, uint32_t percept_bytes, uint32_t actions,
                          void *buffer, uint32_t room,
                          int (*read)(void *ctx, void *bytes, uint32_t room, uint32_t *got),
                          void *ctx) {
    if (!reader || !buffer || !read)
        return RLVC_E_NULL;
    int unknown = percept_bytes == 0 && actions == 0;
    if (!unknown && !sizes_are_sound(percept_bytes, actions))
        return RLVC_E_RANGE;
    if (room < HEAD_BYTES + HEADER_BYTES + CRC_BYTES || room < RLVC_LOG_RECORD_BYTES(percept_bytes))
        return RLVC_E_MEMORY;
    memset(reader, 0, sizeof *reader);
    reader->read = read;
    reader->ctx = ctx;
    reader->buffer = (unsigned char *)buffer;
    reader->room = room;
    reader->percept_bytes = percept_bytes;
    reader->actions = actions;
    return RLVC_OK;
}

/* Gives up the first byte that is not used yet. */
static void skip(rlvc_log_reader *reader) {
    reader->from++;
    reader->skipped++;
    reader->damaged += !reader->skipping;
    reader->skipping = 1;
}

/* Bytes of the record that begins with this byte of kind; 0 if none does. */
static uint32_t length_of(const rlvc_log_reader *reader, uint8_t kind) {
    uint32_t end = (uint32_t)kind >> END_SHIFT;
    if (kind == RLVC_LOG_HEADER)
        return HEAD_BYTES + HEADER_BYTES + CRC_BYTES;
    if (reader->percept_bytes == 0)
        return 0;
    if (kind == RLVC_LOG_BEGIN)
        return HEAD_BYTES + reader->percept_bytes + CRC_BYTES;
    if ((kind & KIND_MASK) != RLVC_LOG_OBSERVE || end > RLVC_TRUNCATED)
        return 0;
    return HEAD_BYTES + INTERACTION_BYTES + (end == RLVC_TERMINATED ? 0 : reader->percept_bytes) +
           CRC_BYTES;
}

/* Reads until `need` bytes are there. *there becomes 0 if the log ends before. */
static rlvc_status fetch(rlvc_log_reader *reader, uint32_t need, int *there) {
    *there = 1;
    while (reader->fill - reader->from < need) {
        uint32_t got = 0;
        if (reader->from > 0) {
            reader->fill -= reader->from;
            memmove(reader->buffer, reader->buffer + reader->from, reader->fill);
            reader->from = 0;
        }
        uint32_t room = reader->room - reader->fill;
        if (reader->read(reader->ctx, reader->buffer + reader->fill, room, &got) != 0 || got > room)
            return RLVC_E_STORE;
        if (got == 0) {
            *there = 0;
            return RLVC_OK;
        }
        reader->fill += got;
    }
    return RLVC_OK;
}

/* Finds the next whole record, and leaves it at `from`. *length becomes 0 at the end of the log. */
static rlvc_status find(rlvc_log_reader *reader, uint32_t *length) {
    *length = 0;
    for (;;) {
        int there = 0;
        uint32_t need = 2;
        rlvc_status status = fetch(reader, need, &there);
        const unsigned char *at = reader->buffer + reader->from;
        if (status == RLVC_OK && there) {
            need = at[0] == MARK ? length_of(reader, at[1]) : 0;
            status = fetch(reader, need, &there);
            at = reader->buffer + reader->from;
        }
        if (status != RLVC_OK)
            return status;
        if (there && need > 0 &&
            rlvc_crc(0, at, need - CRC_BYTES) == rlvc_get(at + need - CRC_BYTES, CRC_BYTES)) {
            *length = need;
            return RLVC_OK;
        }
        if (reader->from == reader->fill)
            return RLVC_OK;
        skip(reader);
    }
}

/* Takes a header's word for what is to come, if it is what was expected. */
static rlvc_status take_header(rlvc_log_reader *reader, const unsigned char *content) {
    uint32_t actions = (uint32_t)rlvc_get(content + 2, 2);
    uint32_t percept_bytes = (uint32_t)rlvc_get(content + 4, 4);
    if (rlvc_get(content, 2) != RLVC_LOG_VERSION)
        return RLVC_E_VERSION;
    if (!sizes_are_sound(percept_bytes, actions))
        return RLVC_E_MISMATCH;
    if (reader->percept_bytes != 0)
        return percept_bytes == reader->percept_bytes && actions == reader->actions
                   ? RLVC_OK
                   : RLVC_E_MISMATCH;
    if (RLVC_LOG_RECORD_BYTES(percept_bytes) > reader->room)
        return RLVC_E_MEMORY;
    reader->percept_bytes = percept_bytes;
    reader->actions = actions;
    return RLVC_OK;
}

/* Takes an interaction apart.
 * @return 0 if no such interaction can be. */
static int take_interaction(const rlvc_log_reader *reader, const unsigned char *at,
                            rlvc_log_record *record) {
    uint32_t bits = (uint32_t)rlvc_get(at + HEAD_BYTES + 1, 4);
    record->choice.action = at[HEAD_BYTES];
    record->choice.exploited = (at[1] & EXPLOITED) != 0;
    record->end = (uint8_t)(at[1] >> END_SHIFT);
    record->percept = record->end == RLVC_TERMINATED ? NULL : at + HEAD_BYTES + INTERACTION_BYTES;
    memcpy(&record->reward, &bits, sizeof bits);
    return record->choice.action < reader->actions && reward_is_sound(record->reward);
}

/* Compares the sequence number with the one that is due. */
static void count_missing(rlvc_log_reader *reader, const unsigned char *at) {
    uint16_t sequence = (uint16_t)rlvc_get(at + 2, 2);
    uint16_t missing = (uint16_t)(sequence - reader->sequence);
    if (reader->counting && missing != 0) {
        reader->lost += missing;
        reader->linked = 0;
    }
    reader->counting = 1;
    reader->sequence = (uint16_t)(sequence + 1u);
}

/* Makes *record of the whole record at `from`. Its kind is RLVC_LOG_END if it is of no use. */
static rlvc_status take(rlvc_log_reader *reader, const unsigned char *at, rlvc_log_record *record) {
    uint8_t kind = at[1] & KIND_MASK;
    if (kind == RLVC_LOG_HEADER) {
        reader->counting = 0;
        reader->linked = 0;
        count_missing(reader, at);
        record->kind = RLVC_LOG_HEADER;
        return take_header(reader, at + HEAD_BYTES);
    }
    count_missing(reader, at);
    if (kind == RLVC_LOG_BEGIN) {
        record->percept = at + HEAD_BYTES;
        record->kind = RLVC_LOG_BEGIN;
        reader->linked = 1;
        return RLVC_OK;
    }
    int sound = take_interaction(reader, at, record);
    int linked = reader->linked && sound;
    reader->linked = sound && record->end == RLVC_GOES_ON;
    if (linked) {
        record->kind = RLVC_LOG_OBSERVE;
        return RLVC_OK;
    }
    reader->lost++;
    record->kind = reader->linked ? RLVC_LOG_BEGIN : RLVC_LOG_END;
    return RLVC_OK;
}

rlvc_status rlvc_log_next(rlvc_log_reader *reader, rlvc_log_record *record) {
    static const rlvc_log_record nothing = {NULL, 0.0f, {0, 0}, 0, RLVC_LOG_END};
    if (!reader || !record)
        return RLVC_E_NULL;
    for (;;) {
        uint32_t length = 0;
        *record = nothing;
        rlvc_status status = find(reader, &length);
        if (status != RLVC_OK)
            return status;
        reader->torn = length == 0 && reader->skipping;
        if (length == 0)
            return RLVC_OK;
        const unsigned char *at = reader->buffer + reader->from;
        reader->skipping = 0;
        reader->from += length;
        status = take(reader, at, record);
        if (status != RLVC_OK || record->kind != RLVC_LOG_END)
            return status;
    }
}
