/* SPDX-License-Identifier: MIT */
/* The two slots of a store of unknown bytes, and a stream in any state, on its way in or out. */
#include "stream.h"

#define MOST 18u /* bytes at once: they may touch three units */

/* A stream at some moment, `from` bytes after a unit's beginning: what the unit holds, how many
 * come after it, and whether something failed before is not known. */
static void some_stream(const rlvc_store *store, uint8_t mode, uint32_t from, rlvc_stream *stream) {
    const rlvc_two_slot slot = {any_in(0, 1), any_in(0, UINT32_MAX), any_in(0, UINT32_MAX),
                                16u * any_in(1, 128)};
    if (mode == RLVC_STREAM_COUNT)
        rlvc_stream_count(stream);
    else if (mode == RLVC_STREAM_SAVE)
        rlvc_stream_save(stream, store, &slot);
    else
        rlvc_stream_load(stream, store, &slot);
    stream->status = -(int)any_in(0, 20);
    stream->crc = any_in(0, UINT32_MAX);
    stream->at = 32u + from; /* of a size that is not known: which unit it is does not matter */
    any_bytes(stream->unit, sizeof stream->unit);
}

static void pass(const rlvc_store *store, uint8_t mode, uint32_t from) {
    unsigned char data[MOST];
    rlvc_stream stream;
    //@ loop unroll 19;
    for (uint32_t bytes = 0; bytes <= MOST; bytes++) {
        some_stream(store, mode, from, &stream);
        any_bytes(data, sizeof data);
        rlvc_stream_bytes(&stream, data, bytes);
    }
    some_stream(store, mode, from, &stream);
    (void)rlvc_stream_end(&stream);
}

int eva_stream(void) {
    const rlvc_store store = {0, 2048, read_any, write_any, erase_any, sync_any};
    rlvc_two_slot slot;
    (void)rlvc_two_slot_newest(&store, &slot);
    (void)rlvc_two_slot_next(&store, &slot);
    //@ loop unroll 48;
    for (uint32_t i = 0; i < 48u; i++) /* each by itself */
        pass(&store, (uint8_t)(i / 16u), i % 16u);
    return 0;
}
