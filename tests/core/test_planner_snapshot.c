/* SPDX-License-Identifier: MIT */
/* Snapshots of a planner: it goes on bit for bit, and what is loaded is not trusted. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "base/bytes.h"
#include "base/crc.h"
#include "block.h"
#include "store/planner_check.h"
#include "slider_player.h"

#define SLOT_MOST 131072u
#define HEAD_BYTES 16u

static uint64_t memory[40000], other_memory[40000];

/* A store in memory, any call of which can fail. */
typedef struct shelf {
    unsigned char byte[2u * SLOT_MOST];
    uint32_t calls;
    uint32_t fail_at; /* the call, from 1, that fails; 0: none */
} shelf;

static shelf first, second;

static int fails(shelf *of) {
    return ++of->calls == of->fail_at;
}

static int shelf_read(void *ctx, uint32_t offset, void *buffer, uint32_t bytes) {
    shelf *of = (shelf *)ctx;
    assert_true(offset + bytes <= sizeof of->byte);
    memcpy(buffer, of->byte + offset, bytes);
    return fails(of);
}

static int shelf_write(void *ctx, uint32_t offset, const void *buffer, uint32_t bytes) {
    shelf *of = (shelf *)ctx;
    assert_true(offset + bytes <= sizeof of->byte);
    memcpy(of->byte + offset, buffer, bytes);
    return fails(of);
}

static rlvc_config short_config(void) {
    rlvc_config config = slider_config();
    config.capacity = 700;
    config.sample = 300;
    config.candidates = 60;
    config.patience = 40;
    return config;
}

static rlvc_store empty_store(shelf *of, const rlvc_config *config) {
    rlvc_store store = {of, 0, shelf_read, shelf_write, NULL, NULL};
    memset(of, 0, sizeof *of);
    assert_int_equal(rlvc_snapshot_size(config, &planner_domain, &store.slot_bytes), RLVC_OK);
    assert_true(store.slot_bytes <= SLOT_MOST);
    return store;
}

static rlvc_planner *make(const rlvc_config *config, uint64_t *block) {
    return make_in(config, block, sizeof memory);
}

static rlvc_status load_into(const rlvc_config *config, const rlvc_store *store,
                             rlvc_planner **planner) {
    rlvc_status status = rlvc_load(config, &planner_domain, other_memory, sizeof other_memory,
                                   store, (rlvc_agent **)planner);
    assert_true((status == RLVC_OK) == (*planner != NULL));
    return status;
}

/* The snapshot of a planner, and its length. */
static uint32_t content_of(rlvc_planner *planner, unsigned char *content) {
    rlvc_store store = empty_store(&second, &planner->config);
    assert_int_equal(rlvc_save(as_agent(planner), &store), RLVC_OK);
    uint32_t bytes = (uint32_t)rlvc_get(second.byte + 12, 4);
    memcpy(content, second.byte, bytes);
    return bytes;
}

static void assert_same(rlvc_planner *a, rlvc_planner *b) {
    static unsigned char one[SLOT_MOST], two[SLOT_MOST];
    uint32_t bytes = content_of(a, one);
    assert_int_equal(content_of(b, two), bytes);
    assert_memory_equal(one, two, bytes);
}

/* ------------------------------------------------------------------ going on */

/* Saved before anything happened, in the random phase, with a model, with a full ring, and in the
 * midst of an episode: what is loaded does what the saved one does. */
static void test_it_goes_on(void **state) {
    (void)state;
    static const uint32_t at[] = {0, 37, 260, 633, 1000};
    for (uint32_t i = 0; i < sizeof at / sizeof at[0]; i++) {
        rlvc_config config = short_config();
        rlvc_store store = empty_store(&first, &config);
        player p, q;
        rlvc_planner *planner = make(&config, memory), *other;
        start(&p, planner, 5);
        play(&p, at[i]);
        assert_int_equal(rlvc_save(as_agent(planner), &store), RLVC_OK);
        assert_int_equal(load_into(&config, &store, &other), RLVC_OK);
        assert_same(planner, other);
        q = p;
        q.planner = other;
        play(&p, 333);
        play(&q, 333);
        assert_same(planner, other);
    }
}

