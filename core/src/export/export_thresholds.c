/* SPDX-License-Identifier: MIT */
/* A policy on thresholds as C: see rlvc/export.h.
 *
 * Each node has its component, its children and its cutpoint. If any test is oblique each also has
 * a slope and another component; a slope of 0 adds 0 to a component and so leaves its value as it
 * is. */
#include "rlvc/float_rules.h"

#include "export_thresholds.h"

#define A_LINE 6u /* numbers */

static rlvc_threshold feature_of(const rlvc_compact *c, uint32_t node) {
    return rlvc_thresholds_feature(rlvc_compact_feature(c, node));
}

void rlvc_export_thresholds_comment(rlvc_compact *c, const rlvc_domain *domain) {
    const rlvc_thresholds *t = (const rlvc_thresholds *)domain->ctx;
    uint32_t node = 0;
    rlvc_compact_number(c, " * A percept x is ", t->components);
    rlvc_compact_string(c, " float. To be compiled with -ffp-contract=off.\n *\n");
    do {
        rlvc_compact_line(c, node);
        if (rlvc_compact_is_mixed(c, node)) {
            char name[RLVC_NAME_BYTES];
            if (domain->name(domain->ctx, rlvc_compact_feature(c, node), name, sizeof name) != 0)
                c->text.status = RLVC_E_CALLBACK;
            else
                rlvc_compact_string(c, name);
        }
        rlvc_compact_string(c, "\n");
        node = rlvc_compact_next(c, node);
    } while (node != 0);
}

/* What the nodes have. */
typedef struct contents {
    uint32_t highest; /* number of a component */
    int oblique;      /* is any test? */
} contents;

static contents look_over(const rlvc_compact *c) {
    contents all = {0, 0};
    uint32_t node = 0;
    do {
        const rlvc_threshold feature = feature_of(c, node);
        all.oblique |= feature.slope != 0.0f;
        all.highest = feature.component > all.highest ? feature.component : all.highest;
        all.highest = feature.other > all.highest ? feature.other : all.highest;
        node = rlvc_compact_next_mixed(c, node);
    } while (node != 0);
    return all;
}

static void open_table(rlvc_compact *c, const char *type, const char *what) {
    rlvc_compact_string(c, "static const ");
    rlvc_compact_name(c, type, what);
    rlvc_compact_number(c, "[", c->mixed);
}

static void put_nodes(rlvc_compact *c, const char *type) {
    uint32_t node = 0, i = 0;
    open_table(c, type, "_node");
    rlvc_compact_string(c,
                        "][3] = { /* component, then which if it is not above, which if above */");
    do {
        rlvc_compact_entry(c, node, i++, feature_of(c, node).component);
        node = rlvc_compact_next_mixed(c, node);
    } while (node != 0);
    rlvc_compact_string(c, "};\n");
}

enum { CUTPOINT, SLOPE, OTHER };

static void put_column(rlvc_compact *c, const char *type, const char *what, int column) {
    uint32_t node = 0, i = 0;
    open_table(c, type, what);
    rlvc_compact_string(c, "] = {");
    do {
        const rlvc_threshold feature = feature_of(c, node);
        rlvc_compact_string(c, i == 0 ? "\n    " : i % A_LINE ? ", " : ",\n    ");
        if (column == OTHER)
            rlvc_compact_number(c, "", feature.other);
        else
            rlvc_compact_float(c, column == SLOPE ? feature.slope : feature.cutpoint);
        i++;
        node = rlvc_compact_next_mixed(c, node);
    } while (node != 0);
    rlvc_compact_string(c, "};\n");
}

static void put_act(rlvc_compact *c, int oblique) {
    rlvc_compact_name(c, "\nstatic inline unsigned ",
                      "_act(const float *x) {\n    unsigned at = 0;\n    do {\n");
    rlvc_compact_name(c, "        const float value = x[", "_node[at][0]]");
    if (oblique) {
        rlvc_compact_name(c, " + ", "_slope[at] * x[");
        rlvc_compact_name(c, "", "_other[at]]");
    }
    rlvc_compact_name(c, ";\n        at = ", "_node[at][1u + (value > ");
    rlvc_compact_name(c, "", "_cutpoint[at])];\n    } while (at < ");
    rlvc_compact_number(c, "", c->mixed);
    rlvc_compact_number(c, "u);\n    return at - ", c->mixed);
    rlvc_compact_string(c, "u;\n}\n");
}

uint32_t rlvc_export_thresholds(rlvc_compact *c) {
    if (c->mixed == 0) {
        rlvc_compact_constant(c, "const float *percept");
        return 0;
    }
    const contents all = look_over(c);
    const int bytes = rlvc_compact_fits_bytes(c) && all.highest < 256u;
    const char *type = bytes ? "unsigned char " : "unsigned ";
    const uint32_t width = bytes ? 1u : 4u;
    put_nodes(c, type);
    put_column(c, "float ", "_cutpoint", CUTPOINT);
    if (all.oblique) {
        put_column(c, "float ", "_slope", SLOPE);
        put_column(c, type, "_other", OTHER);
    }
    put_act(c, all.oblique);
    return c->mixed * (3u * width + 4u + (all.oblique ? 4u + width : 0));
}
