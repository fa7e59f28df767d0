/* SPDX-License-Identifier: MIT */
/* A log of interactions, for flash or a serial line: written as they happen, read back to learn
 * from them.
 *
 * A log is a row of records, each with a sequence number and a CRC. A header begins it, and begins
 * it anew whenever a writer is opened to append to it. An episode is its first percept, then a
 * record for each interaction, which holds s' but not s, since that is the percept before it. A
 * truncated or corrupt record is skipped, and reading continues after it. SPEC.md gives the bytes.
 */
#ifndef RLVC_LOG_H
#define RLVC_LOG_H

#include "rlvc/agent.h"

#ifdef __cplusplus
extern "C" {
#endif

#define RLVC_LOG_VERSION 1u

/* The longest record, of percepts of so many bytes. */
#define RLVC_LOG_RECORD_BYTES(percept_bytes) ((uint32_t)(percept_bytes) + 13u)

/* ------------------------------------------------------------------ writing */

typedef struct rlvc_log_writer {
    /* Appends. Returns 0, or anything else to fail. Called up to three times a record, and once
     * more for each 64 bytes of numbers in it. */
    int (*write)(void *ctx, const void *bytes, uint32_t count);
    void *ctx;
    uint32_t percept_bytes;
    uint32_t percept_words; /* as of the domain, for you to set when the log is open; 0 after
                               rlvc_log_open: percepts are logged as they lie in memory */
    uint16_t sequence;      /* of the next record */
    uint8_t actions;
} rlvc_log_writer;

/* Fills *writer and writes a header. O(1).
 * @param percept_bytes, actions as of the domain and the config
 * @return RLVC_OK; RLVC_E_NULL; RLVC_E_RANGE: percept_bytes or actions; RLVC_E_CALLBACK. */
RLVC_API rlvc_status rlvc_log_open(rlvc_log_writer *writer, uint32_t percept_bytes,
                                   uint32_t actions,
                                   int (*write)(void *ctx, const void *bytes, uint32_t count),
                                   void *ctx);

/* Writes the beginning of an episode: with each rlvc_begin. O(percept_bytes).
 * @return RLVC_OK; RLVC_E_NULL; RLVC_E_CALLBACK: that record is lost, and the next may be tried. */
RLVC_API rlvc_status rlvc_log_begin(rlvc_log_writer *writer, const void *percept);

/* Writes an interaction: with each rlvc_observe, and with its arguments. O(percept_bytes).
 * @return RLVC_OK; RLVC_E_NULL; RLVC_E_RANGE; RLVC_E_REWARD; RLVC_E_CALLBACK. */
RLVC_API rlvc_status rlvc_log_observe(rlvc_log_writer *writer, rlvc_choice choice, float reward,
                                      const void *next, uint8_t end);

/* ------------------------------------------------------------------ reading */

/* record.kind */
#define RLVC_LOG_END 0u     /* there is no more */
#define RLVC_LOG_HEADER 1u  /* a writer was opened */
#define RLVC_LOG_BEGIN 2u   /* an episode begins at percept: rlvc_begin */
#define RLVC_LOG_OBSERVE 3u /* an interaction of the current percept: rlvc_observe */

typedef struct rlvc_log_record {
    const void *percept; /* the first, or s'; null if there is none. In the reader's buffer, not
                            aligned, until the next call */
    float reward;
    rlvc_choice choice;
    uint8_t end;
    uint8_t kind;
} rlvc_log_record;

/* How many lengths a record can have: header, beginning, interaction without and with a percept. */
#define RLVC_LOG_LENGTHS 4u

/* A CRC from some origin up to a position of the log. */
typedef struct rlvc_log_crc {
    uint64_t at;
    uint32_t crc;
} rlvc_log_crc;

/* What moves a CRC over as many bytes as the CRC of a record covers; zeros until it is needed. */
typedef struct rlvc_log_shift {
    uint32_t multiple[16];
} rlvc_log_shift;

typedef struct rlvc_log_reader {
    /* Reads up to `room` bytes, waits if there are none yet, sets *got, 0 at the end of the log.
     * Returns 0, or anything else to fail. */
    int (*read)(void *ctx, void *bytes, uint32_t room, uint32_t *got);
    void *ctx;
    unsigned char *buffer;
    uint32_t room;
    uint32_t percept_bytes; /* 0 until it is known */
    uint32_t percept_words; /* as of the domain, for you to set; 0 after rlvc_log_read */
    uint32_t actions;
    uint32_t from; /* the buffer, a ring, holds from here on */
    uint32_t held; /* so many bytes that are not used yet */
    uint64_t at;   /* how many were used: the position of the first of these */
    rlvc_log_crc start;
    rlvc_log_crc reach[RLVC_LOG_LENGTHS];
    uint64_t furthest; /* of these */
    rlvc_log_shift shift[RLVC_LOG_LENGTHS];
    uint64_t skipped; /* bytes that are part of no whole record */
    uint32_t damaged; /* stretches of such bytes; */
    uint32_t lost; /* records that are missing, as far as sequence numbers tell, or that follow on a
                         missing one and so do not say what they followed on */
    uint8_t torn;  /* 1: the log ended with such a stretch */
    uint8_t skipping;
    uint8_t counting; /* `sequence` is known */
    uint8_t linked;   /* the reader's user has a current percept */
    uint16_t sequence;
} rlvc_log_reader;

/* Fills *reader. Reads nothing. O(1).
 * @param percept_bytes, actions what the log must be of; or both 0: what its first header says
 * @param buffer `room` bytes, RLVC_LOG_RECORD_BYTES(percept_bytes) and 16 or more
 * @return RLVC_OK; RLVC_E_NULL; RLVC_E_RANGE: percept_bytes or actions; RLVC_E_MEMORY: room. */
RLVC_API rlvc_status rlvc_log_read(
    rlvc_log_reader *reader, uint32_t percept_bytes, uint32_t actions, void *buffer, uint32_t room,
    int (*read)(void *ctx, void *bytes, uint32_t room, uint32_t *got), void *ctx);

/* The next record. What can be made of the records in this order, rlvc_begin and rlvc_observe
 * accept. An interaction whose s is lost becomes the beginning of an episode at its s'. Amortised
 * O(1) a byte of the log, whatever it holds: a byte of damage costs at most twenty times as much as
 * one of a record.
 * @return RLVC_OK; RLVC_E_NULL; RLVC_E_STORE: read failed, call again; RLVC_E_VERSION,
 *         RLVC_E_MISMATCH, RLVC_E_MEMORY: by the header just read (of another version, other
 * percepts or actions, with too little room), which is skipped by calling again. */
RLVC_API rlvc_status rlvc_log_next(rlvc_log_reader *reader, rlvc_log_record *record);

#ifdef __cplusplus
}
#endif

#endif
