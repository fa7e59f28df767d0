/* SPDX-License-Identifier: MIT */
/* The policy as a C header: see rlvc/export.h.
 *
 * A node is mixed if its leaves do not all act alike. The compact tree consists of the mixed nodes, which are
 * internal, and of their other children, which become leaves. Nothing is stored of it: each question is
 * answered by a walk over a subtree, so that exporting takes no memory. In pre-order, mixed node i has its
 * absent child, if that is mixed, at i + 1, and its present child after all mixed nodes below the absent
 * one. */
#include "rlvc/export.h"

#include "rlvc/bits.h"
#include "state.h"
#include "text.h"

#define TABLE_BITS_MAX 16u

typedef struct exporter {
    rlvc_text text;
    const rlvc_tree *tree;
    const uint8_t *policy;
    const char *name;
    uint32_t mixed;                   /* nodes of the compact tree */
    uint32_t used;                    /* distinct bits that it tests, or TABLE_BITS_MAX + 1 of more */
    uint16_t bit[TABLE_BITS_MAX + 1]; /* these, ascending */
} exporter;

static void string(exporter *e, const char *s) {
    rlvc_text_string(&e->text, s);
}

static void number(exporter *e, const char *before, uint32_t n) {
    rlvc_text_string(&e->text, before);
    rlvc_text_uint(&e->text, n);
}

/* ------------------------------------------------------------------ the compact tree */

/* The node that follows the subtree of `node` in pre-order; 0 after the last. */
static uint32_t after(const rlvc_tree *tree, uint32_t node) {
    while (node != 0 && node % 2u == 0)
        node = rlvc_tree_parent(tree, node);
    return node == 0 ? 0 : node + 1u;
}

/* The action of the first leaf below a node; if the node is not mixed, that of all. */
static uint32_t first_action(const exporter *e, uint32_t node) {
    while (!rlvc_tree_is_leaf(e->tree, node))
        node = e->tree->node[node];
    return e->policy[rlvc_tree_class(e->tree, node)];
}

static int is_mixed(const exporter *e, uint32_t node) {
    uint32_t action = first_action(e, node), end = after(e->tree, node);
    for (uint32_t at = node;;) {
        if (rlvc_tree_is_leaf(e->tree, at) && e->policy[rlvc_tree_class(e->tree, at)] != action)
            return 1;
        at = rlvc_tree_walk(e->tree, at);
        if (at == end)
            return 0;
    }
}

/* The node of the compact tree that follows in pre-order: nothing is below a leaf of it. */
static uint32_t next(const exporter *e, uint32_t node) {
    return is_mixed(e, node) ? rlvc_tree_walk(e->tree, node) : after(e->tree, node);
}

static uint32_t mixed_below(const exporter *e, uint32_t node) {
    uint32_t count = 0, end = after(e->tree, node);
    do {
        count += is_mixed(e, node) ? 1u : 0u;
        node = next(e, node);
    } while (node != end);
    return count;
}

static uint32_t bit_of(const exporter *e, uint32_t node) {
    return rlvc_bits_feature(rlvc_tree_feature(e->tree, rlvc_tree_split_of(e->tree, node)));
}

/* Adds a bit to those used, in its place. */
static void use_bit(exporter *e, uint32_t bit) {
    uint32_t at = 0;
    while (at < e->used && e->bit[at] < bit)
        at++;
    if (e->used > TABLE_BITS_MAX || (at < e->used && e->bit[at] == bit))
        return;
    for (uint32_t i = e->used++; i > at; i--)
        e->bit[i] = e->bit[i - 1u];
    e->bit[at] = (uint16_t)bit;
}

static void look_over(exporter *e) {
    uint32_t node = 0;
    do {
        if (is_mixed(e, node)) {
            e->mixed++;
            use_bit(e, bit_of(e, node));
        }
        node = next(e, node);
    } while (node != 0);
}

/* ------------------------------------------------------------------ a table of the action by the bits */

static int table_is_small(const exporter *e) {
    return e->used <= TABLE_BITS_MAX && (1u << e->used) <= 16u * (e->mixed + 1u);
}

/* The action where the used bits have the values that `index` is made of. */
static uint32_t action_at(const exporter *e, uint32_t index) {
    uint32_t node = 0;
    while (is_mixed(e, node)) {
        uint32_t at = 0;
        while (e->bit[at] != bit_of(e, node))
            at++;
        node = e->tree->node[node] + (index >> at & 1u);
    }
    return first_action(e, node);
}

/* How many of the used bits from `at` on are neighbours in one byte of the percept. */
static uint32_t neighbours(const exporter *e, uint32_t at) {
    uint32_t count = 1;
    while (at + count < e->used && e->bit[at + count] == e->bit[at] + count &&
           e->bit[at + count] % 8u != 0)
        count++;
    return count;
}

static void put_table(exporter *e) {
    string(e, "static const unsigned char ");
    string(e, e->name);
    number(e, "_action[", 1u << e->used);
    string(e, "] = {");
    for (uint32_t index = 0; index < 1u << e->used; index++)
        number(e, index % 24u ? ", " : index ? ",\n    " : "\n    ", action_at(e, index));
    string(e, "};\n\nstatic inline unsigned ");
    string(e, e->name);
    string(e, "_act(const unsigned char *percept) {\n    return ");
    string(e, e->name);
    string(e, "_action[");
    for (uint32_t at = 0; at < e->used;) {
        uint32_t count = neighbours(e, at);
        number(e, at ? " |\n        (percept[" : "(percept[", e->bit[at] / 8u);
        number(e, "] >> ", e->bit[at] % 8u);
        number(e, " & ", (1u << count) - 1u);
        number(e, "u) << ", at);
        at += count;
    }
    string(e, "];\n}\n");
}

