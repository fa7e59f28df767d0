/* SPDX-License-Identifier: MIT */
/* Policies made of agents: what they do at each percept, what they refuse, and callbacks that
 * fail. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "block.h"
#include "faulty.h"
#include "policy/worth.h"
#include "rlvc/min_tree.h"
#include "rlvc/rlvc.h"

#define BITS 3u
#define CANARY 0xa5

static uint64_t block[RLVC_AGENT_BYTES(70, 1000, 16, 1, RLVC_BITS_FEATURE_BYTES, BITS) / 8u];
static uint64_t saved[sizeof block / sizeof *block];
static uint64_t place[1u << 15];
static faulty broken;

/* What an action earns at a percept: bit 0 is worth most, the others say what to do. Where bit 2
 * alone is 1, action 1 is a little worse than action 0. */
static float reward_of(unsigned percept, uint32_t action) {
    const uint32_t right = (percept >> 1 & 1u) & (percept >> 2 & 1u);
    const float good = action == right ? 1.0f : percept >> 1 == 2u ? 0.9f : 0.0f;
    return 10.0f * (float)(percept & 1u) + good;
}

/* An agent that has seen percepts [0, percepts), and has learnt what to do there. */
static rlvc_agent *make(uint32_t percepts, uint32_t actions, uint32_t learns) {
    rlvc_domain domain, bits;
    rlvc_config config;
    rlvc_agent *agent;
    rlvc_progress progress;
    assert_int_equal(rlvc_bits_domain(BITS, &bits), RLVC_OK);
    domain = faulty_domain(&broken, &bits);
    assert_int_equal(rlvc_config_default(&config, &domain, actions), RLVC_OK);
    config.capacity = 1000;
    config.classes = 16;
    assert_int_equal(rlvc_agent_init(&config, &domain, block, sizeof block, &agent), RLVC_OK);
    for (uint32_t i = 0; i < 960 && percepts > 0; i++) {
        const unsigned char percept = (unsigned char)(i % percepts);
        const rlvc_choice choice = {(uint8_t)(i / percepts % 2u), 0};
        assert_int_equal(rlvc_begin(agent, &percept), RLVC_OK);
        assert_int_equal(
            rlvc_observe(agent, choice, reward_of(percept, choice.action), NULL, RLVC_TERMINATED),
            RLVC_OK);
    }
    if (learns)
        assert_int_equal(rlvc_learn(agent, RLVC_BUDGET_UNBOUNDED, &progress), RLVC_OK);
    return agent;
}

static rlvc_policy_config default_of(const rlvc_agent *agent) {
    rlvc_policy_config config;
    assert_int_equal(rlvc_policy_default(agent, &config), RLVC_OK);
    config.entries = 64;
    return config;
}

/* Makes a policy in a block of just the size, behind which nothing is touched. */
static rlvc_policy *compact(rlvc_agent *agent, const rlvc_policy_config *config,
                            rlvc_policy_info *info) {
    rlvc_policy *policy;
    size_t bytes = 0;
    assert_int_equal(rlvc_policy_size(agent, config, &bytes), RLVC_OK);
    assert_true(bytes + sizeof *place <= sizeof place);
    block_fill(place, CANARY, bytes + sizeof *place);
    block_copy(saved, block, sizeof block);
    assert_int_equal(rlvc_policy_make(agent, config, place, bytes, &policy, info), RLVC_OK);
    assert_true(block_equal(saved, block, sizeof block));
    for (size_t i = 0; i < sizeof *place; i++)
        assert_int_equal(((const unsigned char *)place)[bytes + i], CANARY);
    block_fill((unsigned char *)place + info->bytes, CANARY,
               bytes - info->bytes); /* not needed any more */
    return policy;
}

static uint32_t act(rlvc_policy *policy, unsigned char percept) {
    uint32_t action = 77;
    assert_int_equal(rlvc_policy_act(policy, &percept, &action), RLVC_OK);
    return action;
}

static void check_as_agent(rlvc_policy *policy, rlvc_agent *agent) {
    for (unsigned char percept = 0; percept < 1u << BITS; percept++) {
        uint32_t action = 0;
        assert_int_equal(rlvc_predict(agent, &percept, NULL, &action), RLVC_OK);
        assert_int_equal(act(policy, percept), action);
    }
}

