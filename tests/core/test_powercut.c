/* SPDX-License-Identifier: MIT */
/* The power fails at every byte that is written or erased while an agent is saved, over
 * RLVC_POWER_CYCLES cycles of learning and saving: what is loaded then is the older or the newer of
 * two agents, and goes on to the same tree.
 *
 * An agent that is loaded lies in memory that was filled beforehand, so that all its bytes follow
 * from the snapshot: two that agree in all of them do the same for ever. So it is enough that each
 * cut leaves one of two images, byte for byte, and that each image, once, goes on to the end of the
 * course. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "snapshots.h"
#include "agent/state.h"

#define HELD 64u

static unsigned char older[BLOCK_BYTES], newer[BLOCK_BYTES];
static player_result expected, got;

/* What happens between two saves. */
static void live(player *of, uint32_t cycle) {
    rlvc_progress progress;
    if (of->agent->learner.phase == 0)
        player_play(of, 8);
    assert_int_equal(rlvc_learn(of->agent, 64u + cycle % 7u * 100u, &progress), RLVC_OK);
}

/* From the beginning of a cycle to the end of the course. */
static void live_on(player *of, uint32_t cycle, player_result *result) {
    for (; cycle < RLVC_POWER_CYCLES; cycle++)
        live(of, cycle);
    player_result_of(of, result);
}

/* The memory of an agent that was loaded from a whole snapshot of the agent as it is at the
 * beginning of a cycle; and to that end of the course it comes which is expected. */
static void image_of(uint32_t cycle, unsigned char *image) {
    rlvc_store store = medium_store(&spare, &p.config, &p.domain, 0);
    assert_int_equal(rlvc_save(p.agent, &store), RLVC_OK);
    assert_int_equal(load(&other, &store), RLVC_OK);
    block_copy(image, other.block, p.bytes);
    other.world = p.world;
    other.playing = p.playing;
    live_on(&other, cycle, &got);
    assert_memory_equal(&got, &expected, sizeof got);
}

/* Saves, with a cut before the byte number `cut` of those to be written; returns 0 if it came too
 * late. Adds to *early the cuts after which the newer agent was there already. */
static int cut_at(const rlvc_store *store, uint32_t cycle, uint64_t cut, uint32_t *early) {
    m.power = m.written + cut;
    rlvc_status status = rlvc_save(p.agent, store);
    assert_true(status == RLVC_OK || status == RLVC_E_STORE);
    medium_revive(&m);
    assert_int_equal(load(&other, store), RLVC_OK);
    const int is_newer = block_equal(other.block, newer, p.bytes);
    if (!is_newer && (status == RLVC_OK || !block_equal(other.block, older, p.bytes)))
        fail_msg("cycle %u, cut at byte %u: the agent loaded is neither of the two",
                 (unsigned)cycle, (unsigned)cut);
    *early += is_newer && status != RLVC_OK;
    return status != RLVC_OK;
}

/* An agent whose small ring is full before its first step, which takes evidence the most
 * lightly. */
static void prepare_full(void) {
    prepare_holding(HELD);
    player_play(&p, HELD);
}

static void cut_everywhere(int flash, uint32_t bytes) {
    static medium before;
    uint32_t points = 0, early = 0;
    prepare_full();
    live_on(&p, 0, &expected);
    assert_true(player_stats(&p).classes > 1);
    prepare_full();
    rlvc_store store = medium_store(&m, &p.config, &p.domain, flash);
    assert_int_equal(rlvc_save(p.agent, &store), RLVC_OK);
    image_of(0, newer);
    for (uint32_t cycle = 0; cycle < RLVC_POWER_CYCLES; cycle++) {
        memcpy(older, newer, sizeof older);
        live(&p, cycle);
        image_of(cycle + 1u, newer);
        assert_true(memcmp(older, newer, p.bytes) != 0);
        before = m;
        for (uint64_t cut = 0; cut_at(&store, cycle, cut, &early); cut++) {
            m = before;
            points++;
        }
    }
    player_result_of(&p, &got);
    assert_memory_equal(&got, &expected, sizeof got);
    assert_true(m.syncs > 0);
    assert_true(points > RLVC_POWER_CYCLES * bytes);
    /* The last bytes of a CRC may stand there already, by chance. */
    assert_true(early < 10);
}

static void test_cuts_of_a_file(void **state) {
    (void)state;
    cut_everywhere(0, 400);
}

static void test_cuts_of_a_flash(void **state) {
    (void)state;
    cut_everywhere(1, 1200);
}

/* After a cut, saving goes on: into the slot that was torn, not into the one that is whole. */
static void test_save_after_cut(void **state) {
    (void)state;
    prepare_small();
    rlvc_store store = medium_store(&m, &p.config, &p.domain, 1);
    rlvc_snapshot_info info;
    assert_int_equal(rlvc_save(p.agent, &store), RLVC_OK);
    assert_int_equal(rlvc_save(p.agent, &store), RLVC_OK);
    m.power = m.written + store.slot_bytes + 100u;
    assert_int_equal(rlvc_save(p.agent, &store), RLVC_E_STORE);
    medium_revive(&m);
    assert_int_equal(rlvc_snapshot_peek(&store, &info), RLVC_OK);
    assert_int_equal(info.sequence, 2);
    assert_int_equal(info.slot, 1);
    assert_int_equal(rlvc_save(p.agent, &store), RLVC_OK);
    assert_int_equal(rlvc_snapshot_peek(&store, &info), RLVC_OK);
    assert_int_equal(info.sequence, 3);
    assert_int_equal(info.slot, 0);
    /* The newest rots: the older one counts, and the next goes over the rotten one. */
    medium_slot(&store, 0)[200] ^= 1u;
    assert_int_equal(rlvc_snapshot_peek(&store, &info), RLVC_OK);
    assert_int_equal(info.sequence, 2);
    assert_int_equal(rlvc_save(p.agent, &store), RLVC_OK);
    assert_int_equal(rlvc_snapshot_peek(&store, &info), RLVC_OK);
    assert_int_equal(info.slot, 0);
    assert_int_equal(info.sequence, 3);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_cuts_of_a_file),
        cmocka_unit_test(test_cuts_of_a_flash),
        cmocka_unit_test(test_save_after_cut),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
