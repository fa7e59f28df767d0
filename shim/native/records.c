/* SPDX-License-Identifier: MIT */
/* A whole log of interactions, read by the library's reader into arrays. */
#include "shim.h"

#include "rlvc/log.h"

#include <string.h>

/* The log in memory that the reader reads. */
typedef struct rlvc_tape {
    const unsigned char *bytes;
    size_t count, at;
} rlvc_tape;

static int read_tape(void *ctx, void *bytes, uint32_t room, uint32_t *got) {
    rlvc_tape *tape = (rlvc_tape *)ctx;
    size_t rest = tape->count - tape->at;
    *got = rest < room ? (uint32_t)rest : room;
    memcpy(bytes, tape->bytes + tape->at, *got);
    tape->at += *got;
    return 0;
}

/* Stores an interaction, if there are arrays, and makes its s' current. */
static void take(rlvc_shim_records *records, const rlvc_log_record *record,
                 unsigned char *current) {
    size_t i = records->interactions++, bytes = records->percept_bytes;
    if (records->choices) {
        memcpy(records->percepts + i * bytes, current, bytes);
        if (record->percept)
            memcpy(records->next + i * bytes, record->percept, bytes);
        else
            memset(records->next + i * bytes, 0, bytes);
        records->choices[i] = record->choice;
        records->rewards[i] = record->reward;
        records->ends[i] = record->end;
    }
    if (record->percept)
        memcpy(current, record->percept, bytes);
}

/* An episode in which the writer stopped counts as truncated. */
static void cut(rlvc_shim_records *records, int open) {
    if (open && records->ends)
        records->ends[records->interactions - 1] = RLVC_TRUNCATED;
}

rlvc_status rlvc_shim_records_read(const unsigned char *bytes, size_t count, unsigned char *buffer,
                                   unsigned char *current, rlvc_shim_records *records) {
    rlvc_tape tape = {bytes, count, 0};
    rlvc_log_reader reader;
    rlvc_log_record record;
    int open = 0; /* the newest interaction goes on */
    rlvc_status status =
        rlvc_log_read(&reader, 0, 0, buffer, RLVC_SHIM_RECORDS_ROOM, read_tape, &tape);
    records->interactions = records->fault_at = records->torn = 0;
    while (status == RLVC_OK) {
        uint64_t skipped = reader.skipped;
        uint32_t lost = reader.lost;
        size_t at = tape.at - (reader.held);
        status = rlvc_log_next(&reader, &record);
        int edge = record.kind == RLVC_LOG_HEADER || record.kind == RLVC_LOG_END;
        records->fault_at = at;
        if (status != RLVC_OK)
            return status;
        if (reader.lost != lost || (reader.skipped != skipped && !edge))
            return RLVC_E_DAMAGED;
        records->torn += reader.skipped != skipped;
        records->percept_bytes = reader.percept_bytes;
        records->actions = reader.actions;
        if (record.kind == RLVC_LOG_OBSERVE) {
            take(records, &record, current);
            open = record.end == RLVC_GOES_ON;
            continue;
        }
        cut(records, open);
        open = 0;
        if (record.kind == RLVC_LOG_END)
            return RLVC_OK;
        if (record.kind == RLVC_LOG_BEGIN)
            memcpy(current, record.percept, reader.percept_bytes);
    }
    return status;
}
