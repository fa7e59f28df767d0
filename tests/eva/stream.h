/* SPDX-License-Identifier: MIT */
/* What the loading of an agent may take for granted of the bytes that it gets, whatever a store
 * holds. The driver `stream` holds the functions to it, `store` builds on it. */
#ifndef RLVC_TESTS_EVA_STREAM_H
#define RLVC_TESTS_EVA_STREAM_H

#include "any.h"
#include "store/two_slot.h"

/*@ requires \valid(slot);
    assigns *slot, \result \from indirect: store;
    ensures -20 <= \result < 0 ||
            (\result == 0 && \initialized(&slot->index) && \initialized(&slot->version) &&
             \initialized(&slot->sequence) && \initialized(&slot->bytes)); */
rlvc_status rlvc_two_slot_newest(const rlvc_store *store, rlvc_two_slot *slot);

/*@ requires \valid(stream) && \valid((unsigned char *)data + (0 .. bytes - 1));
    requires -20 <= stream->status <= 0;
    assigns stream->at, stream->crc, stream->status, stream->unit[0 .. 15],
            ((unsigned char *)data)[0 .. bytes - 1] \from indirect: stream, indirect: bytes;
    ensures \initialized(&stream->at) && \initialized(&stream->crc) &&
            \initialized(&stream->status) && -20 <= stream->status <= 0;
    ensures \initialized((unsigned char *)data + (0 .. bytes - 1)); */
void rlvc_stream_bytes(rlvc_stream *stream, void *data, uint32_t bytes);

/* A store of any bytes, each of whose calls may fail. */
static inline int read_any(void *ctx, uint32_t offset, void *buffer, uint32_t bytes) {
    (void)ctx;
    (void)offset;
    any_bytes(buffer, bytes);
    return (int)any_in(0, 1);
}

static inline int write_any(void *ctx, uint32_t offset, const void *buffer, uint32_t bytes) {
    (void)ctx;
    (void)offset;
    (void)buffer;
    (void)bytes;
    return (int)any_in(0, 1);
}

static inline int erase_any(void *ctx, uint32_t offset, uint32_t bytes) {
    (void)ctx;
    (void)offset;
    (void)bytes;
    return (int)any_in(0, 1);
}

static inline int sync_any(void *ctx) {
    (void)ctx;
    return (int)any_in(0, 1);
}

#endif
