/* SPDX-License-Identifier: MIT */
/* The planner as its users see it: on the slider, and on worlds where nothing can be learnt. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "block.h"
#include "rlvc/rlvc.h"
#include "slider_player.h"
#include <math.h>

static uint64_t memory[40000], other_memory[40000];

static rlvc_planner *make(const rlvc_config *config, uint64_t *block) {
    return make_in(config, block, sizeof memory);
}

/* What the learnt policy earns in an episode. */
static float value_of(rlvc_planner *planner) {
    rlvc_rng rng;
    float sum = 0.0f, reward;
    rlvc_rng_seed(&rng, 77);
    for (uint32_t e = 0; e < 50; e++) {
        slider world;
        uint32_t action;
        uint8_t end;
        slider_reset(&world, &rng);
        do {
            assert_int_equal(planner_predict(planner, world.s, &action), RLVC_OK);
            end = slider_step(&world, action, &reward);
            sum += reward / 50.0f;
        } while (end == RLVC_GOES_ON);
    }
    return sum;
}

/* ------------------------------------------------------------------ learning */

static void test_the_slider_is_balanced(void **state) {
    (void)state;
    for (uint32_t seed = 1; seed <= 5; seed += RLVC_STRIDE) {
        rlvc_config config = small_config();
        player p;
        config.seed = seed;
        rlvc_planner *planner = make(&config, memory);
        start(&p, planner, seed);
        play(&p, 2400); /* more than the ring holds */
        rlvc_planner_statistics statistics = stats_of(planner);
        assert_true(value_of(planner) > 50.0f); /* of 60 */
        assert_int_equal(statistics.verdict, RLVC_PLANNER_LEARNT);
        assert_int_equal(statistics.interactions, 2400);
        assert_true(statistics.leaves >= 2 && statistics.leaves <= config.leaves);
        assert_true(statistics.tried > 0 && statistics.fits > 5 && statistics.searches > 3);
        assert_true(statistics.beta > 0.5f && statistics.explored > 0);
        assert_true(fabsf(statistics.score - value_of(planner)) < 6.0f);
    }
}

/* The nodes are those of the policy that predict follows. */
static void test_nodes_are_the_policy(void **state) {
    (void)state;
    rlvc_config config = small_config();
    player p;
    rlvc_planner_test node;
    rlvc_planner *planner = make(&config, memory);
    assert_int_equal(rlvc_planner_node(as_agent(planner), 0, &node), RLVC_OK);
    assert_int_equal(node.component, RLVC_PLANNER_LEAF);
    assert_int_equal(node.action, 0);
    assert_int_equal(rlvc_planner_node(as_agent(planner), 1, &node), RLVC_E_RANGE);
    start(&p, planner, 1);
    play(&p, 1500);
    uint32_t nodes = 2u * stats_of(planner).leaves - 1u;
    assert_int_equal(rlvc_planner_node(as_agent(planner), nodes, &node), RLVC_E_RANGE);
    for (uint32_t i = 0; i < 1000; i++) {
        float s[2] = {2.0f * rlvc_rng_uniform(&p.rng) - 1.0f,
                      2.0f * rlvc_rng_uniform(&p.rng) - 1.0f};
        uint32_t action, k = 0;
        assert_int_equal(planner_predict(planner, s, &action), RLVC_OK);
        for (;;) {
            assert_int_equal(rlvc_planner_node(as_agent(planner), k, &node), RLVC_OK);
            if (node.component == RLVC_PLANNER_LEAF)
                break;
            k = node.child + (uint32_t)(s[node.component] > node.cutpoint);
        }
        assert_int_equal(node.action, action);
    }
}

