/* SPDX-License-Identifier: MIT */
/* Loads anything. The first bytes choose what agent the store once held and how far it had come in
 * a learning step; the others change bytes of its snapshot, or take the snapshot's place. Half of
 * the time the CRC is made right again. What is loaded must be sound and go on learning. */
#include "base/bytes.h"
#include "base/crc.h"
#include "rlvc/bits.h"
#include "rlvc/snapshot.h"

#include <stdlib.h>
#include <string.h>

#define CAPACITY 60u
#define STORE_BYTES 8192u

static unsigned char bytes_of_store[STORE_BYTES];

static int read_store(void *ctx, uint32_t offset, void *buffer, uint32_t bytes) {
    (void)ctx;
    if (offset + bytes > STORE_BYTES)
        abort();
    memcpy(buffer, bytes_of_store + offset, bytes);
    return 0;
}

static int write_store(void *ctx, uint32_t offset, const void *buffer, uint32_t bytes) {
    (void)ctx;
    if (offset + bytes > STORE_BYTES)
        abort();
    memcpy(bytes_of_store + offset, buffer, bytes);
    return 0;
}

static const rlvc_store store = {NULL, STORE_BYTES / 2, read_store, write_store, NULL, NULL};
static uint64_t memory[4096];

static void must(int condition) {
    if (!condition)
        abort();
}

/* Some interactions in a world of 16 cells in a row, of which the last one pays. */
static void play(rlvc_agent *agent) {
    unsigned char cell = 5;
    must(rlvc_begin(agent, &cell) == RLVC_OK);
    for (int i = 0; i < 50; i++) {
        rlvc_choice choice;
        must(rlvc_act(agent, &choice) == RLVC_OK);
        cell = (unsigned char)((cell + (choice.action ? 1u : 15u)) % 16u);
        float reward = cell == 15u ? 1.0f : 0.0f;
        uint8_t end = cell == 15u ? RLVC_TERMINATED : RLVC_GOES_ON;
        must(rlvc_observe(agent, choice, reward, &cell, end) == RLVC_OK);
        if (end == RLVC_TERMINATED) {
            cell = (unsigned char)(i % 15);
            must(rlvc_begin(agent, &cell) == RLVC_OK);
        }
    }
}

/* Saves what the choice stands for, in slot 0. */
static void save(const rlvc_config *config, const rlvc_domain *domain, uint32_t slices) {
    rlvc_agent *agent;
    rlvc_progress progress;
    memset(bytes_of_store, 0, sizeof bytes_of_store);
    must(rlvc_agent_init(config, domain, memory, sizeof memory, &agent) == RLVC_OK);
    play(agent);
    for (uint32_t i = 0; i < slices; i++)
        must(rlvc_learn(agent, RLVC_BUDGET_MIN, &progress) == RLVC_OK);
    must(rlvc_save(agent, &store) == RLVC_OK);
}

static void go_on(rlvc_agent *agent) {
    rlvc_progress progress;
    rlvc_choice choice;
    unsigned char cell = 3;
    must(rlvc_agent_check(agent) == RLVC_OK);
    for (int i = 0; i < 100; i++)
        must(rlvc_learn(agent, 500, &progress) == RLVC_OK);
    if (rlvc_begin(agent, &cell) == RLVC_OK)
        must(rlvc_act(agent, &choice) == RLVC_OK);
    must(rlvc_save(agent, &store) == RLVC_OK);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    rlvc_domain domain;
    rlvc_config config;
    rlvc_agent *agent;
    if (size < 3)
        return 0;
    must(rlvc_bits_domain(4, &domain) == RLVC_OK);
    must(rlvc_config_default(&config, &domain, 2) == RLVC_OK);
    config.capacity = CAPACITY;
    config.classes = 6;
    config.min_samples = 4;
    config.alpha = 1.0f;
    config.max_sweeps = 50;
    config.criterion = data[0] & 1u;
    config.solver = (uint8_t)((data[0] >> 1) % 4u);
    save(&config, &domain, data[1]);
    int mend = data[2] & 1, replace = data[2] >> 1 & 1;
    data += 3;
    size -= 3;
    if (replace) {
        memcpy(bytes_of_store, data, size < STORE_BYTES ? size : STORE_BYTES);
    } else {
        for (; size >= 3; data += 3, size -= 3)
            bytes_of_store[(data[0] | (uint32_t)data[1] << 8) % (STORE_BYTES / 2)] = data[2];
    }
    uint32_t length = (uint32_t)rlvc_get(bytes_of_store + 12, 4);
    if (mend && length >= 64u && length <= STORE_BYTES / 2)
        rlvc_put(bytes_of_store + length - 4, rlvc_crc(0, bytes_of_store, length - 4u), 4);
    rlvc_status status = rlvc_load(&config, &domain, memory, sizeof memory, &store, &agent);
    must((status == RLVC_OK) == (agent != NULL));
    if (status == RLVC_OK)
        go_on(agent);
    return 0;
}
