/* SPDX-License-Identifier: MIT */
/* A policy on descriptors, or on pairs of them, as C: see rlvc/export.h.
 *
 * A feature is written once, however many nodes test it: it belongs to the first of them in
 * pre-order, and is numbered by the order of these. The detector that is written is the text of
 * domains/nearest.c with the number of dimensions put in, so that the same numbers are added in the
 * same order. What is of pairs alone is in export_spatial.c, and of bags in export_bags.c. */
#include "rlvc/float_rules.h"

#include "export_descriptors.h"

#include "export_spatial.h"
#include "rlvc/bags.h"

#include <string.h>

#define A_LINE 8u /* numbers of a vector */

const char *rlvc_export_descriptors_type(const rlvc_descriptors *d) {
    return d->form == RLVC_DESCRIPTORS_INT8 ? "int8_t" : "float";
}

/* ------------------------------------------------------------------ features */

/* The first mixed node that tests the same feature, radius and all. */
static uint32_t first_alike(const rlvc_compact *c, uint32_t node) {
    uint32_t at = 0;
    while (memcmp(rlvc_compact_feature(c, at), rlvc_compact_feature(c, node),
                  c->tree->feature_bytes) != 0)
        at = rlvc_compact_next_mixed(c, at);
    return at;
}

/* The number of a node's feature, where `distinct` features belong to nodes before it. */
static uint32_t feature_number(const rlvc_compact *c, uint32_t node, uint32_t distinct) {
    const uint32_t first = first_alike(c, node);
    if (first == node)
        return distinct;
    uint32_t number = 0;
    for (uint32_t at = 0; at != first; at = rlvc_compact_next_mixed(c, at))
        number += (uint32_t)(first_alike(c, at) == at);
    return number;
}

void rlvc_export_descriptors_comment(rlvc_compact *c, const rlvc_descriptors *d,
                                     const rlvc_spatial *spatial) {
    uint32_t node = 0, distinct = 0;
    rlvc_compact_number(c, " * A percept is a uint32_t, the number of its vectors, at most ",
                        d->points);
    rlvc_compact_number(c, ", and these, of ", d->dimensions);
    rlvc_compact_string(c, " ");
    rlvc_compact_string(c, rlvc_export_descriptors_type(d));
    rlvc_compact_string(c, " each;\n");
    if (spatial != NULL)
        rlvc_export_spatial_comment(c, spatial);
    rlvc_compact_string(c, " * it lies at a multiple of 4. To be compiled with "
                           "-ffp-contract=off.\n *\n");
    do {
        rlvc_compact_line(c, node);
        if (rlvc_compact_is_mixed(c, node)) {
            const uint32_t number = feature_number(c, node, distinct);
            distinct += (uint32_t)(number == distinct);
            rlvc_compact_number(c, "feature ", number);
        }
        rlvc_compact_string(c, "\n");
        node = rlvc_compact_next(c, node);
    } while (node != 0);
}

/* ------------------------------------------------------------------ tables */

static void put_byte(rlvc_compact *c, int8_t number) {
    rlvc_compact_number(c, number < 0 ? "-" : "", (uint32_t)(number < 0 ? -number : number));
}

static void put_vector(rlvc_compact *c, const rlvc_descriptors *d, const unsigned char *vector) {
    for (uint32_t k = 0; k < d->dimensions; k++) {
        rlvc_compact_string(c, k % A_LINE ? ", " : k ? ",\n     " : "");
        if (d->form == RLVC_DESCRIPTORS_INT8)
            put_byte(c, ((const int8_t *)vector)[k]);
        else {
            float number;
            memcpy(&number, vector + k * sizeof number, sizeof number);
            rlvc_compact_float(c, number);
        }
    }
}

static void put_place(rlvc_compact *c, const unsigned char *feature) {
    float number[3];
    memcpy(number, feature + 4u, sizeof number);
    for (uint32_t k = 0; k < 3u; k++) {
        rlvc_compact_string(c, k ? ", " : "");
        rlvc_compact_float(c, number[k]);
    }
}

/* The vectors of a bag; C fills the rest of the entry with zeros. An empty bag, which no agent
 * learns but a snapshot may hold, has one, as C99 has no empty braces. */
static void put_bag(rlvc_compact *c, const rlvc_descriptors *d, const unsigned char *feature) {
    const uint32_t bytes = RLVC_DESCRIPTORS_VECTOR_BYTES(d->dimensions, d->form);
    uint32_t i = 0;
    do {
        rlvc_compact_string(c, i ? ",\n     {" : "{");
        put_vector(c, d, feature + 8u + (size_t)i * bytes);
        rlvc_compact_string(c, "}");
    } while (++i < rlvc_bags_count(feature));
}

