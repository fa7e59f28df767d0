/* SPDX-License-Identifier: MIT */
/* The policies that were tried: their scores against the formula in double, and who is chosen. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "base/rng.h"
#include "plan/archive.h"
#include <math.h>

static uint64_t block[8192];
static rlvc_archive archive;
static rlvc_small_tree tree;

static void make(void) {
    rlvc_arena arena = {NULL, 0};
    rlvc_archive_carve(&archive, &arena, 1);
    assert_true(arena.used <= sizeof block);
    arena.base = (unsigned char *)block;
    arena.used = 0;
    rlvc_archive_carve(&archive, &arena, 1);
    rlvc_small_tree_constant(&tree, 0);
}

/* An episode whose promise is known. */
static void note(uint32_t policy, float promised, float earned) {
    rlvc_trial *trial = archive.trial + policy;
    uint32_t place = trial->episodes % RLVC_ARCHIVE_EPISODES;
    rlvc_archive_note(&archive, policy, &promised, earned);
    assert_true(rlvc_archive_start(&archive, policy, place)[0] == promised);
    assert_true(trial->valued <= place || trial->episodes <= RLVC_ARCHIVE_EPISODES);
    trial->promised[place] = promised;
    trial->valued = rlvc_trial_kept(trial);
}

static void test_untried(void **state) {
    (void)state;
    make();
    assert_int_equal(rlvc_archive_add(&archive, &tree, 50.0f), 0);
    rlvc_archive_score(&archive, 0.0f);
    assert_true(archive.beta == 1.0f && archive.common == 0.0f && archive.deviation == 0.0f);
    assert_true(archive.trial[0].score == 50.0f);
    assert_int_equal(rlvc_archive_best(&archive, 0.5f), 0);
    assert_int_equal(rlvc_archive_race(&archive), 0);
    assert_true(rlvc_archive_flat(&archive, 10.0f));
}

/* Returns are 0.5 of what was promised and 3 less, policy 1 earns 7 more than that; policy 2 was
 * never tried. */
static void test_scores_follow_the_formula(void **state) {
    (void)state;
    double x = 0.0, y = 0.0, xx = 0.0, xy = 0.0, sum[2] = {0.0, 0.0}, squares = 0.0;
    float promised[20], earned[20];
    rlvc_rng rng;
    rlvc_rng_seed(&rng, 4);
    make();
    (void)rlvc_archive_add(&archive, &tree, 60.0f);
    (void)rlvc_archive_add(&archive, &tree, 40.0f);
    (void)rlvc_archive_add(&archive, &tree, 10.0f);
    for (uint32_t i = 0; i < 20; i++) {
        promised[i] = 100.0f * rlvc_rng_uniform(&rng);
        earned[i] = 0.5f * promised[i] - 3.0f + (i % 2u ? 7.0f : 0.0f) + rlvc_rng_uniform(&rng);
        note(i % 2u, promised[i], earned[i]);
        x += (double)promised[i] / 20.0;
        y += (double)earned[i] / 20.0;
    }
    for (uint32_t i = 0; i < 20; i++) {
        xx += ((double)promised[i] - x) * ((double)promised[i] - x);
        xy += ((double)promised[i] - x) * ((double)earned[i] - y);
    }
    double beta = (xy + 0.1 * xx) / (1.1 * xx), common = y - beta * x;
    for (uint32_t i = 0; i < 20; i++)
        sum[i % 2u] += (double)earned[i] - beta * (double)promised[i];
    for (uint32_t i = 0; i < 20; i++)
        squares += pow((double)earned[i] - beta * (double)promised[i] - sum[i % 2u] / 10.0, 2.0);
    rlvc_archive_score(&archive, 80.0f);
    assert_true(fabs((double)archive.beta - beta) < 1e-4);
    assert_true(fabs((double)archive.common - common) < 1e-3);
    assert_true(fabs((double)archive.deviation - sqrt((squares + 64.0) / 19.0)) < 1e-2);
    double scores[2] = {beta * 60.0 + (sum[0] + 12.0 * common) / 22.0,
                        beta * 40.0 + (sum[1] + 12.0 * common) / 22.0};
    assert_true(fabs((double)archive.trial[0].score - scores[0]) < 1e-2);
    assert_true(fabs((double)archive.trial[1].score - scores[1]) < 1e-2);
    assert_true(fabs((double)archive.trial[2].score - beta * 10.0 - common) < 1e-2);
    assert_false(rlvc_archive_flat(&archive, 1e6f));
}

/* A model that foretells nothing, or the opposite, keeps a twentieth of its word; one that
 * foretells too little is not trusted more than wholly; of one that always says the same nothing is
 * known. */
