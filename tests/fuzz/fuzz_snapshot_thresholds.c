/* SPDX-License-Identifier: MIT */
#define RLVC_FUZZ_DOMAIN RLVC_DOMAIN_THRESHOLDS
#include "forged_snapshot.h"
