/* SPDX-License-Identifier: MIT */
/* Snapshots and logs from one byte order to the other: "orders write FOLDER" on one machine,
 * "orders read FOLDER" on another. Writing prints the trees that are learnt; reading prints them
 * twice, of agents that were loaded halfway through their learning step, and of agents that learnt
 * from the logs. */
#include <rlvc/float_rules.h>

#include <rlvc/rlvc.h>
#include <stdio.h>
#include <string.h>

#define INTERACTIONS 400u
#define HALFWAY 5000u
#define POINTS 3u
#define DIMENSIONS 2u
#define NUMBERS (1u + POINTS * DIMENSIONS) /* in the longest percept */

enum { BITS, THRESHOLDS, FLOAT_DESCRIPTORS, INT8_DESCRIPTORS, DOMAINS };
static const char *const names[DOMAINS] = {"bits", "thresholds", "descriptors", "int8"};

static uint64_t block[40000];
static unsigned char flash[1u << 17];
static rlvc_thresholds thresholds;
static rlvc_descriptors descriptors;

/* ------------------------------------------------------------------ domains */

static rlvc_status domain_of(int which, rlvc_domain *domain) {
    if (which == BITS)
        return rlvc_bits_domain(12, domain);
    if (which == THRESHOLDS) {
        (void)rlvc_thresholds_default(&thresholds, 2);
        return rlvc_thresholds_domain(&thresholds, domain);
    }
    const uint32_t form =
        which == INT8_DESCRIPTORS ? RLVC_DESCRIPTORS_INT8 : RLVC_DESCRIPTORS_FLOAT;
    (void)rlvc_descriptors_default(&descriptors, POINTS, DIMENSIONS, form, 40.0f);
    return rlvc_descriptors_domain(&descriptors, domain);
}

static uint32_t chance(uint32_t *state) {
    *state = *state * 1664525u + 1013904223u;
    return *state >> 16;
}

/* Makes a percept of a domain that shows `good`, or not, and noise. */
static void sense(int which, uint32_t good, uint32_t *state, void *percept) {
    float number[NUMBERS] = {0.0f};
    unsigned char *byte = (unsigned char *)percept;
    const uint32_t points = POINTS;
    if (which == BITS) {
        byte[0] = (unsigned char)((chance(state) & 0xf7u) | (good ? 8u : 0u));
        byte[1] = (unsigned char)(chance(state) & 15u);
    } else if (which == THRESHOLDS) {
        number[0] = (float)(chance(state) % 500u + (good ? 500u : 0u)) / 100.0f;
        number[1] = (float)(chance(state) % 7u);
        memcpy(percept, number, 2u * sizeof number[0]);
    } else if (which == FLOAT_DESCRIPTORS) {
        for (uint32_t i = 0; i < POINTS * DIMENSIONS; i++)
            number[i] = (float)(chance(state) % 20u) + (good && i < DIMENSIONS ? 100.0f : 0.0f);
        memcpy(percept, &points, sizeof points);
        memcpy(byte + sizeof points, number, POINTS * DIMENSIONS * sizeof number[0]);
    } else {
        memset(percept, 0,
               RLVC_DESCRIPTORS_PERCEPT_BYTES(POINTS, DIMENSIONS, RLVC_DESCRIPTORS_INT8));
        memcpy(percept, &points, sizeof points);
        for (uint32_t i = 0; i < POINTS * DIMENSIONS; i++)
            byte[sizeof points + i] =
                (unsigned char)(chance(state) % 20u + (good && i < DIMENSIONS ? 100u : 0u));
    }
}

/* ------------------------------------------------------------------ files */

static int flash_read(void *ctx, uint32_t offset, void *buffer, uint32_t bytes) {
    (void)ctx;
    memcpy(buffer, flash + offset, bytes);
    return 0;
}

static int flash_write(void *ctx, uint32_t offset, const void *buffer, uint32_t bytes) {
    (void)ctx;
    memcpy(flash + offset, buffer, bytes);
    return 0;
}

static int log_write(void *ctx, const void *bytes, uint32_t count) {
    return fwrite(bytes, 1, count, (FILE *)ctx) != count;
}

static int log_read(void *ctx, void *bytes, uint32_t room, uint32_t *got) {
    *got = (uint32_t)fread(bytes, 1, room, (FILE *)ctx);
    return 0;
}

static int print(void *ctx, const char *text, size_t bytes) {
    return fwrite(text, 1, bytes, (FILE *)ctx) != bytes;
}

static FILE *open_file(const char *folder, int which, const char *kind, const char *mode) {
    char path[1024];
    snprintf(path, sizeof path, "%s/%s.%s", folder, names[which], kind);
    return fopen(path, mode);
}

/* ------------------------------------------------------------------ learning */

/* Goes on with a learning step to its end, and prints the tree. */
static int finish(rlvc_agent *agent) {
    rlvc_progress progress = {0};
    while (!progress.done)
        if (rlvc_learn(agent, RLVC_BUDGET_UNBOUNDED, &progress) != RLVC_OK)
            return 1;
    return rlvc_print(agent, RLVC_PRINT_JSON, print, stdout) != RLVC_OK;
}

