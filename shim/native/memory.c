/* SPDX-License-Identifier: MIT */
/* Where the library writes for Python: text, and a store in memory. No Python runs while the
 * library writes, so that Ctrl-C cannot leave half of it. The memory is Python's. */
#include "shim.h"

#include <string.h>

int rlvc_shim_text_write(void *ctx, const char *bytes, size_t size) {
    rlvc_shim_text *text = (rlvc_shim_text *)ctx;
    size_t left = text->size < text->room ? text->room - text->size : 0;
    memcpy(text->bytes + (text->room - left), bytes, size < left ? size : left);
    text->size += size;
    return 0;
}

static int outside(const rlvc_shim_memory *memory, uint32_t offset, uint32_t count) {
    return offset > memory->size || count > memory->size - offset;
}

static int read_memory(void *ctx, uint32_t offset, void *buffer, uint32_t count) {
    const rlvc_shim_memory *memory = (const rlvc_shim_memory *)ctx;
    if (outside(memory, offset, count))
        return 1;
    memcpy(buffer, memory->bytes + offset, count);
    return 0;
}

static int write_memory(void *ctx, uint32_t offset, const void *buffer, uint32_t count) {
    rlvc_shim_memory *memory = (rlvc_shim_memory *)ctx;
    if (outside(memory, offset, count))
        return 1;
    memcpy(memory->bytes + offset, buffer, count);
    return 0;
}

void rlvc_shim_memory_store(rlvc_shim_memory *memory, uint32_t slot_bytes, rlvc_store *store) {
    memset(store, 0, sizeof *store);
    store->ctx = memory;
    store->slot_bytes = slot_bytes;
    store->read = read_memory;
    store->write = write_memory;
}