static void test_slices_change_nothing(void **state) {
    (void)state;
    rlvc_config config = small_config();
    rlvc_planner *one = make(&config, memory), *other = make(&config, other_memory);
    player p, q;
    uint32_t least;
    size_t bytes;
    assert_int_equal(rlvc_budget_min(as_agent(other), &least), RLVC_OK);
    assert_int_equal(planner_size(&config, &bytes), RLVC_OK);
    start(&p, one, 3);
    start(&q, other, 3);
    q.budget = least;
    play(&p, 1500);
    play(&q, 1500);
    assert_true(p.work == q.work);
    rlvc_planner_statistics a_stats = stats_of(one), b_stats = stats_of(other);
    assert_memory_equal(&a_stats, &b_stats, sizeof a_stats);
    for (uint32_t k = 0; k + 1u < 2u * stats_of(one).leaves; k++) {
        rlvc_planner_test a, b;
        assert_int_equal(rlvc_planner_node(as_agent(one), k, &a), RLVC_OK);
        assert_int_equal(rlvc_planner_node(as_agent(other), k, &b), RLVC_OK);
        assert_memory_equal(&a, &b, sizeof a);
    }
}

/* A control loop: a slice at each interaction, whatever is under way. */
static void test_learning_while_acting(void **state) {
    (void)state;
    rlvc_config config = small_config();
    config.capacity = 600;
    config.random = 150;
    rlvc_planner *planner = make(&config, memory);
    player p;
    uint32_t busy = 0;
    start(&p, planner, 5);
    for (uint32_t i = 0; i < 12000; i++) {
        rlvc_progress progress;
        uint32_t action;
        float reward;
        assert_int_equal(planner_act(planner, &action), RLVC_OK);
        slider before = p.world;
        uint8_t end = slider_step(&p.world, action, &reward);
        rlvc_status status = planner_observe(planner, action, reward, p.world.s, end);
        if (status == RLVC_E_BUSY) { /* and nothing has changed: the world waits */
            assert_int_equal(planner_begin(planner, before.s), RLVC_E_BUSY);
            busy++;
            p.world = before;
            end = RLVC_GOES_ON;
        } else {
            assert_int_equal(status, RLVC_OK);
        }
        uint32_t budget = i % 3000u < 800u ? 5000u : 600000u;
        assert_int_equal(planner_learn(planner, budget, &progress), RLVC_OK);
        while (end != RLVC_GOES_ON) {
            slider_reset(&p.world, &p.rng);
            status = planner_begin(planner, p.world.s);
            if (status == RLVC_OK)
                break;
            assert_int_equal(status, RLVC_E_BUSY);
            assert_int_equal(planner_learn(planner, 60000, &progress), RLVC_OK);
        }
    }
    assert_true(busy > 0);
    assert_true(value_of(planner) > 45.0f);
    assert_true(stats_of(planner).tried > 0);
}

/* Eight components with their products: a regression of 48 terms, and a larger least budget. */
static void test_many_terms(void **state) {
    (void)state;
    rlvc_config config = small_config();
    rlvc_rng rng;
    rlvc_progress progress;
    float s[8] = {0.0f};
    uint32_t least;
    planner_components(8);
    config.actions = 4;
    config.model_leaves = 2;
    config.candidates = config.patience = 1;
    rlvc_planner *planner = make(&config, memory);
    assert_int_equal(rlvc_budget_min(as_agent(planner), &least), RLVC_OK);
    assert_true(least > 10000u);
    rlvc_rng_seed(&rng, 1);
    assert_int_equal(planner_begin(planner, s), RLVC_OK);
    for (uint32_t i = 0; i < 200; i++) {
        for (uint32_t k = 0; k < 8; k++) /* of which two are bits, one of them rare */
            s[k] =
                k < 6 ? rlvc_rng_uniform(&rng) : (float)(rlvc_rng_below(&rng, 20) < k * 2u - 11u);
        assert_int_equal(planner_observe(planner, i % 4u, s[0] + s[6], s,
                                         i == 199 ? RLVC_TRUNCATED : RLVC_GOES_ON),
                         RLVC_OK);
    }
    do
        assert_int_equal(planner_learn(planner, least, &progress), RLVC_OK);
    while (!progress.done);
    assert_int_equal(planner->fits, 1);
    for (uint32_t k = 0; k <= 8; k++)
        for (uint32_t i = 0; i < planner->model->tree[k].terms; i++)
            assert_true(fabsf(planner->model->tree[k].coefficient[i]) < 100.0f);
}

