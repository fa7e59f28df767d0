/* SPDX-License-Identifier: MIT */
#ifndef RLVC_SRC_SCORE_H
#define RLVC_SRC_SCORE_H
#include <stdint.h>
/* Score of the 2 x 2 table that a cutpoint and a feature make; kind is RLVC_SCORE_*. */
float rlvc_score(uint8_t kind, uint32_t present_below, uint32_t absent_below, uint32_t present_above,
                 uint32_t absent_above);
#endif
