/* SPDX-License-Identifier: MIT */
/* Which methods, solvers, scores, criteria, domains, oracles, kinds of dependence, smallest effects
 * and discounts are built in. A controller that uses one of each need not carry the others:
 * -DRLVC_METHODS=1 -DRLVC_SOLVERS=1 -DRLVC_SCORES=1 -DRLVC_CRITERIA=2 -DRLVC_DOMAINS=2
 * -DRLVC_ORACLES=1 -DRLVC_DEPENDENCES=1 -DRLVC_EFFECTS=1 -DRLVC_DISCOUNTS=1 leave classes, value
 * iteration, the information gain, the residual criterion, the domain of bits, the default refining
 * oracle, samples that count as independent, splits by any difference and discounts below 1. Bit n
 * stands for number n of RLVC_SOLVER_*, RLVC_SCORE_*, RLVC_CRITERION_* or RLVC_DOMAIN_*, or of
 * config.dependence; of RLVC_METHODS 0 is classes and 1 the planner; of RLVC_ORACLES 0 is the
 * default oracle and 1 the domain's own; of RLVC_EFFECTS 0 is a smallest_effect of 0 and 1 any
 * other; of RLVC_DISCOUNTS 0 is a discount below 1, and 1 is 1. -DRLVC_AT_ONCE=0 leaves out what is
 * there only to be fast where budgets or models are large, and large models; -DRLVC_STARTS=0 that
 * exploration seeks new episodes.
 *
 * What is left out is compiled all the same, under conditions that are constant, so that it cannot
 * rot. */
#ifndef RLVC_SRC_SOLVER_SELECT_H
#define RLVC_SRC_SOLVER_SELECT_H

#ifndef RLVC_METHODS
#define RLVC_METHODS 3u
#endif
#ifndef RLVC_SOLVERS
#define RLVC_SOLVERS 15u
#endif
#ifndef RLVC_SCORES
#define RLVC_SCORES 9u
#endif
#ifndef RLVC_CRITERIA
#define RLVC_CRITERIA 3u
#endif

#ifndef RLVC_ORACLES
#define RLVC_ORACLES 3u
#endif
#ifndef RLVC_DEPENDENCES
#define RLVC_DEPENDENCES 3u
#endif
#ifndef RLVC_DOMAINS
#define RLVC_DOMAINS 63u
#endif
#ifndef RLVC_DISCOUNTS
#define RLVC_DISCOUNTS 3u
#endif

#ifndef RLVC_AT_ONCE
#define RLVC_AT_ONCE 1
#endif
/* Models of more classes are large: value_iteration.h has other sweeps for them. */
#define RLVC_CLASSES_SMALL 512u
#define RLVC_CLASSES_MAX (RLVC_AT_ONCE ? 65535u : RLVC_CLASSES_SMALL)

#ifndef RLVC_STARTS
#define RLVC_STARTS 1
#endif

#ifndef RLVC_EFFECTS
#define RLVC_EFFECTS 3u
#endif

/* 1 if the planner is built in. O(1). */
#define RLVC_HAS_PLANNER ((RLVC_METHODS) >> 1 & 1)

/* 1 if a domain may have its own oracle; if dependence can be allowed for; if a split can be too
 * little worth. O(1). */
#define RLVC_HAS_OWN_ORACLE ((int)((unsigned)(RLVC_ORACLES) >> 1u & 1u))
#define RLVC_HAS_DEPENDENCE ((int)((unsigned)(RLVC_DEPENDENCES) >> 1u & 1u))
#define RLVC_HAS_EFFECT ((int)((unsigned)(RLVC_EFFECTS) >> 1u & 1u))

/* 1 if there may be domains other than that of bits. O(1). */
#define RLVC_HAS_OTHER_DOMAINS ((RLVC_DOMAINS) != 1u << RLVC_DOMAIN_BITS)

/* 1 if a discount may be 1. O(1). */
#define RLVC_HAS_UNDISCOUNTED ((int)((unsigned)(RLVC_DISCOUNTS) >> 1u & 1u))

/* 1 if a solver is built in. O(1). */
#define RLVC_HAS_SOLVER(number) ((int)((unsigned)(RLVC_SOLVERS) >> (number)&1u))

/* 1 if there is a solver that learns while observing. O(1). */
#define RLVC_HAS_INCREMENTAL                                                                       \
    (RLVC_HAS_SOLVER(RLVC_SOLVER_Q_LEARNING) || RLVC_HAS_SOLVER(RLVC_SOLVER_SARSA))

/* 1 if a score is built in. O(1). */
#define RLVC_HAS_SCORE(number) ((int)((unsigned)(RLVC_SCORES) >> (number)&1u))

/* 1 if a config's criterion is the returns criterion, which must be built in. O(1). */
#define RLVC_BY_RETURNS(criterion)                                                                 \
    (((unsigned)(RLVC_CRITERIA) >> RLVC_CRITERION_RETURNS & 1u) != 0 &&                            \
     (criterion) == RLVC_CRITERION_RETURNS)

#endif
