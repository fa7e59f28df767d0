/* SPDX-License-Identifier: MIT */
/* Which solvers are built in. A controller that uses one need not carry the others:
 * -DRLVC_SOLVERS=1 leaves all but value iteration out, which saves it some 2 KiB. Bit n stands for
 * the solver number n (RLVC_SOLVER_*).
 *
 * What is left out is compiled all the same, under conditions that are constant, so that it cannot
 * rot. */
#ifndef RLVC_SRC_SOLVER_SELECT_H
#define RLVC_SRC_SOLVER_SELECT_H

#ifndef RLVC_SOLVERS
#define RLVC_SOLVERS 15u
#endif

/* 1 if a solver is built in. O(1). */
#define RLVC_HAS_SOLVER(number) ((int)(1u & (unsigned)(RLVC_SOLVERS) >> (number)))

#endif
