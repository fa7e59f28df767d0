/* SPDX-License-Identifier: MIT */
/* The config: defaults and ranges. */
#include "config.h"

#include "../stats/rank_sum.h"
#include "../base/solver_select.h"

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
    config->successors = domain->kind == RLVC_DOMAIN_BITS && !domain->oracle &&
                         domain->features_max <= config->features_at_once;
    return RLVC_OK;
}

static int within(float x, float low, float high) {
    return x >= low && x <= high; /* false for a NaN */
}

static int above(float x, float low, float high) {
    return x > low && x <= high;
}

/* What may be wrong: one for each message of message_of. */
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
    WRONG_DISCOUNT,
    WRONG_EPSILON,
    WRONG_ALPHA,
    WRONG_ALPHA_KNOWN,
    WRONG_TOLERANCE,
    WRONG_LEARNING_RATE,
    WRONG_SUCCESSORS_DOMAIN,
    WRONG_RANKS
};

static int wrong_in_domain(const rlvc_domain *domain) {
    if (domain->percept_bytes < 1 || domain->percept_bytes > (1u << 20))
        return WRONG_DOMAIN_PERCEPT_BYTES;
    if (domain->feature_bytes < 1 || domain->feature_bytes > (1u << 16))
        return WRONG_DOMAIN_FEATURE_BYTES;
    if (!domain->exhibits)
        return WRONG_DOMAIN_EXHIBITS;
    if (!domain->candidates && !domain->oracle)
        return WRONG_DOMAIN_CANDIDATES;
    if (!domain->name)
        return WRONG_DOMAIN_NAME;
    return NOTHING_WRONG;
}

static int wrong_in_counts(const rlvc_config *config) {
    if (config->actions < 1 || config->actions > 255)
        return WRONG_ACTIONS;
    if (config->capacity < 1 || config->capacity > INT32_MAX)
        return WRONG_CAPACITY;
    if (config->classes < 1 || config->classes > 65535)
        return WRONG_CLASSES;
    if (config->features_at_once < 1 || config->features_at_once > RLVC_DETECT_FEATURES)
        return WRONG_FEATURES_AT_ONCE;
    if (config->min_samples < 2 || config->min_samples > INT32_MAX)
        return WRONG_MIN_SAMPLES;
    if (config->max_sweeps < 1 || config->max_sweeps > INT32_MAX)
        return WRONG_MAX_SWEEPS;
    return NOTHING_WRONG;
}

static int wrong_in_choices(const rlvc_config *config) {
    if (config->criterion > RLVC_CRITERION_RESIDUAL)
        return WRONG_CRITERION;
    if (config->score != RLVC_SCORE_GAIN && config->score != RLVC_SCORE_RANKS)
        return WRONG_SCORE;
    unsigned solver = config->solver <= RLVC_SOLVER_SARSA ? 1u << config->solver : 0u;
    if (!(solver & (unsigned)(RLVC_SOLVERS)))
        return WRONG_SOLVER;
    if (config->continuing > 1)
        return WRONG_CONTINUING;
    if (config->successors > 1)
        return WRONG_SUCCESSORS;
    if (config->explore > RLVC_EXPLORE_DIRECTED)
        return WRONG_EXPLORE;
    return NOTHING_WRONG;
}

static int wrong_in_numbers(const rlvc_config *config) {
    if (!within(config->discount, 0.0f, 1.0f))
        return WRONG_DISCOUNT;
    if (!within(config->epsilon, 0.0f, 1.0f))
        return WRONG_EPSILON;
    if (!above(config->alpha, 0.0f, 1.0f))
        return WRONG_ALPHA;
    if (!above(config->alpha_known, 0.0f, 1.0f))
        return WRONG_ALPHA_KNOWN;
    if (!above(config->tolerance, 0.0f, RLVC_REWARD_MAX))
        return WRONG_TOLERANCE;
    if (!above(config->learning_rate, 0.0f, 1.0f))
        return WRONG_LEARNING_RATE;
    return NOTHING_WRONG;
}

static int wrong_together(const rlvc_config *config, const rlvc_domain *domain) {
    if (config->successors && (domain->features_max < 1 || domain->oracle ||
                               domain->features_max > config->features_at_once))
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
        [WRONG_DOMAIN_EXHIBITS] = "domain: exhibits must not be null",
        [WRONG_DOMAIN_CANDIDATES] = "domain: candidates and oracle must not both be null",
        [WRONG_DOMAIN_NAME] = "domain: name must not be null",
        [WRONG_ACTIONS] = "actions must be within [1, 255]",
        [WRONG_CAPACITY] = "capacity must be within [1, 2^31 - 1]",
        [WRONG_CLASSES] = "classes must be within [1, 65535]",
        [WRONG_FEATURES_AT_ONCE] = "features_at_once must be within [1, 64]",
        [WRONG_MIN_SAMPLES] = "min_samples must be within [2, 2^31 - 1]",
        [WRONG_MAX_SWEEPS] = "max_sweeps must be within [1, 2^31 - 1]",
        [WRONG_CRITERION] = "criterion must be one of RLVC_CRITERION_*",
        [WRONG_SCORE] = "score must be one of RLVC_SCORE_*",
        [WRONG_SOLVER] = "solver must be one of RLVC_SOLVER_* that the library was built with",
        [WRONG_CONTINUING] = "continuing must be 0 or 1",
        [WRONG_SUCCESSORS] = "successors must be 0 or 1",
        [WRONG_EXPLORE] = "explore must be one of RLVC_EXPLORE_*",
        [WRONG_DISCOUNT] = "discount must be within [0, 1]",
        [WRONG_EPSILON] = "epsilon must be within [0, 1]",
        [WRONG_ALPHA] = "alpha must be within (0, 1]",
        [WRONG_ALPHA_KNOWN] = "alpha_known must be within (0, 1]",
        [WRONG_TOLERANCE] = "tolerance must be within (0, 1e12]",
        [WRONG_LEARNING_RATE] = "learning_rate must be within (0, 1]",
        [WRONG_SUCCESSORS_DOMAIN] = "successors needs a domain with features_max within [1, "
                                    "features_at_once] and no oracle",
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
