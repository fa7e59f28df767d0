/* SPDX-License-Identifier: MIT */
/* The method of classes: its functions (base/method.h). */
#include "rlvc/float_rules.h"

#include "../base/method.h"

const rlvc_method rlvc_method_classes = RLVC_METHOD_TABLE(RLVC_BY_CLASSES, rlvc_classes);
