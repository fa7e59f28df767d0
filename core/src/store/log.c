/* SPDX-License-Identifier: MIT */
/* The log of interactions.
 *
 * A record is a mark, a byte of kind and flags, a sequence number, a content whose length follows
 * from these, and the CRC of all before it (SPEC.md). The reader takes what begins with the mark
 * for a record until that proves wrong; then it goes on looking one byte later, in what it has
 * already read, so that no whole record is ever lost to a false beginning.
 *
 * A hostile log has a false beginning at every other byte, so the CRC of a record must not be taken
 * anew for each. Let C(p) be the CRC of the bytes from some origin to position p. Then the CRC of
 * the n bytes from p on is C(p + n) xor C(p) x^(8 n), modulo the CRC's polynomial. The reader keeps
 * C(p) of the first unused byte (`start`) and, for each of the four lengths that a record can have,
 * C(p + n) as far as it was taken (`reach`). They only ever move forward, so each byte is passed
 * five times at most.
 *
 * The buffer is a ring, for a byte that is skipped to cost nothing to move. A record that was found
 * across the ring's end is straightened, at most once for as many bytes as the buffer holds. */
#include "rlvc/float_rules.h"

#include "rlvc/log.h"

#include "../base/bytes.h"
#include "../base/crc.h"
#include <string.h>

#define MARK 0xa5u
#define HEAD_BYTES 4u /* mark, kind, sequence */
#define CRC_BYTES 4u
#define HEADER_BYTES 8u      /* version, actions, percept_bytes */
#define INTERACTION_BYTES 5u /* action, reward */
#define CHUNK_BYTES 64u      /* of numbers, which are turned into bytes on their way */
#define PERCEPT_BYTES_MAX (UINT32_C(1) << 20)

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

/* How many bytes of a percept are numbers. */
static uint32_t bytes_of_numbers(uint32_t percept_bytes, uint32_t words) {
    return words < percept_bytes / 4u ? 4u * words : percept_bytes / 4u * 4u;
}

/* Writes a percept, and takes it into a CRC. */
static int put_percept(const rlvc_log_writer *writer, const void *percept, uint32_t *crc) {
    const unsigned char *byte = (const unsigned char *)percept;
    unsigned char chunk[CHUNK_BYTES];
    uint32_t left = bytes_of_numbers(writer->percept_bytes, writer->percept_words);
    const uint32_t rest = writer->percept_bytes - left;
    while (left > 0) {
        const uint32_t count = left < CHUNK_BYTES ? left : CHUNK_BYTES;
        for (uint32_t i = 0; i < count; i += 4u) {
            uint32_t word;
            memcpy(&word, byte + i, sizeof word);
            rlvc_put(chunk + i, word, 4);
        }
        *crc = rlvc_crc(*crc, chunk, count);
        if (writer->write(writer->ctx, chunk, count) != 0)
            return -1;
        byte += count;
        left -= count;
    }
    *crc = rlvc_crc(*crc, byte, rest);
    return rest > 0 ? writer->write(writer->ctx, byte, rest) : 0;
}

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
    if (writer->write(writer->ctx, record, head) != 0)
        return RLVC_E_CALLBACK;
    if (percept && put_percept(writer, percept, &crc) != 0)
        return RLVC_E_CALLBACK;
    rlvc_put(end, crc, CRC_BYTES);
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
    writer->percept_words = 0;
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

/* Where the byte `ahead` bytes after the first unused one stands in the ring. */
static uint32_t place_of(const rlvc_log_reader *reader, uint32_t ahead) {
    uint32_t to_end = reader->room - reader->from;
    return ahead < to_end ? reader->from + ahead : ahead - to_end;
}

/* Where the byte stands that was used `ago` bytes before it. */
static uint32_t place_before(const rlvc_log_reader *reader, uint32_t ago) {
    return ago <= reader->from ? reader->from - ago : reader->room - (ago - reader->from);
}

/* Continues a CRC up to a position of the log; what it passes is in the ring. */
static void take_crc(const rlvc_log_reader *reader, rlvc_log_crc *crc, uint64_t to) {
    uint32_t count = (uint32_t)(to - crc->at), to_end;
    uint32_t place = crc->at >= reader->at ? place_of(reader, (uint32_t)(crc->at - reader->at))
                                           : place_before(reader, (uint32_t)(reader->at - crc->at));
    to_end = reader->room - place;
    crc->crc = rlvc_crc(crc->crc, reader->buffer + place, count < to_end ? count : to_end);
    if (count > to_end)
        crc->crc = rlvc_crc(crc->crc, reader->buffer, count - to_end);
    crc->at = to;
}

/* Takes C(p) up to the first unused byte, while the bytes before it are in the ring. Where no reach
 * is beyond that, nothing depends on what was, and there is a new origin. */
static void catch_up(rlvc_log_reader *reader) {
    if (reader->furthest > reader->at) {
        take_crc(reader, &reader->start, reader->at);
    } else {
        reader->start.crc = 0;
        reader->start.at = reader->at;
    }
}

static void advance(rlvc_log_reader *reader, uint32_t count) {
    reader->from = place_of(reader, count);
    reader->at += count;
    reader->held -= count;
}

/* Gives up the first byte that is not used yet. */
static void skip(rlvc_log_reader *reader) {
    advance(reader, 1);
    reader->skipped++;
    reader->damaged += !reader->skipping;
    reader->skipping = 1;
}

