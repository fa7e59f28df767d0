/* SPDX-License-Identifier: MIT */
/* The part of an exported policy for the domains of descriptors and of pairs of them, and what that
 * for bags of them shares with it. */
#ifndef RLVC_SRC_EXPORT_DESCRIPTORS_H
#define RLVC_SRC_EXPORT_DESCRIPTORS_H

#include "collapse.h"
#include "rlvc/spatial.h"

/* The lines of the comment: what a percept is, and the tree.
 * @param spatial the domain of pairs, whose vectors `d` are; null for the others */
void rlvc_export_descriptors_comment(rlvc_compact *c, const rlvc_descriptors *d,
                                     const rlvc_spatial *spatial);

/* Tables and functions; returns how many bytes of constants they have. */
uint32_t rlvc_export_descriptors(rlvc_compact *c, const rlvc_descriptors *d,
                                 const rlvc_spatial *spatial);

/* What the numbers of a vector are. */
const char *rlvc_export_descriptors_type(const rlvc_descriptors *d);

/* ------------------------------------------------------------------ parts */

/* The inclusion of <stdint.h> and the table of nodes. Returns how many features there are, and adds
 * the bytes of the table. */
uint32_t rlvc_export_descriptors_nodes(rlvc_compact *c, uint32_t *bytes);

/* What a table has of each feature. A place is scale and displacement; it, and first and second
 * vector, are of features of the domain of pairs, the vector of those of single ones. What is
 * needed, the count and a bag, its first `count` vectors, are of features of the domain of bags. */
typedef enum rlvc_export_column {
    RLVC_EXPORT_RADIUS,
    RLVC_EXPORT_VECTOR,
    RLVC_EXPORT_PLACE,
    RLVC_EXPORT_FIRST,
    RLVC_EXPORT_SECOND,
    RLVC_EXPORT_NEEDED,
    RLVC_EXPORT_COUNT,
    RLVC_EXPORT_BAG
} rlvc_export_column;

/* Begins a table of vectors; ends any table, with these entries in it. */
void rlvc_export_descriptors_table(rlvc_compact *c, const rlvc_descriptors *d, const char *behind,
                                   uint32_t features);
void rlvc_export_descriptors_column(rlvc_compact *c, const rlvc_descriptors *d,
                                    rlvc_export_column column);

/* NAME_between(): the squared distance of two vectors, or more than a limit. */
void rlvc_export_descriptors_between(rlvc_compact *c, const rlvc_descriptors *d);

/* The locals `vector`, where those of `percept` begin, `count`, how many there are, and `i`. */
void rlvc_export_descriptors_percept(rlvc_compact *c, const rlvc_descriptors *d);

/* NAME_act(), by NAME_present() of a percept and a feature. */
void rlvc_export_descriptors_act(rlvc_compact *c);

#endif
