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

int eva_export(void) {
    rlvc_agent *agent = small_agent();
    if (!agent)
        return 1;
    for (uint32_t j = 0; j < 2u; j++) {
        rlvc_split about = {each_in(0, j),
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
    for (uint32_t c = 0; c < 3u; c++)
        agent->values.policy[c] = (uint16_t)any_in(0, 1);
    (void)rlvc_print(agent, any_in(0, 3), write_any, 0);
    (void)rlvc_export_c(agent, "any", write_any, 0, 0);
    return 0;
}
