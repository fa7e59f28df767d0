/* SPDX-License-Identifier: MIT */
/* Checks what was loaded into a planner. No loaded number is used as an index, a shift or a divisor
 * before it was found to be one that a planner itself could have. */
#ifndef RLVC_SRC_PLANNER_CHECK_H
#define RLVC_SRC_PLANNER_CHECK_H

#include "../plan/cells.h"
#include "../plan/planner_state.h"

/* Has the tree room for its terms and leaves? O(1). */
int rlvc_planner_check_terms(const rlvc_dynamics *dynamics, const rlvc_model_tree *tree);

/* Is node k of the endings a leaf, or a test whose children come after it? O(1). */
int rlvc_planner_check_ending(const rlvc_ending *ending, uint32_t k, uint32_t components);

/* All the rest. O(bytes). */
int rlvc_planner_is_sound(const rlvc_planner *planner);

#endif
