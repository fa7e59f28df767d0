/* SPDX-License-Identifier: MIT */
#define RLVC_FUZZ_DOMAIN RLVC_DOMAIN_SPATIAL
#include "forged_snapshot.h"