static void test_fewer_leaves(void **unused) {
    (void)unused;
    rlvc_policy_info info;
    rlvc_agent *agent = make(8, 2, 1);
    rlvc_policy_config config = default_of(agent);
    rlvc_policy *policy = compact(agent, &config, &info);
    check_as_agent(policy, agent);
    assert_int_equal(info.classes, 6);
    assert_int_equal(info.collapsed, 6); /* its root is bit 0 */
    assert_int_equal(info.leaves, 3);
    assert_int_equal(info.percepts, 8);
    assert_int_equal(info.features, 3);
    assert_int_equal(info.exact, 1);
    assert_int_equal(info.as_agent, 0);
}

static void test_tolerance(void **unused) {
    (void)unused;
    rlvc_policy_info info;
    rlvc_agent *agent = make(8, 2, 1);
    rlvc_policy_config config = default_of(agent);
    config.tolerance = 0.0f;
    check_as_agent(compact(agent, &config, &info), agent);
    assert_int_equal(info.leaves, 3);
    config.tolerance = 0.02f; /* of 11, so that bit 2 is enough */
    rlvc_policy *policy = compact(agent, &config, &info);
    assert_int_equal(info.leaves, 2);
    for (unsigned char percept = 0; percept < 1u << BITS; percept++)
        assert_true(reward_of(percept, act(policy, percept)) >=
                    reward_of(percept, 1u - act(policy, percept)) - 0.2f);
    assert_true(info.value_after < info.value_before);
    assert_true(info.value_after >= info.value_before - 0.22f);
    config.tolerance = 1.0f;
    policy = compact(agent, &config, &info);
    assert_int_equal(info.leaves, 1);
    assert_int_equal(info.exact, 1);
}

/* Two worlds that bit 0 tells apart, in which one stays, for ever. Action 0 earns 1 in the one and
 * `less` in the other, action 1 the other way round, and action 2 tells the tree which is which. */
static rlvc_agent *make_lasting(float less, float discount, uint32_t sweeps) {
    rlvc_domain domain;
    rlvc_config config;
    rlvc_agent *agent;
    rlvc_progress progress;
    assert_int_equal(rlvc_bits_domain(1, &domain), RLVC_OK);
    assert_int_equal(rlvc_config_default(&config, &domain, 3), RLVC_OK);
    config.capacity = 1000;
    config.classes = 16;
    config.discount = discount;
    config.tolerance = 1e-5f;
    config.max_sweeps = sweeps;
    config.dependence = 0; /* 300 interactions with one percept, and then as many with the other */
    assert_int_equal(rlvc_agent_init(&config, &domain, block, sizeof block, &agent), RLVC_OK);
    for (uint32_t i = 0; i < 600; i++) {
        const unsigned char percept = (unsigned char)(i / 300u);
        const rlvc_choice choice = {(uint8_t)(i % 3u), 0};
        const float reward = choice.action == percept ? 1.0f
                             : choice.action < 2u     ? less
                                                      : -1.0f - 5.0f * (float)percept;
        if (i % 300u == 0)
            assert_int_equal(rlvc_begin(agent, &percept), RLVC_OK);
        assert_int_equal(rlvc_observe(agent, choice, reward, &percept, RLVC_GOES_ON), RLVC_OK);
    }
    assert_int_equal(rlvc_learn(agent, RLVC_BUDGET_UNBOUNDED, &progress), RLVC_OK);
    return agent;
}

/* A small loss in each step adds up to ten times as much: so less is allowed in a step. */
static void test_losses_add_up(void **unused) {
    (void)unused;
    rlvc_policy_info info;
    rlvc_agent *agent = make_lasting(0.5f, 0.9f, 10000);
    rlvc_policy_config config = default_of(agent);
    config.tolerance = 0.2f; /* of 7: in a step 0.5 would be far less */
    (void)compact(agent, &config, &info);
    assert_int_equal(info.leaves, 2);
    assert_int_equal(info.as_agent, 1);
    assert_true(info.value_before > 9.99f && info.value_before < 10.01f);
    assert_true(info.value_after == info.value_before);
    config.tolerance = 0.8f; /* more than 5 of 7 */
    (void)compact(agent, &config, &info);
    assert_int_equal(info.leaves, 1);
    assert_true(info.value_after > 7.49f && info.value_after < 7.51f); /* 10 and 5 */
    config.tolerance = 0.3f;
    (void)compact(agent, &config, &info);
    assert_int_equal(info.leaves, 2);
    /* Of a world that is unlike what the agent was told of it: five sweeps are all there are. */
    agent = make_lasting(0.5f, 1.0f, 5);
    config = default_of(agent);
    (void)compact(agent, &config, &info);
    assert_int_equal(info.leaves, 2);
}

