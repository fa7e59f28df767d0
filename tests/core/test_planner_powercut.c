/* SPDX-License-Identifier: MIT */
/* The power fails at every byte that is written or erased while a planner is saved: what is loaded
 * then is the older or the newer of two planners as a whole, as its snapshot says, and saving goes
 * on. Each RLVC_STRIDEth cut is tried; of a flash, where most bytes are only erased, each seventh
 * of these. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#define MEDIUM_BYTES 36864u
#include "block.h"
#include "slider_player.h"
#include "store.h"

#define SAVES 3u

static uint64_t memory[20000], other_memory[20000];
static medium m, spare;

typedef struct image {
    uint32_t bytes;
    unsigned char byte[MEDIUM_BYTES / 2];
} image;

/* A planner whose snapshot is short. */
static rlvc_config tiny_config(void) {
    rlvc_config config = slider_config();
    config.capacity = 80;
    config.random = 32;
    config.sample = 80;
    config.candidates = 20;
    config.patience = 10;
    config.model_leaves = 2;
    return config;
}

/* What a planner's snapshot holds, in a store of its own: all that it will ever do follows. */
static void image_of(rlvc_planner *planner, image *held) {
    rlvc_store store = medium_store(&spare, &planner->config, &planner_domain, 0);
    assert_int_equal(rlvc_save(as_agent(planner), &store), RLVC_OK);
    held->bytes = snapshot_bytes(spare.bytes);
    memcpy(held->byte, spare.bytes, held->bytes);
}

static int same(const image *a, const image *b) {
    return a->bytes == b->bytes && memcmp(a->byte, b->byte, a->bytes) == 0;
}

static void load_image(const rlvc_store *store, const rlvc_config *config, image *held) {
    rlvc_agent *loaded;
    size_t bytes;
    assert_int_equal(planner_size(config, &bytes), RLVC_OK);
    assert_true(bytes <= sizeof other_memory);
    block_fill(other_memory, 0, bytes);
    assert_int_equal(rlvc_load(config, &planner_domain, other_memory, bytes, store, &loaded),
                     RLVC_OK);
    image_of((rlvc_planner *)loaded, held);
}

/* Saves with a cut before the byte number `cut` of those to be written; returns 0 if it came too
 * late. */
static int cut_at(rlvc_planner *planner, const rlvc_store *store, uint64_t cut, const image *older,
                  const image *newer) {
    static image held;
    m.power = m.written + cut;
    rlvc_status status = rlvc_save(as_agent(planner), store);
    assert_true(status == RLVC_OK || status == RLVC_E_STORE);
    medium_revive(&m);
    load_image(store, &planner->config, &held);
    if (!same(&held, newer) && (status == RLVC_OK || !same(&held, older)))
        fail_msg("cut at byte %u: the planner loaded is neither of the two", (unsigned)cut);
    return status != RLVC_OK;
}

static void cut_everywhere(int flash, uint32_t stride) {
    static medium before;
    static image older, newer;
    const rlvc_config config = tiny_config();
    rlvc_planner *planner = make_in(&config, memory, sizeof memory);
    rlvc_store store = medium_store(&m, &config, &planner_domain, flash);
    player p;
    uint32_t points = 0;
    start(&p, planner, 3);
    assert_int_equal(rlvc_save(as_agent(planner), &store), RLVC_OK);
    image_of(planner, &newer);
    for (uint32_t i = 0; i < SAVES; i++) { /* without a model, with one, with a full ring */
        memcpy(&older, &newer, sizeof older);
        play(&p, 50);
        image_of(planner, &newer);
        assert_false(same(&older, &newer));
        before = m;
        for (uint64_t cut = 0; cut_at(planner, &store, cut, &older, &newer); cut += stride) {
            m = before;
            points++;
        }
    }
    assert_true(stats_of(planner).searches > 0);
    assert_true(points > SAVES * newer.bytes / 2u / stride);
}

static void test_cuts_of_a_file(void **state) {
    (void)state;
    cut_everywhere(0, RLVC_STRIDE);
}

static void test_cuts_of_a_flash(void **state) {
    (void)state;
    cut_everywhere(1, 7u * RLVC_STRIDE);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_cuts_of_a_file),
        cmocka_unit_test(test_cuts_of_a_flash),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
