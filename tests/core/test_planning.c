/* SPDX-License-Identifier: MIT */
/* One step of a planner's learning: what it promises, when and from where it searches, and what
 * becomes of a candidate and of what exploring found. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "slider_player.h"
#include <math.h>

static uint64_t memory[40000];

/* Ends the episode, learns, and begins the next. @return the searches so far. */
static uint32_t end_episode(player *p) {
    assert_int_equal(planner_observe(p->planner, 0, 1.0f, p->world.s, RLVC_TRUNCATED), RLVC_OK);
    learn(p->planner);
    begin(p);
    return p->planner->searches;
}

/* What a policy earns from a start in the models, by the luck of that number. */
static float earned_in(const rlvc_planner *planner, const rlvc_dynamics *models,
                       const rlvc_small_tree *tree, const float *start, uint32_t number) {
    float s[2];
    rlvc_rollout_input in = {models, 0, 0, NULL, 1};
    rlvc_rollout rollout = {0};
    in.horizon = rlvc_planner_horizon(planner);
    in.seed = planner->config.seed * 31u + 1u;
    rollout.s = s;
    rlvc_rollout_begin(&rollout, &in, start, number);
    while (!rollout.done)
        rlvc_rollout_step(&rollout, &in, tree, NULL);
    return rollout.total;
}

/* A policy's promise is the mean over the common starts, of which it takes the models in turn. */
static void check_promise(const rlvc_planner *planner, const rlvc_trial *trial) {
    float sum = 0.0f;
    for (uint32_t i = 0; i < planner->commons; i++)
        sum += earned_in(planner, planner->model, &trial->tree, planner->common + 2u * i, i);
    assert_true(trial->promise == sum / (float)planner->commons);
}

/* @return of how many episodes it is known what was promised: the mean over the models. */
static uint32_t check_promises(const rlvc_planner *planner) {
    uint32_t known = 0;
    for (uint32_t i = 0; i < planner->archive.count; i++) {
        const rlvc_trial *trial = planner->archive.trial + i;
        check_promise(planner, trial);
        for (uint32_t e = 0; e < trial->valued; e++, known++) {
            const float *start = rlvc_archive_start(&planner->archive, i, e);
            float sum = 0.0f;
            for (uint32_t k = 0; k < RLVC_ROLLOUT_MODELS; k++) {
                const rlvc_dynamics one[RLVC_ROLLOUT_MODELS] = {planner->model[k],
                                                                planner->model[k]};
                sum += earned_in(planner, one, &trial->tree, start, e);
            }
            assert_true(trial->promised[e] == sum / 2.0f);
        }
    }
    return known;
}

/* Also where an episode ends, and takes the place of another, between the models. */
static void test_an_episode_is_promised_by_both_models(void **state) {
    (void)state;
    player p;
    rlvc_planner *planner = play_small(&p, memory, sizeof memory, 3, 900);
    rlvc_progress progress;
    assert_true(check_promises(planner) > 0);
    assert_int_equal(planner_observe(planner, 0, 1.0f, p.world.s, RLVC_TRUNCATED), RLVC_OK);
    rlvc_archive_forget(&planner->archive);
    do
        assert_int_equal(planner_learn(planner, rlvc_planning_grain(planner), &progress), RLVC_OK);
    while (planner->planning.rolled == 0 && !progress.done);
    assert_false(progress.done);
    uint32_t policy = planner->planning.policy;
    rlvc_trial *trial = planner->archive.trial + policy;
    trial->episodes = RLVC_ARCHIVE_EPISODES; /* so that the next is where the first was */
    trial->valued = 0;
    begin(&p);
    planner->acting.why = RLVC_PLANNER_NEW;
    planner->acting.trial = policy;
    planner->acting.serial = trial->serial;
    assert_int_equal(planner_observe(planner, 0, 1.0f, p.world.s, RLVC_TRUNCATED), RLVC_OK);
    learn(planner);
    assert_int_equal(trial->valued, RLVC_ARCHIVE_EPISODES);
    assert_true(check_promises(planner) > RLVC_ARCHIVE_EPISODES);
}

