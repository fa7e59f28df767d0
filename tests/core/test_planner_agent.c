/* SPDX-License-Identifier: MIT */
/* The planner by the calls that serve every agent, and its policy by itself. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "rlvc/rlvc.h"
#include "slider_player.h"

static uint64_t memory[40000], other_memory[40000];

static rlvc_planner *make(const rlvc_config *config, uint64_t *block) {
    return make_in(config, block, sizeof memory);
}

/* ------------------------------------------------------------------ first percepts */

/* They are counted for ever: also where a number of 32 bits would begin anew, there are some, and
 * the next one takes the oldest one's place. */
static void test_first_percepts_for_ever(void **state) {
    (void)state;
    rlvc_config config = small_config();
    rlvc_planner *planner = make(&config, memory);
    const float percept[2] = {0.25f, -0.5f};
    for (uint32_t n = 1; n < 4u * RLVC_PLANNER_STARTS; n++) {
        assert_int_equal(rlvc_begin(as_agent(planner), percept), RLVC_OK);
        assert_int_equal(planner->starts % RLVC_PLANNER_STARTS, n % RLVC_PLANNER_STARTS);
        assert_int_equal(planner->starts < RLVC_PLANNER_STARTS, n < RLVC_PLANNER_STARTS);
    }
    for (uint32_t n = 0; n < 3u; n++) {
        planner->starts = UINT32_MAX - n;
        assert_int_equal(rlvc_begin(as_agent(planner), percept), RLVC_OK);
        assert_int_equal(planner->starts,
                         n == 0 ? RLVC_PLANNER_STARTS : 2u * RLVC_PLANNER_STARTS - n);
    }
}

/* ------------------------------------------------------------------ counts that end */

/* What is counted stays at 2^32 - 1, and the planner learns on. */
static void test_counts_end(void **state) {
    (void)state;
    rlvc_config config = small_config();
    rlvc_planner *planner = make(&config, memory);
    player p;
    start(&p, planner, 7);
    play(&p, 600);
    planner->experience.total = planner->fitted = planner->searched = UINT32_MAX - 1u;
    planner->episodes = planner->fits = planner->searches = planner->candidates = UINT32_MAX - 1u;
    for (uint32_t round = 0; round < 3u; round++) {
        play(&p, 600);
        const rlvc_planner_statistics statistics = stats_of(planner);
        assert_int_equal(statistics.interactions, UINT32_MAX);
        assert_int_equal(statistics.episodes, UINT32_MAX);
        assert_int_equal(statistics.fits, UINT32_MAX);
        assert_int_equal(statistics.searches, UINT32_MAX);
        assert_int_equal(statistics.candidates, UINT32_MAX);
        assert_in_range(planner->experience.total - planner->fitted, 0, 599);
        assert_in_range(planner->experience.total - planner->searched, 0, 599);
    }
}

/* The interactions since the last fit and search are no more than 32 bits tell apart. */
static void test_distances_end(void **state) {
    (void)state;
    rlvc_config config = small_config();
    rlvc_planner *planner = make(&config, memory);
    const float percept[2] = {0.25f, -0.5f};
    const rlvc_choice choice = {0, 0};
    assert_int_equal(rlvc_begin(as_agent(planner), percept), RLVC_OK);
    planner->experience.total = UINT32_MAX;
    planner->fitted = 3;
    planner->searched = 2;
    planner->explored = UINT32_MAX - 1u;
    planner->acting.why = RLVC_PLANNER_EXPLORE;
    for (uint32_t i = 0; i < 3u; i++) {
        assert_int_equal(rlvc_observe(as_agent(planner), choice, 0.0f, percept, RLVC_GOES_ON),
                         RLVC_OK);
        assert_int_equal(planner->fitted, i == 0 ? 2 : 1);
        assert_int_equal(planner->searched, i == 0 ? 1 : 0);
        assert_int_equal(planner->explored, UINT32_MAX);
    }
}

/* A tree that was found or chosen is acted by; what explores is not. */
static void test_what_is_exploited(void **state) {
    (void)state;
    rlvc_config config = small_config();
    rlvc_planner *planner = make(&config, memory);
    const float percept[2] = {0.25f, -0.5f};
    rlvc_choice choice;
    assert_int_equal(rlvc_begin(as_agent(planner), percept), RLVC_OK);
    rlvc_small_tree_constant(&planner->acting.tree, 0);
    for (uint8_t why = RLVC_PLANNER_RANDOM; why <= RLVC_PLANNER_AGAIN; why++) {
        planner->acting.why = why;
        assert_int_equal(rlvc_act(as_agent(planner), &choice), RLVC_OK);
        assert_int_equal(choice.exploited, why == RLVC_PLANNER_NEW || why == RLVC_PLANNER_AGAIN);
    }
}

