/* SPDX-License-Identifier: MIT */
/* Loops over arrays: Python makes one call instead of one for each element. */
#include "shim.h"

#include <string.h>

rlvc_status rlvc_shim_predict(rlvc_agent *agent, const unsigned char *percepts, uint32_t bytes,
                              size_t count, uint32_t *classes, uint32_t *actions, size_t *done) {
    rlvc_status status = RLVC_OK;
    size_t i = 0;
    for (; i < count; i++) {
        status = rlvc_predict(agent, percepts + i * bytes, classes ? classes + i : NULL,
                              actions ? actions + i : NULL);
        if (status != RLVC_OK)
            break;
    }
    *done = i;
    return status;
}

rlvc_status rlvc_shim_policy_act(rlvc_policy *policy, const unsigned char *percepts, uint32_t bytes,
                                 size_t count, uint32_t *actions, size_t *done) {
    rlvc_status status = RLVC_OK;
    size_t i = 0;
    for (; i < count && status == RLVC_OK; i++)
        status = rlvc_policy_act(policy, percepts + i * bytes, actions + i);
    *done = status == RLVC_OK ? i : i - 1u;
    return status;
}

rlvc_status rlvc_shim_act(rlvc_agent *agent, const rlvc_shim_log *log, size_t *done) {
    rlvc_status status = RLVC_OK;
    size_t i = 0;
    for (; i < log->count; i++) {
        status = rlvc_begin(agent, log->percepts + i * log->bytes);
        if (status == RLVC_OK)
            status = rlvc_act(agent, log->choices + i);
        if (status != RLVC_OK)
            break;
    }
    *done = i;
    return status;
}

static rlvc_status check(const rlvc_shim_log *log, size_t i) {
    const rlvc_choice *choice = log->choices + i;
    if (choice->action >= log->actions || choice->exploited > 1 || log->ends[i] > RLVC_TRUNCATED)
        return RLVC_E_RANGE;
    return log->rewards[i] >= -RLVC_REWARD_MAX && log->rewards[i] <= RLVC_REWARD_MAX
               ? RLVC_OK
               : RLVC_E_REWARD;
}

/* Whether interaction i + 1 goes on where i ended. */
static int linked_to_next(const rlvc_shim_log *log, size_t i) {
    return i + 1 < log->count && log->ends[i] == RLVC_GOES_ON &&
           memcmp(log->next + i * log->bytes, log->percepts + (i + 1) * log->bytes, log->bytes) ==
               0;
}

rlvc_status rlvc_shim_observe(rlvc_agent *agent, const rlvc_shim_log *log, size_t *done) {
    for (size_t i = 0; i < log->count; i++) {
        rlvc_status status = check(log, i);
        if (status != RLVC_OK) {
            *done = i;
            return status;
        }
    }
    rlvc_status status = RLVC_OK;
    int linked = log->resume == 1;
    size_t i = 0;
    for (; i < log->count; i++) {
        if (!linked)
            status = rlvc_begin(agent, log->percepts + i * log->bytes);
        if (status == RLVC_OK)
            status = rlvc_observe(agent, log->choices[i], log->rewards[i],
                                  log->next + i * log->bytes, log->ends[i]);
        if (status != RLVC_OK)
            break;
        linked = linked_to_next(log, i);
    }
    *done = i;
    return status;
}

rlvc_status rlvc_shim_tables(const rlvc_agent *agent, uint32_t classes, uint32_t actions, float *q,
                             uint32_t *samples, float *values, uint32_t *policy) {
    for (uint32_t c = 0; c < classes; c++) {
        rlvc_status status = rlvc_value(agent, c, values + c, policy + c);
        for (uint32_t a = 0; a < actions && status == RLVC_OK; a++) {
            size_t pair = (size_t)c * actions + a;
            status = rlvc_q(agent, c, a, q + pair, samples + pair);
        }
        if (status != RLVC_OK)
            return status;
    }
    return RLVC_OK;
}

rlvc_status rlvc_shim_empty_act(rlvc_agent *agent, rlvc_choice *choice) {
    (void)agent;
    (void)choice;
    return RLVC_OK;
}

rlvc_status rlvc_shim_empty_observe(rlvc_agent *agent, rlvc_choice choice, float reward,
                                    const void *next, uint8_t end) {
    (void)agent;
    (void)choice;
    (void)reward;
    (void)next;
    (void)end;
    return RLVC_OK;
}