/* What rounding takes for a tie costs something, once it is evaluated. */
static void test_no_tie(void **unused) {
    (void)unused;
    rlvc_policy_info info;
    rlvc_agent *agent = make_lasting(0.99997f, 0.99f, 10000);
    rlvc_policy_config config = default_of(agent);
    check_as_agent(compact(agent, &config, &info), agent);
    assert_int_equal(info.leaves, 2);
    assert_true(info.value_after == info.value_before);
    agent = make_lasting(1.0f, 0.99f, 10000); /* a tie */
    config = default_of(agent);
    (void)compact(agent, &config, &info);
    assert_int_equal(info.leaves, 1);
    assert_true(info.value_after == info.value_before);
}

/* Q-learning goes by what was earned last, the model by all: then another action may be better than
 * the agent's own, and what follows is random. */
static void test_better_in_the_model(void **unused) {
    (void)unused;
    rlvc_domain domain;
    rlvc_config config;
    rlvc_agent *agent;
    rlvc_progress progress;
    rlvc_policy_info info;
    assert_int_equal(rlvc_bits_domain(1, &domain), RLVC_OK);
    assert_int_equal(rlvc_config_default(&config, &domain, 2), RLVC_OK);
    config.capacity = 1000;
    config.classes = 16;
    config.solver = RLVC_SOLVER_Q_LEARNING;
    config.discount = 0.01f;
    assert_int_equal(rlvc_agent_init(&config, &domain, block, sizeof block, &agent), RLVC_OK);
    for (uint32_t i = 0; i < 800; i++) {
        const unsigned char percept = (unsigned char)(i % 2u), next = (unsigned char)(i / 8u % 2u);
        const rlvc_choice choice = {(uint8_t)(i / 2u % 2u), 0};
        const float changing = choice.action ? 0.9f : i < 500 ? 0.99f : 0.85f;
        const float reward = percept ? 5.0f * (float)(choice.action == 0) : changing;
        assert_int_equal(rlvc_begin(agent, &percept), RLVC_OK);
        assert_int_equal(rlvc_observe(agent, choice, reward, &next, RLVC_TRUNCATED), RLVC_OK);
        if (i == 300 || i == 799)
            assert_int_equal(rlvc_learn(agent, RLVC_BUDGET_UNBOUNDED, &progress), RLVC_OK);
    }
    const rlvc_policy_config options = default_of(agent);
    assert_int_equal(act(compact(agent, &options, &info), 0), 0);
    assert_int_equal(info.collapsed, 2);
    assert_int_equal(info.leaves, 1);
    assert_true(info.value_after == info.value_before);
}

/* Only what a finished learning step has labelled is in the model; of the rest Q is known. */
static void test_unlabelled(void **unused) {
    (void)unused;
    const unsigned char percept = 7;
    const rlvc_choice choice = {1, 0};
    rlvc_policy_info info, more;
    rlvc_progress progress;
    rlvc_agent *agent = make(8, 2, 1);
    const rlvc_policy_config config = default_of(agent);
    (void)compact(agent, &config, &info);
    assert_true(info.value_after == info.value_before);
    assert_int_equal(rlvc_begin(agent, &percept), RLVC_OK);
    assert_int_equal(rlvc_observe(agent, choice, -1e6f, &percept, RLVC_GOES_ON), RLVC_OK);
    (void)compact(agent, &config, &more);
    assert_true(more.value_before == info.value_before);
    assert_int_equal(more.leaves, info.leaves);
    assert_int_equal(rlvc_learn(agent, RLVC_BUDGET_MIN, &progress), RLVC_OK);
    assert_int_equal(progress.done, 0);
    (void)compact(agent, &config, &more);
    assert_true(more.value_before > info.value_before - 0.1f);
    assert_int_equal(more.leaves, info.leaves);
}

/* What was never tried is not as good, however wide the tolerance. */
static void test_untried(void **unused) {
    (void)unused;
    rlvc_policy_info info;
    rlvc_agent *agent = make(8, 64, 1);
    rlvc_policy_config config = default_of(agent);
    config.tolerance = 1.0f;
    assert_true(act(compact(agent, &config, &info), 0) < 2);
    agent = make(8, 64, 0);
    config = default_of(agent);
    assert_int_equal(act(compact(agent, &config, &info), 0), 0);
    assert_int_equal(info.leaves, 1);
}

