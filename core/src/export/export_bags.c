/* SPDX-License-Identifier: MIT */
/* A policy on bags of vectors as C. The functions are the text of domains/bag.c and nearest.c:
 * the vectors of a bag score in the order of its record, until it is enough. */
#include "rlvc/float_rules.h"

#include "export_bags.h"

#include "export_descriptors.h"

/* What a percept scores by a vector. */
static void put_likeness(rlvc_compact *c, const rlvc_descriptors *d) {
    const float limit = d->radius * d->radius;
    rlvc_compact_name(c, "static inline float ", "_likeness(const void *percept, const ");
    rlvc_compact_string(c, rlvc_export_descriptors_type(d));
    rlvc_compact_string(c, " *wanted) {\n");
    rlvc_export_descriptors_percept(c, d);
    rlvc_compact_string(c, "    float least = ");
    rlvc_compact_float(c, limit);
    rlvc_compact_name(c, ";\n    for (i = 0; i < count; i++) {\n        const float squared = ",
                      "_between(vector + i * ");
    rlvc_compact_number(c, "", d->dimensions);
    rlvc_compact_string(c, "u, wanted, least);\n"
                           "        if (squared < least)\n"
                           "            least = squared;\n"
                           "    }\n"
                           "    return ");
    rlvc_compact_float(c, limit);
    rlvc_compact_string(c, " - least;\n}\n\n");
}

/* Whether a percept exhibits a feature. */
static void put_present(rlvc_compact *c) {
    rlvc_compact_name(c, "static inline unsigned ",
                      "_present(const void *percept, unsigned feature) {\n"
                      "    const float needed = ");
    rlvc_compact_name(c, "", "_needed[feature];\n    float score = 0.0f;\n    unsigned i;\n");
    rlvc_compact_name(c, "    for (i = 0; i < ", "_count[feature] && score < needed; i++)\n");
    rlvc_compact_name(c, "        score += ", "_likeness(percept, ");
    rlvc_compact_name(c, "",
                      "_vector[feature][i]);\n"
                      "    return score >= needed && needed >= 0.0f;\n"
                      "}\n\n");
}

static void put_tables(rlvc_compact *c, const rlvc_bags *bags, uint32_t features) {
    rlvc_compact_name(c, "static const float ", "_needed[");
    rlvc_compact_number(c, "", features);
    rlvc_compact_string(c, "] = {");
    rlvc_export_descriptors_column(c, &bags->vectors, RLVC_EXPORT_NEEDED);
    rlvc_compact_name(c, "static const unsigned char ", "_count[");
    rlvc_compact_number(c, "", features);
    rlvc_compact_string(c, "] = {");
    rlvc_export_descriptors_column(c, &bags->vectors, RLVC_EXPORT_COUNT);
    rlvc_compact_string(c, "static const ");
    rlvc_compact_string(c, rlvc_export_descriptors_type(&bags->vectors));
    rlvc_compact_name(c, " ", "_vector[");
    rlvc_compact_number(c, "", features);
    rlvc_compact_number(c, "][", bags->size);
    rlvc_compact_number(c, "][", bags->vectors.dimensions);
    rlvc_compact_string(c, "] = {");
    rlvc_export_descriptors_column(c, &bags->vectors, RLVC_EXPORT_BAG);
}

uint32_t rlvc_export_bags(rlvc_compact *c, const rlvc_bags *bags) {
    const rlvc_descriptors *d = &bags->vectors;
    uint32_t bytes = 0;
    if (c->mixed == 0) {
        rlvc_compact_constant(c, "const void *percept");
        return 0;
    }
    const uint32_t features = rlvc_export_descriptors_nodes(c, &bytes);
    put_tables(c, bags, features);
    rlvc_export_descriptors_between(c, d);
    put_likeness(c, d);
    put_present(c);
    rlvc_export_descriptors_act(c);
    return bytes +
           features * (5u + bags->size * RLVC_DESCRIPTORS_VECTOR_BYTES(d->dimensions, d->form));
}
