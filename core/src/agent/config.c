/* SPDX-License-Identifier: MIT */
/* The config: defaults and ranges. */
#include "rlvc/float_rules.h"

#include "../base/float_math.h"
#include "../base/method.h"
#include "../stats/rank_sum.h"
#include "rlvc/planner.h"
#include <stddef.h>
#include <string.h>

static void set_planner(rlvc_config *config) {
    config->sample = 2000;
    config->model_leaves = 32;
    config->leaves = RLVC_PLANNER_LEAVES_MAX;
    config->horizon = 500;
    config->random = 200;
    config->candidates = 1000;
    config->patience = 300;
}

/* In code, which takes less flash than a table. */
rlvc_status rlvc_config_default(rlvc_config *config, const rlvc_domain *domain, uint32_t actions) {
    if (!config || !domain)
        return RLVC_E_NULL;
    memset(config, 0, sizeof *config);
    config->method = RLVC_METHOD_OF(domain);
    config->capacity = 2000;
    config->classes = 64;
    config->features_at_once = RLVC_DETECT_FEATURES;
    config->min_samples = 8;
    config->max_sweeps = 10000;
    config->seed = 1;
    config->criterion = RLVC_CRITERION_RESIDUAL;
    config->score = RLVC_SCORE_GAIN;
    config->solver = RLVC_SOLVER_VALUE_ITERATION;
    config->explore = RLVC_EXPLORE_DIRECTED;
    config->discount = 0.9f;
    config->epsilon = 0.9f;
    config->alpha = 0.01f;
    config->alpha_known = 1.0f;
    config->tolerance = 0.01f;
    config->learning_rate = 0.1f;
    if (RLVC_HAS_PLANNER)
        set_planner(config);
    config->actions = actions;
    if (domain->features_max > 0 && domain->features_max < RLVC_DETECT_FEATURES)
        config->features_at_once = domain->features_max;
    if (domain->kind == RLVC_DOMAIN_BITS)
        config->alpha_known = 0.1f;
    config->successors = domain->kind == RLVC_DOMAIN_BITS && !domain->oracle;
    config->dependence = RLVC_HAS_DEPENDENCE && config->successors;
    return RLVC_OK;
}

/* What may be wrong: one for each message of message_of. Counts, choices and numbers are in the
 * order of the config's fields. */
enum {
    NOTHING_WRONG,
    WRONG_METHOD,
    WRONG_DOMAIN_PERCEPT_BYTES,
    WRONG_DOMAIN_FEATURE_BYTES,
    WRONG_DOMAIN_EXHIBITS,
    WRONG_DOMAIN_CANDIDATES,
    WRONG_DOMAIN_NAME,
    WRONG_ACTIONS,
    WRONG_CAPACITY,
    WRONG_CLASSES,
    WRONG_FEATURES_AT_ONCE,
    WRONG_MIN_SAMPLES,
    WRONG_MAX_SWEEPS,
    WRONG_CRITERION,
    WRONG_SCORE,
    WRONG_SOLVER,
    WRONG_CONTINUING,
    WRONG_SUCCESSORS,
    WRONG_EXPLORE,
    WRONG_DEPENDENCE,
    WRONG_RESERVED,
    WRONG_DISCOUNT,
    WRONG_EPSILON,
    WRONG_ALPHA,
    WRONG_ALPHA_KNOWN,
    WRONG_TOLERANCE,
    WRONG_LEARNING_RATE,
    WRONG_SMALLEST_EFFECT,
    WRONG_SUCCESSORS_DOMAIN,
    WRONG_RANKS,
    WRONG_PLANNER_DOMAIN,
    WRONG_PLANNER_COMPONENTS,
    WRONG_PLANNER_ACTIONS,
    WRONG_PLANNER_CAPACITY,
    WRONG_SAMPLE,
    WRONG_MODEL_LEAVES,
    WRONG_LEAVES,
    WRONG_HORIZON,
    WRONG_RANDOM,
    WRONG_CANDIDATES,
    WRONG_PATIENCE
};

