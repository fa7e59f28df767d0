/* SPDX-License-Identifier: MIT */
/* Reading the tables of tests/golden: a line of header, then rows of numbers. Include after
 * cmocka.h. */
#ifndef RLVC_TESTS_GOLDEN_H
#define RLVC_TESTS_GOLDEN_H

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define GOLDEN_COLUMNS_MAX 6

typedef struct golden {
    const char *name;
    FILE *file;
    int columns;
    int line; /* of the row, as an editor counts */
    double row[GOLDEN_COLUMNS_MAX];
} golden;

static inline golden golden_open(const char *name, int columns) {
    char path[1024];
    char header[256];
    golden table = {name, NULL, columns, 1, {0.0}};
    snprintf(path, sizeof path, "%s/%s", RLVC_GOLDEN_DIR, name);
    table.file = fopen(path, "r");
    if (table.file == NULL || fgets(header, sizeof header, table.file) == NULL)
        fail_msg("cannot read %s", path);
    return table;
}

/* The next row; 0 at the end, with the file closed. */
static inline int golden_next(golden *table) {
    char line[256];
    if (fgets(line, sizeof line, table->file) == NULL) {
        fclose(table->file);
        if (table->line < 10)
            fail_msg("%s has %d rows only", table->name, table->line - 1);
        return 0;
    }
    table->line++;
    char *at = line;
    for (int i = 0; i < table->columns; i++) {
        char *end;
        table->row[i] = strtod(at, &end);
        if (end == at || (*end != ',' && *end != '\n'))
            fail_msg("%s:%d: column %d is no number", table->name, table->line, i + 1);
        at = end + 1;
    }
    return 1;
}

/* Fails, naming the row, unless got is within `relative` of wanted. */
static inline void golden_close(const golden *table, const char *what, float got, double wanted,
                                double relative) {
    double error = (double)got - wanted;
    double bound = relative * (wanted < 0.0 ? -wanted : wanted);
    if (!(error <= bound && error >= -bound))
        fail_msg("%s:%d: %s is %.9g, not %.9g", table->name, table->line, what, (double)got,
                 wanted);
}

#define DIGEST_START 2166136261u

/* Takes the bits of a result into a digest (FNV-1a): one number that pins all of them down. */
static inline uint32_t digest(uint32_t so_far, float value) {
    unsigned char bytes[4];
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    for (int i = 0; i < 4; i++)
        bytes[i] = (unsigned char)(bits >> (8 * i));
    for (int i = 0; i < 4; i++)
        so_far = (so_far ^ bytes[i]) * 16777619u;
    return so_far;
}

#endif
