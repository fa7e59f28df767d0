/* SPDX-License-Identifier: MIT */
/* A domain around a domain that fails when it is told to, or calls back. Include after cmocka.h.
 *
 * A call that fails first leaves nonsense in what it should have filled in. */
#ifndef RLVC_TESTS_FAULTY_H
#define RLVC_TESTS_FAULTY_H

#include "rlvc/agent.h"

#include <string.h>

typedef struct faulty {
    rlvc_domain inner;
    uint64_t calls;      /* of any callback so far */
    uint64_t fail_at;    /* the call that fails, from 1; 0: none */
    uint64_t fail_every; /* so many calls, one fails; 0: none */
    rlvc_agent *agent;   /* optional: each callback calls it */
    uint64_t refused;    /* calls back, all of which it refused */
} faulty;

static inline int faulty_ignore(void *ctx, const char *text, size_t bytes) {
    (void)ctx;
    (void)text;
    (void)bytes;
    return 0;
}

/* Calls every function of the agent. */
static inline void faulty_call_back(faulty *f) {
    const unsigned char percept[64] = {0};
    rlvc_agent *agent = f->agent;
    rlvc_choice choice = {0, 0};
    rlvc_progress progress;
    rlvc_statistics statistics;
    uint32_t undone;
    const rlvc_status statuses[] = {
        rlvc_begin(agent, percept),
        rlvc_act(agent, &choice),
        rlvc_observe(agent, choice, 0.0f, percept, RLVC_GOES_ON),
        rlvc_learn(agent, RLVC_BUDGET_UNBOUNDED, &progress),
        rlvc_learn_abandon(agent),
        rlvc_prune(agent, 0.0f, 0.0f, &undone),
        rlvc_predict(agent, percept, NULL, NULL),
        rlvc_stats(agent, &statistics),
        rlvc_q(agent, 0, 0, NULL, NULL),
        rlvc_value(agent, 0, NULL, NULL),
        rlvc_split_at(agent, 0, NULL, NULL),
        rlvc_print(agent, RLVC_PRINT_TEXT, faulty_ignore, NULL),
        rlvc_agent_check(agent),
    };
    for (size_t i = 0; i < sizeof statuses / sizeof statuses[0]; i++)
        assert_int_equal(statuses[i], RLVC_E_REENTERED);
    f->refused++;
}

/* Whether this call is to fail. */
static inline int faulty_fails(faulty *f) {
    if (f->agent)
        faulty_call_back(f);
    f->calls++;
    return f->calls == f->fail_at || (f->fail_every > 0 && f->calls % f->fail_every == 0);
}

static inline int faulty_exhibits(void *ctx, const void *percept, const void *feature,
                                  uint8_t *present) {
    faulty *f = (faulty *)ctx;
    int fails = faulty_fails(f);
    int failed = f->inner.exhibits(f->inner.ctx, percept, feature, present);
    if (fails)
        *present = !*present;
    return fails || failed;
}

static inline int faulty_candidates(void *ctx, const rlvc_samples *samples, uint32_t first,
                                    uint32_t room, void *features, uint32_t *written) {
    faulty *f = (faulty *)ctx;
    int fails = faulty_fails(f);
    int failed = f->inner.candidates(f->inner.ctx, samples, first, room, features, written);
    if (fails) {
        memset(features, 0x77, (size_t)*written * f->inner.feature_bytes);
        *written = UINT32_MAX;
    }
    return fails || failed;
}

static inline int faulty_detect(void *ctx, const rlvc_samples *samples, uint32_t first, uint32_t n,
                                const void *features, uint32_t m, uint64_t *columns) {
    faulty *f = (faulty *)ctx;
    int fails = faulty_fails(f);
    int failed = f->inner.detect(f->inner.ctx, samples, first, n, features, m, columns);
    if (fails)
        memset(columns, 0x77, m * sizeof *columns);
    return fails || failed;
}

static inline int faulty_oracle(void *ctx, const rlvc_samples *samples, uint32_t below,
                                void *feature, uint32_t *considered) {
    faulty *f = (faulty *)ctx;
    int fails = faulty_fails(f);
    int failed = f->inner.oracle(f->inner.ctx, samples, below, feature, considered);
    if (fails) {
        memset(feature, 0x77, f->inner.feature_bytes);
        *considered = UINT32_MAX;
    }
    return fails || failed;
}

static inline int faulty_name(void *ctx, const void *feature, char *text, uint32_t room) {
    faulty *f = (faulty *)ctx;
    if (!faulty_fails(f))
        return f->inner.name(f->inner.ctx, feature, text, room);
    memset(text, 'x', room);
    return 1;
}

/* What checks records calls back, but does not fail as the others do. */
static inline int faulty_check_percept(void *ctx, const void *percept) {
    faulty *f = (faulty *)ctx;
    if (f->agent)
        faulty_call_back(f);
    return f->inner.check_percept(f->inner.ctx, percept);
}

static inline int faulty_check_feature(void *ctx, const void *feature) {
    faulty *f = (faulty *)ctx;
    if (f->agent)
        faulty_call_back(f);
    return f->inner.check_feature(f->inner.ctx, feature);
}

/* The domain around *inner. *f must outlive it. */
static inline rlvc_domain faulty_domain(faulty *f, const rlvc_domain *inner) {
    static const faulty none;
    rlvc_domain outer = *inner;
    *f = none;
    f->inner = *inner;
    outer.ctx = f;
    outer.exhibits = faulty_exhibits;
    outer.method = inner->method;
    outer.candidates = inner->candidates ? faulty_candidates : NULL;
    outer.detect = inner->detect ? faulty_detect : NULL;
    outer.oracle = inner->oracle ? faulty_oracle : NULL;
    outer.name = faulty_name;
    outer.check_percept = inner->check_percept ? faulty_check_percept : NULL;
    outer.check_feature = inner->check_feature ? faulty_check_feature : NULL;
    return outer;
}

#endif
