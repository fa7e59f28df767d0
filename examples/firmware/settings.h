/* SPDX-License-Identifier: MIT */
/* How the robot learns, and the times of its control loop. All are constants, so that memory is
 * static. The criterion is chosen by FIRMWARE_RETURNS (0 or 1). */
#ifndef FIRMWARE_SETTINGS_H
#define FIRMWARE_SETTINGS_H

#include "gridworld.h"
#include "rlvc/rlvc.h"

#define DISTRACTORS 11u /* irrelevant bits of a percept */
#define PERCEPT_BITS 18u
#define PERCEPT_BYTES RLVC_BITS_PERCEPT_BYTES(PERCEPT_BITS)
#define FEATURES_AT_ONCE PERCEPT_BITS
#define SEED 1u
#define DISCOUNT 0.9f

#if FIRMWARE_RETURNS
#define CRITERION RLVC_CRITERION_RETURNS
#define CRITERION_NAME "returns"
#define STEPS 20u
#define STEP_INTERACTIONS 10000u
#define CAPACITY STEP_INTERACTIONS
#define CLASSES 64u
#define EPSILON 0.8f
#define ALPHA 0.05f
#define ALPHA_KNOWN 0.0001f
#define SUCCESSORS 0
#else /* within 32 KiB of memory in all, stack included */
#define CRITERION RLVC_CRITERION_RESIDUAL
#define CRITERION_NAME "residual"
#define STEPS 25u
#define STEP_INTERACTIONS 100u
#define CAPACITY 920u
#define CLASSES 52u
#define EPSILON 0.9f
#define ALPHA 0.01f
#define ALPHA_KNOWN 0.1f
#define SUCCESSORS 1
#endif

/* The work that a tick lends to the learner, in the library's units. */
#ifndef SLICE
#define SLICE 64u
#endif

/* What a slice and a tick may take, in instructions of the processor; a tick that takes longer is
 * an overrun. (RISC-V without a floating-point unit needs twice as many for its arithmetic.) */
#if defined(__riscv) && !defined(__riscv_flen)
#define SLICE_INSTRUCTIONS 45000u
#define TICK_INSTRUCTIONS 50000u
#else
#define SLICE_INSTRUCTIONS 20000u
#define TICK_INSTRUCTIONS 25000u
#endif

#endif
