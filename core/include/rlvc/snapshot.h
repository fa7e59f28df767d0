/* SPDX-License-Identifier: MIT */
/* Snapshots: saving an agent so that it survives power loss.
 *
 * rlvc_save writes the whole state of an agent, including a learning step under way. rlvc_load
 * makes an agent that continues bit for bit as if it had never stopped. A store has two slots. A
 * snapshot is written to the slot that does not hold the newest, and is valid only once its last
 * byte is written. Whenever the power fails, one of the two is whole.
 *
 * The bytes are the same on every target; SPEC.md gives them. The content of a store is not
 * trusted: rlvc_load makes a sound agent or returns an error. */
#ifndef RLVC_SNAPSHOT_H
#define RLVC_SNAPSHOT_H

#include "rlvc/agent.h"

#ifdef __cplusplus
extern "C" {
#endif

#define RLVC_SNAPSHOT_VERSION 1u

/* Every write is of this many bytes, at a multiple of them, and follows the one before it. */
#define RLVC_STORE_UNIT 64u

/* Where snapshots are kept: a file, flash, FRAM. Offsets count from the store's first byte. A
 * callback returns 0, or anything else to fail. */
typedef struct rlvc_store {
    void *ctx; /* handed to every callback, untouched */

    /* Of one slot, rlvc_snapshot_size or more, a multiple of RLVC_STORE_UNIT, and of the pages that
     * erase() erases; at most RLVC_SLOT_BYTES_MAX. The slots lie at [0, slot_bytes) and
     * [slot_bytes, 2 * slot_bytes). */
    uint32_t slot_bytes;

    /* Required. What was never written may read as anything, but reading it must not fail. */
    int (*read)(void *ctx, uint32_t offset, void *buffer, uint32_t bytes);
    int (*write)(void *ctx, uint32_t offset, const void *buffer, uint32_t bytes);

    /* Makes a whole slot ready to be written, optional: for flash, whose pages must be erased
     * before. It is not called for a slot that holds the only whole snapshot. */
    int (*erase)(void *ctx, uint32_t offset, uint32_t bytes);

    /* Returns when all that was written will outlast a power failure. Optional. */
    int (*sync)(void *ctx);
} rlvc_store;

#define RLVC_SLOT_BYTES_MAX 0x7fffffc0u

/* The most bytes that a snapshot of an agent can take: what slot_bytes must be. A multiple of
 * RLVC_STORE_UNIT. O(1).
 * @return RLVC_OK; RLVC_E_CONFIG, or RLVC_E_MEMORY if it is above RLVC_SLOT_BYTES_MAX: *bytes is 0.
 */
RLVC_API rlvc_status rlvc_snapshot_size(const rlvc_config *config, const rlvc_domain *domain,
                                        uint32_t *bytes);

/* The same as a constant expression, of an agent of classes. */
#define RLVC_SNAPSHOT_BYTES(actions, capacity, classes, percept_bytes, feature_bytes)              \
    (((size_t)RLVC_SNAPSHOT_FIXED_BYTES + ((size_t)(capacity) + 1u) * ((percept_bytes) + 8u) +     \
      ((size_t)(classes)-1u) * ((feature_bytes) + 28u) + (size_t)(classes)*9u +                    \
      (size_t)(classes) * (actions)*13u + 63u) /                                                   \
     64u * 64u)
#define RLVC_SNAPSHOT_FIXED_BYTES 225u

/* Writes a snapshot, in the format of the agent's method. The agent is not changed. Stack and
 * memory are bounded, but the time is what the store takes for all the bytes. O(bytes).
 * @return RLVC_OK; RLVC_E_NULL; RLVC_E_REENTERED; RLVC_E_BUSY: a planner is learning, go on with
 * rlvc_learn; RLVC_E_RANGE: slot_bytes; RLVC_E_STORE: the last whole snapshot is still there. */
RLVC_API rlvc_status rlvc_save(rlvc_agent *agent, const rlvc_store *store);

/* Makes an agent in the caller's block, as rlvc_agent_init does, out of the newest whole snapshot
 * of a store. The config must be the one it was saved with, in every field, and the domain must be
 * as it was. A learning step under way is restored by repeating its current phase up to where it
 * was. That takes at most the time of grouping all samples and searching one class, and calls the
 * domain. If a callback fails in that, the step is given up (rlvc_learn_abandon). What the domain
 * does not vouch for (check_percept, check_feature) is refused as damaged; a domain without these
 * checks must be right for any record.
 * @return RLVC_OK; RLVC_E_NULL; RLVC_E_CONFIG; RLVC_E_MEMORY; RLVC_E_RANGE: slot_bytes;
 * RLVC_E_STORE; RLVC_E_EMPTY; RLVC_E_DAMAGED; RLVC_E_VERSION: also of an agent of the other method;
 * RLVC_E_MISMATCH. Unless it is RLVC_OK, *agent is null and the block holds nothing of use. */
RLVC_API rlvc_status rlvc_load(const rlvc_config *config, const rlvc_domain *domain, void *memory,
                               size_t bytes, const rlvc_store *store, rlvc_agent **agent);

/* What the newest whole snapshot of a store is. */
typedef struct rlvc_snapshot_info {
    uint32_t version;  /* RLVC_SNAPSHOT_VERSION, or RLVC_PLANNER_SNAPSHOT_VERSION */
    uint32_t sequence; /* one more with each snapshot */
    uint32_t slot;     /* 0 or 1 */
    uint32_t bytes;
    uint32_t percept_bytes; /* of its domain */
    uint32_t feature_bytes;
    rlvc_config config; /* but its method, which is null, and what the method does not look at */
} rlvc_snapshot_info;

/* Reads the head of a store without knowing the config. Only checks that the snapshot is whole.
 * O(bytes).
 * @return RLVC_OK; RLVC_E_NULL; RLVC_E_RANGE: slot_bytes; RLVC_E_STORE; RLVC_E_EMPTY;
 * RLVC_E_DAMAGED; RLVC_E_VERSION: of *info, only what stands before percept_bytes is known;
 * RLVC_E_MISMATCH: its config has an option that this release does not have: *info means nothing.
 */
RLVC_API rlvc_status rlvc_snapshot_peek(const rlvc_store *store, rlvc_snapshot_info *info);

#ifdef __cplusplus
}
#endif

#endif
