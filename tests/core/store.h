/* SPDX-License-Identifier: MIT */
/* A store in memory for tests of snapshots: it can lose its power at any byte that is written, fail
 * at any call, and insist on being erased as flash does. Include after cmocka.h. */
#ifndef RLVC_TESTS_STORE_H
#define RLVC_TESTS_STORE_H

#include "base/bytes.h"
#include "base/crc.h"
#include "rlvc/snapshot.h"

#include <string.h>

#ifndef MEDIUM_BYTES /* two slots */
#define MEDIUM_BYTES 24576u
#endif

typedef struct medium {
    unsigned char bytes[MEDIUM_BYTES];
    uint64_t written; /* bytes so far; */
    uint64_t power;   /* the power fails before byte `power` of them, */
    uint8_t dead;     /* and from then on nothing works */
    uint8_t flash;    /* writing only turns ones into zeros; erasing makes ones, a byte at a time */
    uint32_t calls;   /* of any callback; */
    uint32_t fail_at; /* the one, from 1, that fails; 0: none */
    uint32_t syncs;
    rlvc_agent *agent; /* optional: every callback calls it, which must be refused */
} medium;

static inline int medium_fails(medium *m) {
    if (m->agent) {
        const rlvc_store none = {NULL, 0, NULL, NULL, NULL, NULL};
        rlvc_statistics statistics;
        assert_int_equal(rlvc_save(m->agent, &none), RLVC_E_REENTERED);
        assert_int_equal(rlvc_stats(m->agent, &statistics), RLVC_E_REENTERED);
    }
    m->calls++;
    return m->dead || m->calls == m->fail_at;
}

static inline int medium_put(medium *m, uint32_t offset, unsigned char byte) {
    if (m->written == m->power) {
        m->dead = 1;
        return 1;
    }
    m->written++;
    m->bytes[offset] = byte;
    return 0;
}

static inline int medium_read(void *ctx, uint32_t offset, void *buffer, uint32_t bytes) {
    medium *m = (medium *)ctx;
    assert_true(offset + bytes <= MEDIUM_BYTES);
    if (medium_fails(m))
        return 1;
    memcpy(buffer, m->bytes + offset, bytes);
    return 0;
}

static inline int medium_write(void *ctx, uint32_t offset, const void *buffer, uint32_t bytes) {
    medium *m = (medium *)ctx;
    const unsigned char *byte = (const unsigned char *)buffer;
    assert_int_equal(bytes, RLVC_STORE_UNIT);
    assert_int_equal(offset % RLVC_STORE_UNIT, 0);
    assert_true(offset + bytes <= MEDIUM_BYTES);
    if (medium_fails(m))
        return 1;
    for (uint32_t i = 0; i < bytes; i++) {
        if (m->flash)
            assert_int_equal(m->bytes[offset + i], 0xff);
        if (medium_put(m, offset + i, byte[i]))
            return 1;
    }
    return 0;
}

static inline int medium_erase(void *ctx, uint32_t offset, uint32_t bytes) {
    medium *m = (medium *)ctx;
    if (medium_fails(m))
        return 1;
    for (uint32_t i = 0; i < bytes; i++) {
        if (medium_put(m, offset + i, 0xff))
            return 1;
    }
    return 0;
}

static inline int medium_sync(void *ctx) {
    medium *m = (medium *)ctx;
    m->syncs++;
    return medium_fails(m);
}

/* Power is back; from now on it does not fail. */
static inline void medium_revive(medium *m) {
    m->dead = 0;
    m->power = UINT64_MAX;
    m->calls = 0;
    m->fail_at = 0;
}

/* An empty store with slots for agents of this config. */
static inline rlvc_store medium_store(medium *m, const rlvc_config *config,
                                      const rlvc_domain *domain, int flash) {
    rlvc_store store = {m, 0, medium_read, medium_write, flash ? medium_erase : NULL, medium_sync};
    memset(m, 0, sizeof *m);
    if (flash)
        memset(m->bytes, 0xff, sizeof m->bytes);
    m->flash = (uint8_t)flash;
    medium_revive(m);
    assert_int_equal(rlvc_snapshot_size(config, domain, &store.slot_bytes), RLVC_OK);
    assert_true(2u * store.slot_bytes <= MEDIUM_BYTES);
    return store;
}

/* The snapshot in a slot of the store, and its length. */
static inline unsigned char *medium_slot(const rlvc_store *store, uint32_t slot) {
    return ((medium *)store->ctx)->bytes + slot * store->slot_bytes;
}

static inline uint32_t snapshot_bytes(const unsigned char *snapshot) {
    return (uint32_t)rlvc_get(snapshot + 12, 4);
}

/* Makes a changed snapshot whole again. */
static inline void snapshot_mend(unsigned char *snapshot) {
    uint32_t bytes = snapshot_bytes(snapshot);
    rlvc_put(snapshot + bytes - 4, rlvc_crc(0, snapshot, bytes - 4u), 4);
}

#endif