/* After 2^32 - 1 interactions no more are counted; the planner goes on, also from a snapshot. */
static void test_the_count_ends(void **state) {
    (void)state;
    rlvc_config config = short_config();
    rlvc_store store = empty_store(&first, &config);
    rlvc_planner *planner = make(&config, memory), *other;
    player p, q;
    start(&p, planner, 7);
    play(&p, 500);
    uint32_t ahead = UINT32_MAX - 200u - planner->experience.total;
    planner->experience.total += ahead;
    planner->fitted += ahead;
    planner->searched += ahead;
    play(&p, 600);
    assert_int_equal(planner->experience.total, UINT32_MAX);
    assert_int_equal(rlvc_save(as_agent(planner), &store), RLVC_OK);
    assert_int_equal(load_into(&config, &store, &other), RLVC_OK);
    q = p;
    q.planner = other;
    play(&p, 300);
    play(&q, 300);
    assert_same(planner, other);
}

/* A forged model may hold finite numbers of which a prediction is none: inf - inf. Searches end. */
static void test_predictions_that_are_no_numbers(void **state) {
    (void)state;
    rlvc_config config = short_config();
    rlvc_planner *planner = make(&config, memory);
    player p;
    start(&p, planner, 5);
    play(&p, 400);
    for (uint32_t round = 0; round < 30; round++) {
        for (uint32_t k = 0; k < RLVC_ROLLOUT_MODELS; k++) {
            rlvc_dynamics *model = planner->model + k;
            for (uint32_t i = 0; i < model->basis.components; i++) {
                float *b = rlvc_model_tree_coefficients(model->tree + i, 0);
                model->basis.scale[i] = 1e-30f;
                b[1] = 1e30f;
                b[2] = -1e30f;
                rlvc_model_tree_coefficients(model->tree + model->basis.components, 0)[i + 1u] =
                    i ? 1e30f : -1e30f;
            }
        }
        assert_true(rlvc_planner_is_sound(planner));
        play(&p, 13);
        assert_true(rlvc_planner_is_sound(planner));
    }
}

static void test_before_the_first_percept(void **state) {
    (void)state;
    rlvc_config config = short_config();
    rlvc_snapshot_info found;
    rlvc_store store = empty_store(&first, &config);
    rlvc_planner *planner = make(&config, memory), *other;
    player p, q;
    assert_int_equal(rlvc_save(as_agent(planner), &store), RLVC_OK);
    assert_int_equal(load_into(&config, &store, &other), RLVC_OK);
    start(&p, planner, 3);
    start(&q, other, 3);
    play(&p, 400);
    play(&q, 400);
    assert_same(planner, other);
    assert_int_equal(rlvc_snapshot_peek(&store, &found), RLVC_OK);
    assert_int_equal(found.version, RLVC_PLANNER_SNAPSHOT_VERSION);
    assert_int_equal(found.percept_bytes, sizeof p.world.s);
    assert_int_equal(found.feature_bytes, RLVC_THRESHOLDS_FEATURE_BYTES);
    assert_null(found.config.method);
    assert_int_equal(found.config.capacity, config.capacity);
    assert_memory_equal(&found.config.sample, &config.sample,
                        RLVC_CONFIG_BYTES - offsetof(rlvc_config, sample));
}

/* An episode may have ended that was not learnt from yet. */
static void test_learning_that_is_due(void **state) {
    (void)state;
    rlvc_config config = short_config();
    rlvc_store store = empty_store(&first, &config);
    rlvc_planner *planner = make(&config, memory), *other;
    player p;
    float s[2] = {0.0f, 0.0f};
    start(&p, planner, 3);
    play(&p, 500);
    assert_int_equal(planner_observe(planner, 0, 1.0f, s, RLVC_TRUNCATED), RLVC_OK);
    assert_int_equal(rlvc_save(as_agent(planner), &store), RLVC_OK);
    assert_int_equal(load_into(&config, &store, &other), RLVC_OK);
    learn(planner);
    learn(other);
    assert_same(planner, other);
}

