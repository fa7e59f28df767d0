/* SPDX-License-Identifier: MIT */
/* Calls the agent's functions in any order, on any domain and by each method, with callbacks,
 * writes and stores that fail now and then. The first bytes choose the domain, the method and the
 * config; each further one a call, with the arguments in the bytes after it. Whatever happens, the
 * agent stays sound, and each call returns what its header says. */
#include "rlvc/export.h"
#include "rlvc/planner.h"
#include "rlvc/policy.h"
#include "rlvc/snapshot.h"
#include "world.h"

#include <math.h>

#define STORE_BYTES 65536u
#define CALLS_MAX 300u

/* ------------------------------------------------------------------ the input */

static const uint8_t *input;
static size_t input_left;

static uint32_t next_below(uint32_t bound) {
    if (input_left == 0)
        return 0;
    input_left--;
    return *input++ % bound;
}

/* ------------------------------------------------------------------ what can fail */

static int plans; /* the method is the planner's */

static struct {
    rlvc_domain inner;
    rlvc_agent *agent;   /* each callback calls it, and is refused */
    uint32_t calls;      /* of callbacks; */
    uint32_t fails_from; /* these fail: `failures` of them from this one on */
    uint32_t failures;
    uint32_t store_calls; /* likewise */
    uint32_t store_fails;
    int saved; /* a whole snapshot is there */
    unsigned char store[STORE_BYTES];
} world;

static int callback_fails(void) {
    if (world.agent) {
        rlvc_choice choice;
        rlvc_progress progress;
        must(rlvc_act(world.agent, &choice) == RLVC_E_REENTERED);
        must(rlvc_learn(world.agent, RLVC_BUDGET_MIN, &progress) == RLVC_E_REENTERED);
        must(rlvc_learn_abandon(world.agent) == (plans ? RLVC_E_MISMATCH : RLVC_E_REENTERED));
    }
    return world.calls++ - world.fails_from < world.failures;
}

static int exhibits(void *ctx, const void *percept, const void *feature, uint8_t *present) {
    return callback_fails() || world.inner.exhibits(ctx, percept, feature, present);
}

static int candidates(void *ctx, const rlvc_samples *samples, uint32_t first, uint32_t room,
                      void *features, uint32_t *written) {
    return callback_fails() || world.inner.candidates(ctx, samples, first, room, features, written);
}

static int detect(void *ctx, const rlvc_samples *samples, uint32_t first, uint32_t n,
                  const void *features, uint32_t m, uint64_t *columns) {
    return callback_fails() || world.inner.detect(ctx, samples, first, n, features, m, columns);
}

static int name(void *ctx, const void *feature, char *text, uint32_t room) {
    return callback_fails() || world.inner.name(ctx, feature, text, room);
}

static int write_text(void *ctx, const char *text, size_t bytes) {
    (void)ctx;
    (void)text;
    (void)bytes;
    return callback_fails();
}

static int store_fails(void) {
    return ++world.store_calls == world.store_fails;
}

static int read_store(void *ctx, uint32_t offset, void *buffer, uint32_t bytes) {
    (void)ctx;
    must(offset + bytes <= STORE_BYTES);
    memcpy(buffer, world.store + offset, bytes);
    return store_fails();
}

static int write_store(void *ctx, uint32_t offset, const void *buffer, uint32_t bytes) {
    (void)ctx;
    must(offset + bytes <= STORE_BYTES);
    if (store_fails())
        return 1;
    memcpy(world.store + offset, buffer, bytes);
    return 0;
}

static const rlvc_store store = {NULL, STORE_BYTES / 2, read_store, write_store, NULL, NULL};

/* ------------------------------------------------------------------ the agent */

static rlvc_config config;
static rlvc_domain domain;
static uint64_t memory[2][1u << 14], policy_memory[1u << 14];
static uint32_t held; /* the memory that the agent is in */
static rlvc_agent *agent;

static void choose_domain(void) {
    const uint32_t kind = next_below(6); /* 5: thresholds, by the planner */
    const uint32_t variant = next_below(2);
    plans = kind == 5u;
    world.inner = world_domain(plans ? RLVC_DOMAIN_THRESHOLDS : kind, variant);
    domain = world.inner;
    domain.exhibits = exhibits;
    domain.candidates = candidates;
    domain.detect = domain.detect && next_below(2) ? detect : NULL;
    domain.name = name;
}

