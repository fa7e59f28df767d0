/* SPDX-License-Identifier: MIT */
#define RLVC_FUZZ_DOMAIN RLVC_DOMAIN_DESCRIPTORS
#include "forged_snapshot.h"
