/* SPDX-License-Identifier: MIT */
/* Drawing the rows to fit to: see sample.h. */
#include "rlvc/float_rules.h"

#include "sample.h"

#include <string.h>

void rlvc_sampling_begin(rlvc_sampling_cursor *sampling, uint32_t first, uint32_t rows,
                         uint32_t seed) {
    memset(sampling, 0, sizeof *sampling);
    sampling->first = sampling->row = first;
    sampling->rows = rows;
    rlvc_rng_seed(&sampling->rng, seed);
}

/* Seven in ten, rounded up. */
static uint32_t most_of(uint32_t rows) {
    return rows - rows / 10u * 3u - rows % 10u * 3u / 10u;
}

static uint32_t least_of(uint32_t a, uint32_t b) {
    return a < b ? a : b;
}

/* Shares the room between the strata, once they are counted. */
static void share(rlvc_sampling_cursor *sampling, rlvc_row_sample *sample) {
    uint32_t going = sampling->seen[0], ended = sampling->seen[1], room = sample->room;
    uint32_t most = going + room / 4u >= room ? room / 4u : room - going;
    sampling->needed[1] = least_of(most_of(ended), most);
    sampling->needed[0] = least_of(most_of(going), room - sampling->needed[1]);
    sample->going = sampling->needed[0];
    sample->count = sampling->needed[0] + sampling->needed[1];
    sample->weight_going = going > 0 ? (float)going / (float)sampling->needed[0] : 1.0f;
    sample->weight_ended = ended > 0 ? (float)ended / (float)sampling->needed[1] : 1.0f;
    sampling->placed[1] = sample->going;
    sampling->drawing = 1;
    sampling->at = 0;
    sampling->row = sampling->first;
}

/* Counts a row, or draws it or not. */
static void look_at(rlvc_sampling_cursor *sampling, rlvc_row_sample *sample, uint32_t stratum) {
    if (!sampling->drawing) {
        sampling->seen[stratum]++;
        return;
    }
    if (rlvc_rng_below(&sampling->rng, sampling->seen[stratum]) < sampling->needed[stratum]) {
        sample->row[sampling->placed[stratum]++] = sampling->row;
        sampling->needed[stratum]--;
    }
    sampling->seen[stratum]--;
}

uint32_t rlvc_sampling_step(rlvc_sampling_cursor *sampling, const rlvc_experience *experience,
                            rlvc_row_sample *sample, uint32_t budget) {
    uint32_t spent = 0;
    while (spent < budget && !sampling->done) {
        uint8_t end = experience->end[sampling->row];
        if (end != RLVC_ROW_LAST)
            look_at(sampling, sample, end == RLVC_TERMINATED);
        spent++;
        sampling->row = rlvc_experience_next(experience, sampling->row);
        if (++sampling->at < sampling->rows)
            continue;
        sampling->done = sampling->drawing;
        if (!sampling->done)
            share(sampling, sample);
    }
    return spent;
}
