/* SPDX-License-Identifier: MIT */
/* Beginning, acting, observing and deciding, with unknown percepts and rewards. */
#include "agent.h"

int eva_act(void) {
    rlvc_agent *agent = small_agent();
    unsigned char percept[1];
    uint32_t class_id, action;
    if (!agent)
        return 1;
    while (any_in(0, 1)) {
        live(agent, 1);
        any_bytes(percept, sizeof percept);
        (void)rlvc_predict(agent, percept, &class_id, &action);
    }
    return 0;
}
