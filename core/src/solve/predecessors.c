/* SPDX-License-Identifier: MIT */
/* The model's transitions, turned round: see predecessors.h. A counting sort. */
#include "predecessors.h"

#include "../base/float_math.h"
#include "../samples/replay.h"

enum { CLEAR, COUNT, PLACE, FILL };

void rlvc_predecessors_begin(rlvc_predecessors *predecessors) {
    predecessors->at = 0;
    predecessors->pair = 0;
    predecessors->place = 0;
    predecessors->phase = CLEAR;
    predecessors->done = 0;
}

/* Goes on to the next class or transition, or phase. */
static void advance(rlvc_predecessors *predecessors, uint32_t end) {
    if (++predecessors->at < end)
        return;
    predecessors->at = 0;
    predecessors->phase++;
}

/* Counts a transition to the class that it leads to, or puts it there. */
static void turn_round(const rlvc_predecessors *predecessors, const rlvc_turning *turning,
                       rlvc_sample *group) {
    const rlvc_sample *transition = turning->sample + predecessors->at;
    if (transition->key == RLVC_NO_CLASS)
        return;
    uint32_t place = group[transition->key].slot++;
    if (predecessors->phase == COUNT)
        return;
    const rlvc_values *values = turning->values;
    float share = (float)transition->slot / (float)values->tried[predecessors->pair];
    turning->sample[place].key = predecessors->pair / values->actions;
    turning->sample[place].slot = rlvc_bits_of(turning->discount * share);
}

/* One transition, or the step to the next pair. */
static void fill(rlvc_predecessors *predecessors, const rlvc_turning *turning, rlvc_sample *group) {
    if (predecessors->at < turning->values->first[predecessors->pair + 1u]) {
        turn_round(predecessors, turning, group);
        predecessors->at++;
    } else {
        predecessors->pair++;
        predecessors->done = predecessors->pair == turning->classes * turning->values->actions;
    }
}

void rlvc_predecessors_step(rlvc_predecessors *predecessors, const rlvc_turning *turning) {
    rlvc_sample *group = turning->sample + 2u * (size_t)turning->transitions;
    rlvc_sample *mine; /* of the class */
    uint32_t count;
    switch (predecessors->phase) {
    case CLEAR:
        group[predecessors->at].slot = 0;
        advance(predecessors, turning->classes);
        break;
    case COUNT:
        if (turning->transitions > 0)
            turn_round(predecessors, turning, group);
        advance(predecessors, turning->transitions);
        predecessors->place = turning->transitions;
        break;
    case PLACE:
        mine = group + predecessors->at;
        count = mine->slot;
        mine->key = predecessors->place;
        mine->slot = predecessors->place;
        predecessors->place += count;
        advance(predecessors, turning->classes);
        break;
    default:
        fill(predecessors, turning, group);
        break;
    }
}
