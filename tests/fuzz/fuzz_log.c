/* SPDX-License-Identifier: MIT */
/* Reads anything as a log, in pieces. The first byte chooses the size of the pieces, whether the
 * reader knows the percepts, and whether the rest is taken as it is or as contents, for which
 * records with a right CRC are made. What is read must be what an agent accepts. */
#include "base/bytes.h"
#include "base/crc.h"
#include "must.h"
#include "rlvc/log.h"

#include <string.h>

#define PERCEPT 5u
#define ACTIONS 3u

static unsigned char tape[1u << 16];
static uint32_t length, at, piece;

static int read_tape(void *ctx, void *bytes, uint32_t room, uint32_t *got) {
    uint32_t n = length - at < room ? length - at : room;
    (void)ctx;
    n = n < piece ? n : piece;
    memcpy(bytes, tape + at, n);
    at += n;
    *got = n;
    return 0;
}

/* Records of up to 16 bytes, each of which the input gives but for mark and CRC. */
static void make_records(const uint8_t *data, size_t size) {
    while (size > 0 && length + 32u < sizeof tape) {
        uint32_t n = data[0] % 16u;
        data++;
        size--;
        n = n < size ? n : (uint32_t)size;
        tape[length] = 0xa5;
        memcpy(tape + length + 1, data, n);
        rlvc_put(tape + length + 1 + n, rlvc_crc(0, tape + length, n + 1u), 4);
        length += n + 5u;
        data += n;
        size -= n;
    }
}

/* The first byte chooses the size of the pieces and whether records are made of the rest. */
static void fill_tape(const uint8_t *data, size_t size) {
    length = 0;
    at = 0;
    piece = 1u + data[0] % 32u;
    if (data[0] >> 6 & 1) {
        make_records(data + 1, size - 1);
    } else {
        length = (uint32_t)size - 1u;
        memcpy(tape, data + 1, length);
    }
}

/* A record of an interaction or of the beginning of an episode must be what an agent accepts. */
static void check_record(const rlvc_log_reader *reader, const rlvc_log_record *record, int open,
                         const unsigned char *buffer_end) {
    must(record->kind == RLVC_LOG_BEGIN || (open && record->choice.action < reader->actions));
    must(record->end <= RLVC_TRUNCATED);
    must(record->percept != NULL || record->end == RLVC_TERMINATED);
    if (record->percept)
        must((const unsigned char *)record->percept + reader->percept_bytes <= buffer_end);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    unsigned char buffer[RLVC_LOG_RECORD_BYTES(PERCEPT)];
    rlvc_log_reader reader;
    rlvc_log_record record;
    int open = 0;
    if (size < 1 || size > sizeof tape)
        return 0;
    fill_tape(data, size);
    uint32_t known = data[0] >> 5 & 1u;
    must(rlvc_log_read(&reader, known ? PERCEPT : 0, known ? ACTIONS : 0, buffer, sizeof buffer,
                       read_tape, NULL) == RLVC_OK);
    for (;;) {
        rlvc_status status = rlvc_log_next(&reader, &record);
        must(status == RLVC_OK || status == RLVC_E_VERSION || status == RLVC_E_MISMATCH ||
             status == RLVC_E_MEMORY);
        if (status != RLVC_OK || record.kind == RLVC_LOG_HEADER) {
            open = 0;
            continue;
        }
        if (record.kind == RLVC_LOG_END)
            break;
        check_record(&reader, &record, open, buffer + sizeof buffer);
        open = record.kind == RLVC_LOG_BEGIN || record.end == RLVC_GOES_ON;
    }
    must(at == length && reader.skipped <= length);
    return 0;
}