static void test_as_agent(void **unused) {
    (void)unused;
    rlvc_policy_info info;
    rlvc_agent *agent = make(8, 2, 1);
    rlvc_policy_config config = default_of(agent);
    config.percepts = 7; /* no room for the eighth */
    check_as_agent(compact(agent, &config, &info), agent);
    assert_int_equal(info.leaves, 6);
    assert_int_equal(info.percepts, 0);
    assert_int_equal(info.exact, 0);
    assert_int_equal(info.as_agent, 1);
    config.percepts = 8;
    (void)compact(agent, &config, &info);
    assert_int_equal(info.leaves, 3);
    agent = make(8, 65, 1); /* more actions than a set holds */
    config = default_of(agent);
    check_as_agent(compact(agent, &config, &info), agent);
    assert_int_equal(info.leaves, 6);
    assert_int_equal(info.as_agent, 1);
    agent = make(0, 2, 1); /* no percept */
    config = default_of(agent);
    check_as_agent(compact(agent, &config, &info), agent);
    assert_int_equal(info.leaves, 1);
    assert_int_equal(info.as_agent, 1);
}

/* The index of the percepts takes more room than the search. */
static void test_many_percepts(void **unused) {
    (void)unused;
    rlvc_policy_info info;
    rlvc_agent *agent = make(8, 2, 1);
    rlvc_policy_config config = default_of(agent);
    config.percepts = 1025;
    config.entries = 2;
    check_as_agent(compact(agent, &config, &info), agent);
    assert_int_equal(info.percepts, 8);
}

/* Nothing is smaller than the collapsed tree, which then is taken: it is the agent's at percepts
 * never seen. */
static void test_nothing_smaller(void **unused) {
    (void)unused;
    rlvc_policy_info info;
    rlvc_agent *agent = make(1, 2, 1);
    rlvc_policy_config config = default_of(agent);
    check_as_agent(compact(agent, &config, &info), agent);
    assert_int_equal(info.leaves, 1);
    assert_int_equal(info.percepts, 1);
    assert_int_equal(info.exact, 1);
    assert_int_equal(info.as_agent, 1);
}

static void test_defaults(void **unused) {
    (void)unused;
    rlvc_policy_config config;
    rlvc_agent *agent = make(8, 2, 1);
    assert_int_equal(rlvc_policy_default(agent, &config), RLVC_OK);
    assert_true(config.tolerance == 0.0f);
    assert_int_equal(config.percepts, 1001);
    assert_int_equal(config.entries, 65536);
    assert_true(config.effort == (uint64_t)1 << 26);
    static uint64_t large[RLVC_AGENT_BYTES(2, 20000, 2, 1, RLVC_BITS_FEATURE_BYTES, BITS) / 8u];
    rlvc_domain domain;
    rlvc_config of_agent;
    assert_int_equal(rlvc_bits_domain(BITS, &domain), RLVC_OK);
    assert_int_equal(rlvc_config_default(&of_agent, &domain, 2), RLVC_OK);
    of_agent.capacity = 20000;
    of_agent.classes = 2;
    assert_int_equal(rlvc_agent_init(&of_agent, &domain, large, sizeof large, &agent), RLVC_OK);
    assert_int_equal(rlvc_policy_default(agent, &config), RLVC_OK);
    assert_int_equal(config.percepts, 16384);
}

