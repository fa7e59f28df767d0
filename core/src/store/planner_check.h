/* SPDX-License-Identifier: MIT */
/* Does what was loaded into a planner hold together? Nothing of it may become an index, a shift or
 * a division that is not one of a planner's own. */
#ifndef RLVC_SRC_PLANNER_CHECK_H
#define RLVC_SRC_PLANNER_CHECK_H

#include "../plan/cells.h"
#include "../plan/planner_state.h"

/* Has the tree room for its terms and leaves? O(1). */
int rlvc_planner_check_terms(const rlvc_dynamics *dynamics, const rlvc_model_tree *tree);

/* Is node k of the endings a leaf, or a test whose children come after it? O(1). */
int rlvc_planner_check_ending(const rlvc_ending *ending, uint32_t k, uint32_t components);

/* All the rest. O(bytes). */
int rlvc_planner_check(const rlvc_planner *planner);

#endif
