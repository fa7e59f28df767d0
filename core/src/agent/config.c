/* SPDX-License-Identifier: MIT */
/* The config: defaults and ranges. */
#include "rlvc/float_rules.h"

#include "config.h"

#include "../base/float_math.h"
#include "../base/solver_select.h"
#include "../stats/rank_sum.h"
#include <stddef.h>
#include <string.h>

rlvc_status rlvc_config_default(rlvc_config *config, const rlvc_domain *domain, uint32_t actions) {
    static const rlvc_config defaults = {
        .capacity = 2000,
        .classes = 64,
        .features_at_once = RLVC_DETECT_FEATURES,
        .min_samples = 8,
        .max_sweeps = 10000,
        .seed = 1,
        .criterion = RLVC_CRITERION_RESIDUAL,
        .score = RLVC_SCORE_GAIN,
        .solver = RLVC_SOLVER_VALUE_ITERATION,
        .explore = RLVC_EXPLORE_DIRECTED,
        .discount = 0.9f,
        .epsilon = 0.9f,
        .alpha = 0.01f,
        .alpha_known = 1.0f,
        .tolerance = 0.01f,
        .learning_rate = 0.1f,
    };
    if (!config || !domain)
        return RLVC_E_NULL;
    *config = defaults;
    config->actions = actions;
    if (domain->features_max > 0 && domain->features_max < RLVC_DETECT_FEATURES)
        config->features_at_once = domain->features_max;
    if (domain->kind == RLVC_DOMAIN_BITS)
        config->alpha_known = 0.1f;
    config->successors = domain->kind == RLVC_DOMAIN_BITS && !domain->oracle;
    return RLVC_OK;
}

/* What may be wrong: one for each message of message_of. Counts, choices and numbers are in the
 * order of the config's fields. */
enum {
    NOTHING_WRONG,
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
    WRONG_RANKS
};

static int wrong_in_domain(const rlvc_domain *domain) {
    if (domain->percept_bytes < 1 || domain->percept_bytes > (UINT32_C(1) << 20))
        return WRONG_DOMAIN_PERCEPT_BYTES;
    if (domain->feature_bytes < 1 || domain->feature_bytes > (UINT32_C(1) << 16))
        return WRONG_DOMAIN_FEATURE_BYTES;
    if (!domain->exhibits || (!RLVC_HAS_OTHER_DOMAINS && domain->kind != RLVC_DOMAIN_BITS))
        return WRONG_DOMAIN_EXHIBITS;
    if (!domain->candidates && !(RLVC_HAS_OWN_ORACLE && domain->oracle))
        return WRONG_DOMAIN_CANDIDATES;
    if (!domain->name)
        return WRONG_DOMAIN_NAME;
    return NOTHING_WRONG;
}

/* The fields from an offset on: those of one type follow each other, as the next lines check. */
static const unsigned char *fields_of(const rlvc_config *config, size_t offset) {
    return (const unsigned char *)config + offset;
}
typedef char six_counts[offsetof(rlvc_config, seed) == 24 ? 1 : -1];
typedef char
    eight_choices[offsetof(rlvc_config, discount) - offsetof(rlvc_config, criterion) == 8 ? 1 : -1];
typedef char seven_numbers[sizeof(rlvc_config) - offsetof(rlvc_config, discount) == 28 ? 1 : -1];

/* The range of a field, its ends included. */
typedef struct range {
    uint32_t low;
    uint32_t high;
} range;

static int wrong_in_counts(const rlvc_config *config) {
    uint32_t count[6];
    static const range ranges[] = {{1, 255},       {1, INT32_MAX},
                                   {1, 65535},     {1, RLVC_DETECT_FEATURES},
                                   {2, INT32_MAX}, {1, INT32_MAX}};
    memcpy(count, fields_of(config, offsetof(rlvc_config, actions)), sizeof count);
    for (int i = 0; i < (int)(sizeof count / sizeof count[0]); i++) {
        if (count[i] < ranges[i].low || count[i] > ranges[i].high)
            return WRONG_ACTIONS + i;
    }
    return NOTHING_WRONG;
}

/* Bit n of a field's mask: it may be n. */
static int wrong_in_choices(const rlvc_config *config) {
    uint8_t choice[8];
    static const uint8_t masks[] = {
        (RLVC_CRITERIA) & (1u << RLVC_CRITERION_RETURNS | 1u << RLVC_CRITERION_RESIDUAL),
        (RLVC_SCORES) & (1u << RLVC_SCORE_GAIN | 1u << RLVC_SCORE_RANKS),
        (RLVC_SOLVERS)&15u,
        3,
        3,
        1u << RLVC_EXPLORE_UNIFORM | 1u << RLVC_EXPLORE_DIRECTED,
        (RLVC_DEPENDENCES)&3u,
        1};
    memcpy(choice, fields_of(config, offsetof(rlvc_config, criterion)), sizeof choice);
    for (int i = 0; i < (int)sizeof choice; i++) {
        if (choice[i] > 7u || !(masks[i] >> choice[i] & 1u))
            return WRONG_CRITERION + i;
    }
    return NOTHING_WRONG;
}

/* Numbers from 0 on are in the order of their bits; those below, and a NaN, come after them all. */
static int wrong_in_numbers(const rlvc_config *config) {
    uint32_t number[7];
    memcpy(number, fields_of(config, offsetof(rlvc_config, discount)), sizeof number);
    for (int i = 0; i < (int)(sizeof number / sizeof number[0]); i++) {
        const int may_be_0 = i < 2 || i == 6;
        const float one = RLVC_HAS_UNDISCOUNTED || i > 0 ? 1.0f : 0.9999999f;
        const float most_worth = RLVC_HAS_EFFECT ? RLVC_REWARD_MAX : 0.0f;
        const float most = i == 4 ? RLVC_REWARD_MAX : i < 6 ? one : most_worth;
        const int is_0 = number[i] << 1u == 0; /* or -0 */
        if (is_0 ? !may_be_0 : number[i] > rlvc_bits_of(most))
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

/* Nothing else needs the messages, so that they are left out of a program that does not ask why. */
static const char *message_of(int wrong) {
    static const char *const messages[] = {
        [NOTHING_WRONG] = "ok",
        [WRONG_DOMAIN_PERCEPT_BYTES] = "domain: percept_bytes must be within [1, 1048576]",
        [WRONG_DOMAIN_FEATURE_BYTES] = "domain: feature_bytes must be within [1, 65536]",
        [WRONG_DOMAIN_EXHIBITS] =
            "domain: exhibits must not be null, and its kind one that the library was built with",
        [WRONG_DOMAIN_CANDIDATES] = "domain: candidates and oracle must not both be null",
        [WRONG_DOMAIN_NAME] = "domain: name must not be null",
        [WRONG_ACTIONS] = "actions must be within [1, 255]",
        [WRONG_CAPACITY] = "capacity must be within [1, 2^31 - 1]",
        [WRONG_CLASSES] = "classes must be within [1, 65535]",
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
    };
    return messages[wrong];
}

static int wrong_in(const rlvc_config *config, const rlvc_domain *domain) {
    int wrong = wrong_in_domain(domain);
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