/* What acts at any percept is what acts in the next episode. */
static void test_acting_at_any_percept(void **state) {
    (void)state;
    rlvc_config config = small_config();
    rlvc_planner *planner = make(&config, memory);
    float s[2] = {0.0f, 0.0f}, far[2] = {0.0f, 2e9f};
    uint32_t action, other, count[SLIDER_ACTIONS] = {0};
    player p;
    for (uint32_t i = 0; i < 300; i++) { /* at random, before there is a policy */
        assert_int_equal(rlvc_planner_act_at(as_agent(planner), s, &action), RLVC_OK);
        count[action]++;
    }
    assert_true(count[0] > 60 && count[1] > 60 && count[2] > 60);
    start(&p, planner, 5);
    play(&p, 900);
    for (uint32_t i = 0; i < 20; i++) {
        s[0] = 0.1f * (float)i - 1.0f;
        assert_int_equal(rlvc_planner_act_at(as_agent(planner), s, &action), RLVC_OK);
        assert_int_equal(planner_begin(planner, s), RLVC_OK);
        assert_int_equal(planner_act(planner, &other), RLVC_OK);
        assert_int_equal(action, other);
    }
    assert_int_equal(rlvc_planner_act_at(NULL, s, &action), RLVC_E_NULL);
    assert_int_equal(rlvc_planner_act_at(as_agent(planner), NULL, &action), RLVC_E_NULL);
    assert_int_equal(rlvc_planner_act_at(as_agent(planner), s, NULL), RLVC_E_NULL);
    assert_int_equal(rlvc_planner_act_at(as_agent(planner), far, &action), RLVC_E_PERCEPT);
}

/* Where an episode never ends, a horizon's interactions are one. */
static void test_endless_episodes(void **state) {
    (void)state;
    rlvc_config config = small_config();
    config.horizon = 50;
    rlvc_planner *planner = make(&config, memory);
    rlvc_progress progress;
    rlvc_rng rng;
    float s = 0.0f;
    planner_components(1);
    rlvc_rng_seed(&rng, 1);
    config.actions = 2;
    planner = make(&config, memory);
    assert_int_equal(planner_begin(planner, &s), RLVC_OK);
    assert_int_equal(stats_of(planner).verdict, RLVC_PLANNER_NO_EPISODE);
    for (uint32_t i = 0; i < 1500; i++) {
        uint32_t action;
        assert_int_equal(planner_act(planner, &action), RLVC_OK);
        float reward = 1.0f - fabsf(s - 0.5f);
        s += (action ? 0.1f : -0.1f) + 0.02f * rlvc_rng_uniform(&rng);
        s = s > 2.0f ? 2.0f : s < -2.0f ? -2.0f : s;
        assert_int_equal(planner_observe(planner, action, reward, &s, RLVC_GOES_ON), RLVC_OK);
        assert_int_equal(planner_learn(planner, RLVC_BUDGET_UNBOUNDED, &progress), RLVC_OK);
    }
    assert_int_equal(stats_of(planner).episodes, 30);
    assert_int_equal(stats_of(planner).verdict, RLVC_PLANNER_LEARNT);
    uint32_t action;
    s = 0.9f;
    assert_int_equal(planner_predict(planner, &s, &action), RLVC_OK);
    assert_int_equal(action, 0);
    s = 0.1f;
    assert_int_equal(planner_predict(planner, &s, &action), RLVC_OK);
    assert_int_equal(action, 1);
}

/* ------------------------------------------------------------------ honesty */

enum { SAME, RANDOM, TERMINATED };

/* A reward of -1 at each interaction, or a random one that no policy has a say in; episodes of 20
 * interactions, or of 60 that terminate. */
static rlvc_planner_statistics play_pointless(int kind, uint32_t interactions) {
    rlvc_config config = small_config();
    rlvc_planner *planner = make(&config, memory);
    rlvc_progress progress;
    rlvc_rng rng;
    float s[2] = {0.0f, 0.0f};
    rlvc_rng_seed(&rng, 2);
    assert_int_equal(planner_begin(planner, s), RLVC_OK);
    for (uint32_t i = 1; i <= interactions; i++) {
        uint32_t action;
        assert_int_equal(planner_act(planner, &action), RLVC_OK);
        float reward = kind == RANDOM ? rlvc_rng_uniform(&rng) - 1.0f : -1.0f;
        s[0] = rlvc_rng_uniform(&rng);
        s[1] = rlvc_rng_uniform(&rng);
        uint8_t end = RLVC_GOES_ON;
        if (kind == TERMINATED)
            end = i % 60u == 0 ? RLVC_TERMINATED : RLVC_GOES_ON;
        else if (i % 20u == 0)
            end = RLVC_TRUNCATED;
        assert_int_equal(planner_observe(planner, action, reward, s, end), RLVC_OK);
        if (end == RLVC_GOES_ON)
            continue;
        assert_int_equal(planner_learn(planner, RLVC_BUDGET_UNBOUNDED, &progress), RLVC_OK);
        assert_int_equal(planner_begin(planner, s), RLVC_OK);
    }
    return stats_of(planner);
}