/* ------------------------------------------------------------------ as a policy by itself */

static char text[4000];

static int append(void *ctx, const char *part, size_t bytes) {
    size_t *used = ctx;
    assert_true(*used + bytes < sizeof text);
    memcpy(text + *used, part, bytes);
    *used += bytes;
    text[*used] = '\0';
    return 0;
}

static void test_the_policy_alone(void **state) {
    (void)state;
    static uint64_t block[RLVC_PLANNER_POLICY_BYTES / 8u];
    rlvc_config config = small_config();
    rlvc_planner *planner = make(&config, memory);
    rlvc_policy_config options;
    rlvc_policy_info info;
    rlvc_policy *policy;
    player p;
    size_t used = 0, bytes;
    assert_int_equal(rlvc_policy_default(as_agent(planner), &options), RLVC_OK);
    assert_int_equal(rlvc_policy_size(as_agent(planner), &options, &bytes), RLVC_OK);
    assert_int_equal(bytes, sizeof block);
    start(&p, planner, 2);
    for (uint32_t round = 0; round < 3; round++) {
        assert_int_equal(
            rlvc_policy_make(as_agent(planner), &options, block, bytes, &policy, &info), RLVC_OK);
        assert_int_equal(info.leaves, stats_of(planner).leaves);
        assert_int_equal(info.as_agent, 1);
        for (uint32_t i = 0; i < 500; i++) {
            float s[2] = {2.0f * rlvc_rng_uniform(&p.rng) - 1.0f,
                          2.0f * rlvc_rng_uniform(&p.rng) - 1.0f};
            uint32_t expected, action;
            assert_int_equal(planner_predict(planner, s, &expected), RLVC_OK);
            assert_int_equal(rlvc_policy_act(policy, s, &action), RLVC_OK);
            assert_int_equal(action, expected);
        }
        play(&p, 700);
    }
    assert_int_equal(rlvc_policy_print(policy, RLVC_PRINT_TEXT, append, &used), RLVC_OK);
    assert_non_null(strstr(text, "?\n"));
    used = 0;
    assert_int_equal(rlvc_policy_export_c(policy, "slide", append, &used, NULL), RLVC_OK);
    assert_non_null(strstr(text, "slide"));
}

static void test_no_policy(void **state) {
    (void)state;
    static uint64_t block[RLVC_PLANNER_POLICY_BYTES / 8u];
    rlvc_config config = small_config();
    rlvc_agent *agent = as_agent(make(&config, memory));
    rlvc_policy_config options;
    rlvc_policy *policy;
    size_t bytes = sizeof block;
    (void)rlvc_policy_default(agent, &options);
    assert_int_equal(rlvc_policy_make(agent, &options, block, bytes, NULL, NULL), RLVC_E_NULL);
    assert_int_equal(rlvc_policy_make(NULL, &options, block, bytes, &policy, NULL), RLVC_E_NULL);
    assert_int_equal(rlvc_policy_make(agent, &options, NULL, bytes, &policy, NULL), RLVC_E_NULL);
    assert_int_equal(rlvc_policy_make(agent, &options, block, bytes - 1u, &policy, NULL),
                     RLVC_E_MEMORY);
    assert_int_equal(rlvc_policy_make(agent, &options, (char *)block + 4, bytes, &policy, NULL),
                     RLVC_E_MEMORY);
    assert_null(policy);
    assert_int_equal(rlvc_policy_make(agent, &options, block, bytes, &policy, NULL), RLVC_OK);
}

/* ------------------------------------------------------------------ as any agent */

static void test_the_tree_is_the_policy(void **state) {
    (void)state;
    rlvc_config config = small_config();
    rlvc_planner *planner = make(&config, memory);
    rlvc_agent *agent = as_agent(planner);
    rlvc_statistics statistics;
    rlvc_learnt learnt;
    player p;
    size_t used = 0;
    start(&p, planner, 2);
    for (uint32_t round = 0; round < 3; round++) {
        assert_int_equal(rlvc_stats(agent, &statistics), RLVC_OK);
        rlvc_view(agent, &learnt);
        assert_int_equal(rlvc_tree_check(learnt.tree), 1);
        assert_int_equal(statistics.classes, learnt.tree->classes);
        assert_int_equal(statistics.depth, rlvc_tree_deepest(learnt.tree));
        assert_int_equal(statistics.interactions, 700u * round);
        for (uint32_t i = 0; i < 500; i++) {
            float s[2] = {2.0f * rlvc_rng_uniform(&p.rng) - 1.0f,
                          2.0f * rlvc_rng_uniform(&p.rng) - 1.0f};
            uint32_t class_id, action, expected;
            assert_int_equal(rlvc_predict(agent, s, &class_id, &action), RLVC_OK);
            assert_int_equal(rlvc_tree_classify(learnt.tree, learnt.domain, s, &expected), RLVC_OK);
            assert_int_equal(class_id, expected);
            assert_int_equal(learnt.policy[class_id], action);
        }
        play(&p, 700);
    }
    assert_int_equal(statistics.stored, 1400);
    assert_int_equal(rlvc_print(agent, RLVC_PRINT_TEXT, append, &used), RLVC_OK);
    assert_non_null(strstr(text, "?\n"));
    used = 0;
    assert_int_equal(rlvc_export_c(agent, "slide", append, &used, NULL), RLVC_OK);
    assert_non_null(strstr(text, "slide"));
}

