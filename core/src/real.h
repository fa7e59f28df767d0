/* SPDX-License-Identifier: MIT */
#ifndef RLVC_SRC_REAL_H
#define RLVC_SRC_REAL_H
#include <stdint.h>
float rlvc_ln(float x);  /* x > 0, finite */
float rlvc_log2(float x);
float rlvc_exp(float x); /* <= 0 */
#endif
