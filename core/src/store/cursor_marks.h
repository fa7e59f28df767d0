/* SPDX-License-Identifier: MIT */
/* Where a learning step under way is, in a few words, and going there again.
 *
 * The tables that a phase works on (keys, sorted samples, bit columns, transitions) all follow from
 * the ring, the labels, the tree and the values, so none of them is saved. What is saved is a mark:
 * how far the cursor of the phase has come. To resume is to do the phase anew, in the smallest
 * steps there are, until the cursor has come as far. Every state that a budget can stop at lies on
 * that way, since a slice ends only between two smallest steps; and what is not on it is refused,
 * so that nothing which is loaded ever becomes an index. */
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
