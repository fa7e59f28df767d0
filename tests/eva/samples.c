/* SPDX-License-Identifier: MIT */
/* A small ring of any interactions, with returns and targets at any position; and sorting a few
 * samples of any keys. */
#include "any.h"
#include "base/arena.h"
#include "rlvc/bits.h"
#include "samples/replay.h"
#include "samples/sort.h"
#include "samples/targets.h"

#define SLOTS 3u
#define CLASSES 3u
#define COUNT 4u

static uint64_t memory[64];

/* Every kind of target of the interactions at positions [0, end). */
static void targets(const rlvc_replay *replay, uint32_t end) {
    static float value[CLASSES];
    rlvc_values values = {0};
    rlvc_target_cursor target;
    values.target = value;
    for (uint32_t c = 0; c < CLASSES; c++)
        value[c] = any_real(-1e30f, 1e30f);
    for (uint32_t slot = 0; slot < SLOTS; slot++) /* as labelling leaves what is linked to */
        replay->label[slot] = (uint16_t)any_in(0, CLASSES - 1u);
    const rlvc_target_input input = {
        {replay, end, any_in(0, 1), any_real(0.0f, 0.999f), (uint8_t)any_in(0, 1)},
        &values,
        any_real(0.0f, 1.0f),
        (uint8_t)each_in(0, 2)};
    for (uint32_t position = 0; position < end; position++) {
        rlvc_target_begin(&target, position);
        for (uint32_t i = 0; i < 4u && !target.done; i++)
            (void)rlvc_target_step(&target, &input, 1);
        (void)rlvc_target_distinct(&input, target.key, any_in(0, UINT32_MAX));
    }
}

static void ring(void) {
    rlvc_arena arena = {(unsigned char *)memory, 0};
    rlvc_config config = {0};
    rlvc_replay replay;
    unsigned char percept[1];
    config.capacity = SLOTS - 1u;
    rlvc_replay_carve(&replay, &arena, &config, sizeof percept);
    for (uint32_t i = 0; i < SLOTS + 1u; i++) {
        any_bytes(percept, sizeof percept);
        if (!replay.open) {
            (void)rlvc_replay_begin(&replay, percept);
        } else {
            const rlvc_choice choice = {(uint8_t)any_in(0, 1), (uint8_t)any_in(0, 1)};
            rlvc_replay_append(&replay, choice, any_real(-1e30f, 1e30f), percept,
                               (uint8_t)each_in(0, 2));
        }
    }
    targets(&replay, rlvc_replay_freeze(&replay));
    (void)rlvc_replay_check(&replay, 2, CLASSES);
    rlvc_replay_clear(&replay);
}

static void sorting(void) {
    static uint32_t scratch[RLVC_SORT_SCRATCH_BYTES / sizeof(uint32_t)];
    rlvc_sample sample[COUNT];
    rlvc_sort_cursor sort;
    for (uint32_t i = 0; i < COUNT; i++) {
        sample[i].key = any_in(0, UINT32_MAX);
        sample[i].slot = i;
    }
    rlvc_sort_begin(&sort, sample, each_in(0, COUNT), scratch);
    for (uint32_t i = 0; i < COUNT && !sort.done; i++)
        rlvc_sort_single(&sort);
}

int eva_samples(void) {
    ring();
    sorting();
    return 0;
}