/* Bytes of the record that begins with this byte of kind; 0 if none does.
 * @param which of the four lengths it is: which reach is the record's */
static uint32_t length_of(const rlvc_log_reader *reader, uint8_t kind, uint32_t *which) {
    uint32_t end = (uint32_t)kind >> END_SHIFT;
    *which = 0;
    if (kind == RLVC_LOG_HEADER)
        return HEAD_BYTES + HEADER_BYTES + CRC_BYTES;
    if (reader->percept_bytes == 0)
        return 0;
    *which = 1;
    if (kind == RLVC_LOG_BEGIN)
        return HEAD_BYTES + reader->percept_bytes + CRC_BYTES;
    if ((kind & KIND_MASK) != RLVC_LOG_OBSERVE || end > RLVC_TRUNCATED)
        return 0;
    *which = end == RLVC_TERMINATED ? 2 : 3;
    return HEAD_BYTES + INTERACTION_BYTES + (end == RLVC_TERMINATED ? 0 : reader->percept_bytes) +
           CRC_BYTES;
}

/* Is the CRC of a record right that is held in full? */
static int is_whole(rlvc_log_reader *reader, uint32_t length, uint32_t which) {
    rlvc_log_crc *reach = &reader->reach[which];
    uint32_t covered = length - CRC_BYTES, stored = 0;
    catch_up(reader);
    if (reach->at <= reader->at)
        *reach = reader->start;
    take_crc(reader, reach, reader->at + covered);
    if (reach->at > reader->furthest)
        reader->furthest = reach->at;
    if (reader->shift[which].multiple[1] == 0)
        rlvc_crc_shift_by(covered, reader->shift[which].multiple);
    for (uint32_t i = CRC_BYTES; i-- > 0;)
        stored = stored << 8 | reader->buffer[place_of(reader, covered + i)];
    return (reach->crc ^ rlvc_crc_shift(reader->start.crc, reader->shift[which].multiple)) ==
           stored;
}

/* Reads until `need` bytes are there. *there becomes 0 if the log ends before. */
static rlvc_status fetch(rlvc_log_reader *reader, uint32_t need, int *there) {
    *there = 1;
    if (reader->held >= need)
        return RLVC_OK;
    catch_up(reader);
    if (reader->held == 0)
        reader->from = 0;
    while (reader->held < need) {
        uint32_t got = 0, place = place_of(reader, reader->held);
        uint32_t room = place < reader->from ? reader->from - place : reader->room - place;
        if (reader->read(reader->ctx, reader->buffer + place, room, &got) != 0 || got > room)
            return RLVC_E_STORE;
        if (got == 0) {
            *there = 0;
            return RLVC_OK;
        }
        reader->held += got;
    }
    return RLVC_OK;
}

/* Finds the next whole record, and leaves it at `from`. *length becomes 0 at the end of the log. */
static rlvc_status find(rlvc_log_reader *reader, uint32_t *length) {
    *length = 0;
    for (;;) {
        int there = 0;
        uint32_t need = 0, which = 0;
        rlvc_status status = fetch(reader, 2, &there);
        if (status == RLVC_OK && there && reader->buffer[reader->from] == MARK) {
            need = length_of(reader, reader->buffer[place_of(reader, 1)], &which);
            status = fetch(reader, need, &there);
        }
        if (status != RLVC_OK)
            return status;
        if (there && need > 0 && is_whole(reader, need, which)) {
            *length = need;
            return RLVC_OK;
        }
        if (reader->held == 0)
            return RLVC_OK;
        skip(reader);
    }
}

static void reverse(unsigned char *byte, uint32_t count) {
    for (uint32_t i = 0; i < count / 2u; i++) {
        unsigned char other = byte[count - 1u - i];
        byte[count - 1u - i] = byte[i];
        byte[i] = other;
    }
}

/* The record that is held from the first unused byte on, in one piece: if it goes across the ring's
 * end, the ring is turned for it to begin where the buffer does. */
static unsigned char *in_one_piece(rlvc_log_reader *reader, uint32_t length) {
    if (length > reader->room - reader->from) {
        reverse(reader->buffer, reader->from);
        reverse(reader->buffer + reader->from, reader->room - reader->from);
        reverse(reader->buffer, reader->room);
        reader->from = 0;
    }
    return reader->buffer + reader->from;
}

/* Makes numbers of a record's bytes, as this target keeps them. */
static void take_numbers(const rlvc_log_reader *reader, unsigned char *at, uint32_t length) {
    const uint32_t count = bytes_of_numbers(reader->percept_bytes, reader->percept_words);
    unsigned char *percept = at + length - CRC_BYTES - reader->percept_bytes;
    for (uint32_t i = 0; i < count; i += 4u) {
        const uint32_t word = (uint32_t)rlvc_get(percept + i, 4);
        memcpy(percept + i, &word, sizeof word);
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
        unsigned char *at = in_one_piece(reader, length);
        reader->skipping = 0;
        advance(reader, length);
        status = take(reader, at, record);
        if (record->percept) {
            catch_up(reader); /* no CRC is taken of these bytes later */
            take_numbers(reader, at, length);
        }
        if (status != RLVC_OK || record->kind != RLVC_LOG_END)
            return status;
    }
}
