/* SPDX-License-Identifier: MIT */
/* The policy as a C header: see rlvc/export.h. Here is what is of the domain of bits, and the
 * public function; what is of the other domains has files of its own. */
#include "rlvc/float_rules.h"

#include "rlvc/export.h"

#include "rlvc/bits.h"
#include "collapse.h"
#include "export_bags.h"
#include "export_descriptors.h"
#include "export_thresholds.h"
#include "export_tree.h"
#include "../base/method.h"

#define TABLE_BITS_MAX 16u

typedef struct exporter {
    rlvc_compact c;
    uint32_t used; /* distinct bits that it tests, or TABLE_BITS_MAX + 1 of more */
    uint16_t bit[TABLE_BITS_MAX + 1]; /* these, ascending */
} exporter;

/* ------------------------------------------------------------------ the bits that are tested */

static uint32_t bit_of(const exporter *e, uint32_t node) {
    return rlvc_bits_feature(rlvc_compact_feature(&e->c, node));
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
        use_bit(e, bit_of(e, node));
        node = rlvc_compact_next_mixed(&e->c, node);
    } while (node != 0);
}

/* ------------------------------------------------------------ a table of the action by the bits */

static int table_is_small(const exporter *e) {
    return e->used <= TABLE_BITS_MAX && (UINT32_C(1) << e->used) <= 16u * (e->c.mixed + 1u);
}

/* The action where the used bits have the values that `index` is made of. */
static uint32_t action_at(const exporter *e, uint32_t index) {
    uint32_t node = 0;
    while (rlvc_compact_is_mixed(&e->c, node)) {
        uint32_t at = 0;
        while (at + 1u < e->used && e->bit[at] != bit_of(e, node)) /* it is one of them */
            at++;
        node = e->c.tree->node[node] + (index >> at & 1u);
    }
    return rlvc_compact_action(&e->c, node);
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
    rlvc_compact_string(&e->c, "static const unsigned char ");
    rlvc_compact_string(&e->c, e->c.name);
    rlvc_compact_number(&e->c, "_action[", UINT32_C(1) << e->used);
    rlvc_compact_string(&e->c, "] = {");
    for (uint32_t index = 0; index < UINT32_C(1) << e->used; index++)
        rlvc_compact_number(&e->c,
                            index % 24u ? ", "
                            : index     ? ",\n    "
                                        : "\n    ",
                            action_at(e, index));
    rlvc_compact_string(&e->c, "};\n\nstatic inline unsigned ");
    rlvc_compact_string(&e->c, e->c.name);
    rlvc_compact_string(&e->c, "_act(const unsigned char *percept) {\n    return ");
    rlvc_compact_string(&e->c, e->c.name);
    rlvc_compact_string(&e->c, "_action[");
    for (uint32_t at = 0; at < e->used;) {
        uint32_t count = neighbours(e, at);
        rlvc_compact_number(&e->c, at ? " |\n        (percept[" : "(percept[", e->bit[at] / 8u);
        rlvc_compact_number(&e->c, "] >> ", e->bit[at] % 8u);
        rlvc_compact_number(&e->c, " & ", (1u << count) - 1u);
        rlvc_compact_number(&e->c, "u) << ", at);
        at += count;
    }
    rlvc_compact_string(&e->c, "];\n}\n");
}

/* ------------------------------------------------------------------ a table of nodes */

static void put_nodes(exporter *e, int bytes) {
    rlvc_compact_string(&e->c, bytes ? "static const unsigned char " : "static const unsigned ");
    rlvc_compact_string(&e->c, e->c.name);
    rlvc_compact_number(&e->c, "_node[", e->c.mixed);
    rlvc_compact_string(&e->c, "][3] = { /* bit, then which if it is 0, which if 1 */");
    uint32_t i = 0, node = 0;
    do {
        rlvc_compact_entry(&e->c, node, i++, bit_of(e, node));
        node = rlvc_compact_next_mixed(&e->c, node);
    } while (node != 0);
    rlvc_compact_string(&e->c, "};\n\nstatic inline unsigned ");
    rlvc_compact_string(&e->c, e->c.name);
    rlvc_compact_string(&e->c,
                        "_act(const unsigned char *percept) {\n    unsigned at = 0;\n    do {\n"
                        "        unsigned bit = ");
    rlvc_compact_string(&e->c, e->c.name);
    rlvc_compact_string(&e->c, "_node[at][0];\n        at = ");
    rlvc_compact_string(&e->c, e->c.name);
    rlvc_compact_string(
        &e->c, "_node[at][1u + (percept[bit / 8u] >> bit % 8u & 1u)];\n    } while (at < ");
    rlvc_compact_number(&e->c, "", e->c.mixed);
    rlvc_compact_number(&e->c, "u);\n    return at - ", e->c.mixed);
    rlvc_compact_string(&e->c, "u;\n}\n");
}

/* ------------------------------------------------------------------ the header */

