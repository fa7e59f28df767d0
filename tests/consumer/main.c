/* SPDX-License-Identifier: MIT */
/* The smallest use of the library that touches each kind of thing it exports: a function without an
 * agent, a ready-made domain, and an agent in a static block of the size that the headers name. */
#include <rlvc/rlvc.h>
#include <stdio.h>
#include <string.h>

int main(void) {
    static uint64_t memory[RLVC_AGENT_BYTES(2, 10, 2, 1, RLVC_BITS_FEATURE_BYTES, 8) / 8];
    rlvc_domain domain;
    rlvc_config config;
    rlvc_agent *agent = NULL;

    if (strcmp(rlvc_version(), EXPECTED_VERSION) != 0) {
        fprintf(stderr, "linked with rlvc %s, not " EXPECTED_VERSION "\n", rlvc_version());
        return 1;
    }
    rlvc_status status = rlvc_bits_domain(8, &domain);
    if (status == RLVC_OK)
        status = rlvc_config_default(&config, &domain, 2);
    config.capacity = 10;
    config.classes = 2;
    if (status == RLVC_OK)
        status = rlvc_agent_init(&config, &domain, memory, sizeof memory, &agent);
    if (status == RLVC_OK)
        status = rlvc_begin(agent, "x");
    printf("rlvc %s: %s\n", rlvc_version(), rlvc_status_text(status));
    return status != RLVC_OK;
}
