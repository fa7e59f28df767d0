/* SPDX-License-Identifier: MIT */
/* A policy on pairs of descriptors as C. The functions are the text of domains/vectors.c and
 * nearest.c, with the sizes put in. */
#include "rlvc/float_rules.h"

#include "export_spatial.h"

#include "export_descriptors.h"

static uint32_t places_at(const rlvc_descriptors *d) {
    return RLVC_DESCRIPTORS_PERCEPT_BYTES(d->points, d->dimensions, d->form);
}

void rlvc_export_spatial_comment(rlvc_compact *c, const rlvc_spatial *spatial) {
    const rlvc_descriptors *d = &spatial->vectors;
    rlvc_compact_number(c, " * from byte ", places_at(d));
    rlvc_compact_string(c, " on, int16_t x, y of each vector's point");
    if (spatial->directed) {
        rlvc_compact_number(c, "; from byte ", places_at(d) + 4u * d->points);
        rlvc_compact_string(c, " on, int8_t c, s, its direction");
    }
    rlvc_compact_string(c, ";\n");
}

/* Coordinate i of the places, low byte first. */
static void put_coordinate(rlvc_compact *c) {
    rlvc_compact_name(c, "static inline int32_t ",
                      "_coordinate(const unsigned char *places, uint32_t i) {\n"
                      "    const uint32_t bits = (uint32_t)places[2u * i] | "
                      "(uint32_t)places[2u * i + 1u] << 8;\n"
                      "    return (int32_t)(bits ^ 0x8000u) - 0x8000;\n"
                      "}\n\n");
}

/* How far point j is from where a feature has it beside point i, squared and scaled. */
static void put_misplacement(rlvc_compact *c, const rlvc_spatial *spatial) {
    rlvc_compact_name(c, "static inline float ",
                      "_misplacement(const unsigned char *places, uint32_t i, uint32_t j,\n"
                      "        unsigned feature) {\n    const float *wanted = ");
    rlvc_compact_name(c, "", "_place[feature];\n");
    rlvc_compact_name(c, "    float x = (float)(", "_coordinate(places, 2u * j)");
    rlvc_compact_name(c, " - ", "_coordinate(places, 2u * i));\n");
    rlvc_compact_name(c, "    float y = (float)(", "_coordinate(places, 2u * j + 1u)");
    rlvc_compact_name(c, " - ", "_coordinate(places, 2u * i + 1u));\n");
    if (spatial->directed) {
        rlvc_compact_number(c,
                            "    {\n"
                            "        const int8_t *direction = (const int8_t *)places + ",
                            4u * spatial->vectors.points);
        rlvc_compact_string(c, "u + 2u * i;\n"
                               "        const float along = (float)direction[0] / 127.0f;\n"
                               "        const float across = (float)direction[1] / 127.0f;\n"
                               "        const float turned = x * along + y * across;\n"
                               "        y = y * along - x * across;\n"
                               "        x = turned;\n"
                               "    }\n");
    }
    rlvc_compact_string(c, "    x = x - wanted[1];\n"
                           "    y = y - wanted[2];\n"
                           "    return (x * x + y * y) * wanted[0];\n"
                           "}\n\n");
}

static void put_completed(rlvc_compact *c, const rlvc_descriptors *d) {
    const char *type = rlvc_export_descriptors_type(d);
    rlvc_compact_name(c, "static inline unsigned ",
                      "_completed(const void *percept, unsigned feature, uint32_t i,\n"
                      "        uint32_t count, float limit) {\n    const ");
    rlvc_compact_string(c, type);
    rlvc_compact_string(c, " *vector = (const ");
    rlvc_compact_string(c, type);
    rlvc_compact_number(c,
                        " *)((const unsigned char *)percept + 4);\n"
                        "    const unsigned char *places = (const unsigned char *)percept + ",
                        places_at(d));
    rlvc_compact_name(c, ";\n    uint32_t j;\n    if (!(",
                      "_place[feature][0] > 0.0f))\n"
                      "        return 1u;\n"
                      "    for (j = 0; j < count; j++)\n");
    rlvc_compact_name(c, "        if (j != i && ",
                      "_misplacement(places, i, j, feature) <= limit &&\n");
    rlvc_compact_name(c, "            ", "_between(vector + j * ");
    rlvc_compact_number(c, "", d->dimensions);
    rlvc_compact_name(c, "u, ",
                      "_second[feature], limit) <= limit)\n"
                      "            return 1u;\n"
                      "    return 0;\n"
                      "}\n\n");
}

uint32_t rlvc_export_spatial(rlvc_compact *c, const rlvc_spatial *spatial, uint32_t features) {
    const rlvc_descriptors *d = &spatial->vectors;
    rlvc_compact_name(c, "static const float ", "_place");
    rlvc_compact_number(c, "[", features);
    rlvc_compact_string(c, "][3] = { /* scale (0: a single vector), displacement x, y */");
    rlvc_export_descriptors_column(c, d, RLVC_EXPORT_PLACE);
    rlvc_export_descriptors_table(c, d, "_second", features);
    rlvc_export_descriptors_column(c, d, RLVC_EXPORT_SECOND);
    put_coordinate(c);
    put_misplacement(c, spatial);
    put_completed(c, d);
    return features * (12u + RLVC_DESCRIPTORS_VECTOR_BYTES(d->dimensions, d->form));
}