/* Is a domain of a kind that there is, and that is built in? */
static int is_known(uint32_t kind) {
    return kind < 32u && ((uint32_t)(RLVC_DOMAINS) >> kind & 1u);
}

static int wrong_in_domain(const rlvc_domain *domain) {
    if (domain->percept_bytes < 1 || domain->percept_bytes > (UINT32_C(1) << 20))
        return WRONG_DOMAIN_PERCEPT_BYTES;
    if (domain->feature_bytes < 1 || domain->feature_bytes > (UINT32_C(1) << 16))
        return WRONG_DOMAIN_FEATURE_BYTES;
    if (!domain->exhibits || !is_known(domain->kind))
        return WRONG_DOMAIN_EXHIBITS;
    if (!domain->candidates && !(RLVC_HAS_OWN_ORACLE && domain->oracle))
        return WRONG_DOMAIN_CANDIDATES;
    if (!domain->name)
        return WRONG_DOMAIN_NAME;
    return NOTHING_WRONG;
}

/* The bits of the i-th of the fields of 4 bytes from an offset on: those of one type follow each
 * other, as the next lines check. */
static uint32_t field_of(const rlvc_config *config, size_t offset, int i) {
    uint32_t bits;
    memcpy(&bits, (const unsigned char *)config + offset + 4u * (size_t)i, sizeof bits);
    return bits;
}
typedef char
    six_counts[offsetof(rlvc_config, seed) - offsetof(rlvc_config, actions) == 24 ? 1 : -1];
typedef char
    eight_choices[offsetof(rlvc_config, discount) - offsetof(rlvc_config, criterion) == 8 ? 1 : -1];
typedef char
    seven_numbers[offsetof(rlvc_config, sample) - offsetof(rlvc_config, discount) == 28 ? 1 : -1];

/* The range of a field, its ends included. */
typedef struct range {
    uint32_t low;
    uint32_t high;
} range;

static int wrong_in_counts(const rlvc_config *config) {
    static const range ranges[] = {
        {1, 255},       {1, INT32_MAX}, {1, RLVC_CLASSES_MAX}, {1, RLVC_DETECT_FEATURES},
        {2, INT32_MAX}, {1, INT32_MAX}};
    for (int i = 0; i < (int)(sizeof ranges / sizeof ranges[0]); i++) {
        const uint32_t count = field_of(config, offsetof(rlvc_config, actions), i);
        if (count < ranges[i].low || count > ranges[i].high)
            return WRONG_ACTIONS + i;
    }
    return NOTHING_WRONG;
}

/* Bit n of a field's mask: it may be n. */
static int wrong_in_choices(const rlvc_config *config) {
    const uint8_t *choice = (const uint8_t *)config + offsetof(rlvc_config, criterion);
    static const uint8_t masks[] = {
        (RLVC_CRITERIA) & (1u << RLVC_CRITERION_RETURNS | 1u << RLVC_CRITERION_RESIDUAL),
        (RLVC_SCORES) & (1u << RLVC_SCORE_GAIN | 1u << RLVC_SCORE_RANKS),
        (RLVC_SOLVERS)&15u,
        3,
        3,
        1u << RLVC_EXPLORE_UNIFORM | 1u << RLVC_EXPLORE_DIRECTED,
        (RLVC_DEPENDENCES)&3u,
        1};
    for (int i = 0; i < (int)sizeof masks; i++) {
        if (choice[i] > 7u || !(masks[i] >> choice[i] & 1u))
            return WRONG_CRITERION + i;
    }
    return NOTHING_WRONG;
}