static void put_entry(rlvc_compact *c, const rlvc_descriptors *d, const unsigned char *feature,
                      rlvc_export_column column) {
    const uint32_t bytes = RLVC_DESCRIPTORS_VECTOR_BYTES(d->dimensions, d->form);
    if (column == RLVC_EXPORT_RADIUS || column == RLVC_EXPORT_NEEDED) {
        rlvc_compact_float(c, rlvc_descriptors_radius(feature)); /* both come first */
        return;
    }
    if (column == RLVC_EXPORT_COUNT) {
        rlvc_compact_number(c, "", rlvc_bags_count(feature));
        return;
    }
    rlvc_compact_string(c, "{");
    if (column == RLVC_EXPORT_PLACE)
        put_place(c, feature);
    else if (column == RLVC_EXPORT_BAG)
        put_bag(c, d, feature);
    else
        put_vector(c, d,
                   feature + (column == RLVC_EXPORT_VECTOR  ? 4u
                              : column == RLVC_EXPORT_FIRST ? 16u
                                                            : 16u + bytes));
    rlvc_compact_string(c, "}");
}

void rlvc_export_descriptors_column(rlvc_compact *c, const rlvc_descriptors *d,
                                    rlvc_export_column column) {
    uint32_t node = 0;
    do {
        if (first_alike(c, node) == node) {
            rlvc_compact_string(c, node ? ",\n    " : "\n    ");
            put_entry(c, d, (const unsigned char *)rlvc_compact_feature(c, node), column);
        }
        node = rlvc_compact_next_mixed(c, node);
    } while (node != 0);
    rlvc_compact_string(c, "};\n\n");
}

void rlvc_export_descriptors_table(rlvc_compact *c, const rlvc_descriptors *d, const char *behind,
                                   uint32_t features) {
    rlvc_compact_string(c, "static const ");
    rlvc_compact_string(c, rlvc_export_descriptors_type(d));
    rlvc_compact_name(c, " ", behind);
    rlvc_compact_number(c, "[", features);
    rlvc_compact_number(c, "][", d->dimensions);
    rlvc_compact_string(c, "] = {");
}

uint32_t rlvc_export_descriptors_nodes(rlvc_compact *c, uint32_t *bytes) {
    uint32_t node = 0, i = 0, distinct = 0;
    rlvc_compact_string(c, "#include <stdint.h>\n\n");
    rlvc_compact_name(
        c, rlvc_compact_fits_bytes(c) ? "static const unsigned char " : "static const unsigned ",
        "_node");
    rlvc_compact_number(c, "[", c->mixed);
    rlvc_compact_string(c, "][3] = { /* feature, then which if it is absent, which if present */");
    do {
        const uint32_t number = feature_number(c, node, distinct);
        distinct += (uint32_t)(number == distinct);
        rlvc_compact_entry(c, node, i++, number);
        node = rlvc_compact_next_mixed(c, node);
    } while (node != 0);
    rlvc_compact_string(c, "};\n\n");
    *bytes += c->mixed * (rlvc_compact_fits_bytes(c) ? 3u : 12u);
    return distinct;
}

static void put_tables(rlvc_compact *c, const rlvc_descriptors *d, uint32_t features,
                       rlvc_export_column vector) {
    rlvc_compact_name(c, "static const float ", "_radius");
    rlvc_compact_number(c, "[", features);
    rlvc_compact_string(c, "] = {");
    rlvc_export_descriptors_column(c, d, RLVC_EXPORT_RADIUS);
    rlvc_export_descriptors_table(c, d, "_vector", features);
    rlvc_export_descriptors_column(c, d, vector);
}

/* ------------------------------------------------------------------ functions */

