/* SPDX-License-Identifier: MIT */
/* Two slots, and streams of bytes into and out of them: see two_slot.h. */
#include "rlvc/float_rules.h"

#include "two_slot.h"

#include "../base/bytes.h"
#include "../base/crc.h"
#include <string.h>

#define HEAD_BYTES 16u
#define CRC_BYTES 4u
static const unsigned char magic[4] = {'R', 'L', 'V', 'S'};

/* ------------------------------------------------------------------ which slot */

rlvc_status rlvc_two_slot_check(const rlvc_store *store, uint64_t min_bytes) {
    if (!store || !store->read || !store->write)
        return RLVC_E_NULL;
    return store->slot_bytes >= min_bytes && store->slot_bytes <= RLVC_SLOT_BYTES_MAX &&
                   store->slot_bytes % RLVC_STORE_UNIT == 0
               ? RLVC_OK
               : RLVC_E_RANGE;
}

static uint32_t base_of(const rlvc_store *store, uint32_t index) {
    return index * store->slot_bytes;
}

/* Reads a slot's head. *plausible: it begins like a snapshot that fits into the slot. */
static rlvc_status read_head(const rlvc_store *store, uint32_t index, rlvc_two_slot *slot,
                             int *plausible) {
    unsigned char head[HEAD_BYTES];
    if (store->read(store->ctx, base_of(store, index), head, HEAD_BYTES) != 0)
        return RLVC_E_STORE;
    slot->index = index;
    slot->version = (uint32_t)rlvc_get(head + 4, 4);
    slot->sequence = (uint32_t)rlvc_get(head + 8, 4);
    slot->bytes = (uint32_t)rlvc_get(head + 12, 4);
    *plausible = memcmp(head, magic, sizeof magic) == 0 && slot->bytes > 0 &&
                 slot->bytes <= store->slot_bytes && slot->bytes % RLVC_STORE_UNIT == 0;
    return RLVC_OK;
}

/* RLVC_OK if the CRC is right, else RLVC_E_DAMAGED. */
static rlvc_status check_whole(const rlvc_store *store, const rlvc_two_slot *slot) {
    unsigned char unit[RLVC_STORE_UNIT];
    uint32_t crc = 0, base = base_of(store, slot->index), at = 0;
    do { /* a plausible slot has a unit or more */
        uint32_t last = at + RLVC_STORE_UNIT == slot->bytes;
        if (store->read(store->ctx, base + at, unit, RLVC_STORE_UNIT) != 0)
            return RLVC_E_STORE;
        crc = rlvc_crc(crc, unit, RLVC_STORE_UNIT - (last ? CRC_BYTES : 0));
        at += RLVC_STORE_UNIT;
    } while (at < slot->bytes);
    return rlvc_get(unit + RLVC_STORE_UNIT - CRC_BYTES, CRC_BYTES) == crc ? RLVC_OK
                                                                          : RLVC_E_DAMAGED;
}

rlvc_status rlvc_two_slot_newest(const rlvc_store *store, rlvc_two_slot *slot) {
    rlvc_two_slot heads[2];
    int plausible[2];
    for (uint32_t i = 0; i < 2; i++) {
        rlvc_status status = read_head(store, i, &heads[i], &plausible[i]);
        if (status != RLVC_OK)
            return status;
    }
    /* The sequence number may come round to 0 again. */
    uint32_t ahead = heads[1].sequence - heads[0].sequence;
    uint32_t newer = plausible[1] && (!plausible[0] || ahead - 1u < INT32_MAX);
    rlvc_status status = RLVC_E_EMPTY;
    for (uint32_t i = 0; i < 2 && plausible[newer ^ i]; i++) {
        *slot = heads[newer ^ i];
        status = check_whole(store, slot);
        if (status != RLVC_E_DAMAGED)
            return status;
    }
    return status;
}

