/* SPDX-License-Identifier: MIT */
/* The value gate by itself, against the same rule in double. (test_split.c has it in a search.) */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "split/gate.h"
#include "base/rng.h"

#define ACTIONS 3u
#define SAMPLES_MAX 400u
#define MIN_SAMPLES 8u

/* The targets of a class: of each action on each side. */
static struct {
    float target[ACTIONS][2][SAMPLES_MAX];
    uint32_t count[ACTIONS][2];
} class;

static int passes(float gap) {
    rlvc_gate gate;
    int passed = -1;
    rlvc_gate_begin(&gate, &class);
    assert_ptr_equal(gate.feature, &class);
    for (uint32_t a = 0; a < ACTIONS; a++) {
        for (uint32_t s = 0; s < 2u; s++)
            for (uint32_t i = 0; i < class.count[a][s]; i++)
                rlvc_gate_add(&gate, class.target[a][s][i], s);
        passed = rlvc_gate_close(&gate, MIN_SAMPLES, gap);
    }
    return passed;
}

/* By how much the best lower bound of a side exceeds the upper one of the greedy action, on the
 * better side. */
static double margin(void) {
    double most[2] = {-HUGE_VAL, -HUGE_VAL}, enough[2] = {HUGE_VAL, HUGE_VAL}, highest = -HUGE_VAL;
    for (uint32_t a = 0; a < ACTIONS; a++) {
        double upper[2], total = 0.0;
        for (uint32_t s = 0; s < 2u; s++) {
            const uint32_t n = class.count[a][s];
            double sum = 0.0, squares = 0.0;
            for (uint32_t i = 0; i < n; i++)
                sum += (double)class.target[a][s][i];
            total += sum;
            for (uint32_t i = 0; i < n; i++)
                squares += pow((double)class.target[a][s][i] - sum / n, 2);
            upper[s] = HUGE_VAL;
            if (n >= MIN_SAMPLES) {
                double reach = (double)RLVC_GATE_DEVIATIONS * sqrt(squares / n / n);
                upper[s] = sum / n + reach;
                most[s] = fmax(most[s], sum / n - reach);
            }
        }
        if (class.count[a][0] + class.count[a][1] == 0)
            continue;
        double mean = total / (class.count[a][0] + class.count[a][1]);
        if (mean > highest) {
            highest = mean;
            enough[0] = upper[0];
            enough[1] = upper[1];
        }
    }
    return fmax(most[0] - enough[0], most[1] - enough[1]);
}

static void clear(void) {
    for (uint32_t a = 0; a < ACTIONS; a++)
        class.count[a][0] = class.count[a][1] = 0;
}

static void add(uint32_t a, uint32_t s, uint32_t times, float target) {
    for (uint32_t i = 0; i < times; i++)
        class.target[a][s][class.count[a][s]++] = target;
}

/* Random classes, whose targets lie far from 0 or near; some pairs have few samples, or none. */
static void test_against_double(void **state) {
    (void)state;
    rlvc_rng rng;
    uint32_t passed = 0, sure = 0;
    rlvc_rng_seed(&rng, 1);
    for (uint32_t i = 0; i < 3000u; i++) {
        const float base = i % 3u == 0 ? 0.0f : i % 3u == 1u ? 1000.0f : -30.0f;
        clear();
        for (uint32_t a = 0; a < ACTIONS; a++)
            for (uint32_t s = 0; s < 2u; s++) {
                const uint32_t size = rlvc_rng_below(&rng, 4) == 0 ? 12 : 300;
                const float worth = base + (float)rlvc_rng_below(&rng, 3);
                for (uint32_t n = rlvc_rng_below(&rng, size); n > 0; n--)
                    add(a, s, 1, worth + (float)rlvc_rng_below(&rng, 9) * 0.3f);
            }
        const double found = margin();
        for (float gap = 0.0f; gap < 1.0f; gap += 0.24f) {
            if (fabs(found - (double)gap) < 0.002)
                continue; /* rounding may tell */
            if (passes(gap) != (found > (double)gap))
                fail_msg("class %u, gap %g: margin %g", (unsigned)i, (double)gap, found);
            passed += found > (double)gap;
            sure++;
        }
    }
    assert_in_range(passed, sure / 10u, sure / 2u); /* or there is nothing to see */
}

/* Targets without any spread: the gap alone tells. */
static void test_gap(void **state) {
    (void)state;
    clear();
    add(0, 0, 20, 5.0f);
    add(0, 1, 10, 1.0f);
    add(1, 0, 10, 0.0f);
    add(1, 1, 10, 2.0f);
    assert_int_equal(passes(0.9f), 1);
    assert_int_equal(passes(1.0f), 0);
}

/* What has too few samples says nothing, neither of the other action nor of the greedy one. */
static void test_few(void **state) {
    (void)state;
    for (uint32_t few = 0; few < 2u; few++)
        for (uint32_t n = 0; n < 12u; n++) {
            clear();
            add(0, 0, 20, 5.0f);
            add(0, 1, few == 0 ? 10 : n, 1.0f);
            add(2, 0, 10, 0.0f);
            add(2, 1, few == 0 ? n : 10, 2.0f);
            assert_int_equal(passes(0.5f), n >= MIN_SAMPLES);
        }
}

/* Where the same action is best on both sides, or all are alike, there is nothing to raise. */
static void test_nothing_to_raise(void **state) {
    (void)state;
    clear();
    assert_int_equal(passes(0.0f), 0);
    for (uint32_t a = 0; a < ACTIONS; a++) {
        add(a, 0, 30, 0.0f);
        add(a, 1, 30, 100.0f);
    }
    assert_int_equal(passes(0.0f), 0);
    add(1, 0, 30, 1.0f);
    add(1, 1, 30, 101.0f);
    assert_int_equal(passes(0.0f), 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_against_double),
        cmocka_unit_test(test_gap),
        cmocka_unit_test(test_few),
        cmocka_unit_test(test_nothing_to_raise),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
