/* SPDX-License-Identifier: MIT */
/* The part of an exported policy for the domain of thresholds. */
#ifndef RLVC_SRC_EXPORT_THRESHOLDS_H
#define RLVC_SRC_EXPORT_THRESHOLDS_H

#include "collapse.h"
#include "rlvc/thresholds.h"

/* The lines of the comment: what a percept is, and the tree. */
void rlvc_export_thresholds_comment(rlvc_compact *c, const rlvc_domain *domain);

/* Tables and the function; returns how many bytes of constants they have. */
uint32_t rlvc_export_thresholds(rlvc_compact *c);

#endif