static void test_beta_has_bounds(void **state) {
    (void)state;
    for (uint32_t k = 0; k < 4; k++) {
        make();
        (void)rlvc_archive_add(&archive, &tree, 0.0f);
        for (uint32_t i = 0; i < 30; i++) {
            float x = (float)(i % 5u), promised = k == 3 ? 2.0f : x;
            note(0, promised, k == 0 ? -x : k == 2 ? 0.0f : 3.0f * x);
        }
        rlvc_archive_score(&archive, 1.0f);
        if (k % 2u == 1u)
            assert_true(archive.beta == 1.0f);
        else
            assert_true(archive.beta < 0.1f);
    }
}

/* Returns in another unit are trusted as much: beta stays, all else is in that unit. */
static void test_any_unit_of_returns(void **state) {
    (void)state;
    const float unit[] = {1.0f, 1.0f / 1024.0f, 4096.0f};
    float beta = 0.0f, common = 0.0f, deviation = 0.0f, score = 0.0f;
    for (uint32_t k = 0; k < 3; k++) {
        make();
        (void)rlvc_archive_add(&archive, &tree, 3.0f * unit[k]);
        for (uint32_t i = 0; i < 30; i++) {
            float x = (float)(i % 5u);
            note(0, x * unit[k], (0.4f * x - 1.0f + 0.2f * (float)(i % 3u)) * unit[k]);
        }
        rlvc_archive_score(&archive, 2.0f * unit[k]);
        if (k == 0) {
            beta = archive.beta;
            common = archive.common;
            deviation = archive.deviation;
            score = archive.trial[0].score;
        }
        assert_true(beta > 0.3f && beta < 0.6f);
        assert_true(fabsf(archive.beta - beta) < 1e-5f);
        assert_true(fabsf(archive.common / unit[k] - common) < 1e-4f);
        assert_true(fabsf(archive.deviation / unit[k] - deviation) < 1e-4f);
        assert_true(fabsf(archive.trial[0].score / unit[k] - score) < 1e-4f);
    }
}

/* The lowest score makes room, wherever it stands; the newest is never it, as it comes after. */
static void test_the_worst_makes_room(void **state) {
    (void)state;
    for (uint32_t worst = 0; worst < RLVC_ARCHIVE_POLICIES; worst++) {
        make();
        for (uint32_t i = 0; i < RLVC_ARCHIVE_POLICIES; i++) {
            assert_int_equal(rlvc_archive_add(&archive, &tree, 0.0f), i);
            archive.trial[i].score = (float)((7u * (RLVC_ARCHIVE_POLICIES + i - worst)) % 16u);
        }
        assert_int_equal(rlvc_archive_add(&archive, &tree, 0.0f), worst);
        assert_int_equal(archive.count, RLVC_ARCHIVE_POLICIES);
        assert_int_equal(archive.trial[worst].serial, RLVC_ARCHIVE_POLICIES);
    }
}

/* An episode that takes the place of an older one has no promise until it is made. */
static void test_old_episodes_leave(void **state) {
    (void)state;
    make();
    (void)rlvc_archive_add(&archive, &tree, 0.0f);
    for (uint32_t i = 0; i < RLVC_ARCHIVE_EPISODES; i++)
        note(0, 1.0f, 2.0f);
    float start = 5.0f;
    rlvc_archive_note(&archive, 0, &start, 9.0f);
    assert_int_equal(archive.trial[0].valued, 0);
    rlvc_archive_note(&archive, 0, &start, 9.0f);
    assert_int_equal(archive.trial[0].valued, 0);
    assert_int_equal(rlvc_trial_kept(archive.trial), RLVC_ARCHIVE_EPISODES);
    rlvc_archive_forget(&archive);
    assert_false(archive.trial[0].promise_known);
}

static void test_flat(void **state) {
    (void)state;
    make();
    (void)rlvc_archive_add(&archive, &tree, 0.0f);
    (void)rlvc_archive_add(&archive, &tree, 0.0f);
    note(1, 0.0f, -500.0f);
    note(0, 0.0f, -500.0f);
    assert_true(rlvc_archive_flat(&archive, -90.0f));
    assert_false(rlvc_archive_flat(&archive, -500.0f)); /* nothing better was ever seen */
    note(0, 0.0f, -499.0f);
    assert_false(rlvc_archive_flat(&archive, -90.0f));
}

