/* SPDX-License-Identifier: MIT */
/* For tests of snapshots: an agent and another that is loaded from its snapshots. Include after
 * cmocka.h. */
#ifndef RLVC_TESTS_SNAPSHOTS_H
#define RLVC_TESTS_SNAPSHOTS_H

#include "player.h"
#include "store.h"

static player p, other;
static medium m, spare;

/* An agent whose snapshots are short. */
static inline void prepare_holding(uint32_t capacity) {
    player_enter_world(&p, BATCH);
    p.config.capacity = capacity;
    p.config.classes = 5;
    p.config.min_samples = 4;
    p.config.alpha = 1.0f;
    player_init(&p);
}

static inline void prepare_small(void) {
    prepare_holding(30);
}

static inline rlvc_status load(player *to, const rlvc_store *store) {
    to->config = p.config;
    to->domain = p.domain;
    to->bytes = p.bytes;
    to->faulty = p.faulty;
    to->domain.ctx = &to->faulty;
    block_fill(to->block, CANARY, to->bytes + 64u);
    rlvc_status status =
        rlvc_load(&to->config, &to->domain, to->block, to->bytes, store, &to->agent);
    assert_true((status == RLVC_OK) == (to->agent != NULL));
    for (size_t i = to->bytes; i < to->bytes + 64u; i++)
        assert_int_equal(((const unsigned char *)to->block)[i], CANARY);
    return status;
}

/* The content of a snapshot of the agent as it is now. */
typedef struct content {
    uint32_t bytes;
    unsigned char byte[MEDIUM_BYTES / 2];
} content;

static inline void content_of(player *of, content *c) {
    rlvc_store store = medium_store(&spare, &of->config, &of->domain, 0);
    assert_int_equal(rlvc_save(of->agent, &store), RLVC_OK);
    c->bytes = snapshot_bytes(spare.bytes);
    memcpy(c->byte, spare.bytes, c->bytes);
}

static inline int same_content(const content *a, const content *b) {
    return a->bytes == b->bytes && memcmp(a->byte, b->byte, a->bytes) == 0;
}

#endif
