/* SPDX-License-Identifier: MIT */
/* Reinforcement learning of (visual) classes: everything public. */
#ifndef RLVC_RLVC_H
#define RLVC_RLVC_H

#include "rlvc/agent.h"
#include "rlvc/bags.h"
#include "rlvc/bits.h"
#include "rlvc/chi2.h"
#include "rlvc/counts.h"
#include "rlvc/descriptors.h"
#include "rlvc/domain.h"
#include "rlvc/export.h"
#include "rlvc/min_tree.h"
#include "rlvc/log.h"
#include "rlvc/planner.h"
#include "rlvc/policy.h"
#include "rlvc/snapshot.h"
#include "rlvc/spatial.h"
#include "rlvc/status.h"
#include "rlvc/thresholds.h"

#define RLVC_VERSION_MAJOR 0
#define RLVC_VERSION_MINOR 1
#define RLVC_VERSION_PATCH 0
#define RLVC_VERSION "0.1.0"

#ifdef __cplusplus
extern "C" {
#endif

/* RLVC_VERSION of the library that is linked or loaded. O(1). */
RLVC_API const char *rlvc_version(void);

#ifdef __cplusplus
}
#endif

#endif
