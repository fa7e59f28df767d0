/* SPDX-License-Identifier: MIT */
/* Proves the exported policies equal to the agents that they were exported from. Of bits, on every
 * percept if there are no more than RLVC_EXPORT_BITS, else on so many random ones, of which the
 * first fall on a path to each leaf of the tree (many, the other bits being random). Of others, on
 * RLVC_EXPORT_REALS. Of these, of descriptors, half have a vector whose distance from a feature is
 * its radius up to a few roundings, and of pairs half have one in place or nearly; of bags, half
 * score what a feature needs up to a few roundings; of thresholds, half lie on a cutpoint up to a
 * few roundings. And an agent that learnt the same exports the same, to the letter. With
 * RLVC_EXPORT_LOADS the cases that take long are not learnt but loaded. */
#include "bags.h"
#include "bytes.h"
#include "cases.h"
#include "floats.h"
#include "int8s.h"
#include "many.h"
#include "maze.h"
#include "pairs.h"
#include "parts.h"
#include "reals.h"
#include "single.h"
#include "slants.h"
#include "turned.h"
#include "wide.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define BYTES_MAX (RLVC_BITS_PERCEPT_BYTES(300) + 2u) /* whole words */

static uint64_t state = 1;

static unsigned exported(uint32_t i, const unsigned char *percept) {
    switch (i) {
    case 0:
        return maze_act(percept);
    case 1:
        return single_act(percept);
    case 2:
        return bytes_act(percept);
    case 3:
        return wide_act(percept);
    case 4:
        return many_act(percept);
    case 5:
        return floats_act(percept);
    case 6:
        return int8s_act(percept);
    case 7:
        return pairs_act(percept);
    case 8:
        return turned_act(percept);
    case 11:
        return bags_act(percept);
    default:
        return parts_act(percept);
    }
}

static unsigned exported_of_numbers(uint32_t i, const float *x) {
    return i == 9 ? reals_act(x) : slants_act(x);
}

/* 1 if both act alike. */
static int same(const learnt *made, uint32_t i, const unsigned char *percept) {
    uint32_t action = UINT32_MAX;
    if (rlvc_predict(made->agent, percept, NULL, &action) == RLVC_OK &&
        action == exported(i, percept))
        return 1;
    const uint32_t bytes = made->bits > 0 ? RLVC_BITS_PERCEPT_BYTES(made->bits) : sizeof(vectors);
    printf("  percept");
    for (uint32_t byte = 0; byte < bytes; byte++)
        printf(" %02x", percept[byte]);
    printf(": the agent does %u, its export %u\n", (unsigned)action, exported(i, percept));
    return 0;
}

static int check_all(const learnt *made, uint32_t i) {
    unsigned char percept[BYTES_MAX];
    for (uint32_t value = 0; value < 1u << made->bits; value++) {
        for (uint32_t byte = 0; byte < 3; byte++)
            percept[byte] = (unsigned char)(value >> 8u * byte);
        if (!same(made, i, percept))
            return 0;
    }
    return 1;
}

/* Sets a random percept's bits so that it falls into a class: split by split back through the
 * history of the tree (agent.h). */
static void lead_to(const learnt *made, uint32_t class_id, uint32_t classes,
                    unsigned char *percept) {
    for (uint32_t j = classes - 1u; j-- > 0;) {
        rlvc_split split;
        unsigned char feature[RLVC_BITS_FEATURE_BYTES];
        if (rlvc_split_at(made->agent, j, &split, feature) != RLVC_OK)
            return;
        int present = class_id == j + 1u;
        if (!present && class_id != split.class_id)
            continue;
        uint32_t bit = rlvc_bits_feature(feature);
        unsigned char mask = (unsigned char)(1u << bit % 8u);
        if (present)
            percept[bit / 8u] = (unsigned char)(percept[bit / 8u] | mask);
        else
            percept[bit / 8u] = (unsigned char)(percept[bit / 8u] & ~mask);
        class_id = split.class_id;
    }
}

static int check_some(const learnt *made, uint32_t i) {
    unsigned char percept[BYTES_MAX];
    rlvc_statistics statistics;
    if (rlvc_stats(made->agent, &statistics) != RLVC_OK)
        return 0;
    for (uint32_t n = 0; n < RLVC_EXPORT_BITS; n++) {
        for (uint32_t byte = 0; byte < RLVC_BITS_PERCEPT_BYTES(made->bits); byte += 4u) {
            const uint32_t four = draw(&state);
            memcpy(percept + byte, &four, sizeof four);
        }
        if (n < 100u * statistics.classes) {
            uint32_t wanted = n % statistics.classes, found = UINT32_MAX;
            lead_to(made, wanted, statistics.classes, percept);
            if (rlvc_predict(made->agent, percept, &found, NULL) != RLVC_OK || found != wanted) {
                printf("  a percept for class %u fell into %u\n", (unsigned)wanted,
                       (unsigned)found);
                return 0;
            }
        }
        if (!same(made, i, percept))
            return 0;
    }
    return 1;
}