/* Snapshots fit into what the size says, also of the largest model. */
static void test_the_size_is_enough(void **state) {
    (void)state;
    for (uint32_t leaves = 2; leaves <= 32; leaves += 15) {
        rlvc_config config = short_config();
        config.model_leaves = leaves;
        rlvc_store store = empty_store(&first, &config);
        rlvc_planner *planner = make(&config, memory);
        player p;
        uint32_t bytes = 0;
        start(&p, planner, leaves);
        for (uint32_t i = 0; i < 12; i++) {
            play(&p, 100);
            assert_int_equal(rlvc_save(as_agent(planner), &store), RLVC_OK);
        }
        for (uint32_t slot = 0; slot < 2; slot++) {
            uint32_t n = (uint32_t)rlvc_get(first.byte + slot * store.slot_bytes + 12, 4);
            bytes = n > bytes ? n : bytes;
        }
        assert_true(bytes <= store.slot_bytes);
    }
    rlvc_config large = short_config();
    uint32_t bytes = 1;
    large.capacity = RLVC_PLANNER_CAPACITY_MAX;
    planner_components(64);
    assert_int_equal(rlvc_snapshot_size(&large, &planner_domain, &bytes), RLVC_E_MEMORY);
    assert_int_equal(bytes, 0);
}

/* ------------------------------------------------------------------ what is refused */

static void test_arguments(void **state) {
    (void)state;
    rlvc_config config = short_config(), wrong = config;
    rlvc_snapshot_info found;
    rlvc_store store = empty_store(&first, &config), bad = store;
    rlvc_planner *planner = make(&config, memory), *other;
    uint32_t bytes;
    wrong.actions = 1;
    assert_int_equal(rlvc_snapshot_size(&config, &planner_domain, NULL), RLVC_E_NULL);
    assert_int_equal(rlvc_snapshot_size(NULL, &planner_domain, &bytes), RLVC_E_NULL);
    assert_int_equal(rlvc_snapshot_size(&wrong, &planner_domain, &bytes), RLVC_E_CONFIG);
    assert_int_equal(rlvc_save(NULL, &store), RLVC_E_NULL);
    assert_int_equal(rlvc_save(as_agent(planner), NULL), RLVC_E_NULL);
    assert_int_equal(
        rlvc_load(&config, &planner_domain, other_memory, sizeof other_memory, &store, NULL),
        RLVC_E_NULL);
    assert_int_equal(load_into(NULL, &store, &other), RLVC_E_NULL);
    assert_int_equal(load_into(&wrong, &store, &other), RLVC_E_CONFIG);
    assert_int_equal(load_into(&config, NULL, &other), RLVC_E_NULL);
    assert_int_equal(load_into(&config, &store, &other), RLVC_E_EMPTY);
    assert_int_equal(rlvc_snapshot_peek(&store, NULL), RLVC_E_NULL);
    assert_int_equal(rlvc_snapshot_peek(NULL, &found), RLVC_E_NULL);
    assert_int_equal(rlvc_snapshot_peek(&store, &found), RLVC_E_EMPTY);
    bad.slot_bytes -= RLVC_STORE_UNIT;
    assert_int_equal(rlvc_save(as_agent(planner), &bad), RLVC_E_RANGE);
    bad.slot_bytes = store.slot_bytes + 1u;
    assert_int_equal(load_into(&config, &bad, &other), RLVC_E_RANGE);
    assert_int_equal(rlvc_save(as_agent(planner), &store), RLVC_OK);
    wrong = config;
    wrong.seed++;
    assert_int_equal(load_into(&wrong, &store, &other), RLVC_E_MISMATCH);
    assert_int_equal(
        rlvc_load(&config, &planner_domain, other_memory, 64, &store, (rlvc_agent **)&other),
        RLVC_E_MEMORY);
}

static void test_not_in_the_midst_of_learning(void **state) {
    (void)state;
    rlvc_config config = short_config();
    rlvc_store store = empty_store(&first, &config);
    rlvc_planner *planner = make(&config, memory), *other;
    rlvc_progress progress;
    player p;
    float s[2] = {0.0f, 0.0f};
    uint32_t least;
    start(&p, planner, 3);
    play(&p, 500);
    assert_int_equal(planner_observe(planner, 0, 1.0f, s, RLVC_TRUNCATED), RLVC_OK);
    assert_int_equal(rlvc_budget_min(as_agent(planner), &least), RLVC_OK);
    assert_int_equal(planner_learn(planner, least, &progress), RLVC_OK);
    assert_false(progress.done);
    assert_int_equal(rlvc_save(as_agent(planner), &store), RLVC_E_BUSY);
    assert_int_equal(rlvc_agent_check(as_agent(planner)), RLVC_E_BUSY);
    assert_int_equal(load_into(&config, &store, &other), RLVC_E_EMPTY);
    learn(planner);
    assert_int_equal(rlvc_save(as_agent(planner), &store), RLVC_OK);
}

