/* SPDX-License-Identifier: MIT */
/* Printing a tree with an action for each class: see rlvc_print. */
#ifndef RLVC_SRC_PRINT_H
#define RLVC_SRC_PRINT_H

#include "text.h"
#include "../tree/tree.h"
#include "../tree/values.h"

typedef struct rlvc_printer {
    rlvc_text text;
    const rlvc_domain *domain;
    const rlvc_tree *tree;
    const uint8_t *policy;     /* [classes] */
    const rlvc_values *values; /* or null: then neither they nor how splits came about is printed */
    uint32_t actions;
    uint32_t step;
} rlvc_printer;

/* Prints all of it in one of the formats RLVC_PRINT_*, until something fails. O(nodes * depth). */
void rlvc_printer_run(rlvc_printer *p, uint32_t format);

#endif