static void test_nothing_to_learn_is_said(void **state) {
    (void)state;
    rlvc_planner_statistics statistics = play_pointless(SAME, 1000);
    assert_int_equal(statistics.verdict, RLVC_PLANNER_NO_DIFFERENCE);
    assert_int_equal(statistics.searches, 0);
    assert_true(statistics.explored > 500);
    assert_int_equal(statistics.acting, RLVC_PLANNER_EXPLORE);
    statistics = play_pointless(RANDOM, 100);
    assert_int_equal(statistics.verdict, RLVC_PLANNER_NO_MODEL);
    statistics = play_pointless(RANDOM, 2000);
    assert_true(statistics.beta < 0.7f);
    statistics = play_pointless(TERMINATED, 240); /* too few to say that all are alike */
    assert_int_equal(statistics.verdict, RLVC_PLANNER_NO_DIFFERENCE);
    assert_true(statistics.searches > 0);
    statistics = play_pointless(TERMINATED, 900);
    assert_int_equal(statistics.acting, RLVC_PLANNER_EXPLORE);
}

/* Returns that are all equally good leave the model nothing to predict. */
static void test_equally_good_is_learnt(void **state) {
    (void)state;
    player p;
    rlvc_planner *planner = play_small(&p, memory, sizeof memory, 1, 900);
    assert_int_equal(stats_of(planner).verdict, RLVC_PLANNER_LEARNT);
    float score = stats_of(planner).score;
    planner->archive.beta = 0.05f;
    planner->archive.deviation = 0.2f * (score - planner->least);
    assert_int_equal(stats_of(planner).verdict, RLVC_PLANNER_LEARNT);
    planner->archive.deviation = 0.3f * (score - planner->least);
    assert_int_equal(stats_of(planner).verdict, RLVC_PLANNER_NO_MODEL);
    planner->archive.beta = 0.1f; /* is enough */
    assert_int_equal(stats_of(planner).verdict, RLVC_PLANNER_LEARNT);
}

/* ------------------------------------------------------------------ arguments */

static void test_defaults_and_ranges(void **state) {
    (void)state;
    rlvc_config config, wrong;
    size_t bytes = 1;
    rlvc_planner *planner;
    config = planner_default(4, 2);
    assert_ptr_equal(config.method, &rlvc_method_planner);
    assert_int_equal(config.actions, 2);
    assert_int_equal(planner_size(NULL, &bytes), RLVC_E_NULL);
    assert_int_equal(planner_size(&config, NULL), RLVC_E_NULL);
    struct {
        size_t field;
        uint32_t low;
        uint32_t high;
    } const range[] = {
        {offsetof(rlvc_config, actions), 2, RLVC_PLANNER_ACTIONS_MAX},
        {offsetof(rlvc_config, capacity), 2000, RLVC_PLANNER_CAPACITY_MAX},
        {offsetof(rlvc_config, sample), 32, 2000},
        {offsetof(rlvc_config, model_leaves), 1, RLVC_PLANNER_MODEL_LEAVES_MAX},
        {offsetof(rlvc_config, leaves), 2, RLVC_PLANNER_LEAVES_MAX},
        {offsetof(rlvc_config, horizon), 1, RLVC_PLANNER_CAPACITY_MAX},
        {offsetof(rlvc_config, random), 32, 1000},
        {offsetof(rlvc_config, candidates), 1, RLVC_PLANNER_CANDIDATES_MAX},
        {offsetof(rlvc_config, patience), 1, RLVC_PLANNER_CANDIDATES_MAX},
    };
    for (size_t i = 0; i < sizeof range / sizeof range[0]; i++) {
        const uint32_t value[] = {range[i].low, range[i].high, range[i].low - 1u,
                                  range[i].high + 1u};
        for (uint32_t k = 0; k < 4; k++) {
            wrong = config;
            memcpy((unsigned char *)&wrong + range[i].field, &value[k], sizeof value[k]);
            assert_int_equal(planner_size(&wrong, &bytes), k < 2 ? RLVC_OK : RLVC_E_CONFIG);
            assert_true((bytes > 0) == (k < 2));
        }
    }
    wrong = config;
    wrong.capacity = 63;
    wrong.sample = wrong.random = 32;
    assert_int_equal(planner_size(&wrong, &bytes), RLVC_E_CONFIG);
    assert_int_equal(planner_init(&wrong, memory, sizeof memory, &planner), RLVC_E_CONFIG);
    assert_null(planner);
    for (uint32_t components = 64; components <= 65; components++) {
        planner_components(components);
        assert_int_equal(planner_size(&config, &bytes), components == 64 ? RLVC_OK : RLVC_E_CONFIG);
    }
    planner_domain.percept_bytes = 3;
    assert_int_equal(planner_size(&config, &bytes), RLVC_E_CONFIG);
}

