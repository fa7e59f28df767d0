/* SPDX-License-Identifier: MIT */
/* The array of the database's rows. It has two contents, at different times:
 *
 *     samples       while classes are searched for splits: {key, slot}, grouped by class and action
 *     transitions   while values are solved for: {class of s', count}, grouped by class and action
 *
 * The model turns the one into the other in place (model.c): there are never more transitions than
 * samples. */
#ifndef RLVC_SRC_ROWS_H
#define RLVC_SRC_ROWS_H

#include "rlvc/domain.h"

typedef struct rlvc_transition {
    uint32_t next;  /* class of s', or RLVC_NO_CLASS where the episode terminated */
    uint32_t count; /* interactions */
} rlvc_transition;

typedef union rlvc_rows {
    rlvc_sample *sample;
    rlvc_transition *transition;
} rlvc_rows;

#endif