static int write_one(int which, const char *folder, const rlvc_config *config,
                     const rlvc_domain *domain, const rlvc_store *store) {
    uint32_t percept[NUMBERS], state = 7;
    rlvc_agent *agent;
    rlvc_log_writer writer;
    rlvc_progress progress;
    FILE *log = open_file(folder, which, "log", "wb");
    if (!log || rlvc_agent_init(config, domain, block, sizeof block, &agent) != RLVC_OK ||
        rlvc_log_open(&writer, domain->percept_bytes, 2, log_write, log) != RLVC_OK)
        return 1;
    writer.percept_words = domain->percept_words;
    for (uint32_t i = 0; i < INTERACTIONS; i++) {
        const uint32_t good = chance(&state) & 1u;
        const rlvc_choice choice = {(uint8_t)(chance(&state) & 1u), 0};
        const float reward = choice.action == good ? 1.0f : 0.0f;
        sense(which, good, &state, percept);
        if (rlvc_begin(agent, percept) != RLVC_OK || rlvc_log_begin(&writer, percept) != RLVC_OK)
            return 1;
        sense(which, good, &state, percept);
        if (rlvc_observe(agent, choice, reward, percept, RLVC_TRUNCATED) != RLVC_OK ||
            rlvc_log_observe(&writer, choice, reward, percept, RLVC_TRUNCATED) != RLVC_OK)
            return 1;
    }
    if (fclose(log) != 0 || rlvc_learn(agent, HALFWAY, &progress) != RLVC_OK ||
        rlvc_save(agent, store) != RLVC_OK)
        return 1;
    FILE *snapshot = open_file(folder, which, "snapshot", "wb");
    if (!snapshot || fwrite(flash, 1, sizeof flash, snapshot) != sizeof flash ||
        fclose(snapshot) != 0)
        return 1;
    return finish(agent);
}

/* The agent that learns from a log what it says. */
static int read_log(int which, const char *folder, const rlvc_config *config,
                    const rlvc_domain *domain) {
    static unsigned char buffer[256];
    uint32_t percept[NUMBERS];
    rlvc_agent *agent;
    rlvc_log_reader reader;
    rlvc_log_record record;
    rlvc_progress progress;
    rlvc_status status = RLVC_OK;
    FILE *log = open_file(folder, which, "log", "rb");
    if (!log || rlvc_agent_init(config, domain, block, sizeof block, &agent) != RLVC_OK ||
        rlvc_log_read(&reader, domain->percept_bytes, 2, buffer, sizeof buffer, log_read, log) !=
            RLVC_OK)
        return 1;
    reader.percept_words = domain->percept_words;
    do {
        status = rlvc_log_next(&reader, &record);
        if (status == RLVC_OK && record.percept)
            memcpy(percept, record.percept, domain->percept_bytes);
        if (status == RLVC_OK && record.kind == RLVC_LOG_BEGIN)
            status = rlvc_begin(agent, percept);
        else if (status == RLVC_OK && record.kind == RLVC_LOG_OBSERVE)
            status = rlvc_observe(agent, record.choice, record.reward, percept, record.end);
    } while (status == RLVC_OK && record.kind != RLVC_LOG_END);
    if (fclose(log) != 0 || status != RLVC_OK || reader.skipped > 0)
        return 1;
    return rlvc_learn(agent, HALFWAY, &progress) != RLVC_OK || finish(agent);
}

static int read_one(int which, const char *folder, const rlvc_config *config,
                    const rlvc_domain *domain, const rlvc_store *store) {
    rlvc_agent *agent;
    FILE *snapshot = open_file(folder, which, "snapshot", "rb");
    if (!snapshot || fread(flash, 1, sizeof flash, snapshot) != sizeof flash ||
        fclose(snapshot) != 0)
        return 1;
    if (rlvc_load(config, domain, block, sizeof block, store, &agent) != RLVC_OK || finish(agent))
        return 1;
    return read_log(which, folder, config, domain);
}

int main(int count, char **argument) {
    const int writing = count == 3 && strcmp(argument[1], "write") == 0;
    if (count != 3 || (!writing && strcmp(argument[1], "read") != 0)) {
        fprintf(stderr, "Usage: orders write|read FOLDER\n");
        return 2;
    }
    for (int which = 0; which < DOMAINS; which++) {
        rlvc_domain domain;
        rlvc_config config;
        rlvc_store store = {.read = flash_read, .write = flash_write};
        memset(flash, 0xff, sizeof flash);
        if (domain_of(which, &domain) != RLVC_OK ||
            rlvc_config_default(&config, &domain, 2) != RLVC_OK)
            return 1;
        config.method = &rlvc_method_classes;
        config.capacity = 2u * INTERACTIONS;
        config.classes = 16;
        if (rlvc_snapshot_size(&config, &domain, &store.slot_bytes) != RLVC_OK ||
            2u * store.slot_bytes > sizeof flash)
            return 1;
        if ((writing ? write_one : read_one)(which, argument[2], &config, &domain, &store) != 0) {
            fprintf(stderr, "orders: %s failed\n", names[which]);
            return 1;
        }
    }
    return 0;
}