static void test_memory(void **state) {
    (void)state;
    rlvc_config config = small_config();
    rlvc_planner *planner;
    size_t bytes;
    assert_int_equal(planner_size(&config, &bytes), RLVC_OK);
    assert_int_equal(planner_init(&config, memory, bytes, NULL), RLVC_E_NULL);
    assert_int_equal(planner_init(&config, NULL, bytes, &planner), RLVC_E_NULL);
    block_fill(memory, 0x5a, sizeof memory);
    assert_int_equal(planner_init(&config, memory, bytes - 1u, &planner), RLVC_E_MEMORY);
    assert_int_equal(planner_init(&config, (char *)memory + 4, bytes, &planner), RLVC_E_MEMORY);
    for (size_t i = 0; i < sizeof memory / sizeof memory[0]; i++)
        assert_true(memory[i] == UINT64_C(0x5a5a5a5a5a5a5a5a));
    assert_null(planner);
    make(&config, memory);
    assert_true(memory[(bytes + 7u) / 8u] == UINT64_C(0x5a5a5a5a5a5a5a5a));
}

/* A block of the ample size is made use of, one of a byte less is not; both learn the same by the
 * same work. */
static void test_ample_memory(void **state) {
    (void)state;
    static uint64_t ample[60000], other[60000];
    rlvc_config config = small_config();
    size_t bytes, least;
    assert_int_equal(rlvc_planner_ample_size(&config, &planner_domain, NULL), RLVC_E_NULL);
    config.leaves = 1;
    assert_int_equal(rlvc_planner_ample_size(&config, &planner_domain, &bytes), RLVC_E_CONFIG);
    assert_int_equal(bytes, 0);
    config = small_config();
    assert_int_equal(rlvc_planner_ample_size(&config, &planner_domain, &bytes), RLVC_OK);
    assert_int_equal(planner_size(&config, &least), RLVC_OK);
    assert_true(bytes > least && bytes <= sizeof ample);
    rlvc_planner *planner[2];
    player p[2];
    block_fill(ample, 0x5a, sizeof ample);
    block_fill(other, 0x5a, sizeof other);
    assert_int_equal(planner_init(&config, ample, bytes, planner), RLVC_OK);
    assert_int_equal(planner_init(&config, other, bytes - 1u, planner + 1), RLVC_OK);
    assert_non_null(planner[0]->planning.search.reach[1].box);
    assert_null(planner[1]->planning.search.reach[0].box);
    for (uint32_t i = 0; i < 2; i++) {
        start(p + i, planner[i], 3);
        play(p + i, 1500);
    }
    assert_true(p[0].work == p[1].work && stats_of(planner[0]).searches > 3);
    assert_int_equal(planner[0]->archive.count, planner[1]->archive.count);
    for (uint32_t i = 0; i < planner[0]->archive.count; i++) {
        const rlvc_trial *one = planner[0]->archive.trial + i;
        const rlvc_trial *same = planner[1]->archive.trial + i;
        assert_true(one->promise == same->promise && one->score == same->score);
        assert_int_equal(one->tree.nodes, same->tree.nodes);
        assert_memory_equal(one->tree.node, same->tree.node,
                            one->tree.nodes * sizeof *one->tree.node);
    }
    assert_true(other[(least + 7u) / 8u] == UINT64_C(0x5a5a5a5a5a5a5a5a));
    assert_true(ample[(bytes + 7u) / 8u] == UINT64_C(0x5a5a5a5a5a5a5a5a));
}

