/* SPDX-License-Identifier: MIT */
/* The ring of rows: see experience.h. */
#include "rlvc/float_rules.h"

#include "experience.h"

#include "../base/assert.h"
#include <string.h>

void rlvc_experience_carve(rlvc_experience *experience, rlvc_arena *arena, uint32_t components,
                           uint32_t rows) {
    memset(experience, 0, sizeof *experience);
    experience->percept = rlvc_arena_carve(arena, rows, components * (uint32_t)sizeof(float));
    experience->reward = rlvc_arena_carve(arena, rows, sizeof(float));
    experience->low = rlvc_arena_carve(arena, components, sizeof(float));
    experience->high = rlvc_arena_carve(arena, components, sizeof(float));
    experience->action = rlvc_arena_carve(arena, rows, 1u);
    experience->end = rlvc_arena_carve(arena, rows, 1u);
    experience->components = components;
    experience->rows = rows;
}

uint32_t rlvc_experience_freeze(rlvc_experience *experience, uint32_t *first) {
    uint32_t count = experience->count, room = experience->rows - count;
    uint32_t least = experience->rows / 8u, leave = room < least ? least - room : 0u;
    experience->frozen = 1;
    experience->spare = room + leave;
    *first = rlvc_experience_row(experience, leave);
    return count - leave - 1u;
}

void rlvc_experience_begin(rlvc_experience *experience, const float *percept) {
    RLVC_ASSERT(rlvc_experience_has_room(experience));
    if (experience->count > 0)
        experience->head = rlvc_experience_next(experience, experience->head);
    if (experience->frozen)
        experience->spare--;
    float *place = experience->percept + (size_t)experience->head * experience->components;
    for (uint32_t i = 0; i < experience->components; i++) {
        place[i] = percept[i];
        if (experience->count == 0 || percept[i] < experience->low[i])
            experience->low[i] = percept[i];
        if (experience->count == 0 || percept[i] > experience->high[i])
            experience->high[i] = percept[i];
    }
    experience->end[experience->head] = RLVC_ROW_LAST;
    if (experience->count < experience->rows)
        experience->count++;
}

void rlvc_experience_append(rlvc_experience *experience, uint8_t action, float reward,
                            const float *next, uint8_t end) {
    uint32_t row = experience->head;
    experience->action[row] = action;
    experience->reward[row] = reward;
    experience->end[row] = end;
    rlvc_experience_begin(experience, next);
    if (experience->total < UINT32_MAX)
        experience->total++;
}
