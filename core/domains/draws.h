/* SPDX-License-Identifier: MIT */
/* Candidates: patterns drawn at random from a class's percepts. */
#ifndef RLVC_DOMAINS_DRAWS_H
#define RLVC_DOMAINS_DRAWS_H

#include "vectors.h"

/* candidates() of the domains: first d->candidates vectors, then layout->pairs pairs. Candidate i
 * comes from the samples of one target: of the i-th of them round and round, or of every so manieth
 * if there are more targets than candidates. */
int rlvc_draw_candidates(const rlvc_layout *layout, const rlvc_samples *samples, uint32_t first,
                         uint32_t room, void *features, uint32_t *written);

#endif
