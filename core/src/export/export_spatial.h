/* SPDX-License-Identifier: MIT */
/* What an exported policy on pairs of descriptors has beyond one on descriptors. */
#ifndef RLVC_SRC_EXPORT_SPATIAL_H
#define RLVC_SRC_EXPORT_SPATIAL_H

#include "collapse.h"
#include "rlvc/spatial.h"

/* Where the places of a percept are. */
void rlvc_export_spatial_comment(rlvc_compact *c, const rlvc_spatial *spatial);

/* Tables, and NAME_completed(): whether a point like a feature's first vector makes up the feature,
 * alone or with another. Returns how many bytes of constants there are. */
uint32_t rlvc_export_spatial(rlvc_compact *c, const rlvc_spatial *spatial, uint32_t features);

#endif
