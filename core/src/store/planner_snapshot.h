/* SPDX-License-Identifier: MIT */
/* The head of a planner's snapshot: see planner_snapshot.c. */
#ifndef RLVC_SRC_PLANNER_SNAPSHOT_H
#define RLVC_SRC_PLANNER_SNAPSHOT_H

#include "rlvc/planner.h"
#include "two_slot.h"

#define RLVC_PLANNER_SNAPSHOT_FIRST 0x10001u

/* Can snapshots of this version be loaded into a planner? O(1). */
static inline int rlvc_planner_snapshot_known(uint32_t version) {
    return version == RLVC_PLANNER_SNAPSHOT_VERSION || version == RLVC_PLANNER_SNAPSHOT_FIRST;
}

/* Opens a planner's snapshot. Its config takes the place of info's, but for what a planner does not
 * look at.
 * @return RLVC_OK; RLVC_E_VERSION; RLVC_E_STORE; RLVC_E_DAMAGED. */
rlvc_status rlvc_planner_open_slot(const rlvc_store *store, const rlvc_two_slot *slot,
                                   rlvc_stream *stream, rlvc_snapshot_info *info);

#endif
