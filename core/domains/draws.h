/* SPDX-License-Identifier: MIT */
/* Candidates: patterns drawn at random from a class's percepts. */
#ifndef RLVC_DOMAINS_DRAWS_H
#define RLVC_DOMAINS_DRAWS_H

#include "vectors.h"

/* candidates() of the domains: first d->candidates vectors, then layout->pairs pairs. Candidate i
 * comes from the samples of one target. Targets take turns; if there are more targets than
 * candidates, those that take part are spread evenly. */
int rlvc_draw_candidates(const rlvc_layout *layout, const rlvc_samples *samples, uint32_t first,
                         uint32_t room, void *features, uint32_t *written);

#endif