rlvc_status rlvc_two_slot_next(const rlvc_store *store, rlvc_two_slot *slot) {
    rlvc_two_slot newest = {1, 0, 0, 0};
    rlvc_status status = rlvc_two_slot_newest(store, &newest);
    if (status == RLVC_E_STORE)
        return status;
    memset(slot, 0, sizeof *slot);
    slot->sequence = 1;
    if (status == RLVC_OK) { /* else there is nothing to lose */
        slot->index = 1u - newest.index;
        slot->sequence = newest.sequence + 1u;
    }
    return RLVC_OK;
}

/* ------------------------------------------------------------------ streams */

static void begin(rlvc_stream *stream, uint8_t mode) {
    memset(stream, 0, sizeof *stream);
    stream->mode = mode;
    stream->status = RLVC_OK;
}

void rlvc_stream_count(rlvc_stream *stream) {
    begin(stream, RLVC_STREAM_COUNT);
    stream->at = HEAD_BYTES;
}

uint64_t rlvc_stream_size(const rlvc_stream *stream) {
    uint64_t unit = RLVC_STORE_UNIT;
    return (stream->at + CRC_BYTES + unit - 1u) / unit * unit;
}

void rlvc_stream_save(rlvc_stream *stream, const rlvc_store *store, const rlvc_two_slot *slot) {
    unsigned char head[HEAD_BYTES];
    begin(stream, RLVC_STREAM_SAVE);
    stream->store = store;
    stream->base = base_of(store, slot->index);
    stream->size = slot->bytes;
    if (store->erase && store->erase(store->ctx, stream->base, store->slot_bytes) != 0)
        stream->status = RLVC_E_STORE;
    memcpy(head, magic, sizeof magic);
    rlvc_put(head + 4, slot->version, 4);
    rlvc_put(head + 8, slot->sequence, 4);
    rlvc_put(head + 12, slot->bytes, 4);
    rlvc_stream_bytes(stream, head, HEAD_BYTES);
}

void rlvc_stream_load(rlvc_stream *stream, const rlvc_store *store, const rlvc_two_slot *slot) {
    unsigned char head[HEAD_BYTES];
    begin(stream, RLVC_STREAM_LOAD);
    stream->store = store;
    stream->base = base_of(store, slot->index);
    stream->size = slot->bytes;
    rlvc_stream_bytes(stream, head, HEAD_BYTES);
}

static uint32_t within_unit(const rlvc_stream *stream) {
    return (uint32_t)(stream->at % RLVC_STORE_UNIT);
}

/* Before the first byte of a unit is loaded: reads it. */
static void fetch(rlvc_stream *stream) {
    const rlvc_store *store = stream->store;
    if (stream->status == RLVC_OK && stream->at + RLVC_STORE_UNIT > stream->size)
        stream->status = RLVC_E_DAMAGED;
    if (stream->status == RLVC_OK && store->read(store->ctx, stream->base + (uint32_t)stream->at,
                                                 stream->unit, RLVC_STORE_UNIT) != 0)
        stream->status = RLVC_E_STORE;
    if (stream->status != RLVC_OK)
        memset(stream->unit, 0, sizeof stream->unit);
}

/* After the last byte of a unit is saved: writes it. */
static void flush(rlvc_stream *stream) {
    const rlvc_store *store = stream->store;
    uint32_t offset = stream->base + (uint32_t)stream->at - RLVC_STORE_UNIT;
    if (stream->status == RLVC_OK &&
        store->write(store->ctx, offset, stream->unit, RLVC_STORE_UNIT) != 0)
        stream->status = RLVC_E_STORE;
}