/* A planner with models and policies that has been saved. Always of short_config(): it plays in the
 * first call alone, and its block is as it was then in each other one. */
static rlvc_planner *saved(const rlvc_config *config, rlvc_store *store) {
    static uint64_t played[sizeof memory / sizeof memory[0]];
    static uint32_t calls;
    rlvc_planner *planner = make(config, memory);
    *store = empty_store(&first, config);
    if (calls++ == 0) {
        player p;
        start(&p, planner, 5);
        play(&p, 1000);
        block_copy(played, memory, sizeof memory);
    } else
        block_copy(memory, played, sizeof memory);
    assert_int_equal(rlvc_save(as_agent(planner), store), RLVC_OK);
    return planner;
}

/* Whichever call of the store fails, that is said, and a whole snapshot stays. */
static void test_a_store_that_fails(void **state) {
    (void)state;
    rlvc_config config = short_config();
    rlvc_snapshot_info found;
    rlvc_store store;
    rlvc_planner *planner = saved(&config, &store), *other;
    first.calls = 0;
    assert_int_equal(rlvc_save(as_agent(planner), &store), RLVC_OK);
    uint32_t calls = first.calls;
    for (uint32_t k = 1; k <= calls; k += k < 5 ? 1u : 97u) {
        first.calls = 0;
        first.fail_at = k;
        assert_int_equal(rlvc_save(as_agent(planner), &store), RLVC_E_STORE);
        first.fail_at = 0;
        assert_int_equal(load_into(&config, &store, &other), RLVC_OK);
        assert_same(planner, other);
    }
    first.calls = 0;
    assert_int_equal(load_into(&config, &store, &other), RLVC_OK);
    calls = first.calls;
    for (uint32_t k = 1; k <= calls; k += k < 5 ? 1u : 97u) {
        first.calls = 0;
        first.fail_at = k;
        assert_int_equal(load_into(&config, &store, &other), RLVC_E_STORE);
    }
    first.calls = 0;
    first.fail_at = 1;
    assert_int_equal(rlvc_snapshot_peek(&store, &found), RLVC_E_STORE);
}

static rlvc_agent *saving;

static int call_back(void *ctx, uint32_t offset, const void *buffer, uint32_t bytes) {
    rlvc_store store = {ctx, SLOT_MOST, shelf_read, shelf_write, NULL, NULL};
    assert_int_equal(rlvc_save(saving, &store), RLVC_E_REENTERED);
    return shelf_write(ctx, offset, buffer, bytes);
}

static void test_a_store_that_calls_back(void **state) {
    (void)state;
    rlvc_config config = short_config();
    rlvc_store store = empty_store(&first, &config);
    rlvc_planner *other;
    store.write = call_back;
    saving = as_agent(make(&config, memory));
    assert_int_equal(rlvc_save(saving, &store), RLVC_OK);
    assert_int_equal(load_into(&config, &store, &other), RLVC_OK);
}

static void mend(unsigned char *snapshot) {
    uint32_t bytes = (uint32_t)rlvc_get(snapshot + 12, 4);
    rlvc_put(snapshot + bytes - 4u, rlvc_crc(0, snapshot, bytes - 4u), 4);
}

/* Forged bytes that the checksum vouches for: they are refused, or make a planner that can act,
 * learn and be saved. */
static void test_forged_bytes(void **state) {
    (void)state;
    static unsigned char whole[SLOT_MOST];
    rlvc_config config = short_config();
    rlvc_store store;
    rlvc_planner *planner = saved(&config, &store), *other;
    uint32_t bytes = content_of(planner, whole), refused = 0, tried = 0;
    rlvc_rng rng;
    rlvc_rng_seed(&rng, 11);
    for (uint32_t at = HEAD_BYTES; at + 4u < bytes; at += at < 2500u ? 1u : 11u) {
        player p;
        memset(&first, 0, sizeof first);
        memcpy(first.byte, whole, bytes);
        uint32_t draw = rlvc_rng_below(&rng, 3);
        first.byte[at] = draw == 0 ? 0xffu : draw == 1 ? 0u : (uint8_t)rlvc_rng_next(&rng);
        mend(first.byte);
        tried++;
        if (load_into(&config, &store, &other) != RLVC_OK) {
            refused++;
            continue;
        }
        if (at % 16u != 0)
            continue;
        start(&p, other, at);
        play(&p, 61);
    }
    assert_true(refused > 100 && refused < tried);
}

