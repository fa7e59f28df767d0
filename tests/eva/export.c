/* SPDX-License-Identifier: MIT */
/* Printing and exporting an agent whose splits and values are unknown. */
#include "agent.h"
#include "agent/state.h"
#include "rlvc/export.h"

static int write_any(void *ctx, const char *text, size_t bytes) {
    (void)ctx;
    (void)text;
    (void)bytes;
    return (int)any_in(0, 1);
}

/* An agent of three classes, the last of which was split off `class_id`. */
static rlvc_agent *grown_agent(uint32_t class_id) {
    rlvc_agent *agent = small_agent();
    for (uint32_t j = 0; agent && j < 2u; j++) {
        rlvc_split about = {j * class_id,
                            1,
                            any_in(0, 3),
                            any_in(0, UINT32_MAX),
                            any_real(-1e30f, 1e30f),
                            any_real(-1e30f, 1e30f),
                            any_real(-1e30f, 1e30f)};
        uint16_t feature = (uint16_t)any_in(0, 3);
        rlvc_tree_grow(&agent->tree, rlvc_tree_leaf(&agent->tree, about.class_id), &about,
                       &feature);
    }
    return agent;
}

/* Printing with any policy; exporting with the policy whose actions are the bits of `actions`: an
 * export goes where actions differ. */
static void write_out(uint32_t class_id, uint32_t actions) {
    rlvc_agent *agent = grown_agent(class_id);
    if (!agent)
        return;
    for (uint32_t c = 0; c < 3u; c++)
        agent->values.policy[c] = (uint16_t)(actions >> c & 1u);
    (void)rlvc_export_c(agent, "any", write_any, 0, 0);
    for (uint32_t c = 0; c < 3u; c++)
        agent->values.policy[c] = (uint16_t)any_in(0, 1);
    if (actions == 0)
        (void)rlvc_print(agent, any_in(0, 3), write_any, 0);
}

int eva_export(void) {
    //@ loop unroll 16;
    for (uint32_t i = 0; i < 16u; i++) /* each by itself */
        if (any_in(0, 1)) {
            write_out(i / 8u, i % 8u);
            return 0;
        }
    return 0;
}