static void test_refusals(void **unused) {
    (void)unused;
    rlvc_agent *agent = make(8, 2, 1);
    rlvc_policy_config config = default_of(agent), wrong;
    rlvc_policy *policy = NULL, *unwanted;
    unsigned char percept = 0;
    uint32_t action = 0;
    size_t bytes = 0;
    assert_int_equal(rlvc_policy_default(NULL, &config), RLVC_E_NULL);
    assert_int_equal(rlvc_policy_default(agent, NULL), RLVC_E_NULL);
    assert_int_equal(rlvc_policy_size(NULL, &config, &bytes), RLVC_E_NULL);
    assert_int_equal(rlvc_policy_size(agent, NULL, &bytes), RLVC_E_NULL);
    assert_int_equal(rlvc_policy_size(agent, &config, NULL), RLVC_E_NULL);
    const rlvc_policy_config wrongs[] = {{-1.0f, 8, 64, 0, 1},
                                         {1.1f, 8, 64, 0, 1},
                                         {0.0f, 0, 64, 0, 1},
                                         {0.0f, 8, 1, 0, 1},
                                         {0.0f, 8, 64, 1, 1},
                                         {0.0f, 8, 64, 0, 0},
                                         {0.0f, RLVC_MIN_TREE_ROWS_MAX + 1u, 64, 0, 1}};
    for (size_t i = 0; i < sizeof wrongs / sizeof *wrongs; i++) {
        wrong = wrongs[i];
        bytes = 1;
        assert_int_equal(rlvc_policy_size(agent, &wrong, &bytes), RLVC_E_RANGE);
        assert_int_equal(bytes, 0);
        assert_int_equal(rlvc_policy_make(agent, &wrong, place, sizeof place, &unwanted, NULL),
                         RLVC_E_RANGE);
        assert_null(unwanted);
    }
    assert_int_equal(rlvc_policy_size(agent, &config, &bytes), RLVC_OK);
    assert_int_equal(rlvc_policy_make(NULL, &config, place, bytes, &unwanted, NULL), RLVC_E_NULL);
    assert_int_equal(rlvc_policy_make(agent, NULL, place, bytes, &unwanted, NULL), RLVC_E_NULL);
    assert_int_equal(rlvc_policy_make(agent, &config, NULL, bytes, &unwanted, NULL), RLVC_E_NULL);
    assert_int_equal(rlvc_policy_make(agent, &config, place, bytes, NULL, NULL), RLVC_E_NULL);
    assert_int_equal(rlvc_policy_make(agent, &config, place, bytes - 1u, &unwanted, NULL),
                     RLVC_E_MEMORY);
    assert_int_equal(
        rlvc_policy_make(agent, &config, (unsigned char *)place + 4, bytes, &unwanted, NULL),
        RLVC_E_MEMORY);
    assert_null(unwanted);
    assert_int_equal(rlvc_policy_make(agent, &config, place, bytes, &policy, NULL), RLVC_OK);
    assert_int_equal(rlvc_policy_act(NULL, &percept, &action), RLVC_E_NULL);
    assert_int_equal(rlvc_policy_act(policy, NULL, &action), RLVC_E_NULL);
    assert_int_equal(rlvc_policy_act(policy, &percept, NULL), RLVC_E_NULL);
    assert_int_equal(rlvc_policy_print(NULL, 0, faulty_ignore, NULL), RLVC_E_NULL);
    assert_int_equal(rlvc_policy_print(policy, 0, NULL, NULL), RLVC_E_NULL);
    assert_int_equal(rlvc_policy_print(policy, 3, faulty_ignore, NULL), RLVC_E_RANGE);
    assert_int_equal(rlvc_policy_export_c(NULL, "a", faulty_ignore, NULL, NULL), RLVC_E_NULL);
    assert_int_equal(rlvc_policy_export_c(policy, NULL, faulty_ignore, NULL, NULL), RLVC_E_NULL);
    assert_int_equal(rlvc_policy_export_c(policy, "a", NULL, NULL, NULL), RLVC_E_NULL);
    assert_int_equal(rlvc_policy_export_c(policy, "1", faulty_ignore, NULL, NULL), RLVC_E_RANGE);
}

static void test_each_callback_failing(void **unused) {
    (void)unused;
    rlvc_policy_info info;
    rlvc_policy *policy;
    rlvc_agent *agent = make(8, 2, 1);
    rlvc_policy_config config = default_of(agent);
    const unsigned char percept = 6;
    uint32_t action = 77;
    broken.calls = 0;
    (void)compact(agent, &config, &info);
    const uint64_t calls = broken.calls;
    assert_int_equal(calls, 3u * 960u);
    for (uint64_t i = 1; i <= calls; i += 97) {
        rlvc_policy_info unchanged = info;
        broken.calls = 0;
        broken.fail_at = i;
        assert_int_equal(rlvc_policy_make(agent, &config, place, sizeof place, &policy, &unchanged),
                         RLVC_E_CALLBACK);
        assert_null(policy);
        assert_memory_equal(&unchanged, &info, sizeof info);
    }
    broken.fail_at = 0;
    policy = compact(agent, &config, &info);
    for (uint64_t i = 1; i <= 2; i++) {
        broken.calls = 0;
        broken.fail_at = i;
        assert_int_equal(rlvc_policy_act(policy, &percept, &action), RLVC_E_CALLBACK);
        assert_int_equal(action, 77);
    }
    broken.calls = 0;
    broken.fail_at = 2;
    assert_int_equal(rlvc_policy_print(policy, RLVC_PRINT_TEXT, faulty_ignore, NULL),
                     RLVC_E_CALLBACK);
    broken.fail_at = 0;
    assert_int_equal(act(policy, 6), 1);
}