/* ------------------------------------------------------------------ a table of nodes */

/* What a node's entry says of a child: the number of a mixed one; else their count and the action. */
static uint32_t reference(const exporter *e, uint32_t child, uint32_t if_mixed) {
    return is_mixed(e, child) ? if_mixed : e->mixed + first_action(e, child);
}

static void put_node(exporter *e, uint32_t node, uint32_t i) {
    uint32_t absent = e->tree->node[node];
    number(e, i ? ",\n    {" : "\n    {", bit_of(e, node));
    number(e, ", ", reference(e, absent, i + 1u));
    number(e, ", ", reference(e, absent + 1u, i + 1u + mixed_below(e, absent)));
    string(e, "}");
}

/* An entry holds a bit and two references: a byte each, if they fit. */
static int fits_bytes(const exporter *e, uint32_t actions, uint32_t bits) {
    return e->mixed + actions <= 256u && bits <= 256u;
}

static void put_nodes(exporter *e, int bytes) {
    string(e, bytes ? "static const unsigned char " : "static const unsigned ");
    string(e, e->name);
    number(e, "_node[", e->mixed);
    string(e, "][3] = { /* bit, then which if it is 0, which if 1 */");
    uint32_t i = 0, node = 0;
    do {
        if (is_mixed(e, node))
            put_node(e, node, i++);
        node = next(e, node);
    } while (node != 0);
    string(e, "};\n\nstatic inline unsigned ");
    string(e, e->name);
    string(e, "_act(const unsigned char *percept) {\n    unsigned at = 0;\n    do {\n"
              "        unsigned bit = ");
    string(e, e->name);
    string(e, "_node[at][0];\n        at = ");
    string(e, e->name);
    string(e, "_node[at][1u + (percept[bit / 8u] >> bit % 8u & 1u)];\n    } while (at < ");
    number(e, "", e->mixed);
    number(e, "u);\n    return at - ", e->mixed);
    string(e, "u;\n}\n");
}

static void put_constant(exporter *e) {
    string(e, "static inline unsigned ");
    string(e, e->name);
    string(e, "_act(const unsigned char *percept) {\n    (void)percept;\n    return ");
    number(e, "", first_action(e, 0));
    string(e, "u;\n}\n");
}

/* ------------------------------------------------------------------ the header */

/* The compact tree, for people. */
static void put_comment(exporter *e) {
    uint32_t node = 0;
    do {
        string(e, " * ");
        for (uint32_t depth = rlvc_tree_depth(e->tree, node); depth > 0; depth--)
            string(e, "  ");
        if (node > 0)
            string(e, node % 2u == 0 ? "1: " : "0: ");
        if (is_mixed(e, node))
            number(e, "bit ", bit_of(e, node));
        else
            number(e, "action ", first_action(e, node));
        string(e, "\n");
        node = next(e, node);
    } while (node != 0);
}

static int is_identifier(const char *name) {
    uint32_t length = 0;
    for (; name[length] != '\0'; length++) {
        char c = name[length];
        int letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
        if (!(letter || (length > 0 && c >= '0' && c <= '9')) || length >= 48u)
            return 0;
    }
    return length > 0;
}

static void put_header(exporter *e, const rlvc_agent *agent, rlvc_export_info *info) {
    uint32_t actions = agent->config.actions;
    int table = table_is_small(e), bytes = fits_bytes(e, actions, agent->domain.percept_bytes * 8u);
    number(e, "/* A policy learnt by rlvc: of ", agent->tree.classes);
    number(e, " classes ", e->mixed + 1u);
    string(e, " are left, once those that act alike are one.\n"
              " * Bit i of a percept is bit i % 8 of its byte i / 8.\n *\n");
    put_comment(e);
    string(e, " */\n#ifndef ");
    string(e, e->name);
    string(e, "_policy_h\n#define ");
    string(e, e->name);
    string(e, "_policy_h\n\n");
    if (e->mixed == 0)
        put_constant(e);
    else if (table)
        put_table(e);
    else
        put_nodes(e, bytes);
    string(e, "\n#endif\n");
    info->leaves = agent->tree.classes;
    info->compact = e->mixed + 1u;
    info->bytes = e->mixed == 0 ? 0 : table ? 1u << e->used : e->mixed * (bytes ? 3u : 12u);
}

rlvc_status rlvc_export_c(rlvc_agent *agent, const char *name, rlvc_write write, void *ctx,
                          rlvc_export_info *info) {
    if (!agent || !name || !write)
        return RLVC_E_NULL;
    if (agent->busy)
        return RLVC_E_REENTERED;
    if (!is_identifier(name))
        return RLVC_E_RANGE;
    if (agent->domain.kind != RLVC_DOMAIN_BITS)
        return RLVC_E_CONFIG;
    rlvc_export_info unwanted;
    exporter e = {{write, ctx, RLVC_OK}, &agent->tree, agent->values.policy, name, 0, 0, {0}};
    agent->busy = 1;
    look_over(&e);
    put_header(&e, agent, info ? info : &unwanted);
    agent->busy = 0;
    return e.text.status;
}
