/* SPDX-License-Identifier: MIT */
/* How long a feature stays: see persistence.h. */
#include "rlvc/float_rules.h"

#include "persistence.h"

#include <string.h>

/* So seldom that nothing is significant. */
#define CHANGE_MIN 1e-6f

void rlvc_persistence_begin(rlvc_persistence *persistence) {
    memset(persistence, 0, sizeof *persistence);
}

rlvc_status rlvc_persistence_step(rlvc_persistence *persistence, const rlvc_replay *replay,
                                  const rlvc_domain *domain, uint32_t end, uint32_t class_id,
                                  const void *feature, uint32_t budget, uint32_t *used) {
    for (*used = 0; *used < budget && persistence->at < end; ++*used) {
        uint32_t slot = rlvc_replay_slot(replay, persistence->at);
        if (replay->label[slot] == class_id && (replay->flags[slot] & RLVC_SLOT_STORED)) {
            uint8_t present = 0;
            if (domain->exhibits(domain->ctx, rlvc_replay_percept(replay, slot), feature,
                                 &present) != 0)
                return RLVC_E_CALLBACK;
            present = present != 0;
            persistence->count[persistence->last][present] += persistence->any;
            persistence->any = 1;
            persistence->last = present;
        }
        persistence->at++;
    }
    return RLVC_OK;
}

/* Of the pairs that begin with absent, or present: the share that changes. */
static float changes(const uint32_t *count, uint32_t other) {
    uint32_t all = count[0] + count[1];
    return (float)count[other] / (float)(all > 0 ? all : 1u);
}

float rlvc_persistence_effect(const rlvc_persistence *persistence) {
    float change = changes(persistence->count[0], 1) + changes(persistence->count[1], 0);
    change = change > CHANGE_MIN ? change : CHANGE_MIN;
    return change < 1.0f ? (2.0f - change) / change : 1.0f;
}