/* ------------------------------------------------------------------ text */

typedef struct text {
    size_t bytes;
    char text[4000];
    rlvc_policy *reenter;
    uint32_t writes, failing;
} text;

static int append(void *ctx, const char *string, size_t bytes) {
    text *t = ctx;
    assert_true(t->bytes + bytes < sizeof t->text);
    memcpy(t->text + t->bytes, string, bytes);
    t->bytes += bytes;
    if (t->reenter) {
        const unsigned char percept = 0;
        uint32_t action = 0;
        assert_int_equal(rlvc_policy_act(t->reenter, &percept, &action), RLVC_E_REENTERED);
        assert_int_equal(rlvc_policy_print(t->reenter, 0, faulty_ignore, NULL), RLVC_E_REENTERED);
        assert_int_equal(rlvc_policy_export_c(t->reenter, "a", faulty_ignore, NULL, NULL),
                         RLVC_E_REENTERED);
    }
    return ++t->writes == t->failing;
}

static void test_print(void **unused) {
    (void)unused;
    static const char *const expected[] = {
        "bit 2?\n  no: action 0\n  yes: bit 1?\n    no: action 0\n    yes: action 1\n",
        "digraph rlvc {\n  node [fontname=\"sans-serif\"];\n  n0 [label=\"bit 2\"];\n"
        "  n0 -> n1 [label=\"no\", style=dashed];\n  n0 -> n2 [label=\"yes\"];\n"
        "  n1 [shape=box, label=\"action 0\"];\n  n2 [label=\"bit 1\"];\n"
        "  n2 -> n3 [label=\"no\", style=dashed];\n  n2 -> n4 [label=\"yes\"];\n"
        "  n3 [shape=box, label=\"action 0\"];\n  n4 [shape=box, label=\"action 1\"];\n}\n",
        "{\"classes\": 3, \"actions\": 2, \"nodes\": [\n"
        "  {\"node\": 0, \"test\": \"bit 2\", \"absent\": 1, \"present\": 2},\n"
        "  {\"node\": 1, \"class\": 0, \"action\": 0},\n"
        "  {\"node\": 2, \"test\": \"bit 1\", \"absent\": 3, \"present\": 4},\n"
        "  {\"node\": 3, \"class\": 1, \"action\": 0},\n"
        "  {\"node\": 4, \"class\": 2, \"action\": 1}\n]}\n"};
    static text t;
    rlvc_policy_info info;
    rlvc_agent *agent = make(8, 2, 1);
    rlvc_policy_config config = default_of(agent);
    rlvc_policy *policy = compact(agent, &config, &info);
    for (uint32_t format = RLVC_PRINT_TEXT; format <= RLVC_PRINT_JSON; format++) {
        memset(&t, 0, sizeof t);
        t.reenter = policy;
        assert_int_equal(rlvc_policy_print(policy, format, append, &t), RLVC_OK);
        assert_string_equal(t.text, expected[format]);
    }
}

static void test_export(void **unused) {
    (void)unused;
    static text t;
    rlvc_policy_info info;
    rlvc_export_info exported;
    rlvc_agent *agent = make(8, 2, 1);
    rlvc_policy_config config = default_of(agent);
    rlvc_policy *policy = compact(agent, &config, &info);
    memset(&t, 0, sizeof t);
    t.reenter = policy;
    assert_int_equal(rlvc_policy_export_c(policy, "a", append, &t, &exported), RLVC_OK);
    assert_int_equal(exported.leaves, 3);
    assert_int_equal(exported.compact, 3);
    assert_non_null(strstr(t.text, "a_action[4] = {\n    0, 0, 0, 1};"));
    t.bytes = 0;
    t.failing = t.writes + 5u;
    assert_int_equal(rlvc_policy_export_c(policy, "a", append, &t, NULL), RLVC_E_CALLBACK);
}