/* ------------------------------------------------------------------ what does not hold together */

static rlvc_planner *checked;

/* A field that is changed is noticed. */
static void refuse(void *field, const void *bad, size_t bytes) {
    unsigned char kept[8];
    memcpy(kept, field, bytes);
    memcpy(field, bad, bytes);
    assert_false(rlvc_planner_is_sound(checked));
    memcpy(field, kept, bytes);
    assert_true(rlvc_planner_is_sound(checked));
}

static void refuse_float(float *field, float bad) {
    refuse(field, &bad, sizeof bad);
}

static void refuse_u8(uint8_t *field, uint8_t bad) {
    refuse(field, &bad, sizeof bad);
}

static void refuse_u16(uint16_t *field, uint16_t bad) {
    refuse(field, &bad, sizeof bad);
}

static void refuse_u32(uint32_t *field, uint32_t bad) {
    refuse(field, &bad, sizeof bad);
}

static void prepare_check(void) {
    static rlvc_config config;
    rlvc_store store;
    config = short_config();
    checked = saved(&config, &store);
    assert_true(rlvc_planner_is_sound(checked));
}

static void test_rings_are_checked(void **state) {
    (void)state;
    prepare_check();
    rlvc_experience *experience = &checked->experience;
    refuse_u8(experience->end + 5, RLVC_ROW_LAST + 1u);
    const uint8_t end = experience->end[5];
    assert_int_equal(rlvc_agent_check(as_agent(checked)), RLVC_OK);
    experience->end[5] = RLVC_ROW_LAST + 1u;
    assert_int_equal(rlvc_agent_check(as_agent(checked)), RLVC_E_MEMORY);
    experience->end[5] = end;
    refuse_u8(experience->end + experience->head, RLVC_GOES_ON);
    refuse_u8(experience->action + 5, SLIDER_ACTIONS);
    refuse_float(experience->reward + 5, 2e12f);
    refuse_float(experience->percept + 5, -2e9f);
    refuse_float(experience->low, 2e9f);
    refuse_float(experience->high, 2e9f);
}

/* One test more: the first model tree gets two leaves. */
static rlvc_model_tree *two_leaves(void) {
    rlvc_model_tree *tree = checked->model->tree;
    tree->leaves = 2;
    memset(tree->node, 0, 3u * sizeof *tree->node);
    tree->node[0].child = 1;
    tree->node[1].test = tree->node[2].test = RLVC_MODEL_LEAF;
    tree->node[2].child = 1;
    tree->leaf[1] = tree->leaf[0];
    memset(rlvc_model_tree_coefficients(tree, 1), 0, tree->terms * sizeof(float));
    assert_true(rlvc_planner_is_sound(checked));
    return tree;
}

static void test_models_are_checked(void **state) {
    (void)state;
    prepare_check();
    rlvc_dynamics *dynamics = checked->model;
    rlvc_model_tree *tree = two_leaves();
    refuse_u16(&tree->node[0].test, SLIDER_COMPONENTS + SLIDER_ACTIONS);
    refuse_u16(&tree->node[0].child, 0);
    refuse_u16(&tree->node[0].child, 2);
    refuse_float(&tree->node[0].cut, 2e30f);
    refuse_u16(&tree->node[2].child, 2);
    refuse_float(&tree->leaf[1].low, 2e30f);
    refuse_float(&tree->leaf[1].high, 2e30f);
    refuse_float(&tree->leaf[1].noise, 2e30f);
    refuse_float(rlvc_model_tree_coefficients(tree, 1), 2e30f);
    refuse_float(&tree->mean, 2e30f);
    refuse_float(&tree->scale, 2e30f);
    refuse_float(dynamics->basis.mean, 2e30f);
    refuse_float(dynamics->basis.scale, 0.0f);
    refuse_float(dynamics->basis.scale, 2e30f);
    refuse_float(dynamics->low, 2e30f);
    refuse_float(dynamics->high, 2e30f);
    refuse_float(&dynamics->reward_low, 2e30f);
    refuse_float(&dynamics->reward_high, 2e30f);
}

