/* SPDX-License-Identifier: MIT */
/* The method of the planner: its functions (base/method.h). */
#include "rlvc/float_rules.h"

#include "../base/method.h"

const rlvc_method rlvc_method_planner = RLVC_METHOD_TABLE(RLVC_BY_PLANNER, rlvc_planner);
