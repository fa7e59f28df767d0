/* SPDX-License-Identifier: MIT */
#define RLVC_FUZZ_DOMAIN RLVC_DOMAIN_BAGS
#define CAPACITY 96u /* one half of the samples must bear out what is gathered from the other */
#define STORE_BYTES 16384u
#include "forged_snapshot.h"
