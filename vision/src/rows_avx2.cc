// SPDX-License-Identifier: MIT
#define RLVC_ROWS rows_avx2
#define RLVC_ROWS_LANES 8
#include "rows_body.h"