static void test_policies_are_checked(void **state) {
    (void)state;
    prepare_check();
    rlvc_archive *archive = &checked->archive;
    rlvc_trial *trial = archive->trial + rlvc_archive_best(archive, 0.5f);
    float *start = rlvc_archive_start(archive, (uint32_t)(trial - archive->trial), 0);
    assert_true(trial->tree.nodes >= 3u && trial->episodes > 0);
    refuse_u8(&trial->tree.nodes, 2);
    refuse_u8(&trial->tree.leaves, RLVC_SMALL_LEAVES_MAX + 1u);
    refuse_u8(&trial->tree.leaves, 1);
    refuse_float(&trial->tree.node[0].cut, 2e30f);
    refuse_u8(&trial->tree.node[1].action, SLIDER_ACTIONS);
    refuse_u16(&trial->tree.node[0].component, SLIDER_COMPONENTS);
    refuse_u8(&trial->tree.node[0].child, 0);
    refuse_float(&trial->promise, 2e30f);
    refuse_float(&trial->score, 2e30f);
    refuse_u32(&trial->valued, trial->episodes + 1u);
    refuse_float(&trial->earned[0], 2e30f);
    refuse_float(&trial->promised[0], 2e30f);
    refuse_float(start, 2e9f);
    refuse_float(&archive->beta, 2.0f);
    refuse_float(&archive->common, 2e30f);
    refuse_float(&archive->deviation, 2e30f);
    refuse_u8(&checked->acting.why, RLVC_PLANNER_AGAIN + 1u);
    refuse_u8(&checked->next.tree.nodes, 0);
    checked->next.why = RLVC_PLANNER_AGAIN;
    refuse_u32(&checked->next.trial, RLVC_ARCHIVE_POLICIES);
    checked->next.why = RLVC_PLANNER_RANDOM; /* may have a tree that was chosen before */
    assert_true(rlvc_planner_is_sound(checked));
}

/* A child of a test that comes before it, or is another test's. */
static void test_order_of_nodes(void **state) {
    (void)state;
    prepare_check();
    rlvc_small_tree *tree = &checked->archive.trial[0].tree;
    memset(tree, 0, sizeof *tree);
    tree->nodes = 5;
    tree->leaves = 3;
    for (uint32_t k = 0; k < 5; k++)
        tree->node[k].component = RLVC_SMALL_LEAF;
    tree->node[0].component = tree->node[2].component = 0;
    tree->node[0].child = 1;
    tree->node[2].child = 3;
    assert_true(rlvc_planner_is_sound(checked));
    tree->node[2].component = RLVC_SMALL_LEAF;
    tree->node[3].component = 0;
    tree->node[3].child = 3;
    assert_false(rlvc_planner_is_sound(checked));
}

static void test_counters_are_checked(void **state) {
    (void)state;
    prepare_check();
    refuse_u8(&checked->gainful, 2);
    refuse_u8(&checked->open, 2);
    refuse_u8(&checked->due, 2);
    refuse_u32(&checked->commons, RLVC_PLANNER_STARTS + 1u);
    refuse_u32(&checked->commons, 0);
    refuse_u32(&checked->fitted, checked->experience.total + 1u);
    refuse_u32(&checked->fitted, 0);
    refuse_u32(&checked->starts, 0);
    refuse_u32(&checked->experience.count, 0);
    refuse_u32(&checked->steps, checked->config.horizon);
    refuse_float(&checked->earned, 2e30f);
    refuse_float(&checked->least, 2e30f);
    refuse_float(&checked->most, 2e30f);
    refuse_float(checked->start, 2e9f);
    refuse_float(checked->common, 2e9f);
    refuse_float(checked->now, 2e9f);
    rlvc_config config = checked->config;
    checked = make(&config, memory);
    assert_true(rlvc_planner_is_sound(checked));
    refuse_u8(&checked->open, 1);
    refuse_u8(&checked->due, 1);
    refuse_u32(&checked->experience.total, 1);
}