/* Episodes are counted up to 2^32 - 1. The last ones are kept all the same. */
static void test_episodes_for_ever(void **state) {
    (void)state;
    const uint32_t ahead = 4u * RLVC_ARCHIVE_EPISODES;
    make();
    (void)rlvc_archive_add(&archive, &tree, 0.0f);
    archive.trial[0].episodes = UINT32_MAX - ahead;
    for (uint32_t i = 0; i < 3u * ahead; i++) {
        note(0, 0.0f, (float)i);
        for (uint32_t e = 0; e < RLVC_ARCHIVE_EPISODES && i >= RLVC_ARCHIVE_EPISODES; e++)
            assert_in_range((uint32_t)archive.trial[0].earned[e], i - RLVC_ARCHIVE_EPISODES + 1u,
                            i);
        assert_in_range(archive.trial[0].episodes, UINT32_MAX - ahead, UINT32_MAX);
    }
}

/* Caution prefers what was tried more; the race what was tried less. */
static void test_choosing(void **state) {
    (void)state;
    make();
    for (uint32_t i = 0; i < 6; i++)
        (void)rlvc_archive_add(&archive, &tree, 0.0f);
    for (uint32_t i = 0; i < 5; i++)
        for (uint32_t e = 0; e < (i == 2 ? 1u : 20u); e++)
            note(i, 0.0f, 10.0f);
    const float scores[6] = {10.0f, 9.0f, 10.5f, 3.0f, 9.9f, 1.0f};
    for (uint32_t i = 0; i < 6; i++)
        archive.trial[i].score = scores[i];
    archive.deviation = 4.0f;
    assert_int_equal(rlvc_archive_best(&archive, 0.0f), 2);
    assert_int_equal(rlvc_archive_best(&archive, 0.5f), 0);
    assert_int_equal(rlvc_archive_race(&archive), 2);
    note(2, 0.0f, 10.0f);
    archive.deviation = 0.0f;
    archive.trial[2].score = 0.0f;
    assert_int_equal(rlvc_archive_race(&archive), 0);
    archive.trial[5].score = 9.5f; /* never tried, and now among the four */
    assert_int_equal(rlvc_archive_race(&archive), 5);
}

/* Of two that earned the same the smaller one is chosen, whether returns are gains or losses. */
static void test_the_smaller_is_chosen(void **state) {
    (void)state;
    for (float score = -100.0f; score < 200.0f; score += 200.0f) {
        make();
        for (uint32_t i = 0; i < 3; i++) {
            tree.leaves = (uint8_t)(i == 1 ? 4u : 6u);
            (void)rlvc_archive_add(&archive, &tree, 0.0f);
            note(i, 0.0f, score);
            archive.trial[i].score = i == 2 ? score + 0.3f : score;
        }
        assert_int_equal(rlvc_archive_best(&archive, 0.5f), 1);
        assert_int_equal(rlvc_archive_best(&archive, 0.0f), 2);
        archive.trial[2].score = score + 0.5f; /* two leaves are charged 0.4 */
        assert_int_equal(rlvc_archive_best(&archive, 0.5f), 2);
    }
}

/* Whatever its place among the four best, one that was never tried is raced; behind them it is not.
 * Where all were tried alike, it is the best. */
static void test_each_place(void **state) {
    (void)state;
    for (uint32_t odd = 0; odd < 36u; odd++) {
        make();
        for (uint32_t i = 0; i < 6u; i++)
            (void)rlvc_archive_add(&archive, &tree, 0.0f);
        const uint32_t place = odd % 6u, turn = odd / 6u; /* which one is which */
        for (uint32_t rank = 0; rank < 6u; rank++)
            for (uint32_t e = 0; e < 20u && rank != place; e++)
                note((rank + turn) % 6u, 0.0f, 10.0f);
        for (uint32_t rank = 0; rank < 6u; rank++)
            archive.trial[(rank + turn) % 6u].score = 10.0f - (float)rank;
        const uint32_t expected = (place < 4u ? place : 0u) + turn;
        archive.deviation = 0.001f;
        assert_int_equal(rlvc_archive_race(&archive), expected % 6u);
        for (uint32_t e = 0; e < 20u; e++)
            note((place + turn) % 6u, 0.0f, 10.0f);
        for (uint32_t rank = 0; rank < 6u; rank++)
            archive.trial[(rank + turn) % 6u].score = 10.0f - (float)rank;
        archive.deviation = 0.001f;
        assert_int_equal(rlvc_archive_race(&archive), turn);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_untried),
        cmocka_unit_test(test_episodes_for_ever),
        cmocka_unit_test(test_scores_follow_the_formula),
        cmocka_unit_test(test_beta_has_bounds),
        cmocka_unit_test(test_any_unit_of_returns),
        cmocka_unit_test(test_the_worst_makes_room),
        cmocka_unit_test(test_old_episodes_leave),
        cmocka_unit_test(test_flat),
        cmocka_unit_test(test_choosing),
        cmocka_unit_test(test_the_smaller_is_chosen),
        cmocka_unit_test(test_each_place),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
