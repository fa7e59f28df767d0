/* SPDX-License-Identifier: MIT */
/* The part of an exported policy for the domains of descriptors and of pairs of them. */
#ifndef RLVC_SRC_EXPORT_DESCRIPTORS_H
#define RLVC_SRC_EXPORT_DESCRIPTORS_H

#include "collapse.h"
#include "rlvc/spatial.h"

/* The lines of the comment: what a percept is, and the tree.
 * @param spatial the domain of pairs, whose vectors `d` are; null for the domain of descriptors */
void rlvc_export_descriptors_comment(rlvc_compact *c, const rlvc_descriptors *d,
                                     const rlvc_spatial *spatial);

/* Tables and functions; returns how many bytes of constants they have. */
uint32_t rlvc_export_descriptors(rlvc_compact *c, const rlvc_descriptors *d,
                                 const rlvc_spatial *spatial);

/* What the numbers of a vector are. */
const char *rlvc_export_descriptors_type(const rlvc_descriptors *d);

/* What a table has of each feature. A place is scale and displacement; it, and first and second
 * vector, are of features of the domain of pairs, the vector of those of the other. */
typedef enum rlvc_export_column {
    RLVC_EXPORT_RADIUS,
    RLVC_EXPORT_VECTOR,
    RLVC_EXPORT_PLACE,
    RLVC_EXPORT_FIRST,
    RLVC_EXPORT_SECOND
} rlvc_export_column;

/* Begins a table of vectors; ends any table, with these entries in it. */
void rlvc_export_descriptors_table(rlvc_compact *c, const rlvc_descriptors *d, const char *behind,
                                   uint32_t features);
void rlvc_export_descriptors_column(rlvc_compact *c, const rlvc_descriptors *d,
                                    rlvc_export_column column);

#endif
