/* SPDX-License-Identifier: MIT */
/* The compact tree of a policy: see collapse.h. */
#include "rlvc/float_rules.h"

#include "collapse.h"

/* The node that follows the subtree of `node` in pre-order; 0 after the last. */
static uint32_t after(const rlvc_tree *tree, uint32_t node) {
    while (node != 0 && node % 2u == 0)
        node = rlvc_tree_parent(tree, node);
    return node == 0 ? 0 : node + 1u;
}

uint32_t rlvc_compact_action(const rlvc_compact *c, uint32_t node) {
    while (!rlvc_tree_is_leaf(c->tree, node))
        node = c->tree->node[node];
    return c->policy[rlvc_tree_class(c->tree, node)];
}

int rlvc_compact_is_mixed(const rlvc_compact *c, uint32_t node) {
    uint32_t action = rlvc_compact_action(c, node), end = after(c->tree, node);
    for (uint32_t at = node;;) {
        if (rlvc_tree_is_leaf(c->tree, at) && c->policy[rlvc_tree_class(c->tree, at)] != action)
            return 1;
        at = rlvc_tree_walk(c->tree, at);
        if (at == end)
            return 0;
    }
}

uint32_t rlvc_compact_next(const rlvc_compact *c, uint32_t node) {
    return rlvc_compact_is_mixed(c, node) ? rlvc_tree_walk(c->tree, node) : after(c->tree, node);
}

uint32_t rlvc_compact_next_mixed(const rlvc_compact *c, uint32_t node) {
    do
        node = rlvc_compact_next(c, node);
    while (node != 0 && !rlvc_compact_is_mixed(c, node));
    return node;
}

static uint32_t mixed_below(const rlvc_compact *c, uint32_t node) {
    uint32_t count = 0, end = after(c->tree, node);
    do {
        count += rlvc_compact_is_mixed(c, node) ? 1u : 0u;
        node = rlvc_compact_next(c, node);
    } while (node != end);
    return count;
}

void rlvc_compact_count(rlvc_compact *c) {
    c->mixed = mixed_below(c, 0);
}

/* ------------------------------------------------------------------ writing */

void rlvc_compact_name(rlvc_compact *c, const char *before, const char *behind) {
    rlvc_compact_string(c, before);
    rlvc_compact_string(c, c->name);
    rlvc_compact_string(c, behind);
}

void rlvc_compact_line(rlvc_compact *c, uint32_t node) {
    rlvc_compact_string(c, " * ");
    for (uint32_t depth = rlvc_tree_depth(c->tree, node); depth > 0; depth--)
        rlvc_compact_string(c, "  ");
    if (node > 0)
        rlvc_compact_string(c, node % 2u == 0 ? "1: " : "0: ");
    if (!rlvc_compact_is_mixed(c, node))
        rlvc_compact_number(c, "action ", rlvc_compact_action(c, node));
}

int rlvc_compact_fits_bytes(const rlvc_compact *c) {
    return c->mixed + c->actions <= 256u;
}

/* What a node's entry says of a child. */
static uint32_t reference(const rlvc_compact *c, uint32_t child, uint32_t if_mixed) {
    return rlvc_compact_is_mixed(c, child) ? if_mixed : c->mixed + rlvc_compact_action(c, child);
}

void rlvc_compact_entry(rlvc_compact *c, uint32_t node, uint32_t i, uint32_t test) {
    uint32_t absent = c->tree->node[node];
    rlvc_compact_number(c, i ? ",\n    {" : "\n    {", test);
    rlvc_compact_number(c, ", ", reference(c, absent, i + 1u));
    rlvc_compact_number(c, ", ", reference(c, absent + 1u, i + 1u + mixed_below(c, absent)));
    rlvc_compact_string(c, "}");
}

void rlvc_compact_constant(rlvc_compact *c, const char *percept) {
    rlvc_compact_name(c, "static inline unsigned ", "_act(");
    rlvc_compact_string(c, percept);
    rlvc_compact_number(c, ") {\n    (void)percept;\n    return ", rlvc_compact_action(c, 0));
    rlvc_compact_string(c, "u;\n}\n");
}

void rlvc_compact_float(rlvc_compact *c, float number) {
    const int whole = number * number < 1e18f && (float)(int32_t)number == number;
    rlvc_text_float(&c->text, number, 9);
    rlvc_compact_string(c, whole ? ".0f" : "f");
}