/* What is of classes alone, and what is of planners alone. */
static void test_another_method(void **state) {
    (void)state;
    rlvc_config config = small_config();
    rlvc_agent *agent = as_agent(make(&config, memory));
    rlvc_counts counts = {0};
    rlvc_progress progress;
    rlvc_planner_statistics statistics;
    rlvc_planner_test node;
    float s[2] = {0.0f, 0.0f};
    uint32_t number;
    size_t bytes;
    assert_int_equal(rlvc_q(agent, 0, 0, NULL, NULL), RLVC_E_MISMATCH);
    assert_int_equal(rlvc_value(agent, 0, NULL, NULL), RLVC_E_MISMATCH);
    assert_int_equal(rlvc_split_at(agent, 0, NULL, NULL), RLVC_E_MISMATCH);
    assert_int_equal(rlvc_learn_abandon(agent), RLVC_E_MISMATCH);
    assert_int_equal(rlvc_prune(agent, 0.0f, 0.0f, &number), RLVC_E_MISMATCH);
    assert_int_equal(rlvc_counts_size(agent, &counts, &bytes), RLVC_E_MISMATCH);
    assert_int_equal(rlvc_learn_counts(agent, &counts, other_memory, 8, &progress),
                     RLVC_E_MISMATCH);
    config.method = &rlvc_method_classes;
    assert_int_equal(planner_size(&config, &bytes), RLVC_OK);
    assert_int_equal(rlvc_agent_init(&config, &planner_domain, other_memory, bytes, &agent),
                     RLVC_OK);
    assert_int_equal(rlvc_planner_act_at(agent, s, &number), RLVC_E_MISMATCH);
    assert_int_equal(rlvc_planner_stats(agent, &statistics), RLVC_E_MISMATCH);
    assert_int_equal(rlvc_planner_node(agent, 0, &node), RLVC_E_MISMATCH);
    assert_int_equal(rlvc_value(agent, 0, NULL, NULL), RLVC_OK);
    assert_int_equal(rlvc_budget_min(agent, &number), RLVC_OK);
    assert_int_equal(number, RLVC_BUDGET_MIN);
    assert_int_equal(rlvc_budget_min(agent, NULL), RLVC_E_NULL);
    config.method = NULL;
    bytes = 1;
    assert_int_equal(planner_size(&config, &bytes), RLVC_E_CONFIG);
    assert_int_equal(bytes, 0);
    assert_int_equal(planner_size(&config, NULL), RLVC_E_NULL);
    assert_int_equal(rlvc_agent_init(&config, &planner_domain, memory, sizeof memory, &agent),
                     RLVC_E_CONFIG);
    assert_null(agent);
    assert_int_equal(rlvc_agent_init(&config, &planner_domain, memory, sizeof memory, NULL),
                     RLVC_E_NULL);
}

/* Where one method alone is built in its functions are the public ones: they look for null pointers
 * themselves. */