static void choose_planner(void) {
    must(rlvc_config_default(&config, &domain, 2u + next_below(3)) == RLVC_OK);
    config.method = &rlvc_method_planner;
    config.capacity = 64u + next_below(64);
    config.sample = 32u + next_below(32);
    config.model_leaves = 1u + next_below(4);
    config.leaves = 2u + next_below(5);
    config.horizon = 1u + next_below(12);
    config.random = 32;
    config.candidates = 1u + next_below(3);
    config.patience = 1u + next_below(2);
}

static void choose_classes(void) {
    static const float discounts[] = {0.9f, 0.0f, 0.5f, 1.0f}, rates[] = {1.0f, 0.01f, 1e-6f};
    must(rlvc_config_default(&config, &domain, 1u + next_below(4)) == RLVC_OK);
    config.method = &rlvc_method_classes;
    config.capacity = 1u + next_below(60);
    config.classes = 1u + next_below(10);
    config.features_at_once = 1u + next_below(64);
    config.min_samples = 2u + next_below(6);
    config.max_sweeps = 1u + next_below(60);
    config.criterion = (uint8_t)next_below(2);
    config.score = next_below(4) ? RLVC_SCORE_GAIN : RLVC_SCORE_RANKS;
    config.solver = (uint8_t)next_below(4);
    config.continuing = (uint8_t)next_below(2);
    config.successors = (uint8_t)next_below(2);
    config.explore = (uint8_t)next_below(2);
    config.discount = discounts[next_below(4)];
    config.epsilon = rates[next_below(3)];
    config.alpha = rates[next_below(3)];
    config.alpha_known = rates[next_below(3)];
}

static int is_sound(const unsigned char *percept) {
    float number[2];
    if (!plans)
        return domain.check_percept == NULL || domain.check_percept(domain.ctx, percept) == 0;
    memcpy(number, percept, sizeof number);
    return fabsf(number[0]) <= RLVC_PLANNER_NUMBER_MAX &&
           fabsf(number[1]) <= RLVC_PLANNER_NUMBER_MAX;
}

/* A percept of any bytes, or one of the world's; in it, now and then, numbers that are none. */
static int choose_percept(unsigned char percept[PERCEPT_MAX]) {
    static const float odd[] = {NAN, INFINITY, -1e16f, 1e15f, -0.0f};
    const uint32_t kind = next_below(8);
    world_percept(&world.inner, next_below(CELLS), percept);
    if (kind == 0)
        for (uint32_t i = 0; i < domain.percept_bytes; i++)
            percept[i] = (unsigned char)next_below(256);
    if (kind == 1 && domain.percept_bytes >= 8u)
        memcpy(percept + 4u * next_below(domain.percept_bytes / 4u), &odd[next_below(5)], 4);
    return is_sound(percept);
}

/* ------------------------------------------------------------------ the calls */

/* Is this what rlvc_observe says of a reward that is a number, and an end that there is? */
static int is_answer(rlvc_status status, int sound, int looked_at) {
    if (status == RLVC_E_PERCEPT)
        return !sound && looked_at;
    return status == RLVC_E_ORDER || status == RLVC_E_BUSY || status == RLVC_E_CALLBACK ||
           (status == RLVC_OK && (sound || !looked_at));
}

static void observe(float reward, const unsigned char *percept, int sound, uint32_t end) {
    rlvc_choice choice = {0, 0};
    rlvc_status status = rlvc_act(agent, &choice);
    must(status == RLVC_OK || status == RLVC_E_ORDER || status == RLVC_E_CALLBACK);
    must(choice.action < config.actions && choice.exploited <= 1u);
    status = rlvc_observe(agent, choice, reward, percept, (uint8_t)end);
    if (plans && !sound) /* the planner learns what an end looks like, too */
        must(status == RLVC_E_PERCEPT);
    else if (plans && status == RLVC_E_ORDER)
        return;
    else if (end > RLVC_TRUNCATED)
        must(status == RLVC_E_RANGE);
    else if (!(reward <= RLVC_REWARD_MAX))
        must(status == RLVC_E_REWARD);
    else
        must(is_answer(status, sound, plans || end != RLVC_TERMINATED));
}

static void call_observe(const unsigned char *percept, int sound) {
    const float rewards[] = {0.0f, 1.0f, -1e12f, 1e12f, NAN};
    const float reward = rewards[next_below(5)];
    observe(reward, percept, sound, next_below(4) ? 0 : next_below(4));
}

