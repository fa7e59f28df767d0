/* SPDX-License-Identifier: MIT */
/* The moves of the search from one small tree to the next: split a leaf, shift a cut or draw it
 * anew, replace a test, change an action, put a side in its test's place, swap a test's sides.
 *
 * There is always one move, a second one in a third of the cases, and a third one in a tenth. A cut
 * that is drawn is the value of a component in a row of the experience. Nodes that no rollout
 * passed are rarely moved. */
#ifndef RLVC_SRC_MOVES_H
#define RLVC_SRC_MOVES_H

#include "../dynamics/experience.h"
#include "small_tree.h"
#include "../base/rng.h"

#define RLVC_MOVES_NODES (RLVC_SMALL_NODES_MAX + 6u) /* three splits more */

typedef struct rlvc_moves_input {
    const rlvc_experience *experience;
    const float *scale; /* [components] the deviation of each component */
    uint32_t actions;
    uint32_t leaves_max;
} rlvc_moves_input;

/* Makes `to` out of `from`.
 * @param visits of from's nodes
 * @return 1; 0: what came of it has too many leaves. O(nodes). */
int rlvc_moves_make(const rlvc_moves_input *in, const rlvc_small_tree *from, const uint32_t *visits,
                    rlvc_rng *rng, rlvc_small_tree *to);

#endif