/* The detector calls every function of the agent while a policy is made of it. */
static int detector(void *ctx, const void *percept, const void *feature, uint8_t *present) {
    static rlvc_policy_config config;
    rlvc_agent *agent = ctx;
    rlvc_policy *policy;
    size_t bytes;
    (void)feature;
    *present = *(const unsigned char *)percept & 1u;
    assert_int_equal(rlvc_policy_default(agent, &config), RLVC_E_REENTERED);
    assert_int_equal(rlvc_policy_size(agent, &config, &bytes), RLVC_E_REENTERED);
    assert_int_equal(rlvc_policy_make(agent, &config, place, sizeof place, &policy, NULL),
                     RLVC_E_REENTERED);
    return 0;
}

static void test_reentering(void **unused) {
    (void)unused;
    rlvc_agent *agent = make(8, 2, 1);
    rlvc_policy_config config = default_of(agent);
    rlvc_policy *policy;
    broken.inner.exhibits = detector;
    broken.inner.ctx = agent;
    broken.agent = agent;
    broken.refused = 0;
    assert_int_equal(rlvc_policy_make(agent, &config, place, sizeof place, &policy, NULL), RLVC_OK);
    assert_true(broken.refused > 0);
}

/* One class, in which action `best` earns 1 and the others nothing, less than nothing, or half:
 * only what loses no more than it may is allowed. Whatever the memory held before. */
static void test_what_an_action_loses(void **state) {
    static const float earned[] = {0.0f, -1.0f, 0.5f};
    (void)state;
    for (uint32_t best = 0; best < 3u; best++) {
        rlvc_domain domain;
        rlvc_config config;
        rlvc_agent *agent;
        rlvc_progress progress;
        rlvc_worth worth;
        const unsigned char percept[1] = {0};
        assert_int_equal(rlvc_bits_domain(BITS, &domain), RLVC_OK);
        assert_int_equal(rlvc_config_default(&config, &domain, 3), RLVC_OK);
        config.capacity = 60;
        config.classes = 1;
        assert_int_equal(rlvc_agent_init(&config, &domain, block, sizeof block, &agent), RLVC_OK);
        for (uint32_t i = 0; i < 60u; i++) {
            const rlvc_choice choice = {(uint8_t)(i % 3u), 0};
            const float reward = i % 3u == best ? 1.0f : earned[i % 3u];
            assert_int_equal(rlvc_begin(agent, percept), RLVC_OK);
            assert_int_equal(rlvc_observe(agent, choice, reward, percept, RLVC_TERMINATED),
                             RLVC_OK);
        }
        assert_int_equal(rlvc_learn(agent, RLVC_BUDGET_UNBOUNDED, &progress), RLVC_OK);
        block_fill(place, CANARY, sizeof place);
        rlvc_arena arena = {(unsigned char *)place, 0};
        rlvc_worth_carve(&worth, &arena, agent);
        rlvc_worth_begin(&worth);
        float least = 1.0f;
        for (uint32_t a = 0; a < 3u; a++) {
            assert_true(worth.model.q[a] == (a == best ? 1.0f : earned[a]));
            least = worth.model.q[a] < least ? worth.model.q[a] : least;
        }
        assert_true(worth.spread == 1.0f - least);
        assert_int_equal(rlvc_worth_allowed(&worth, 0, 0.0f), 1u << best);
        assert_int_equal(rlvc_worth_allowed(&worth, 0, 0.6f), 1u << best | 1u << 2);
        assert_int_equal(rlvc_worth_allowed(&worth, 0, 2.0f), 7u);
        RLVC_UNPOISON(place, sizeof place);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_fewer_leaves),
        cmocka_unit_test(test_tolerance),
        cmocka_unit_test(test_losses_add_up),
        cmocka_unit_test(test_no_tie),
        cmocka_unit_test(test_better_in_the_model),
        cmocka_unit_test(test_unlabelled),
        cmocka_unit_test(test_untried),
        cmocka_unit_test(test_as_agent),
        cmocka_unit_test(test_nothing_smaller),
        cmocka_unit_test(test_many_percepts),
        cmocka_unit_test(test_defaults),
        cmocka_unit_test(test_refusals),
        cmocka_unit_test(test_each_callback_failing),
        cmocka_unit_test(test_print),
        cmocka_unit_test(test_export),
        cmocka_unit_test(test_reentering),
        cmocka_unit_test(test_what_an_action_loses),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
