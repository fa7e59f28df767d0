/* SPDX-License-Identifier: MIT */
/* What the module has in common with the page: memory, text, and what came of a tick. */
#ifndef PLAYGROUND_PAGE_H
#define PLAYGROUND_PAGE_H

#include <stddef.h>
#include <stdint.h>

/* Exported to the page under its own name. */
#define EXPORT(name) __attribute__((export_name(#name)))

/* What a tick returns: whether something else is to be drawn. */
enum { TICK_ON, TICK_EPISODE_OVER, TICK_LEARNT, TICK_FAILED };

/* The library allocates nothing: the blocks that it is handed come from here.
 * A block, aligned to 16, that stays until memory_release. Grows the module's memory if need be.
 * @return null if there is no more. */
void *memory_take(size_t bytes);

/* Gives back all blocks taken since `mark` was asked for. */
size_t memory_mark(void);
void memory_release(size_t mark);

/* Text that is made for the page, in memory of its own: text_begin empties it, text_write is an
 * rlvc_write, and the page reads text_bytes() characters at text_start(). */
void text_begin(void);
const unsigned char *text_start(void);
size_t text_bytes(void);
int text_write(void *ctx, const char *text, size_t bytes);

#endif