/* Numbers from 0 on are in the order of their bits; those below, and a NaN, come after them all. */
static int wrong_in_numbers(const rlvc_config *config) {
    for (int i = 0; i < 7; i++) {
        const uint32_t number = field_of(config, offsetof(rlvc_config, discount), i);
        const int may_be_0 = i < 2 || i == 6;
        const float discount = RLVC_HAS_UNDISCOUNTED ? 1.0f : 0.9999999f;
        const float most_worth = RLVC_HAS_EFFECT ? RLVC_REWARD_MAX : 0.0f;
        const float most = i == 4 ? RLVC_REWARD_MAX : i == 6 ? most_worth : i > 0 ? 1.0f : discount;
        const int is_0 = number << 1u == 0; /* or -0 */
        if (is_0 ? !may_be_0 : number > rlvc_bits_of(most))
            return WRONG_DISCOUNT + i;
    }
    return NOTHING_WRONG;
}

static int wrong_together(const rlvc_config *config, const rlvc_domain *domain) {
    if (config->successors && (domain->features_max < 1 || domain->oracle))
        return WRONG_SUCCESSORS_DOMAIN;
    if (config->score == RLVC_SCORE_RANKS &&
        (domain->oracle || config->capacity >= RLVC_RANK_SUM_MAX))
        return WRONG_RANKS;
    return NOTHING_WRONG;
}

static int wrong_in_planner(const rlvc_config *config, const rlvc_domain *domain) {
    const struct {
        uint32_t count;
        range range;
    } fields[] = {
        {domain->percept_bytes / 4u, {1, RLVC_PLANNER_COMPONENTS_MAX}},
        {config->actions, {2, RLVC_PLANNER_ACTIONS_MAX}},
        {config->capacity, {64, RLVC_PLANNER_CAPACITY_MAX}},
        {config->sample, {32, config->capacity}},
        {config->model_leaves, {1, RLVC_PLANNER_MODEL_LEAVES_MAX}},
        {config->leaves, {2, RLVC_PLANNER_LEAVES_MAX}},
        {config->horizon, {1, RLVC_PLANNER_CAPACITY_MAX}},
        {config->random, {32, config->capacity / 2u}},
        {config->candidates, {1, RLVC_PLANNER_CANDIDATES_MAX}},
        {config->patience, {1, RLVC_PLANNER_CANDIDATES_MAX}},
    };
    if (domain->kind != RLVC_DOMAIN_THRESHOLDS)
        return WRONG_PLANNER_DOMAIN;
    for (int i = 0; i < (int)(sizeof fields / sizeof fields[0]); i++)
        if (fields[i].count < fields[i].range.low || fields[i].count > fields[i].range.high)
            return WRONG_PLANNER_COMPONENTS + i;
    return NOTHING_WRONG;
}