/* The macro is enough for every shape, and not much more. */
static void test_the_macro_is_enough(void **state) {
    (void)state;
    for (uint32_t d = 1; d <= 64; d++) {
        for (uint32_t a = 2; a <= 64; a += 7) {
            rlvc_config config;
            size_t bytes;
            config = planner_default(d, a);
            config.model_leaves = 1u + (d * 5u + a) % 40u;
            config.capacity = 401u + d;
            config.sample = 33u + a;
            assert_int_equal(planner_size(&config, &bytes), RLVC_OK);
            size_t bound =
                RLVC_PLANNER_BYTES(d, a, config.capacity, config.sample, config.model_leaves);
#ifndef RLVC_RED_ZONES
            assert_true(bytes <= bound);
            assert_true(bound <= bytes + bytes / 5u + 4096u);
#else
            (void)bound;
#endif
        }
    }
}

static void test_nulls_and_order(void **state) {
    (void)state;
    rlvc_config config = small_config();
    rlvc_planner *planner = make(&config, memory);
    rlvc_planner_statistics statistics;
    rlvc_planner_test node;
    rlvc_progress progress;
    float s[2] = {0.0f, 0.0f};
    uint32_t action;
    assert_int_equal(planner_begin(NULL, s), RLVC_E_NULL);
    assert_int_equal(planner_begin(planner, NULL), RLVC_E_NULL);
    assert_int_equal(planner_act(NULL, &action), RLVC_E_NULL);
    assert_int_equal(rlvc_act(as_agent(planner), NULL), RLVC_E_NULL);
    assert_int_equal(rlvc_planner_act_at(as_agent(planner), s, NULL), RLVC_E_NULL);
    assert_int_equal(planner_observe(NULL, 0, 0.0f, s, 0), RLVC_E_NULL);
    assert_int_equal(planner_observe(planner, 0, 0.0f, NULL, 0), RLVC_E_NULL);
    assert_int_equal(planner_learn(NULL, 1u << 20, &progress), RLVC_E_NULL);
    assert_int_equal(planner_learn(planner, 1u << 20, NULL), RLVC_E_NULL);
    assert_int_equal(rlvc_budget_min(as_agent(NULL), &action), RLVC_E_NULL);
    assert_int_equal(rlvc_budget_min(as_agent(planner), NULL), RLVC_E_NULL);
    assert_int_equal(planner_predict(NULL, s, &action), RLVC_E_NULL);
    assert_int_equal(planner_predict(planner, NULL, &action), RLVC_E_NULL);
    assert_int_equal(planner_predict(planner, s, NULL), RLVC_OK);
    assert_int_equal(rlvc_planner_stats(NULL, &statistics), RLVC_E_NULL);
    assert_int_equal(rlvc_planner_stats(as_agent(planner), NULL), RLVC_E_NULL);
    assert_int_equal(rlvc_planner_node(NULL, 0, &node), RLVC_E_NULL);
    assert_int_equal(rlvc_planner_node(as_agent(planner), 0, NULL), RLVC_E_NULL);
    assert_int_equal(planner_act(planner, &action), RLVC_E_ORDER);
    assert_int_equal(planner_observe(planner, 0, 0.0f, s, 0), RLVC_E_ORDER);
    assert_int_equal(planner_predict(planner, s, &action), RLVC_OK);
    assert_int_equal(action, 0);
    assert_int_equal(rlvc_budget_min(as_agent(planner), &action), RLVC_OK);
    assert_int_equal(planner_learn(planner, action - 1u, &progress), RLVC_E_RANGE);
    assert_int_equal(planner_learn(planner, action, &progress), RLVC_OK);
    assert_true(progress.done && progress.work == 0); /* nothing is due */
}

