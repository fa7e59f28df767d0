/* SPDX-License-Identifier: MIT */
/* A store in memory whose snapshot an attacker changes, with its CRC made right again: for the fuzz
 * targets of snapshots. STORE_BYTES is its size. */
#ifndef RLVC_TESTS_FORGED_STORE_H
#define RLVC_TESTS_FORGED_STORE_H

#include "base/bytes.h"
#include "base/crc.h"
#include "must.h"
#include "rlvc/snapshot.h"

#include <string.h>

static unsigned char bytes_of_store[STORE_BYTES];

static int read_store(void *ctx, uint32_t offset, void *buffer, uint32_t bytes) {
    (void)ctx;
    must(offset + bytes <= STORE_BYTES);
    memcpy(buffer, bytes_of_store + offset, bytes);
    return 0;
}

static int write_store(void *ctx, uint32_t offset, const void *buffer, uint32_t bytes) {
    (void)ctx;
    must(offset + bytes <= STORE_BYTES);
    memcpy(bytes_of_store + offset, buffer, bytes);
    return 0;
}

static const rlvc_store store = {NULL, STORE_BYTES / 2, read_store, write_store, NULL, NULL};

/* Each three bytes change one, or four that make a number which is hard to bear. */
static void forge(const uint8_t *data, size_t size) {
    static const uint32_t hard[] = {0x7fc00000u, 0x7f800000u, 0xff800000u, 0x5a000000u,
                                    0x80000000u, 0xffffffffu, 0x7fffffffu, 0x0000ffffu,
                                    0x00000000u, 0x00000001u, 0x60ad78ecu, 0x7f7fffffu};
    uint32_t bytes = (uint32_t)rlvc_get(bytes_of_store + 12, 4);
    for (; size >= 3; data += 3, size -= 3) {
        uint32_t at = data[0] | (uint32_t)(data[1] & 0x7fu) << 8;
        if (data[1] & 0x80u)
            rlvc_put(bytes_of_store + 16 + at % (bytes - 24u),
                     hard[data[2] % (sizeof hard / sizeof hard[0])], 4);
        else
            bytes_of_store[at % (bytes - 4u)] = data[2];
    }
    bytes = (uint32_t)rlvc_get(bytes_of_store + 12, 4);
    if (bytes >= 64u && bytes <= STORE_BYTES / 2)
        rlvc_put(bytes_of_store + bytes - 4, rlvc_crc(0, bytes_of_store, bytes - 4u), 4);
}

/* Writes nothing. */
static int ignore(void *ctx, const char *text, size_t bytes) {
    (void)ctx;
    (void)text;
    (void)bytes;
    return 0;
}

#endif
