/* SPDX-License-Identifier: MIT */
/* Agents whose policies are exported: learnt anew, alike, by the program that exports and by the
 * one that checks, or loaded by that: some would take an emulated machine minutes. */
#ifndef RLVC_TESTS_EXPORT_CASES_H
#define RLVC_TESTS_EXPORT_CASES_H

#include "rlvc/rlvc.h"
#include <stdio.h>

/* maze    Sutton's maze: 18 bits, a table of actions
 * single  nothing to learn: one class
 * bytes   40 bits, of which many matter: a table of nodes in bytes
 * wide    300 bits: a table of nodes in words
 * many    so many leaves that the table of nodes is in words
 * floats  descriptors, as floats
 * int8s   descriptors, as int8_t
 * pairs   pairs of descriptors, as int8_t
 * turned  pairs of descriptors, as floats, with directions
 * reals   thresholds
 * slants  oblique thresholds
 * bags    bags of descriptors, as int8_t
 * parts   bags of descriptors, as floats */
#define CASE_NAMES                                                                                 \
    {                                                                                              \
        "maze", "single", "bytes", "wide", "many", "floats", "int8s", "pairs", "turned", "reals",  \
            "slants", "bags", "parts"                                                              \
    }
#define CASES 13u

#define POINTS 4u
#define DIMENSIONS 36u
#define COMPONENTS 3u
#define BAG_SIZE 4u

typedef struct learnt {
    rlvc_agent *agent;
    uint32_t bits;                       /* 0: descriptors or thresholds */
    const rlvc_descriptors *descriptors; /* of which the percepts are, or null */
    const rlvc_spatial *spatial;         /* likewise */
    const rlvc_bags *bags;               /* likewise */
} learnt;

/* A percept of descriptors in either form, with places or without, or a feature; aligned. */
typedef union vectors {
    uint32_t count;
    unsigned char bag[RLVC_BAGS_FEATURE_BYTES(BAG_SIZE, DIMENSIONS, RLVC_DESCRIPTORS_FLOAT)];
    unsigned char bytes[RLVC_SPATIAL_PERCEPT_BYTES(POINTS, DIMENSIONS, RLVC_DESCRIPTORS_FLOAT, 1)];
} vectors;

/* A random number; seed *state with anything. */
uint32_t draw(uint64_t *state);

/* Draws a percept of 0 to POINTS vectors, each near one of a few places. */
void draw_vectors(uint64_t *state, uint32_t form, vectors *percept);

/* Draws the places of its points: at the left or at the right. */
void draw_places(uint64_t *state, const rlvc_spatial *spatial, vectors *percept);

/* The place of a point, which may be changed. */
void get_place(const rlvc_spatial *spatial, const vectors *percept, uint32_t point,
               int16_t place[2]);
void set_place(const rlvc_spatial *spatial, vectors *percept, uint32_t point,
               const int16_t place[2]);

/* Number k of the vectors of a percept, or of a feature. */
void set_number(unsigned char *record, uint32_t form, uint32_t k, float number);
float get_number(const unsigned char *record, uint32_t form, uint32_t k);

/* Draws a percept of COMPONENTS numbers in [-1, 1). */
void draw_numbers(uint64_t *state, float *x);

/* Learns case i, or loads it if a file is given, in which a snapshot of it is; the memory is
 * static, so that the last case is the one there is. Ends the program with a message if anything
 * fails. */
learnt make_case(uint32_t i, FILE *saved);

/* Saves a case that was learnt into an empty file. Ends the program likewise. */
void save_case(const learnt *made, FILE *file);

/* 1 for a case that takes long to learn, and is of a kind of which another one is learnt sooner. */
int takes_long(uint32_t i);

#endif
