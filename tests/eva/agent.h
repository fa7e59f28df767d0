/* SPDX-License-Identifier: MIT */
/* A small agent of bits, for the drivers of Frama-C's Eva. */
#ifndef RLVC_TESTS_EVA_AGENT_H
#define RLVC_TESTS_EVA_AGENT_H

#include "any.h"
#include "rlvc/agent.h"
#include "rlvc/bits.h"

static uint64_t memory[1024];

static inline void small_config(rlvc_domain *domain, rlvc_config *config) {
    (void)rlvc_bits_domain(4, domain);
    (void)rlvc_config_default(config, domain, 2);
    config->capacity = 4;
    config->classes = 3;
}

static inline rlvc_agent *small_agent(void) {
    rlvc_domain domain;
    rlvc_config config;
    rlvc_agent *agent;
    small_config(&domain, &config);
    return rlvc_agent_init(&config, &domain, memory, sizeof memory, &agent) == RLVC_OK ? agent : 0;
}

/* Up to `most` interactions with unknown percepts and rewards. */
static inline void live(rlvc_agent *agent, uint32_t most) {
    unsigned char percept[1];
    rlvc_choice choice;
    any_bytes(percept, sizeof percept);
    (void)rlvc_begin(agent, percept);
    for (uint32_t i = 0; i < most; i++)
        if (rlvc_act(agent, &choice) == RLVC_OK) {
            any_bytes(percept, sizeof percept);
            (void)rlvc_observe(agent, choice, any_real(-3e38f, 3e38f), percept,
                               (uint8_t)any_in(0, 3));
        }
}

#endif
