/* SPDX-License-Identifier: MIT */
/* The compact tree of a policy, for writing it as C.
 *
 * A node is mixed if its leaves do not all act alike. The compact tree consists of the mixed nodes,
 * which are internal, and of their other children, which become leaves. It is not
 * stored: each query walks over a subtree, so that exporting takes no memory. In
 * pre-order, mixed node i has its absent child, if that is mixed, at i + 1, and its present child
 * after all mixed nodes below the absent one. */
#ifndef RLVC_SRC_COLLAPSE_H
#define RLVC_SRC_COLLAPSE_H

#include "text.h"
#include "../tree/tree.h"

typedef struct rlvc_compact {
    rlvc_text text;
    const rlvc_tree *tree;
    const uint8_t *policy;
    const char *name; /* begins everything that is defined */
    uint32_t actions;
    uint32_t mixed; /* nodes of the compact tree */
} rlvc_compact;

/* Counts the mixed nodes. The walks below need it no sooner than what they put does. */
void rlvc_compact_count(rlvc_compact *c);

int rlvc_compact_is_mixed(const rlvc_compact *c, uint32_t node);

/* The action of the first leaf below a node; if the node is not mixed, that of all. */
uint32_t rlvc_compact_action(const rlvc_compact *c, uint32_t node);

/* The node of the compact tree that follows in pre-order, 0 after the last: nothing is below a leaf
 * of it. */
uint32_t rlvc_compact_next(const rlvc_compact *c, uint32_t node);

/* The next mixed node; 0 after the last. */
uint32_t rlvc_compact_next_mixed(const rlvc_compact *c, uint32_t node);

/* The record of the feature that an internal node tests. */
static inline const void *rlvc_compact_feature(const rlvc_compact *c, uint32_t node) {
    return rlvc_tree_feature(c->tree, rlvc_tree_split_of(c->tree, node));
}

/* ------------------------------------------------------------------ writing */

static inline void rlvc_compact_string(rlvc_compact *c, const char *string) {
    rlvc_text_string(&c->text, string);
}

static inline void rlvc_compact_number(rlvc_compact *c, const char *before, uint32_t n) {
    rlvc_text_string(&c->text, before);
    rlvc_text_uint(&c->text, n);
}

/* `before`, the name, `behind`. */
void rlvc_compact_name(rlvc_compact *c, const char *before, const char *behind);

/* A constant of type float, by digits that tell any two floats apart. Whole numbers below 1e9 are
 * printed as such, and lack a point. */
void rlvc_compact_float(rlvc_compact *c, float number);

/* A line of the tree for people, up to what is tested, or all of it at a leaf. */
void rlvc_compact_line(rlvc_compact *c, uint32_t node);

/* An entry of the table of nodes holds the number of a test, and for each answer the number of a
 * mixed node, or else their count and an action. 1: these fit into a byte each, if the numbers of
 * tests do. */
int rlvc_compact_fits_bytes(const rlvc_compact *c);

/* The entry of mixed node number i, which is `node`. */
void rlvc_compact_entry(rlvc_compact *c, uint32_t node, uint32_t i, uint32_t test);

/* The function of a policy without a mixed node. */
void rlvc_compact_constant(rlvc_compact *c, const char *percept);

#endif
