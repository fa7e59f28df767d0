/* SPDX-License-Identifier: MIT */
/* Reading a log of unknown bytes, in pieces of unknown size. */
#include "any.h"
#include "rlvc/log.h"

static int read_any(void *ctx, void *bytes, uint32_t room, uint32_t *got) {
    (void)ctx;
    *got = any_in(0, room);
    any_bytes(bytes, *got);
    return (int)any_in(0, 1);
}

int eva_log(void) {
    static unsigned char buffer[RLVC_LOG_RECORD_BYTES(5)];
    rlvc_log_reader reader;
    rlvc_log_record record;
    (void)rlvc_log_read(&reader, 5, 3, buffer, sizeof buffer, read_any, 0);
    while (any_in(0, 1))
        (void)rlvc_log_next(&reader, &record);
    return 0;
}