static void put_bits_comment(exporter *e) {
    uint32_t node = 0;
    rlvc_compact_string(&e->c, " * Bit i of a percept is bit i % 8 of its byte i / 8.\n *\n");
    do {
        rlvc_compact_line(&e->c, node);
        if (rlvc_compact_is_mixed(&e->c, node))
            rlvc_compact_number(&e->c, "bit ", bit_of(e, node));
        rlvc_compact_string(&e->c, "\n");
        node = rlvc_compact_next(&e->c, node);
    } while (node != 0);
}

/* Returns how many bytes of constants there are. */
static uint32_t put_bits(exporter *e, uint32_t bits) {
    if (e->c.mixed == 0) {
        rlvc_compact_constant(&e->c, "const unsigned char *percept");
        return 0;
    }
    look_over(e);
    if (table_is_small(e)) {
        put_table(e);
        return UINT32_C(1) << e->used;
    }
    const int bytes = rlvc_compact_fits_bytes(&e->c) && bits <= 256u;
    put_nodes(e, bytes);
    return e->c.mixed * (bytes ? 3u : 12u);
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

static void put_comment(exporter *e, const rlvc_domain *domain) {
    if (domain->kind == RLVC_DOMAIN_BITS)
        put_bits_comment(e);
    else if (domain->kind == RLVC_DOMAIN_DESCRIPTORS)
        rlvc_export_descriptors_comment(&e->c, (const rlvc_descriptors *)domain->ctx, NULL);
    else if (domain->kind == RLVC_DOMAIN_SPATIAL) {
        const rlvc_spatial *spatial = (const rlvc_spatial *)domain->ctx;
        rlvc_export_descriptors_comment(&e->c, &spatial->vectors, spatial);
    } else if (domain->kind == RLVC_DOMAIN_BAGS)
        rlvc_export_descriptors_comment(&e->c, &((const rlvc_bags *)domain->ctx)->vectors, NULL);
    else
        rlvc_export_thresholds_comment(&e->c, domain);
}

/* Returns how many bytes of constants there are. */
static uint32_t put_policy(exporter *e, const rlvc_domain *domain) {
    if (domain->kind == RLVC_DOMAIN_BITS)
        return put_bits(e, domain->percept_bytes * 8u);
    if (domain->kind == RLVC_DOMAIN_DESCRIPTORS)
        return rlvc_export_descriptors(&e->c, (const rlvc_descriptors *)domain->ctx, NULL);
    if (domain->kind == RLVC_DOMAIN_SPATIAL) {
        const rlvc_spatial *spatial = (const rlvc_spatial *)domain->ctx;
        return rlvc_export_descriptors(&e->c, &spatial->vectors, spatial);
    }
    if (domain->kind == RLVC_DOMAIN_BAGS)
        return rlvc_export_bags(&e->c, (const rlvc_bags *)domain->ctx);
    return rlvc_export_thresholds(&e->c);
}

static void put_header(exporter *e, const rlvc_domain *domain, rlvc_export_info *info) {
    info->leaves = e->c.tree->classes;
    info->compact = e->c.mixed + 1u;
    rlvc_compact_number(&e->c, "/* A policy learnt by rlvc: of ", info->leaves);
    rlvc_compact_number(&e->c, " classes ", info->compact);
    rlvc_compact_string(&e->c, " are left, once those that act alike are one.\n");
    put_comment(e, domain);
    rlvc_compact_name(&e->c, " */\n#ifndef ", "_policy_h\n");
    rlvc_compact_name(&e->c, "#define ", "_policy_h\n\n");
    info->bytes = put_policy(e, domain);
    rlvc_compact_string(&e->c, "\n#endif\n");
}

rlvc_status rlvc_export_tree(const rlvc_domain *domain, const rlvc_tree *tree,
                             const uint8_t *policy, uint32_t actions, const char *name,
                             rlvc_write write, void *ctx, rlvc_export_info *info) {
    if (!is_identifier(name))
        return RLVC_E_RANGE;
    if (domain->kind == RLVC_DOMAIN_OWN)
        return RLVC_E_CONFIG;
    rlvc_export_info unwanted;
    exporter e = {{{write, ctx, RLVC_OK}, tree, policy, name, actions, 0}, 0, {0}};
    rlvc_compact_count(&e.c);
    put_header(&e, domain, info ? info : &unwanted);
    return e.c.text.status;
}

rlvc_status rlvc_export_c(rlvc_agent *agent, const char *name, rlvc_write write, void *ctx,
                          rlvc_export_info *info) {
    rlvc_learnt learnt;
    if (!agent || !name || !write)
        return RLVC_E_NULL;
    rlvc_view(agent, &learnt);
    if (*learnt.busy)
        return RLVC_E_REENTERED;
    *learnt.busy = 1;
    const rlvc_status status = rlvc_export_tree(learnt.domain, learnt.tree, learnt.policy,
                                                learnt.actions, name, write, ctx, info);
    *learnt.busy = 0;
    return status;
}
