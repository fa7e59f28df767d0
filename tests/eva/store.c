/* SPDX-License-Identifier: MIT */
/* Loading an agent from a store whose bytes are unknown. */
#include "agent.h"
#include "rlvc/snapshot.h"

static int read_any(void *ctx, uint32_t offset, void *buffer, uint32_t bytes) {
    (void)ctx;
    (void)offset;
    any_bytes(buffer, bytes);
    return (int)any_in(0, 1);
}

static int write_any(void *ctx, uint32_t offset, const void *buffer, uint32_t bytes) {
    (void)ctx;
    (void)offset;
    (void)buffer;
    (void)bytes;
    return (int)any_in(0, 1);
}

int eva_store(void) {
    const rlvc_store store = {0, 2048, read_any, write_any, 0, 0};
    rlvc_domain domain;
    rlvc_config config;
    rlvc_agent *agent;
    small_config(&domain, &config);
    (void)rlvc_load(&config, &domain, memory, sizeof memory, &store, &agent);
    return 0;
}