/* Walks about, so that there is something to learn from: the last cell pays and ends an episode. */
static void call_play(void) {
    unsigned char percept[PERCEPT_MAX];
    uint32_t cell = next_below(CELLS), left = 1u + next_below(50);
    const uint32_t stride = 1u + next_below(CELLS);
    for (; left > 0; left--) {
        cell = (cell + stride) % CELLS;
        const uint32_t end = cell == CELLS - 1u ? RLVC_TERMINATED : RLVC_GOES_ON;
        world_percept(&world.inner, cell, percept);
        observe((float)end, percept, 1, end);
        if (end == RLVC_GOES_ON)
            continue;
        const rlvc_status status = rlvc_begin(agent, percept);
        must(status == RLVC_OK || status == RLVC_E_BUSY);
    }
}

static void call_learn(void) {
    rlvc_progress progress;
    uint32_t least, budget = RLVC_BUDGET_UNBOUNDED;
    must(rlvc_budget_min(agent, &least) == RLVC_OK);
    must(rlvc_learn(agent, least - 1u, &progress) == RLVC_E_RANGE);
    if (next_below(4))
        budget = least + (plans ? 64u : 3u) * next_below(256);
    rlvc_status status = rlvc_learn(agent, budget, &progress);
    must(status == RLVC_OK || (!plans && status == RLVC_E_CALLBACK));
    must(progress.work <= budget && progress.done <= 1u);
}

static void call_predict(const unsigned char *percept, int sound) {
    uint32_t class_id = 99, action = 99;
    rlvc_status status = rlvc_predict(agent, percept, &class_id, &action);
    if (status == RLVC_OK)
        must(class_id < (plans ? config.leaves : config.classes) && action < config.actions);
    else
        must(status == (plans ? RLVC_E_PERCEPT : RLVC_E_CALLBACK) && class_id == 99u &&
             action == 99u);
    must(!plans || sound == (status == RLVC_OK));
    float numbers[PERCEPT_MAX / 4u];
    memcpy(numbers, percept, sizeof numbers);
    must(rlvc_planner_act_at(agent, numbers, &action) == (plans ? status : RLVC_E_MISMATCH));
}

static void call_policy(const unsigned char *percept) {
    rlvc_policy_config wanted;
    rlvc_policy_info info;
    rlvc_policy *policy;
    size_t bytes;
    uint32_t action;
    must(rlvc_policy_default(agent, &wanted) == RLVC_OK);
    wanted.percepts = 1u + next_below(64);
    wanted.entries = 2u + next_below(200);
    wanted.effort = 1u + 16u * next_below(200);
    must(rlvc_policy_size(agent, &wanted, &bytes) == RLVC_OK && bytes <= sizeof policy_memory);
    rlvc_status status = rlvc_policy_make(agent, &wanted, policy_memory, bytes, &policy, &info);
    must((status == RLVC_OK) == (policy != NULL));
    if (!policy)
        return;
    must(info.leaves >= 1u && info.leaves <= info.collapsed && info.collapsed <= info.classes);
    world.agent = NULL; /* a policy's callbacks may call the agent */
    status = rlvc_policy_act(policy, percept, &action);
    must(status == RLVC_E_CALLBACK || (status == RLVC_OK && action < config.actions));
    (void)rlvc_policy_print(policy, next_below(3), write_text, NULL);
    (void)rlvc_policy_export_c(policy, "fuzz", write_text, NULL, NULL);
    world.agent = agent;
}

static void call_save_and_load(void) {
    rlvc_agent *loaded;
    world.store_calls = 0;
    world.store_fails = next_below(4) ? 0 : 1u + next_below(100);
    rlvc_status status = rlvc_save(agent, &store);
    must(status == RLVC_OK || status == RLVC_E_STORE || (plans && status == RLVC_E_BUSY));
    world.saved |= status == RLVC_OK;
    world.store_calls = 0;
    world.store_fails = next_below(4) ? 0 : 1u + next_below(100);
    world.agent = NULL;
    status = rlvc_load(&config, &domain, memory[1u - held], sizeof memory[0], &store, &loaded);
    world.agent = agent;
    must((status == RLVC_OK) == (loaded != NULL));
    if (status != RLVC_OK && status != RLVC_E_STORE)
        must(!world.saved && (status == RLVC_E_EMPTY || status == RLVC_E_DAMAGED));
    if (loaded && next_below(2)) {
        agent = loaded;
        held = 1u - held;
        world.agent = agent;
    }
}

