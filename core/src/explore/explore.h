/* SPDX-License-Identifier: MIT */
/* Directed exploration: which action to try in a class when the policy's own is not taken.
 *
 * A pair (c, a) is little tried if it was tried fewer than m times, where
 *
 *     m = max(3, a quarter of the mean over all pairs).
 *
 * One exploring action in two goes after such pairs: the least tried action of the class if that is
 * little tried, else the action that leads to a little-tried pair soonest (novelty.h). The other is
 * drawn, and so is that of a class from where none can be reached, or whose own little-tried pairs
 * have been tried since that was found, with the weight
 *
 *     w(a) = p(a) / (1 + min(n(c, a), 8))^4,    p(a) = 4 if a was the action before, else 1.
 *
 * The first half needs classes that separate situations. While they do not, a path through them can
 * end at a wall, and the second half moves the walk: in a coarse class all n are large, and it
 * keeps its direction; in a fine class hardly any action is repeated before all have been tried. */
#ifndef RLVC_SRC_EXPLORE_H
#define RLVC_SRC_EXPLORE_H

#include "../base/arena.h"
#include "../base/rng.h"

#define RLVC_NO_ACTION 255u

typedef struct rlvc_explorer {
    uint8_t *count; /* [classes_max][actions] n(c, a): interactions in the ring when last counted,
                      and choices since; 255 stands for more */
    uint8_t *to_novel; /* [classes_max] the action that leads to a little-tried pair of another
                      class soonest, as was found when last looked; RLVC_NO_ACTION: none can be
                      reached, or one of the class's own was little tried */
    uint8_t min_tried; /* m; 0 before the first learning step, when nothing is known of what leads
                      where */
    uint8_t last;      /* the action before, or RLVC_NO_ACTION */
} rlvc_explorer;

/* Carves the tables. O(1). */
void rlvc_explorer_carve(rlvc_explorer *explorer, rlvc_arena *arena, const rlvc_config *config);

/* Makes class 0 one in which nothing was tried. O(actions). */
void rlvc_explorer_clear(rlvc_explorer *explorer, uint32_t actions);

/* Gives a new class what was counted in the class that it was split from. O(actions). */
void rlvc_explorer_inherit(rlvc_explorer *explorer, uint32_t actions, uint32_t new_class,
                           uint32_t old_class);

/* Adds to a class what was counted in another, which becomes part of it. O(actions). */
void rlvc_explorer_join(rlvc_explorer *explorer, uint32_t actions, uint32_t class_id,
                        uint32_t other);

/* m for a database of so many interactions of so many pairs. O(1). */
uint8_t rlvc_explorer_min_tried(uint32_t interactions, uint32_t pairs);

/* Chooses an exploring action for a class. O(actions). */
uint32_t rlvc_explorer_choose(const rlvc_explorer *explorer, uint32_t actions, uint32_t class_id,
                              rlvc_rng *rng);

/* Takes note of the action chosen in a class, for whatever reason. O(1). */
void rlvc_explorer_note(rlvc_explorer *explorer, uint32_t actions, uint32_t class_id,
                        uint32_t action);

/* @return 1 if every action in the tables is one. O(classes). */
int rlvc_explorer_check(const rlvc_explorer *explorer, uint32_t actions, uint32_t classes);

#endif