/* Floats are added in lanes, eight at a time. */
void rlvc_export_descriptors_between(rlvc_compact *c, const rlvc_descriptors *d) {
    const int bytes = d->form == RLVC_DESCRIPTORS_INT8;
    const char *number = bytes ? "int32_t" : "float";
    rlvc_compact_name(c, "static inline float ", "_between(const ");
    rlvc_compact_string(c, rlvc_export_descriptors_type(d));
    rlvc_compact_string(c, " *a, const ");
    rlvc_compact_string(c, rlvc_export_descriptors_type(d));
    rlvc_compact_string(c, " *b, float limit) {\n    ");
    rlvc_compact_string(c, bytes ? "int32_t sum = 0" : "float lane[8] = {0.0f}, sum = 0.0f");
    rlvc_compact_number(c, ";\n    uint32_t i, k;\n    for (i = 0; i < ", d->dimensions);
    rlvc_compact_number(c,
                        "u && !((float)sum > limit); i += k) {\n"
                        "        for (k = 0; k < 32u && i + k < ",
                        d->dimensions);
    rlvc_compact_string(c, "u; k++) {\n            const ");
    rlvc_compact_string(c, number);
    rlvc_compact_string(c, " difference = (");
    rlvc_compact_string(c, number);
    rlvc_compact_string(c, ")a[i + k] - b[i + k];\n            ");
    rlvc_compact_string(c, bytes ? "sum" : "lane[k % 8u]");
    rlvc_compact_string(c, " += difference * difference;\n        }\n");
    rlvc_compact_string(c, bytes ? ""
                                 : "        sum = ((lane[0] + lane[4]) + (lane[2] + lane[6])) +\n"
                                   "              ((lane[1] + lane[5]) + (lane[3] + lane[7]));\n");
    rlvc_compact_string(c, "    }\n    return (float)sum;\n}\n\n");
}

void rlvc_export_descriptors_percept(rlvc_compact *c, const rlvc_descriptors *d) {
    rlvc_compact_string(c, "    const ");
    rlvc_compact_string(c, rlvc_export_descriptors_type(d));
    rlvc_compact_string(c, " *vector = (const ");
    rlvc_compact_string(c, rlvc_export_descriptors_type(d));
    rlvc_compact_string(c, " *)((const unsigned char *)percept + 4);\n"
                           "    uint32_t count, i;\n"
                           "    for (i = 0; i < 4u; i++)\n"
                           "        ((unsigned char *)&count)[i] = "
                           "((const unsigned char *)percept)[i];\n");
}

/* Whether a percept exhibits a feature. */
static void put_present(rlvc_compact *c, const rlvc_descriptors *d, const rlvc_spatial *spatial) {
    rlvc_compact_name(
        c, "static inline unsigned ",
        "_present(const void *percept, unsigned feature) {\n    const float radius = ");
    rlvc_compact_name(c, "", "_radius[feature], limit = radius * radius;\n");
    rlvc_export_descriptors_percept(c, d);
    rlvc_compact_string(c, "    for (i = 0; radius >= 0.0f && i < count; i++)\n");
    rlvc_compact_name(c, "        if (", "_between(vector + i * ");
    rlvc_compact_number(c, "", d->dimensions);
    rlvc_compact_name(c, "u, ", "_vector[feature], limit) <= limit");
    if (spatial != NULL)
        rlvc_compact_name(c, " &&\n            ", "_completed(percept, feature, i, count, limit)");
    rlvc_compact_string(c, ")\n            return 1u;\n    return 0;\n}\n\n");
}

void rlvc_export_descriptors_act(rlvc_compact *c) {
    rlvc_compact_name(c, "static inline unsigned ",
                      "_act(const void *percept) {\n    unsigned at = 0;\n    do\n        at = ");
    rlvc_compact_name(c, "", "_node[at][1u + ");
    rlvc_compact_name(c, "", "_present(percept, ");
    rlvc_compact_name(c, "", "_node[at][0])];\n    while (at < ");
    rlvc_compact_number(c, "", c->mixed);
    rlvc_compact_number(c, "u);\n    return at - ", c->mixed);
    rlvc_compact_string(c, "u;\n}\n");
}

uint32_t rlvc_export_descriptors(rlvc_compact *c, const rlvc_descriptors *d,
                                 const rlvc_spatial *spatial) {
    if (c->mixed == 0) {
        rlvc_compact_constant(c, "const void *percept");
        return 0;
    }
    uint32_t bytes = 0;
    const uint32_t features = rlvc_export_descriptors_nodes(c, &bytes);
    bytes += features * (4u + RLVC_DESCRIPTORS_VECTOR_BYTES(d->dimensions, d->form));
    put_tables(c, d, features, spatial != NULL ? RLVC_EXPORT_FIRST : RLVC_EXPORT_VECTOR);
    rlvc_export_descriptors_between(c, d);
    if (spatial != NULL)
        bytes += rlvc_export_spatial(c, spatial, features);
    put_present(c, d, spatial);
    rlvc_export_descriptors_act(c);
    return bytes;
}