static void test_without_a_table(void **state) {
    (void)state;
    const rlvc_choice choice = {0, 0};
    rlvc_config config = small_config();
    rlvc_store store = {0};
    rlvc_agent *agent = as_agent(make(&config, memory));
    rlvc_choice chosen;
    rlvc_progress progress;
    rlvc_statistics statistics;
    float s[2] = {0.0f, 0.0f};
    uint32_t number = 1;
    size_t bytes = 1;
    assert_int_equal(rlvc_snapshot_size(NULL, &planner_domain, NULL), RLVC_E_NULL);
    assert_int_equal(rlvc_snapshot_size(NULL, &planner_domain, &number), RLVC_E_NULL);
    assert_int_equal(number, 0);
    assert_int_equal(rlvc_agent_size(NULL, &planner_domain, NULL), RLVC_E_NULL);
    assert_int_equal(rlvc_agent_size(NULL, &planner_domain, &bytes), RLVC_E_NULL);
    assert_int_equal(rlvc_agent_init(NULL, &planner_domain, memory, 8, NULL), RLVC_E_NULL);
    assert_int_equal(rlvc_load(NULL, &planner_domain, memory, 8, &store, NULL), RLVC_E_NULL);
    assert_int_equal(rlvc_agent_check(NULL), RLVC_E_NULL);
    assert_int_equal(rlvc_save(NULL, &store), RLVC_E_NULL);
    assert_int_equal(rlvc_stats(NULL, &statistics), RLVC_E_NULL);
    assert_int_equal(rlvc_stats(agent, NULL), RLVC_E_NULL);
    assert_int_equal(rlvc_classes_learn(NULL, RLVC_BUDGET_MIN, &progress), RLVC_E_NULL);
    assert_int_equal(rlvc_classes_budget_min(NULL, &number), RLVC_E_NULL);
    assert_int_equal(rlvc_classes_save(NULL, &store), RLVC_E_NULL);
    assert_int_equal(rlvc_classes_load(NULL, &planner_domain, memory, 8, &store, &agent),
                     RLVC_E_NULL);
    assert_int_equal(rlvc_planner_begin(NULL, s), RLVC_E_NULL);
    assert_int_equal(rlvc_planner_act(NULL, &chosen), RLVC_E_NULL);
    assert_int_equal(rlvc_planner_observe(NULL, choice, 0.0f, s, 0), RLVC_E_NULL);
    assert_int_equal(rlvc_planner_learn(NULL, 1u << 20, &progress), RLVC_E_NULL);
    assert_int_equal(rlvc_planner_budget_min(NULL, &number), RLVC_E_NULL);
    assert_int_equal(rlvc_planner_check(NULL), RLVC_E_NULL);
}

static rlvc_agent *printed;

/* While a callback runs, nothing else may. */
static int call_back(void *ctx, const char *part, size_t bytes) {
    rlvc_planner *planner = (rlvc_planner *)(void *)printed;
    rlvc_statistics statistics;
    rlvc_planner_statistics more;
    rlvc_planner_test node;
    rlvc_progress progress;
    rlvc_policy_config options = {0};
    rlvc_policy *policy;
    float s[2] = {0.0f, 0.0f};
    uint32_t action;
    assert_int_equal(planner_begin(planner, s), RLVC_E_REENTERED);
    assert_int_equal(planner_act(planner, &action), RLVC_E_REENTERED);
    assert_int_equal(planner_observe(planner, 0, 0.0f, s, 0), RLVC_E_REENTERED);
    assert_int_equal(planner_learn(planner, 1u << 20, &progress), RLVC_E_REENTERED);
    assert_int_equal(planner_predict(planner, s, &action), RLVC_E_REENTERED);
    assert_int_equal(rlvc_planner_act_at(printed, s, &action), RLVC_E_REENTERED);
    assert_int_equal(rlvc_stats(printed, &statistics), RLVC_E_REENTERED);
    assert_int_equal(rlvc_planner_stats(printed, &more), RLVC_E_REENTERED);
    assert_int_equal(rlvc_planner_node(printed, 0, &node), RLVC_E_REENTERED);
    assert_int_equal(rlvc_agent_check(printed), RLVC_E_REENTERED);
    assert_int_equal(rlvc_print(printed, RLVC_PRINT_TEXT, append, ctx), RLVC_E_REENTERED);
    assert_int_equal(rlvc_export_c(printed, "again", append, ctx, NULL), RLVC_E_REENTERED);
    assert_int_equal(
        rlvc_policy_make(printed, &options, other_memory, sizeof other_memory, &policy, NULL),
        RLVC_E_REENTERED);
    return append(ctx, part, bytes);
}

static void test_calls_from_callbacks(void **state) {
    (void)state;
    rlvc_config config = small_config();
    size_t used = 0;
    printed = as_agent(make(&config, memory));
    assert_int_equal(rlvc_print(printed, RLVC_PRINT_TEXT, call_back, &used), RLVC_OK);
    assert_string_equal(text, "action 0\n");
    assert_int_equal(rlvc_agent_check(printed), RLVC_OK);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_first_percepts_for_ever), cmocka_unit_test(test_counts_end),
        cmocka_unit_test(test_distances_end),           cmocka_unit_test(test_what_is_exploited),
        cmocka_unit_test(test_the_policy_alone),        cmocka_unit_test(test_no_policy),
        cmocka_unit_test(test_the_tree_is_the_policy),  cmocka_unit_test(test_another_method),
        cmocka_unit_test(test_without_a_table),         cmocka_unit_test(test_calls_from_callbacks),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
