/* SPDX-License-Identifier: MIT */
/* Marks: the position of a learning step under way in a few words, and how to restore it.
 *
 * The tables of a phase (keys, sorted samples, bit columns, transitions) follow from the ring, the
 * labels, the tree and the values, so none of them is saved. What is saved is a mark: how far the
 * cursor of the phase is. To resume is to repeat the phase in the smallest steps until the cursor
 * is at the mark. A budget only ends between two smallest steps, so every saved state is on that
 * way. A mark that is not reached is refused. So nothing that is loaded ever becomes an index. */
#ifndef RLVC_SRC_CURSOR_MARKS_H
#define RLVC_SRC_CURSOR_MARKS_H

#include "../agent/state.h"

#define RLVC_CURSOR_MARK_WORDS 10u

/* SPEC.md says what the words are, by phase; those that a phase has no use for are 0. */
typedef struct rlvc_cursor_mark {
    uint32_t word[RLVC_CURSOR_MARK_WORDS];
} rlvc_cursor_mark;

/* The mark of the learner's cursor. O(1). */
void rlvc_cursor_marks_take(const rlvc_agent *agent, rlvc_cursor_mark *mark);

/* Is the learner's position (all but its cursor) sound, and do ring and labels fit it? O(slots). */
int rlvc_cursor_marks_check(const rlvc_agent *agent);

/* Brings the cursor of the learner, which has passed the check, to a mark.
 * @return RLVC_OK; RLVC_E_DAMAGED: it never gets there; RLVC_E_CALLBACK. */
rlvc_status rlvc_cursor_marks_resume(rlvc_agent *agent, const rlvc_cursor_mark *mark);

#endif
