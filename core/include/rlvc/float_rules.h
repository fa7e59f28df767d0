/* SPDX-License-Identifier: MIT */
/* Makes compilers round each operation on floats by itself, whatever their options. The promise of
 * the same bits everywhere rests on that. Every source of the library includes this file first. So
 * should the sources of a domain of your own that calculates with floats.
 *
 * A compiler that cannot be told to do so stops here with an error. */
#ifndef RLVC_FLOAT_RULES_H
#define RLVC_FLOAT_RULES_H

/* A product and a sum must not become one operation, which rounds once. */
#if defined(__clang__)
#pragma STDC FP_CONTRACT OFF /* which -ffp-contract=fast, no default of clang, overrides */
#elif defined(__GNUC__)
/* Only where there is such an operation: the pragma keeps gcc from some inlining. */
#ifdef __FP_FAST_FMAF
#pragma GCC optimize("fp-contract=off")
#endif
#elif defined(_MSC_VER)
#pragma fp_contract(off)
#else
#pragma STDC FP_CONTRACT OFF
#endif

/* Nor may sums be reordered, divisions become products, or numbers count as finite. */
#if defined(__FAST_MATH__) || defined(__ASSOCIATIVE_MATH__) || defined(__RECIPROCAL_MATH__) ||     \
    (defined(__FINITE_MATH_ONLY__) && __FINITE_MATH_ONLY__ > 0) || defined(_M_FP_FAST)
#error "rlvc: learns something else by -ffast-math, -Ofast or /fp:fast: leave these options out"
#endif

/* Results must not have more digits than a float on their way: the x87 has. */
#if defined(__i386__) && !defined(__SSE2_MATH__)
#error "rlvc: on 32-bit x86, compile with -msse2 -mfpmath=sse"
#elif defined(__FLT_EVAL_METHOD__) && __FLT_EVAL_METHOD__ != 0 && __FLT_EVAL_METHOD__ != 16
#error "rlvc: floats must be evaluated as floats: FLT_EVAL_METHOD must be 0"
#endif

#endif