static void test_bad_percepts_and_rewards(void **state) {
    (void)state;
    rlvc_config config = small_config();
    rlvc_planner *planner = make(&config, memory);
    const float bad[] = {NAN, INFINITY, -INFINITY, 1.1e9f};
    float s[2] = {0.5f, -1e9f};
    uint32_t action;
    assert_int_equal(planner_begin(planner, s), RLVC_OK);
    rlvc_planner before = *planner;
    for (uint32_t i = 0; i < 4; i++) {
        float wrong[2] = {0.0f, bad[i]};
        assert_int_equal(planner_begin(planner, wrong), RLVC_E_PERCEPT);
        assert_int_equal(planner_observe(planner, 0, 0.0f, wrong, 0), RLVC_E_PERCEPT);
        assert_int_equal(planner_predict(planner, wrong, &action), RLVC_E_PERCEPT);
        if (i < 3)
            assert_int_equal(planner_observe(planner, 0, bad[i], s, 0), RLVC_E_REWARD);
    }
    assert_int_equal(planner_observe(planner, 0, 2e12f, s, 0), RLVC_E_REWARD);
    assert_int_equal(planner_observe(planner, 3, 0.0f, s, 0), RLVC_E_RANGE);
    assert_int_equal(planner_observe(planner, 0, 0.0f, s, 3), RLVC_E_RANGE);
    assert_int_equal(rlvc_observe(as_agent(planner), (rlvc_choice){0, 2}, 0.0f, s, 0),
                     RLVC_E_RANGE);
    assert_memory_equal(planner, &before, sizeof before);
    assert_int_equal(rlvc_observe(as_agent(planner), (rlvc_choice){2, 1}, 1.0f, s, RLVC_TERMINATED),
                     RLVC_OK); /* of a policy that is followed elsewhere */
    assert_int_equal(planner_observe(planner, 2, 1.0f, s, 0), RLVC_E_ORDER);
}

/* A policy that has left the archive while it acted gets no return of another's. */
static void test_a_return_of_one_that_left(void **state) {
    (void)state;
    player p;
    rlvc_planner *planner = play_small(&p, memory, sizeof memory, 1, 900);
    rlvc_archive *archive = &planner->archive;
    assert_true(archive->count > 0);
    float s[2] = {0.0f, 0.0f};
    assert_int_equal(planner_begin(planner, s), RLVC_OK);
    planner->acting.why = RLVC_PLANNER_NEW;
    planner->acting.trial = 0;
    planner->acting.serial = archive->trial[0].serial + 1000u;
    uint32_t episodes = archive->trial[0].episodes;
    assert_int_equal(planner_observe(planner, 0, 1.0f, s, RLVC_TRUNCATED), RLVC_OK);
    assert_int_equal(archive->trial[0].episodes, episodes);
    assert_int_equal(planner_begin(planner, s), RLVC_OK);
    planner->acting.why = RLVC_PLANNER_NEW;
    planner->acting.trial = 0;
    planner->acting.serial = archive->trial[0].serial;
    assert_int_equal(planner_observe(planner, 0, 1.0f, s, RLVC_TRUNCATED), RLVC_OK);
    assert_int_equal(archive->trial[0].episodes, episodes + 1u);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_the_slider_is_balanced),
        cmocka_unit_test(test_nodes_are_the_policy),
        cmocka_unit_test(test_slices_change_nothing),
        cmocka_unit_test(test_learning_while_acting),
        cmocka_unit_test(test_many_terms),
        cmocka_unit_test(test_acting_at_any_percept),
        cmocka_unit_test(test_endless_episodes),
        cmocka_unit_test(test_nothing_to_learn_is_said),
        cmocka_unit_test(test_equally_good_is_learnt),
        cmocka_unit_test(test_defaults_and_ranges),
        cmocka_unit_test(test_memory),
        cmocka_unit_test(test_ample_memory),
        cmocka_unit_test(test_the_macro_is_enough),
        cmocka_unit_test(test_nulls_and_order),
        cmocka_unit_test(test_bad_percepts_and_rewards),
        cmocka_unit_test(test_a_return_of_one_that_left),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
