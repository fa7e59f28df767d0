// SPDX-License-Identifier: MIT
#define RLVC_ROWS rows_base
#define RLVC_ROWS_LANES 4
#include "rows_body.h"