void rlvc_stream_bytes(rlvc_stream *stream, void *data, uint32_t bytes) {
    unsigned char *byte = (unsigned char *)data;
    if (stream->mode == RLVC_STREAM_COUNT) {
        stream->at += bytes;
        return;
    }
    while (bytes > 0) {
        uint32_t n, from = within_unit(stream);
        //@ split from;
        n = bytes < RLVC_STORE_UNIT - from ? bytes : RLVC_STORE_UNIT - from;
        if (stream->mode == RLVC_STREAM_SAVE)
            memcpy(stream->unit + from, byte, n);
        else if (from == 0)
            fetch(stream);
        if (stream->mode == RLVC_STREAM_LOAD)
            memcpy(byte, stream->unit + from, n);
        stream->crc = rlvc_crc(stream->crc, byte, n);
        stream->at += n;
        if (stream->mode == RLVC_STREAM_SAVE && from + n == RLVC_STORE_UNIT)
            flush(stream);
        byte += n;
        bytes -= n;
    }
}

static uint64_t number_of(rlvc_stream *stream, uint64_t number, uint32_t bytes) {
    unsigned char buffer[8] = {0};
    rlvc_put(buffer, number, bytes);
    rlvc_stream_bytes(stream, buffer, bytes);
    return rlvc_get(buffer, bytes);
}

void rlvc_stream_u8(rlvc_stream *stream, uint8_t *number) {
    *number = (uint8_t)number_of(stream, *number, 1);
}

void rlvc_stream_u16(rlvc_stream *stream, uint16_t *number) {
    *number = (uint16_t)number_of(stream, *number, 2);
}

void rlvc_stream_u32(rlvc_stream *stream, uint32_t *number) {
    *number = (uint32_t)number_of(stream, *number, 4);
}

void rlvc_stream_u64(rlvc_stream *stream, uint64_t *number) {
    *number = number_of(stream, *number, 8);
}

void rlvc_stream_float(rlvc_stream *stream, float *number) {
    uint32_t bits;
    memcpy(&bits, number, sizeof bits);
    rlvc_stream_u32(stream, &bits);
    memcpy(number, &bits, sizeof bits);
}

/* Passes numbers of 2 or 4 bytes each, up to `limit` bytes of them.
 * @return how many bytes they were. */
static uint32_t pass_numbers(rlvc_stream *stream, unsigned char *at, uint32_t count, uint32_t width,
                             uint32_t limit) {
    uint32_t passed = 0;
    for (uint32_t i = 0; i < count && limit - passed >= width; i++, passed += width) {
        uint32_t word;
        uint16_t half;
        if (width == sizeof word) {
            memcpy(&word, at + passed, sizeof word);
            rlvc_stream_u32(stream, &word);
            memcpy(at + passed, &word, sizeof word);
        } else {
            memcpy(&half, at + passed, sizeof half);
            rlvc_stream_u16(stream, &half);
            memcpy(at + passed, &half, sizeof half);
        }
    }
    return passed;
}

void rlvc_stream_record(rlvc_stream *stream, void *record, uint32_t bytes, uint32_t words,
                        uint32_t halves) {
    unsigned char *at = (unsigned char *)record;
    uint32_t passed = pass_numbers(stream, at, words, 4, bytes);
    passed += pass_numbers(stream, at + passed, halves, 2, bytes - passed);
    rlvc_stream_bytes(stream, at + passed, bytes - passed);
}

rlvc_status rlvc_stream_end(rlvc_stream *stream) {
    const rlvc_store *store = stream->store;
    if (stream->status == RLVC_OK && stream->size != rlvc_stream_size(stream))
        stream->status = RLVC_E_DAMAGED;
    while (stream->status == RLVC_OK && within_unit(stream) != RLVC_STORE_UNIT - CRC_BYTES) {
        uint8_t zero = 0;
        rlvc_stream_u8(stream, &zero);
    }
    uint32_t crc = stream->crc, stored = crc;
    rlvc_stream_u32(stream, &stored);
    if (stream->status == RLVC_OK && stored != crc)
        stream->status = RLVC_E_DAMAGED;
    if (stream->status == RLVC_OK && stream->mode == RLVC_STREAM_SAVE && store->sync &&
        store->sync(store->ctx) != 0)
        stream->status = RLVC_E_STORE;
    return stream->status;
}