/* Is what was written of a planner that does not hold together refused? */
static void refuse_saved(void) {
    rlvc_planner *other;
    rlvc_config config = checked->config;
    rlvc_store store = empty_store(&first, &config);
    assert_int_equal(rlvc_save(as_agent(checked), &store), RLVC_OK);
    assert_int_equal(load_into(&config, &store, &other), RLVC_E_DAMAGED);
    prepare_check();
}

/* What decides how much there is to come is checked on the way. */
static void test_lengths_are_checked(void **state) {
    (void)state;
    prepare_check();
    checked->archive.count = RLVC_ARCHIVE_POLICIES + 1u;
    refuse_saved();
    checked->archive.trial[0].tree.nodes = RLVC_SMALL_NODES_MAX + 1u;
    refuse_saved();
    checked->acting.tree.nodes = RLVC_SMALL_NODES_MAX + 1u;
    refuse_saved();
    checked->next.tree.nodes = RLVC_SMALL_NODES_MAX + 1u;
    refuse_saved();
    checked->experience.head = checked->experience.rows;
    refuse_saved();
    checked->model[1].tree[0].terms = 1;
    refuse_saved();
    checked->model[1].tree[0].leaves = 0;
    refuse_saved();
    checked->model[1].tree[0].leaves = (uint16_t)(checked->config.model_leaves + 1u);
    refuse_saved();
    rlvc_ending_node *node = checked->model[1].ending.node;
    assert_true(node->component < SLIDER_COMPONENTS);
    node->component = SLIDER_COMPONENTS;
    refuse_saved();
    node->child = 0;
    refuse_saved();
    node->child = RLVC_ENDING_NODES - 1u;
    refuse_saved();
    node->probability = 2.0f;
    refuse_saved();
    node->probability = -1.0f;
    refuse_saved();
    node->cut = 2e30f;
    refuse_saved();
    node->reward = 2e30f;
    refuse_saved();
}

/* The longer of two tests' subtrees may come first. */
static void test_any_order_of_endings(void **state) {
    (void)state;
    prepare_check();
    rlvc_ending *ending = &checked->model[1].ending;
    rlvc_config config = checked->config;
    rlvc_store store = empty_store(&first, &config);
    rlvc_planner *other;
    memset(ending, 0, sizeof *ending);
    for (uint32_t k = 0; k < 5; k++)
        ending->node[k].component = RLVC_ENDING_LEAF;
    ending->node[0].component = ending->node[1].component = 0;
    ending->node[0].child = 1;
    ending->node[1].child = 3;
    assert_int_equal(rlvc_save(as_agent(checked), &store), RLVC_OK);
    assert_int_equal(load_into(&config, &store, &other), RLVC_OK);
    ending->node[0].child = 3; /* both lead to the same two */
    ending->node[1].child = 2;
    assert_same(checked, checked);
}

/* More bytes than the content takes. */
static void test_a_length_that_is_wrong(void **state) {
    (void)state;
    prepare_check();
    rlvc_config config = checked->config;
    rlvc_store store = empty_store(&first, &config);
    rlvc_planner *other;
    assert_int_equal(rlvc_save(as_agent(checked), &store), RLVC_OK);
    uint32_t bytes = (uint32_t)rlvc_get(first.byte + 12, 4);
    rlvc_put(first.byte + 12, bytes + RLVC_STORE_UNIT, 4);
    mend(first.byte);
    assert_int_equal(load_into(&config, &store, &other), RLVC_E_DAMAGED);
}

static void test_other_versions(void **state) {
    (void)state;
    rlvc_config config = short_config();
    rlvc_snapshot_info found;
    rlvc_store store;
    rlvc_planner *other;
    (void)saved(&config, &store);
    rlvc_put(first.byte + 4, RLVC_SNAPSHOT_VERSION, 4);
    mend(first.byte);
    assert_int_equal(load_into(&config, &store, &other), RLVC_E_VERSION);
    rlvc_put(first.byte + 4, RLVC_PLANNER_SNAPSHOT_VERSION + 1u, 4);
    mend(first.byte);
    assert_int_equal(load_into(&config, &store, &other), RLVC_E_VERSION);
    assert_int_equal(rlvc_snapshot_peek(&store, &found), RLVC_E_VERSION);
    rlvc_put(first.byte + 4, RLVC_PLANNER_SNAPSHOT_VERSION, 4);
    mend(first.byte);
    assert_int_equal(rlvc_snapshot_peek(&store, &found), RLVC_OK);
    config.method = &rlvc_method_classes;
    assert_int_equal(load_into(&config, &store, &other), RLVC_E_VERSION);
    config.method = &rlvc_method_planner;
    first.byte[200] ^= 1u;
    assert_int_equal(load_into(&config, &store, &other), RLVC_E_DAMAGED);
}