/* Nothing else needs the messages, so that they are left out of a program that does not ask why. */
static const char *message_of(int wrong) {
    static const char *const messages[] = {
        [NOTHING_WRONG] = "ok",
        [WRONG_METHOD] = "method must be one of &rlvc_method_* that the library was built with",
        [WRONG_DOMAIN_PERCEPT_BYTES] = "domain: percept_bytes must be within [1, 1048576]",
        [WRONG_DOMAIN_FEATURE_BYTES] = "domain: feature_bytes must be within [1, 65536]",
        [WRONG_DOMAIN_EXHIBITS] =
            "domain: exhibits must not be null, and its kind one that the library was built with",
        [WRONG_DOMAIN_CANDIDATES] = "domain: candidates and oracle must not both be null",
        [WRONG_DOMAIN_NAME] = "domain: name must not be null",
        [WRONG_ACTIONS] = "actions must be within [1, 255]",
        [WRONG_CAPACITY] = "capacity must be within [1, 2^31 - 1]",
        [WRONG_CLASSES] = RLVC_AT_ONCE ? "classes must be within [1, 65535]"
                                       : "classes must be within [1, 512]: RLVC_AT_ONCE is 0",
        [WRONG_FEATURES_AT_ONCE] = "features_at_once must be within [1, 64]",
        [WRONG_MIN_SAMPLES] = "min_samples must be within [2, 2^31 - 1]",
        [WRONG_MAX_SWEEPS] = "max_sweeps must be within [1, 2^31 - 1]",
        [WRONG_CRITERION] =
            "criterion must be one of RLVC_CRITERION_* that the library was built with",
        [WRONG_SCORE] = "score must be one of RLVC_SCORE_* that the library was built with",
        [WRONG_SOLVER] = "solver must be one of RLVC_SOLVER_* that the library was built with",
        [WRONG_CONTINUING] = "continuing must be 0 or 1",
        [WRONG_SUCCESSORS] = "successors must be 0 or 1",
        [WRONG_EXPLORE] = "explore must be one of RLVC_EXPLORE_*",
        [WRONG_DEPENDENCE] = "dependence must be 0 or 1",
        [WRONG_RESERVED] = "reserved must be 0",
        [WRONG_DISCOUNT] = "discount must be within [0, 1]",
        [WRONG_EPSILON] = "epsilon must be within [0, 1]",
        [WRONG_ALPHA] = "alpha must be within (0, 1]",
        [WRONG_ALPHA_KNOWN] = "alpha_known must be within (0, 1]",
        [WRONG_TOLERANCE] = "tolerance must be within (0, 1e12]",
        [WRONG_LEARNING_RATE] = "learning_rate must be within (0, 1]",
        [WRONG_SMALLEST_EFFECT] = "smallest_effect must be within [0, 1e12]",
        [WRONG_SUCCESSORS_DOMAIN] = "successors needs a features_max above 0 and no oracle",
        [WRONG_RANKS] = "score ranks needs a domain without an oracle and a capacity below 2^21",
        [WRONG_PLANNER_DOMAIN] = "domain: must be of thresholds for the planner",
        [WRONG_PLANNER_COMPONENTS] = "domain: components must be within [1, 64] for the planner",
        [WRONG_PLANNER_ACTIONS] = "actions must be within [2, 64] for the planner",
        [WRONG_PLANNER_CAPACITY] = "capacity must be within [64, 100000000] for the planner",
        [WRONG_SAMPLE] = "sample must be within [32, capacity]",
        [WRONG_MODEL_LEAVES] = "model_leaves must be within [1, 256]",
        [WRONG_LEAVES] = "leaves must be within [2, 16]",
        [WRONG_HORIZON] = "horizon must be within [1, 100000000]",
        [WRONG_RANDOM] = "random must be within [32, capacity / 2]",
        [WRONG_CANDIDATES] = "candidates must be within [1, 1000000]",
        [WRONG_PATIENCE] = "patience must be within [1, 1000000]",
    };
    return messages[wrong];
}

/* Is the method one that is built in? */
static int has_method(const rlvc_config *config) {
    return RLVC_METHOD_IS_IN(config->method);
}

static int wrong_in(const rlvc_config *config, const rlvc_domain *domain) {
    if (!has_method(config))
        return WRONG_METHOD;
    int wrong = wrong_in_domain(domain);
    if (!wrong && rlvc_config_plans(config))
        return wrong_in_planner(config, domain);
    if (!wrong)
        wrong = wrong_in_counts(config);
    if (!wrong)
        wrong = wrong_in_choices(config);
    if (!wrong)
        wrong = wrong_in_numbers(config);
    if (!wrong)
        wrong = wrong_together(config, domain);
    return wrong;
}

rlvc_status rlvc_config_status(const rlvc_config *config, const rlvc_domain *domain) {
    if (!config || !domain)
        return RLVC_E_NULL;
    return wrong_in(config, domain) == NOTHING_WRONG ? RLVC_OK : RLVC_E_CONFIG;
}

rlvc_status rlvc_config_check(const rlvc_config *config, const rlvc_domain *domain,
                              const char **why) {
    rlvc_status status = rlvc_config_status(config, domain);
    if (status != RLVC_E_NULL && why)
        *why = message_of(wrong_in(config, domain));
    return status;
}
