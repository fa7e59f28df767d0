/* SPDX-License-Identifier: MIT */
/* The part of an exported policy for the domain of bags of vectors. */
#ifndef RLVC_SRC_EXPORT_BAGS_H
#define RLVC_SRC_EXPORT_BAGS_H

#include "collapse.h"
#include "rlvc/bags.h"

/* Tables and functions; returns how many bytes of constants they have. The lines of the comment are
 * those of the bags' vectors. */
uint32_t rlvc_export_bags(rlvc_compact *c, const rlvc_bags *bags);

#endif