#define FEW 32u /* first percepts in a snapshot of the first version */
#define MORE ((RLVC_PLANNER_STARTS - FEW) * 2u)

/* Makes a snapshot of the first version: cuts out the runs of marks. */
static void make_old(unsigned char *snapshot, const float *mark) {
    const uint32_t run = MORE * (uint32_t)sizeof *mark;
    uint32_t bytes = (uint32_t)rlvc_get(snapshot + 12, 4), cuts = 0;
    for (uint32_t at = HEAD_BYTES; at + run <= bytes; at++) {
        if (memcmp(snapshot + at, mark, run) != 0)
            continue;
        bytes -= run;
        memmove(snapshot + at, snapshot + at + run, bytes - at);
        cuts++;
    }
    assert_int_equal(cuts, 2);
    rlvc_put(snapshot + 4, RLVC_PLANNER_SNAPSHOT_VERSION - 1u, 4);
    rlvc_put(snapshot + 12, bytes, 4);
    mend(snapshot);
}

/* What the first version saved is loaded, of a planner that began few episodes or many. */
static void test_the_first_version(void **state) {
    (void)state;
    static const uint32_t played[] = {300, 4000};
    float mark[MORE];
    for (uint32_t i = 0; i < MORE; i++)
        mark[i] = 1234.5f;
    for (uint32_t i = 0; i < 2u; i++) {
        rlvc_config config = short_config();
        rlvc_snapshot_info found;
        rlvc_store store = empty_store(&first, &config);
        rlvc_planner *planner = make(&config, memory), *other;
        player p;
        start(&p, planner, 5);
        play(&p, played[i]);
        assert_int_equal(planner->starts > FEW, i);
        memcpy(planner->start + FEW * 2u, mark, sizeof mark);
        memcpy(planner->common + FEW * 2u, mark, sizeof mark);
        planner->commons = planner->commons < FEW ? planner->commons : FEW;
        assert_int_equal(rlvc_save(as_agent(planner), &store), RLVC_OK);
        make_old(first.byte, mark);
        assert_int_equal(rlvc_snapshot_peek(&store, &found), RLVC_OK);
        assert_int_equal(found.version, RLVC_PLANNER_SNAPSHOT_VERSION - 1u);
        assert_int_equal(load_into(&config, &store, &other), RLVC_OK);
        memset(planner->start + FEW * 2u, 0, sizeof mark);
        memset(planner->common + FEW * 2u, 0, sizeof mark);
        planner->starts = i == 1u ? FEW : planner->starts;
        assert_same(planner, other);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_it_goes_on),
        cmocka_unit_test(test_the_first_version),
        cmocka_unit_test(test_predictions_that_are_no_numbers),
        cmocka_unit_test(test_the_count_ends),
        cmocka_unit_test(test_before_the_first_percept),
        cmocka_unit_test(test_learning_that_is_due),
        cmocka_unit_test(test_the_size_is_enough),
        cmocka_unit_test(test_arguments),
        cmocka_unit_test(test_not_in_the_midst_of_learning),
        cmocka_unit_test(test_a_store_that_fails),
        cmocka_unit_test(test_a_store_that_calls_back),
        cmocka_unit_test(test_forged_bytes),
        cmocka_unit_test(test_rings_are_checked),
        cmocka_unit_test(test_models_are_checked),
        cmocka_unit_test(test_policies_are_checked),
        cmocka_unit_test(test_order_of_nodes),
        cmocka_unit_test(test_counters_are_checked),
        cmocka_unit_test(test_lengths_are_checked),
        cmocka_unit_test(test_any_order_of_endings),
        cmocka_unit_test(test_a_length_that_is_wrong),
        cmocka_unit_test(test_other_versions),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