/* Gives a percept the two vectors of a feature, so far apart as it says up to a little more than it
 * allows. */
static void put_pair(const learnt *made, uint32_t split_number, vectors *percept) {
    const uint32_t form = made->descriptors->form;
    const uint32_t bytes = RLVC_DESCRIPTORS_VECTOR_BYTES(DIMENSIONS, form);
    rlvc_split split;
    vectors feature;
    int16_t place[2];
    float apart[2];
    if (rlvc_split_at(made->agent, split_number, &split, &feature) != RLVC_OK ||
        !rlvc_spatial_is_pair(made->spatial, &feature))
        return;
    percept->count = POINTS;
    for (uint32_t k = 0; k < DIMENSIONS; k++) {
        set_number(percept->bytes, form, k, get_number(feature.bytes + 12u, form, k));
        set_number(percept->bytes, form, DIMENSIONS + k,
                   get_number(feature.bytes + 12u + bytes, form, k));
    }
    memcpy(apart, feature.bytes + 8u, sizeof apart);
    get_place(made->spatial, percept, 0, place);
    for (uint32_t k = 0; k < 2u; k++)
        place[k] = (int16_t)(place[k] + (int)apart[k] + (int)(draw(&state) % 61u) - 30);
    set_place(made->spatial, percept, 1, place);
}

/* Puts the first vector of a percept just so far from that of a feature as its radius reaches: each
 * number is off by radius / 6, and there are 36. */
static void put_at_edge(const learnt *made, uint32_t split_number, vectors *percept) {
    const uint32_t form = made->descriptors->form;
    rlvc_split split;
    vectors feature;
    if (rlvc_split_at(made->agent, split_number, &split, &feature) != RLVC_OK)
        return;
    const float radius = rlvc_descriptors_radius(&feature);
    const uint32_t skip = made->spatial ? 12u : 0; /* scale and displacement */
    percept->count = 1u + percept->count % POINTS;
    for (uint32_t k = 0; k < DIMENSIONS; k++) {
        const float roundings = (float)(draw(&state) % 33u) - 16.0f;
        const float off = radius / 6.0f * (1.0f + 1.2e-7f * roundings);
        set_number(percept->bytes, form, k,
                   get_number(feature.bytes + skip, form, k) + (draw(&state) % 2u ? off : -off));
    }
}

/* Gives a percept so many vectors of a bag that one more is too much, and one so far from the next
 * vector that together they score what is needed. If that takes more than POINTS, changes nothing.
 */
static void put_enough(const learnt *made, uint32_t split_number, vectors *percept) {
    const uint32_t form = made->descriptors->form;
    const float most = made->descriptors->radius * made->descriptors->radius;
    rlvc_split split;
    vectors feature;
    if (rlvc_split_at(made->agent, split_number, &split, &feature) != RLVC_OK)
        return;
    const float needed = rlvc_bags_needed(&feature);
    const uint32_t whole = (uint32_t)(needed / most), count = rlvc_bags_count(&feature);
    if (whole >= POINTS || whole >= count)
        return;
    const float roundings = 1.2e-7f * ((float)(draw(&state) % 33u) - 16.0f);
    const float off =
        sqrtf((most - (needed - most * (float)whole)) / DIMENSIONS) * (1.0f + roundings);
    const uint32_t first = draw(&state) % count;
    percept->count = whole + 1u;
    for (uint32_t k = 0; k < (whole + 1u) * DIMENSIONS; k++) {
        const uint32_t from = (first * DIMENSIONS + k) % (count * DIMENSIONS);
        const float number = get_number(feature.bag + 4u, form, from);
        set_number(percept->bytes, form, k,
                   k / DIMENSIONS < whole ? number : number + (draw(&state) % 2u ? off : -off));
    }
}

static int all_reached(const uint32_t *reached, uint32_t classes) {
    for (uint32_t c = 0; c < classes; c++)
        if (reached[c] == 0) {
            printf("  no percept fell into class %u\n", (unsigned)c);
            return 0;
        }
    return 1;
}

