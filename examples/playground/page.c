/* SPDX-License-Identifier: MIT */
/* Memory and text: see page.h. The module's memory is, from the bottom up: constants and stack, a
 * room for text, and the blocks, one after another. */
#include "page.h"

#define PAGE_BYTES 65536u
#define TEXT_ROOM (4u << 20) /* the tree of a maze of 900 cells takes a tenth of it */

extern unsigned char __heap_base; /* where the linker put the end of the stack */

static struct {
    size_t used; /* bytes of blocks */
    size_t text;
} memory;

static unsigned char *text_room(void) {
    return (unsigned char *)(((size_t)&__heap_base + 15u) / 16u * 16u);
}

static int reserve(size_t end) {
    const size_t pages = __builtin_wasm_memory_size(0), wanted = end / PAGE_BYTES + 1;
    return wanted <= pages || __builtin_wasm_memory_grow(0, wanted - pages) != (size_t)-1;
}

void *memory_take(size_t bytes) {
    unsigned char *block = text_room() + TEXT_ROOM + memory.used;
    const size_t taken = (bytes + 15u) / 16u * 16u;
    if (taken < bytes || (size_t)block + taken < taken || !reserve((size_t)block + taken)) {
        return NULL;
    }
    memory.used += taken;
    return block;
}

size_t memory_mark(void) {
    return memory.used;
}

void memory_release(size_t mark) {
    memory.used = mark;
}

void text_begin(void) {
    memory.text = 0;
}

int text_write(void *ctx, const char *text, size_t bytes) {
    unsigned char *to = text_room() + memory.text;
    (void)ctx;
    if (bytes > TEXT_ROOM - memory.text || !reserve((size_t)to + bytes)) {
        return 1;
    }
    __builtin_memcpy(to, text, bytes);
    memory.text += bytes;
    return 0;
}

EXPORT(text_start) const unsigned char *text_start(void) {
    return text_room();
}

EXPORT(text_bytes) size_t text_bytes(void) {
    return memory.text;
}

/* The page is about to write so much text at text_start(). 0 if there is no room. */
EXPORT(text_take) uint32_t text_take(size_t bytes) {
    if (bytes > TEXT_ROOM || !reserve((size_t)text_room() + bytes)) {
        return 0;
    }
    memory.text = bytes;
    return 1;
}