/* After searches without gain the next one waits, but not for ever. */
static void test_searches_pause(void **state) {
    (void)state;
    player p;
    rlvc_planner *planner = play_small(&p, memory, sizeof memory, 5, 900);
    uint32_t searches = planner->searches;
    planner->gainful = 0;
    planner->fitted = planner->experience.total;
    planner->failures = 4;
    planner->searched = planner->experience.total;
    assert_int_equal(end_episode(&p), searches);
    assert_int_equal(planner->next.why, RLVC_PLANNER_AGAIN);
    planner->searched = planner->experience.total - 498u;
    assert_int_equal(end_episode(&p), searches);
    planner->searched = planner->experience.total - 499u; /* two pauses, with the next one */
    assert_int_equal(end_episode(&p), searches + 1u);
    assert_int_equal(planner->searched, planner->experience.total);
}

/* Learns slice by slice until a search is done. */
static void finish_search(rlvc_planner *planner, uint32_t least) {
    const uint32_t before = planner->candidates;
    rlvc_progress progress;
    while (planner->candidates == before)
        assert_int_equal(planner_learn(planner, least, &progress), RLVC_OK);
}

/* Ends the episode and learns slice by slice. @return how many searches were made. */
static uint32_t searches_of_a_step(player *p, uint32_t least) {
    const uint32_t *seed = &p->planner->planning.search.in.seed;
    uint32_t last = *seed, made = 0;
    rlvc_progress progress;
    assert_int_equal(planner_observe(p->planner, 0, 1.0f, p->world.s, RLVC_TRUNCATED), RLVC_OK);
    do {
        assert_int_equal(planner_learn(p->planner, least, &progress), RLVC_OK);
        made += *seed != last;
        last = *seed;
    } while (!progress.done);
    begin(p);
    return made;
}

/* A step of learning searches from the best policy; also from nothing once if the last search was
 * without gain, and twice at each eighth step. */
static void test_searches_from_nothing(void **state) {
    (void)state;
    const struct {
        uint32_t counter, failures, searches;
    } step[] = {{9, 0, 1}, {15, 0, 1}, {16, 0, 3}, {17, 1, 2}, {23, 2, 2}, {24, 2, 3}, {25, 0, 1}};
    player p;
    uint32_t least;
    rlvc_planner *planner = play_small(&p, memory, sizeof memory, 5, 600);
    assert_int_equal(rlvc_budget_min(as_agent(planner), &least), RLVC_OK);
    for (size_t i = 0; i < sizeof step / sizeof step[0]; i++) {
        planner->gainful = 0;
        planner->fitted = planner->experience.total;
        planner->counter = step[i].counter - 1u;
        planner->failures = step[i].failures;
        assert_int_equal(searches_of_a_step(&p, least), step[i].searches);
    }
}

/* Of searches that find what is worth the same, the first one's is the candidate. */
static void test_equal_candidates(void **state) {
    (void)state;
    float found = -3e38f; /* by the search from nothing, when anything is better */
    for (uint32_t equal = 0; equal < 2; equal++) {
        player p;
        uint32_t least;
        rlvc_planner *planner = play_small(&p, memory, sizeof memory, 5, 600);
        const rlvc_planning_cursor *planning = &planner->planning;
        planner->gainful = 0;
        planner->fitted = planner->experience.total;
        planner->counter = 8;
        planner->failures = 1;
        assert_int_equal(rlvc_budget_min(as_agent(planner), &least), RLVC_OK);
        assert_int_equal(planner_observe(planner, 0, 1.0f, p.world.s, RLVC_TRUNCATED), RLVC_OK);
        finish_search(planner, least);
        planner->planning.candidate_value = found;
        finish_search(planner, least);
        assert_int_equal(planning->derived, equal);
        assert_true(!equal || planning->candidate_value == found);
        found = planning->candidate_value;
    }
}

/* No policy has more leaves than asked for: on the slider others have three and more. */
static void test_leaves_are_bounded(void **state) {
    (void)state;
    rlvc_config config = small_config();
    player p;
    config.leaves = 2;
    rlvc_planner *planner = make_in(&config, memory, sizeof memory);
    start(&p, planner, 1);
    play(&p, 900);
    assert_int_equal(stats_of(planner).leaves, 2);
    for (uint32_t i = 0; i < planner->archive.count; i++)
        assert_in_range(planner->archive.trial[i].tree.leaves, 1, 2);
}

/* An episode of one interaction by a tree that explores; it is not learnt from. */
static void explore_once(player *p, uint32_t action, float reward) {
    rlvc_small_tree_constant(&p->planner->next.tree, action);
    p->planner->next.why = RLVC_PLANNER_EXPLORE;
    begin(p);
    assert_int_equal(planner_observe(p->planner, action, reward, p->world.s, RLVC_TRUNCATED),
                     RLVC_OK);
}