static int check_vectors(const learnt *made, uint32_t i) {
    uint32_t reached[400] = {0};
    rlvc_statistics statistics;
    if (rlvc_stats(made->agent, &statistics) != RLVC_OK || statistics.classes < 4)
        return 0;
    for (uint32_t n = 0; n < RLVC_EXPORT_REALS; n++) {
        vectors percept;
        uint32_t class_id = 0;
        memset(&percept, 0, sizeof percept);
        draw_vectors(&state, made->descriptors->form, &percept);
        if (made->spatial)
            draw_places(&state, made->spatial, &percept);
        if (n % 2u && made->bags)
            put_enough(made, draw(&state) % (statistics.classes - 1u), &percept);
        else if (n % 2u)
            put_at_edge(made, draw(&state) % (statistics.classes - 1u), &percept);
        if (made->spatial && n % 4u > 1u)
            put_pair(made, draw(&state) % (statistics.classes - 1u), &percept);
        if (!same(made, i, percept.bytes) ||
            rlvc_predict(made->agent, &percept, &class_id, NULL) != RLVC_OK)
            return 0;
        reached[class_id]++;
    }
    return all_reached(reached, statistics.classes);
}

/* Puts a percept on the cutpoint of a split, or beside it. */
static void put_on_cutpoint(const learnt *made, uint32_t split_number, float *x) {
    rlvc_split split;
    unsigned char record[RLVC_THRESHOLDS_FEATURE_BYTES];
    if (rlvc_split_at(made->agent, split_number, &split, record) != RLVC_OK)
        return;
    const rlvc_threshold feature = rlvc_thresholds_feature(record);
    const float roundings = (float)(draw(&state) % 17u) - 8.0f;
    const float rest = feature.slope * x[feature.other];
    if (feature.slope == 0.0f)
        x[feature.component] = feature.cutpoint * (1.0f + 1.2e-7f * roundings);
    else
        x[feature.component] = (feature.cutpoint - rest) * (1.0f + 1.2e-7f * roundings);
}

static int check_numbers(const learnt *made, uint32_t i) {
    uint32_t reached[400] = {0};
    rlvc_statistics statistics;
    if (rlvc_stats(made->agent, &statistics) != RLVC_OK || statistics.classes < 4)
        return 0;
    for (uint32_t n = 0; n < RLVC_EXPORT_REALS; n++) {
        float x[COMPONENTS];
        uint32_t class_id = 0, action = 0;
        draw_numbers(&state, x);
        if (n % 2u)
            put_on_cutpoint(made, draw(&state) % (statistics.classes - 1u), x);
        if (rlvc_predict(made->agent, x, &class_id, &action) != RLVC_OK ||
            action != exported_of_numbers(i, x)) {
            printf("  percept %.9g %.9g %.9g: the agent does %u, its export %u\n", (double)x[0],
                   (double)x[1], (double)x[2], (unsigned)action, exported_of_numbers(i, x));
            return 0;
        }
        reached[class_id]++;
    }
    return all_reached(reached, statistics.classes);
}

/* Compares what is written with a file as it goes. */
static int compare(void *file, const char *text, size_t bytes) {
    for (size_t i = 0; i < bytes; i++) {
        if (fgetc(file) != (unsigned char)text[i])
            return 1;
    }
    return 0;
}

static FILE *open_beside(const char *name, const char *ending) {
    char path[1024];
    snprintf(path, sizeof path, "%s/%s%s", RLVC_EXPORT_DIR, name, ending);
    FILE *file = fopen(path, "rb");
    if (!file)
        perror(path);
    return file;
}

static int exports_the_same(const learnt *made, const char *name) {
    FILE *file = open_beside(name, ".h");
    if (!file)
        return 0;
    rlvc_status status = rlvc_export_c(made->agent, name, compare, file, NULL);
    int same_length = fgetc(file) == EOF;
    fclose(file);
    return status == RLVC_OK && same_length;
}

/* Learns a case, or loads it. */
static learnt get_case(uint32_t i, const char *name) {
    if (!RLVC_EXPORT_LOADS || !takes_long(i))
        return make_case(i, NULL);
    FILE *file = open_beside(name, ".h.rlvc");
    if (!file)
        exit(2);
    learnt made = make_case(i, file);
    fclose(file);
    return made;
}

int main(void) {
    static const char *const names[CASES] = CASE_NAMES;
    int failed = 0;
    for (uint32_t i = 0; i < CASES; i++) {
        learnt made = get_case(i, names[i]);
        int equal = made.descriptors ? check_vectors(&made, i)
                    : made.bits == 0 ? check_numbers(&made, i)
                    : made.bits < 32 && 1u << made.bits <= RLVC_EXPORT_BITS ? check_all(&made, i)
                                                                            : check_some(&made, i);
        int again = exports_the_same(&made, names[i]);
        printf("%s: %s, exported again %s\n", names[i],
               equal ? "the same on all percepts tried" : "DIFFERENT",
               again ? "the same" : "DIFFERENT");
        failed += !equal || !again;
    }
    return failed > 0;
}
