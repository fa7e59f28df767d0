/* SPDX-License-Identifier: MIT */
/* The part of an exported policy for the domain of descriptors. */
#ifndef RLVC_SRC_EXPORT_DESCRIPTORS_H
#define RLVC_SRC_EXPORT_DESCRIPTORS_H

#include "collapse.h"
#include "rlvc/descriptors.h"

/* The lines of the comment: what a percept is, and the tree. */
void rlvc_export_descriptors_comment(rlvc_compact *c, const rlvc_descriptors *d);

/* Tables and functions; returns how many bytes of constants they have. */
uint32_t rlvc_export_descriptors(rlvc_compact *c, const rlvc_descriptors *d);

#endif
