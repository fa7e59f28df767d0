/* SPDX-License-Identifier: MIT */
/* Learners on real numbers, where a compiler that fuses a product and a sum learns another tree: by
 * thresholds with tests of two components, and by descriptors. Prints their trees as JSON. */
#include <rlvc/float_rules.h>

#include <rlvc/rlvc.h>
#include <stdio.h>
#include <string.h>

#define ACTIONS 3u
#define CAPACITY 600u
#define CLASSES 24u
#define COMPONENTS 3u
#define POINTS 2u
#define DIMENSIONS 11u

static uint64_t block[30000];

static int print(void *file, const char *text, size_t bytes) {
    return fwrite(text, 1, bytes, (FILE *)file) != bytes;
}

/* A number in [0, 1), a multiple of 2^-16. */
static float chance(uint32_t *state) {
    *state = *state * 1664525u + 1013904223u;
    return (float)(*state >> 16) * (1.0f / 65536.0f);
}

/* Fills a percept: its second number is noise, the others say, more or less, where the agent is. */
static void sense(float at, uint32_t numbers, uint32_t *state, float *number) {
    for (uint32_t k = 0; k < numbers; k++)
        number[k] = k == 1 ? chance(state) : at + 0.1f * chance(state);
}

/* Lives a while: action 0 goes up, action 1 goes down, and action 2 stays, which pays where the sum
 * of two numbers is high. The percept's numbers begin at `offset`. */
static rlvc_status live(rlvc_agent *agent, uint32_t numbers, uint32_t offset, float *percept) {
    rlvc_status status = RLVC_OK;
    rlvc_progress progress;
    rlvc_choice choice;
    uint32_t state = 7;
    float at = 0.3f;
    for (uint32_t i = 0; i < CAPACITY && status == RLVC_OK; i++) {
        if (i % 25u == 0) {
            sense(at, numbers, &state, percept + offset);
            status = rlvc_begin(agent, percept);
        }
        if (status == RLVC_OK)
            status = rlvc_act(agent, &choice);
        if (status != RLVC_OK)
            return status;
        const float sum = percept[offset] + 0.5f * percept[offset + 1u];
        const float reward = choice.action == 2u && sum > 0.8f ? 1.0f : 0.0f;
        at += choice.action == 0 ? 0.137f : choice.action == 1u ? -0.129f : 0.0f;
        at = at < 0.0f ? 0.0f : at > 1.0f ? 1.0f : at;
        sense(at, numbers, &state, percept + offset);
        status = rlvc_observe(agent, choice, reward + 0.3f * chance(&state), percept,
                              i % 25u == 24u ? RLVC_TRUNCATED : RLVC_GOES_ON);
        if (status == RLVC_OK && i % 200u == 199u)
            status = rlvc_learn(agent, RLVC_BUDGET_UNBOUNDED, &progress);
    }
    return status;
}

static rlvc_status learn(const rlvc_domain *domain, uint32_t numbers, uint32_t offset,
                         float *percept) {
    rlvc_config config;
    rlvc_agent *agent;
    rlvc_status status = rlvc_config_default(&config, domain, ACTIONS);
    config.method = &rlvc_method_classes;
    config.capacity = CAPACITY;
    config.classes = CLASSES;
    config.epsilon = 0.7f;
    if (status == RLVC_OK)
        status = rlvc_agent_init(&config, domain, block, sizeof block, &agent);
    if (status == RLVC_OK)
        status = live(agent, numbers, offset, percept);
    return status == RLVC_OK ? rlvc_print(agent, RLVC_PRINT_JSON, print, stdout) : status;
}

static rlvc_status learn_thresholds(void) {
    float percept[COMPONENTS];
    rlvc_thresholds thresholds;
    rlvc_domain domain;
    rlvc_status status = rlvc_thresholds_default(&thresholds, COMPONENTS);
    thresholds.oblique = 1;
    if (status == RLVC_OK)
        status = rlvc_thresholds_domain(&thresholds, &domain);
    return status == RLVC_OK ? learn(&domain, COMPONENTS, 0, percept) : status;
}

static rlvc_status learn_descriptors(void) {
    static const uint32_t points = POINTS;
    float percept[1u + POINTS * DIMENSIONS];
    rlvc_descriptors descriptors;
    rlvc_domain domain;
    rlvc_status status =
        rlvc_descriptors_default(&descriptors, POINTS, DIMENSIONS, RLVC_DESCRIPTORS_FLOAT, 0.8f);
    if (status == RLVC_OK)
        status = rlvc_descriptors_domain(&descriptors, &domain);
    memcpy(percept, &points, sizeof points);
    return status == RLVC_OK ? learn(&domain, POINTS * DIMENSIONS, 1, percept) : status;
}

int main(void) {
    printf("{\"trees\": [\n");
    rlvc_status status = learn_thresholds();
    printf(",\n");
    if (status == RLVC_OK)
        status = learn_descriptors();
    printf("]}\n");
    return status == RLVC_OK ? 0 : 1;
}