/* A tree that explored is a policy if it earned more than the best one is held to. */
static void test_discoveries_are_policies(void **state) {
    (void)state;
    rlvc_config config = small_config();
    rlvc_planner *planner = make_in(&config, memory, sizeof memory);
    const rlvc_archive *archive = &planner->archive;
    player p;
    start(&p, planner, 5);
    explore_once(&p, 0, -3.0f); /* the worst so far */
    assert_int_equal(archive->count, 0);
    explore_once(&p, 1, 2.0f);
    assert_int_equal(archive->count, 1);
    assert_int_equal(archive->trial->episodes, 1);
    assert_int_equal(archive->trial->promise_known, 0);
    assert_true(archive->trial->score == 2.0f && archive->trial->earned[0] == 2.0f);
    assert_int_equal(archive->trial->tree.node->action, 1);
    explore_once(&p, 2, 2.0f); /* no more than the best */
    assert_int_equal(archive->count, 1);
    for (uint32_t i = 1; i < 2u * RLVC_ARCHIVE_POLICIES; i++)
        explore_once(&p, i % 3u, (float)(2u + i));
    assert_int_equal(archive->count, RLVC_ARCHIVE_POLICIES);
    assert_true(archive->trial[RLVC_ARCHIVE_POLICIES - 1u].score == 17.0f);
}

/* What a new policy is held to earn: what all of such a promise did; or, derived from the best one,
 * what that does and what it promises more, if that is more. */
static void check_worth(const rlvc_archive *archive, const rlvc_trial *added,
                        const rlvc_trial *best, int derived) {
    const double beta = (double)archive->beta, promise = (double)added->promise;
    const double worth = beta * promise + (double)archive->common;
    const double made = (double)best->score + beta * (promise - (double)best->promise);
    assert_true(fabs((double)added->score - (derived ? fmax(made, worth) : worth)) < 1e-3);
}

/* A candidate acts unless it is held to earn less than the best policy by more than a return may
 * deviate: one of a search from nothing, where the best has come to earn much more. */
static void test_a_hopeless_candidate(void **state) {
    (void)state;
    for (uint32_t kind = 0; kind < 3; kind++) {
        const int hopeless = kind == 2;
        player p;
        rlvc_planner *planner = play_small(&p, memory, sizeof memory, 5, 900);
        rlvc_archive *archive = &planner->archive;
        uint32_t least;
        planner->gainful = 0;
        planner->failures = 0;
        planner->counter = 8; /* so that the next step makes one search, from the best policy */
        assert_int_equal(rlvc_budget_min(as_agent(planner), &least), RLVC_OK);
        assert_int_equal(planner_observe(planner, 0, 1.0f, p.world.s, RLVC_TRUNCATED), RLVC_OK);
        finish_search(planner, least);
        rlvc_trial *best = archive->trial + rlvc_archive_best(archive, 0.0f);
        assert_int_equal(planner->planning.derived, 1);
        planner->planning.derived = kind == 0;
        if (hopeless)
            best->score = 1e6f;
        learn(planner);
        assert_int_equal(planner->next.why, hopeless ? RLVC_PLANNER_AGAIN : RLVC_PLANNER_NEW);
        if (hopeless)
            assert_int_equal(planner->failures, 1);
        else
            check_worth(archive, archive->trial + planner->next.trial, best, kind == 0);
    }
}

/* Of an episode that explores, no more steps count than there are cells for a pair of components.
 */
static void test_a_long_exploration(void **state) {
    (void)state;
    player p;
    rlvc_planner *planner = play_small(&p, memory, sizeof memory, 5, 300);
    planner->acting.why = RLVC_PLANNER_EXPLORE;
    planner->steps = 400;
    planner->new_cells = 2;
    (void)end_episode(&p);
    assert_int_equal(planner->gainful, 0);
    planner->acting.why = RLVC_PLANNER_EXPLORE;
    planner->steps = 400;
    planner->new_cells = 3; /* one in fifty of 144 */
    (void)end_episode(&p);
    assert_int_equal(planner->gainful, 1);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_an_episode_is_promised_by_both_models),
        cmocka_unit_test(test_searches_pause),
        cmocka_unit_test(test_searches_from_nothing),
        cmocka_unit_test(test_equal_candidates),
        cmocka_unit_test(test_leaves_are_bounded),
        cmocka_unit_test(test_discoveries_are_policies),
        cmocka_unit_test(test_a_hopeless_candidate),
        cmocka_unit_test(test_a_long_exploration),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
