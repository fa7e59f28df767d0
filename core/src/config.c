/* SPDX-License-Identifier: MIT */
/* The config: defaults and ranges. */
#include "rlvc/agent.h"

#include "solvers.h"

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
        .untried = RLVC_UNTRIED_EXCLUDED,
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

static const char *wrong_in_domain(const rlvc_domain *domain) {
    if (domain->percept_bytes < 1 || domain->percept_bytes > (1u << 20))
        return "domain: percept_bytes must be within [1, 1048576]";
    if (domain->feature_bytes < 1 || domain->feature_bytes > (1u << 16))
        return "domain: feature_bytes must be within [1, 65536]";
    if (!domain->exhibits)
        return "domain: exhibits must not be null";
    if (!domain->candidates && !domain->oracle)
        return "domain: candidates and oracle must not both be null";
    if (!domain->name)
        return "domain: name must not be null";
    return NULL;
}

static const char *wrong_in_counts(const rlvc_config *config) {
    if (config->actions < 1 || config->actions > 255)
        return "actions must be within [1, 255]";
    if (config->capacity < 1 || config->capacity > INT32_MAX)
        return "capacity must be within [1, 2^31 - 1]";
    if (config->classes < 1 || config->classes > 65535)
        return "classes must be within [1, 65535]";
    if (config->features_at_once < 1 || config->features_at_once > RLVC_DETECT_FEATURES)
        return "features_at_once must be within [1, 64]";
    if (config->min_samples < 2 || config->min_samples > INT32_MAX)
        return "min_samples must be within [2, 2^31 - 1]";
    if (config->max_sweeps < 1 || config->max_sweeps > INT32_MAX)
        return "max_sweeps must be within [1, 2^31 - 1]";
    return NULL;
}

static const char *wrong_in_choices(const rlvc_config *config) {
    if (config->criterion > RLVC_CRITERION_RESIDUAL)
        return "criterion must be one of RLVC_CRITERION_*";
    if (config->score > RLVC_SCORE_CHI2)
        return "score must be one of RLVC_SCORE_*";
    unsigned solver = config->solver <= RLVC_SOLVER_PRIORITIZED ? 1u << config->solver : 0u;
    if (!((unsigned)(RLVC_SOLVERS) & solver))
        return "solver must be one of RLVC_SOLVER_* that the library was built with";
    if (config->untried > RLVC_UNTRIED_OPTIMISTIC)
        return "untried must be one of RLVC_UNTRIED_*";
    if (config->continuing > 1)
        return "continuing must be 0 or 1";
    if (config->successors > 1)
        return "successors must be 0 or 1";
    if (config->explore > RLVC_EXPLORE_DIRECTED)
        return "explore must be one of RLVC_EXPLORE_*";
    if (config->reserved)
        return "reserved must be 0";
    return NULL;
}

static const char *wrong_in_numbers(const rlvc_config *config) {
    if (!within(config->discount, 0.0f, 1.0f))
        return "discount must be within [0, 1]";
    if (!within(config->epsilon, 0.0f, 1.0f))
        return "epsilon must be within [0, 1]";
    if (!above(config->alpha, 0.0f, 1.0f))
        return "alpha must be within (0, 1]";
    if (!above(config->alpha_known, 0.0f, 1.0f))
        return "alpha_known must be within (0, 1]";
    if (!above(config->tolerance, 0.0f, RLVC_REWARD_MAX))
        return "tolerance must be within (0, 1e12]";
    if (!above(config->learning_rate, 0.0f, 1.0f))
        return "learning_rate must be within (0, 1]";
    if (!within(config->optimistic_value, -RLVC_REWARD_MAX, RLVC_REWARD_MAX))
        return "optimistic_value must be within [-1e12, 1e12]";
    return NULL;
}

static const char *wrong_together(const rlvc_config *config, const rlvc_domain *domain) {
    if (config->successors && (domain->features_max < 1 || domain->oracle ||
                               domain->features_max > config->features_at_once))
        return "successors needs a domain with features_max within [1, features_at_once] and no oracle";
    return NULL;
}

rlvc_status rlvc_config_check(const rlvc_config *config, const rlvc_domain *domain,
                              const char **why) {
    if (!config || !domain)
        return RLVC_E_NULL;
    const char *wrong = wrong_in_domain(domain);
    if (!wrong)
        wrong = wrong_in_counts(config);
    if (!wrong)
        wrong = wrong_in_choices(config);
    if (!wrong)
        wrong = wrong_in_numbers(config);
    if (!wrong)
        wrong = wrong_together(config, domain);
    if (why)
        *why = wrong ? wrong : "ok";
    return wrong ? RLVC_E_CONFIG : RLVC_OK;
}