static void call_show(void) {
    rlvc_status status = rlvc_print(agent, next_below(3), write_text, NULL);
    must(status == RLVC_OK || status == RLVC_E_CALLBACK);
    status = rlvc_export_c(agent, "fuzz", write_text, NULL, NULL);
    must(status == RLVC_OK || status == RLVC_E_CALLBACK || status == RLVC_E_CONFIG);
}

static void check_classes(uint32_t classes) {
    for (uint32_t c = 0; c < classes; c++) {
        float value, q;
        uint32_t action, samples;
        must(rlvc_value(agent, c, &value, &action) == RLVC_OK);
        must(value - value == 0.0f && action < config.actions);
        for (uint32_t a = 0; a < config.actions; a++)
            must(rlvc_q(agent, c, a, &q, &samples) == RLVC_OK && q - q == 0.0f);
        if (c > 0)
            must(rlvc_split_at(agent, c - 1u, NULL, NULL) == RLVC_OK);
    }
}

static void check_planner(uint32_t leaves) {
    rlvc_planner_statistics statistics;
    rlvc_planner_test node;
    must(rlvc_planner_stats(agent, &statistics) == RLVC_OK);
    must(statistics.leaves == leaves && statistics.acting <= RLVC_PLANNER_AGAIN);
    must(statistics.score - statistics.score == 0.0f && statistics.beta <= 1.0f);
    for (uint32_t k = 0; k + 1u < 2u * leaves; k++)
        must(rlvc_planner_node(agent, k, &node) == RLVC_OK);
    must(rlvc_planner_node(agent, 2u * leaves - 1u, &node) == RLVC_E_RANGE);
    must(rlvc_value(agent, 0, NULL, NULL) == RLVC_E_MISMATCH);
    must(rlvc_q(agent, 0, 0, NULL, NULL) == RLVC_E_MISMATCH);
    must(rlvc_split_at(agent, 0, NULL, NULL) == RLVC_E_MISMATCH);
}

/* What can be asked of a sound agent has finite answers. */
static void call_check(void) {
    rlvc_statistics statistics;
    const rlvc_status status = rlvc_agent_check(agent);
    must(status == RLVC_OK || (plans && status == RLVC_E_BUSY));
    must(rlvc_stats(agent, &statistics) == RLVC_OK && statistics.classes >= 1u);
    must(statistics.classes <= (plans ? config.leaves : config.classes));
    if (plans)
        check_planner(statistics.classes);
    else
        check_classes(statistics.classes);
}

static void call(void) {
    unsigned char percept[PERCEPT_MAX];
    const uint32_t which = next_below(16);
    int sound = choose_percept(percept);
    rlvc_status status;
    uint32_t undone;
    switch (which) {
    case 0:
        status = rlvc_begin(agent, percept);
        must(sound ? status == RLVC_OK || status == RLVC_E_BUSY : status == RLVC_E_PERCEPT);
        break;
    case 1:
        call_predict(percept, sound);
        break;
    case 2:
        call_policy(percept);
        break;
    case 3:
        call_save_and_load();
        break;
    case 4:
        call_show();
        break;
    case 5:
        call_check();
        break;
    case 6:
        status = rlvc_prune(agent, (float)next_below(3), (float)next_below(3), &undone);
        must(plans ? status == RLVC_E_MISMATCH : status == RLVC_OK || status == RLVC_E_BUSY);
        break;
    case 7:
        must(rlvc_learn_abandon(agent) == (plans ? RLVC_E_MISMATCH : RLVC_OK));
        break;
    case 8:
        world.fails_from = world.calls + next_below(64);
        world.failures = next_below(40);
        break;
    case 9:
    case 10:
        call_learn();
        break;
    case 11:
        call_play();
        break;
    default:
        call_observe(percept, sound);
        break;
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    size_t bytes;
    input = data;
    input_left = size;
    memset(&world, 0, sizeof world);
    choose_domain();
    if (plans)
        choose_planner();
    else
        choose_classes();
    rlvc_status status = rlvc_agent_size(&config, &domain, &bytes);
    if (status != RLVC_OK) {
        must(status == RLVC_E_CONFIG && bytes == 0);
        return 0;
    }
    held = 0;
    must(rlvc_agent_init(&config, &domain, memory[0], sizeof memory[0], &agent) == RLVC_OK);
    world.agent = agent;
    for (uint32_t i = 0; i < CALLS_MAX && input_left > 0; i++)
        call();
    world.failures = 0;
    call_check();
    return 0;
}
