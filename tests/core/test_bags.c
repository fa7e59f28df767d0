/* SPDX-License-Identifier: MIT */
/* The domain of bags of vectors: detect() agrees with exhibits() and with the definition, by whole
 * numbers; a bag is gathered of what a thing's percepts have in common, and found though half of it
 * is missing; what is refused; and a task that no single vector tells is learnt. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "../domains/runs.h"
#include "rlvc/agent.h"
#include "rlvc/bags.h"
#include "rlvc/thresholds.h"

#include <math.h>
#include <stdlib.h>

#define POINTS_MAX 12u
#define DIMENSIONS_MAX 33u
#define FEATURES_MAX 64u
#define SIZE 4u
#define TAU 4.0f
#include "vectors.h"

static rlvc_bags bags;
static float records[FEATURES_MAX * (2u + SIZE * DIMENSIONS_MAX)];

static unsigned char *bag(uint32_t j) {
    return (unsigned char *)records + (size_t)j * f.domain.feature_bytes;
}

static unsigned char *bag_vector(uint32_t j, uint32_t i) {
    return bag(j) + 8u + i * vector_bytes();
}

static void set_head(uint32_t j, float needed, uint32_t count) {
    memcpy(bag(j), &needed, sizeof needed);
    memcpy(bag(j) + 4u, &count, sizeof count);
}

static void open_bags(uint32_t points, uint32_t dimensions, uint32_t form) {
    memset(&f, 0, sizeof f);
    memset(records, 0, sizeof records);
    assert_int_equal(rlvc_bags_default(&bags, points, dimensions, form, TAU), RLVC_OK);
    bags.size = SIZE;
    assert_int_equal(rlvc_bags_domain(&bags, &f.domain), RLVC_OK);
    f.s.vectors = bags.vectors;
    draw_percepts();
}

/* ------------------------------------------------------------------ detecting */

static void make_bags(void) {
    for (uint32_t j = 0; j < FEATURES_MAX; j++) {
        for (uint32_t i = 0; i < SIZE; i++)
            for (uint32_t k = 0; k < bags.vectors.dimensions; k++)
                set_number(bag_vector(j, i), k, (int)rlvc_rng_below(&f.rng, 5) - 2);
        if (count_of(percept(j)) > 0) /* a vector of some percept */
            memcpy(bag_vector(j, 0), percept(j) + 4u, vector_bytes());
        set_head(j, j % 8u == 7u ? -1.0f : (float)rlvc_rng_below(&f.rng, 40), j % (SIZE + 1u));
    }
}

static double score_by_definition(uint32_t at, uint32_t j) {
    double sum = 0.0;
    for (uint32_t i = 0; i < rlvc_bags_count(bag(j)); i++) {
        double least = (double)(TAU * TAU);
        for (uint32_t point = 0; point < count_of(percept(at)); point++)
            least = fmin(least, squared_of(percept(at), point, bag_vector(j, i)));
        sum += (double)(TAU * TAU) - least;
    }
    return sum;
}

static void check_detect(uint32_t first, uint32_t n) {
    uint64_t columns[FEATURES_MAX + 1u];
    columns[FEATURES_MAX] = 0x123456789abcdefu;
    assert_int_equal(f.domain.detect(&bags, &f.samples, first, n, records, FEATURES_MAX, columns),
                     0);
    for (uint32_t j = 0; j < FEATURES_MAX; j++) {
        const double needed = (double)rlvc_bags_needed(bag(j));
        for (uint32_t i = 0; i < n; i++) {
            const uint32_t slot = f.sample[first + i].slot;
            uint8_t present = 2;
            assert_int_equal(f.domain.exhibits(&bags, percept(slot), bag(j), &present), 0);
            assert_int_equal(present, needed >= 0.0 && score_by_definition(slot, j) >= needed);
            assert_int_equal(columns[j] >> i & 1u, present);
        }
        assert_true(n == 64u || columns[j] >> n == 0);
    }
    assert_true(columns[FEATURES_MAX] == 0x123456789abcdefu);
}

static void test_detect(void **state) {
    (void)state;
    const uint32_t dimensions[] = {1, 3, 8, 33};
    for (uint32_t form = 0; form <= RLVC_DESCRIPTORS_INT8; form++)
        for (size_t i = 0; i < sizeof dimensions / sizeof dimensions[0]; i++)
            for (uint32_t points = 1; points <= 6u; points++) {
                open_bags(points, dimensions[i], form);
                make_bags();
                check_detect(0, 64);
                check_detect(PERCEPTS - 3u, 3);
            }
}

static void test_nearest(void **state) {
    (void)state;
    open_bags(5, 8, RLVC_DESCRIPTORS_FLOAT);
    make_bags();
    for (uint32_t j = 0; j < FEATURES_MAX; j++)
        for (uint32_t i = 0; i < SIZE; i++) {
            uint32_t point = 9;
            float squared = -1.0f;
            const rlvc_status status =
                rlvc_bags_nearest(&bags, percept(j), bag(j), i, &point, &squared);
            if (count_of(percept(j)) == 0 || i >= rlvc_bags_count(bag(j))) {
                assert_int_equal(status, RLVC_E_RANGE);
                assert_int_equal(point, 9);
                continue;
            }
            assert_int_equal(status, RLVC_OK);
            assert_int_equal(rlvc_bags_nearest(&bags, percept(j), bag(j), i, NULL, NULL), RLVC_OK);
            assert_true(fabs(squared_of(percept(j), point, bag_vector(j, i)) - (double)squared) <
                        1e-3);
            for (uint32_t k = 0; k < count_of(percept(j)); k++)
                assert_true(squared_of(percept(j), k, bag_vector(j, i)) >= (double)squared);
        }
    set_count(0, 6);
    assert_int_equal(rlvc_bags_nearest(&bags, percept(0), bag(1), 0, NULL, NULL), RLVC_E_RANGE);
    assert_int_equal(rlvc_bags_nearest(NULL, percept(1), bag(1), 0, NULL, NULL), RLVC_E_NULL);
    assert_int_equal(rlvc_bags_nearest(&bags, NULL, bag(1), 0, NULL, NULL), RLVC_E_NULL);
    assert_int_equal(rlvc_bags_nearest(&bags, percept(1), NULL, 0, NULL, NULL), RLVC_E_NULL);
    assert_int_equal(rlvc_bags_count(NULL), 0);
    assert_true(rlvc_bags_needed(NULL) < 0.0f);
}

/* ------------------------------------------------------------------ gathering */

/* A thing has four vectors, ten times a unit vector each; what is behind it, four of 64 others. */
static void see_thing(uint32_t i, uint32_t thing, uint32_t missing) {
    memset(percept(i), 0, f.domain.percept_bytes);
    uint32_t count = 0;
    const uint32_t first = rlvc_rng_below(&f.rng, 4);
    for (uint32_t part = 0; part < 8u; part++) {
        if (part < 4u && (part + first) % 4u < missing)
            continue;
        unsigned char *vectors = percept(i) + 4u + count * vector_bytes();
        if (part < 4u) {
            set_number(vectors, 4u * thing + part, 10);
        } else {
            set_number(vectors, 16u + rlvc_rng_below(&f.rng, 8), -10);
            set_number(vectors, 24u + rlvc_rng_below(&f.rng, 8), 10);
        }
        count++;
    }
    set_count(i, count);
}

static void open_things(uint32_t form) {
    open_bags(8, 32, form);
    for (uint32_t i = 0; i < PERCEPTS; i++) {
        see_thing(i, i % 4u, rlvc_rng_below(&f.rng, 2));
        f.sample[i] = (rlvc_sample){(i * 4u / PERCEPTS), 0};
        f.sample[i].slot = f.sample[i].key + 4u * (i % (PERCEPTS / 4u));
    }
}

static void test_gathered(void **state) {
    (void)state;
    for (uint32_t form = 0; form <= RLVC_DESCRIPTORS_INT8; form++) {
        uint32_t written = 0, found[4] = {0};
        open_things(form);
        assert_int_equal(f.domain.candidates(&bags, &f.samples, 0, 64, records, &written), 0);
        assert_int_equal(written, 16);
        for (uint32_t j = 0; j < written; j++) {
            const uint32_t thing = j % 4u; /* each run has its turn */
            uint32_t own = 0;
            for (uint32_t i = 0; i < rlvc_bags_count(bag(j)); i++)
                for (uint32_t part = 0; part < 4u; part++)
                    own += get_number(bag_vector(j, i), 4u * thing + part) > 0.0;
            assert_int_equal(own, 4);
            for (uint32_t other = 0; other < 4u; other++) { /* half of it is enough */
                uint8_t present = 2;
                see_thing(0, other, 2);
                assert_int_equal(f.domain.exhibits(&bags, percept(0), bag(j), &present), 0);
                assert_int_equal(present, other == thing);
            }
            see_thing(0, 0, 0);
            found[thing]++;
        }
        assert_int_equal(found[3], 4);
        open_things(form); /* the last one, asked for alone, is the same again */
        float last[2u + SIZE * DIMENSIONS_MAX];
        assert_int_equal(f.domain.candidates(&bags, &f.samples, 0, 64, records, &written), 0);
        memcpy(last, bag(15), f.domain.feature_bytes);
        assert_int_equal(f.domain.candidates(&bags, &f.samples, 15, 64, records, &written), 0);
        assert_int_equal(written, 1);
        assert_memory_equal(last, bag(0), f.domain.feature_bytes);
    }
}

/* Where there is one target alone there are no candidates; where there is nothing to tell targets
 * by, they are refused. */
static void test_nothing_to_gather(void **state) {
    (void)state;
    uint32_t written = 0;
    open_things(RLVC_DESCRIPTORS_FLOAT);
    for (uint32_t i = 0; i < PERCEPTS; i++)
        f.sample[i].key = 5;
    assert_int_equal(f.domain.candidates(&bags, &f.samples, 0, 64, records, &written), 0);
    assert_int_equal(written, 0);
    open_things(RLVC_DESCRIPTORS_FLOAT);
    for (uint32_t i = 0; i < PERCEPTS; i++)
        set_count(i, 0);
    assert_int_equal(f.domain.candidates(&bags, &f.samples, 0, 64, records, &written), 0);
    assert_int_equal(written, 16);
    for (uint32_t j = 0; j < written; j++) {
        uint8_t present = 2;
        assert_true(rlvc_bags_needed(bag(j)) < 0.0f);
        assert_int_equal(rlvc_bags_count(bag(j)), 0);
        assert_int_equal(f.domain.check_feature(&bags, bag(j)), 0);
        assert_int_equal(f.domain.exhibits(&bags, percept(0), bag(j), &present), 0);
        assert_int_equal(present, 0);
    }
}

/* Two targets show the same thing: a bag is refused, or at least twice as common in its run. More
 * runs than candidates: some have none. */
static void test_nothing_to_tell(void **state) {
    (void)state;
    uint32_t written = 0;
    open_things(RLVC_DESCRIPTORS_INT8);
    for (uint32_t i = 0; i < PERCEPTS; i++) {
        see_thing(i, 0, 0);
        f.sample[i] = (rlvc_sample){2u * i / PERCEPTS, i};
    }
    assert_int_equal(f.domain.candidates(&bags, &f.samples, 0, 64, records, &written), 0);
    assert_int_equal(written, 16);
    for (uint32_t j = 0; j < written; j++) {
        uint32_t has[2] = {0, 0};
        for (uint32_t i = 0; i < PERCEPTS; i++) {
            uint8_t present = 2;
            assert_int_equal(f.domain.exhibits(&bags, percept(i), bag(j), &present), 0);
            has[f.sample[i].key] += present;
        }
        assert_true(rlvc_bags_needed(bag(j)) < 0.0f || has[j % 2u] > 2u * has[1u - j % 2u]);
    }
    for (uint32_t i = 0; i < PERCEPTS; i++)
        f.sample[i].key = i / 4u;
    assert_int_equal(f.domain.candidates(&bags, &f.samples, 3, 64, records, &written), 0);
    assert_int_equal(written, 13);
}

/* Four samples of one target show a thing always, the many of the other once in four times: nowhere
 * can a bag of it be asked for so much that it parts them. Of the many, who are what is left over
 * of other things, nothing is gathered. */
static void test_nothing_parts(void **state) {
    (void)state;
    uint32_t written = 0;
    open_things(RLVC_DESCRIPTORS_INT8);
    for (uint32_t i = 0; i < PERCEPTS; i++) {
        see_thing(i, 0, 0);
        set_count(i, i < 4u || i / 2u % 4u == 0 ? 4u : 0u); /* nothing behind it */
        f.sample[i] = (rlvc_sample){i >= 4u, i};
    }
    assert_int_equal(f.domain.candidates(&bags, &f.samples, 0, 64, records, &written), 0);
    assert_int_equal(written, 16);
    for (uint32_t j = 0; j < written; j++) {
        assert_int_equal(rlvc_bags_count(bag(j)), 4);
        assert_true(rlvc_bags_needed(bag(j)) < 0.0f);
    }
}

/* Four percepts have a vector each, of which any two are sqrt(10) apart. Two of the samples only
 * bear out what is gathered from the others, but in the end the bag is of all four. Each percept
 * scores 16 - 10 by any other's vector, and as much for its own: that is 48 bins of 128, where
 * nothing else reaches bin 9. */
static void test_own_vectors_do_not_count(void **state) {
    (void)state;
    uint32_t written = 0;
    open_bags(8, 32, RLVC_DESCRIPTORS_FLOAT);
    bags.vectors.candidates = 4; /* the chance of 2 of 2 and 0 of 38 is 1 in 780 */
    for (uint32_t i = 0; i < PERCEPTS; i++) {
        memset(percept(i), 0, f.domain.percept_bytes);
        set_count(i, 1);
        set_number(vectors_of(percept(i)), i < 4u ? 30u : 31u, 10);
        if (i < 4u) {
            set_number(vectors_of(percept(i)), 2u * i, 2);
            set_number(vectors_of(percept(i)), 2u * i + 1u, 1);
        }
        f.sample[i] = (rlvc_sample){i >= 4u, i};
    }
    assert_int_equal(f.domain.candidates(&bags, &f.samples, 0, 64, records, &written), 0);
    assert_int_equal(written, 4);
    for (uint32_t j = 0; j < written; j++) {
        assert_int_equal(rlvc_bags_count(bag(j)), 4);
        assert_true(rlvc_bags_needed(bag(j)) == 0.5f * (9.0f + (48.0f - 9.0f) / 8.0f));
    }
}

/* The targets of two actions ascend apart, or one after the other: a thing is gathered all the
 * same. */
static void test_actions(void **state) {
    (void)state;
    for (uint32_t next = 0; next <= 3u; next += 3u) {
        uint32_t written = 0;
        open_things(RLVC_DESCRIPTORS_INT8);
        for (uint32_t i = 0; i < PERCEPTS; i++) { /* the first action: thing 3 and thing 2; then */
            const uint32_t half = i / (PERCEPTS / 2u), place = i % (PERCEPTS / 2u);
            const uint32_t thing = place < PERCEPTS / 4u ? 2u : 3u;
            f.sample[i] = (rlvc_sample){1u + half * next + (half ? thing - 2u : 3u - thing),
                                        thing + 4u * (place % (PERCEPTS / 4u))};
        }
        for (uint32_t i = 0; i < PERCEPTS / 4u; i++) { /* sorted */
            const rlvc_sample swap = f.sample[i];
            f.sample[i] = f.sample[PERCEPTS / 4u + i];
            f.sample[PERCEPTS / 4u + i] = swap;
        }
        assert_int_equal(f.domain.candidates(&bags, &f.samples, 0, 64, records, &written), 0);
        assert_int_equal(written, 16);
        uint32_t found = 0;
        for (uint32_t j = 0; j < written; j++)
            found += rlvc_bags_needed(bag(j)) > 0.0f && rlvc_bags_count(bag(j)) == 4u;
        assert_true(found >= 8u);
    }
}

#define MANY 256u
#define FEW 48u

/* How many of a class's candidates are not refused. Half of its samples have the first of two
 * targets. What they see is drawn from `things` things, or, if these are two, goes by the target.
 */
static uint32_t offered(uint32_t things, uint32_t count) {
    rlvc_sample sample[MANY];
    uint32_t written = 0, offers = 0;
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t key = 2u * i / count;
        const uint32_t thing = things == 2u ? key : rlvc_rng_below(&f.rng, things);
        const uint32_t place = rlvc_rng_below(&f.rng, PERCEPTS / 4u);
        sample[i] = (rlvc_sample){key, 4u * place + thing};
    }
    const rlvc_samples drawn = {(const unsigned char *)f.percepts, sample, f.domain.percept_bytes,
                                count};
    assert_int_equal(f.domain.candidates(&bags, &drawn, 0, 64, records, &written), 0);
    assert_int_equal(written, bags.vectors.candidates);
    for (uint32_t j = 0; j < written; j++)
        offers += rlvc_bags_needed(bag(j)) >= 0.0f;
    return offers;
}

/* A candidate of noise is borne out in at most one class of a hundred, of a thing always. */
static void test_noise(void **state) {
    (void)state;
    uint32_t classes = 0;
    open_things(RLVC_DESCRIPTORS_INT8);
    for (uint32_t i = 0; i < PERCEPTS; i++)
        see_thing(i, i % 4u, rlvc_rng_below(&f.rng, 2));
    for (uint32_t round = 0; round < 20u; round++)
        classes += offered(4, FEW) > 0;
    assert_true(classes <= 1u);
    assert_int_equal(offered(2, MANY), 16);
}

/* Fisher's exact test of a thing that all of its run show, and none of the others: n of n and 0 of
 * n in the half that bears it out. Both margins are n, so that one table of C(2 n, n) is as far
 * from independence, and one to the other side. */
static void test_the_bar_is_exact(void **state) {
    (void)state;
    double tables = 1.0;
    open_things(RLVC_DESCRIPTORS_INT8);
    for (uint32_t i = 0; i < PERCEPTS; i++)
        see_thing(i, i % 4u, 0);
    for (uint32_t n = 1; n <= 12u; n++) {
        tables *= (double)(2u * n * (2u * n - 1u)) / (double)(n * n);
        const double corrected = 2.0 / tables * (double)bags.vectors.candidates;
        assert_int_equal(offered(2, 4u * n), corrected < 2.0 * 0.01 ? 16 : 0);
    }
}

/* Percept number i of 64 vectors, four parts of a thing after 32 that are all the same: one of ten
 * that `plain` percepts have, too. */
static void see_behind(uint32_t i, uint32_t ten) {
    memset(percept(i), 0, f.domain.percept_bytes);
    set_count(i, 64);
    for (uint32_t v = 0; v < 64u; v++)
        set_number(vectors_of(percept(i)) + v * vector_bytes(), v < 32u ? 8u + ten : v % 4u, 10);
}

/* Of those ten all, or every second one. */
static void see_plain(uint32_t i, uint32_t first, uint32_t step) {
    uint32_t count = 0;
    memset(percept(i), 0, f.domain.percept_bytes);
    for (uint32_t ten = first; ten < 10u; ten += step)
        set_number(vectors_of(percept(i)) + count++ * vector_bytes(), 8u + ten, 10);
    set_count(i, count);
}

/* A bag begins anywhere among the vectors of a percept, if it does not take all: else what lies
 * first would hide a thing that only part of the run shows. */
static void test_things_behind(void **state) {
    (void)state;
    uint32_t written = 0, found = 0;
    open_bags(64, 20, RLVC_DESCRIPTORS_INT8);
    bags.vectors.candidates = 32;
    for (uint32_t i = 0; i < PERCEPTS; i++) {
        if (i >= PERCEPTS / 2u)
            see_plain(i, i / 2u % 2u, 2);
        else if (i / 2u % 2u)
            see_plain(i, 0, 1);
        else
            see_behind(i, i / 4u);
        f.sample[i] = (rlvc_sample){2u * i / PERCEPTS, i};
    }
    assert_int_equal(f.domain.candidates(&bags, &f.samples, 0, 64, records, &written), 0);
    assert_int_equal(written, 32);
    for (uint32_t j = 0; j < written; j++) {
        uint8_t present[2] = {2, 2};
        assert_int_equal(f.domain.exhibits(&bags, percept(0), bag(j), &present[0]), 0);
        assert_int_equal(f.domain.exhibits(&bags, percept(2), bag(j), &present[1]), 0);
        found += present[0] && !present[1];
    }
    assert_true(found >= 4u);
}

/* A run of one sample is gathered from if it has an even number; what bears it out is missing. */
static void test_short_runs(void **state) {
    (void)state;
    uint32_t written = 0;
    open_things(RLVC_DESCRIPTORS_INT8);
    for (uint32_t i = 0; i < PERCEPTS; i++)
        f.sample[i].key = i;
    assert_int_equal(f.domain.candidates(&bags, &f.samples, 0, 64, records, &written), 0);
    assert_int_equal(written, 16);
    for (uint32_t j = 0; j < written; j++)
        assert_true(rlvc_bags_needed(bag(j)) < 0.0f);
    f.samples.count = 2; /* only the first is gathered from, and there are no others */
    assert_int_equal(f.domain.candidates(&bags, &f.samples, 0, 64, records, &written), 0);
    assert_int_equal(written, 0);
}

/* Numbers in a row are scattered evenly, as if drawn: a twentieth is four deviations. */
static void test_scatter(void **state) {
    (void)state;
    uint32_t count[64] = {0};
    for (uint32_t i = 0; i < 64u * 4096u; i++)
        count[rlvc_scatter(i) % 64u]++;
    for (uint32_t k = 0; k < 64u; k++)
        assert_in_range(count[k], 3800, 4400);
}

/* ------------------------------------------------------------------ what is refused */

static void test_damaged_percepts(void **state) {
    (void)state;
    uint8_t present = 2;
    uint64_t column = 7;
    uint32_t written = 7;
    open_bags(2, 3, RLVC_DESCRIPTORS_FLOAT);
    make_bags();
    set_count(f.sample[0].slot, 3);
    assert_int_not_equal(f.domain.exhibits(&bags, percept(f.sample[0].slot), bag(0), &present), 0);
    assert_int_not_equal(f.domain.detect(&bags, &f.samples, 0, 1, records, 1, &column), 0);
    assert_int_not_equal(f.domain.candidates(&bags, &f.samples, 0, 1, records, &written), 0);
    assert_int_equal(present, 2);
    assert_int_equal(written, 7);
}

static void test_name(void **state) {
    (void)state;
    char text[RLVC_NAME_BYTES];
    open_bags(1, 3, RLVC_DESCRIPTORS_INT8);
    assert_int_equal(f.domain.name(&bags, bag(0), text, sizeof text), 0);
    assert_memory_equal(text, "bag ", 4);
    assert_int_equal(strlen(text), 12);
}

static void test_checks(void **state) {
    (void)state;
    const float wrong[] = {NAN, INFINITY, -1.5f, 3.3e31f};
    for (uint32_t form = 0; form <= RLVC_DESCRIPTORS_INT8; form++) {
        open_bags(2, 3, form);
        assert_int_equal(f.domain.check_percept(&bags, percept(0)), 0);
        set_count(0, 3);
        assert_int_not_equal(f.domain.check_percept(&bags, percept(0)), 0);
        set_head(0, -1.0f, 0);
        assert_int_equal(f.domain.check_feature(&bags, bag(0)), 0);
        set_head(0, 3e31f, SIZE);
        assert_int_equal(f.domain.check_feature(&bags, bag(0)), 0);
        set_head(0, 1.0f, SIZE + 1u);
        assert_int_not_equal(f.domain.check_feature(&bags, bag(0)), 0);
        for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
            set_head(0, wrong[i], 1);
            assert_int_not_equal(f.domain.check_feature(&bags, bag(0)), 0);
        }
        set_head(0, 1.0f, 1);
        memset(bag_vector(0, SIZE - 1u), 0xff, vector_bytes()); /* NaN, or -1 */
        assert_int_equal(f.domain.check_feature(&bags, bag(0)) == 0, form == RLVC_DESCRIPTORS_INT8);
    }
}

static void refuse(void) {
    rlvc_domain domain;
    memset(&domain, 0x5a, sizeof domain);
    const rlvc_domain before = domain;
    assert_int_equal(rlvc_bags_domain(&bags, &domain), RLVC_E_RANGE);
    assert_memory_equal(&domain, &before, sizeof domain);
}

static void test_ranges(void **state) {
    (void)state;
    rlvc_domain domain;
    rlvc_bags good;
    assert_int_equal(rlvc_bags_default(&good, 2, 3, RLVC_DESCRIPTORS_INT8, 1.0f), RLVC_OK);
    bags = good;
    assert_int_equal(rlvc_bags_domain(&bags, &domain), RLVC_OK);
    assert_int_equal(domain.percept_bytes, 4 + 8);
    assert_int_equal(domain.feature_bytes, 8 + 32 * 3);
    assert_int_equal(domain.features_max, 16);
    bags.size = RLVC_BAGS_SIZE_MAX + 1u;
    refuse();
    bags.size = 0;
    refuse();
    bags = good;
    bags.vectors.points = 0;
    refuse();
    assert_int_equal(rlvc_bags_default(&bags, 1000, 256, RLVC_DESCRIPTORS_FLOAT, 1.0f), RLVC_OK);
    bags.size = RLVC_BAGS_SIZE_MAX;
    assert_int_equal(rlvc_bags_domain(&bags, &domain), RLVC_OK);
    assert_int_equal(domain.feature_bytes, 8 + 32 * 1024);
    assert_int_equal(domain.feature_words, 2 + 32 * 256);
    assert_int_equal(rlvc_bags_domain(NULL, &domain), RLVC_E_NULL);
    assert_int_equal(rlvc_bags_domain(&bags, NULL), RLVC_E_NULL);
    assert_int_equal(rlvc_bags_default(NULL, 1, 1, 0, 1.0f), RLVC_E_NULL);
}

/* ------------------------------------------------------------------ learning */

/* Four things; action 1 is right with the first. Of each, one part may be missing while it is
 * learnt and two in the test, always before something else. */
static void test_learning(void **state) {
    (void)state;
    static uint64_t memory[60000];
    rlvc_config config;
    rlvc_agent *agent;
    rlvc_progress progress;
    open_things(RLVC_DESCRIPTORS_INT8);
    assert_int_equal(rlvc_config_default(&config, &f.domain, 2), RLVC_OK);
    config.capacity = 400;
    assert_int_equal(rlvc_agent_init(&config, &f.domain, memory, sizeof memory, &agent), RLVC_OK);
    for (uint32_t t = 0; t < 400u; t++) {
        const uint32_t thing = rlvc_rng_below(&f.rng, 4);
        const rlvc_choice choice = {(uint8_t)rlvc_rng_below(&f.rng, 2), 0};
        see_thing(0, thing, rlvc_rng_below(&f.rng, 2));
        assert_int_equal(rlvc_begin(agent, percept(0)), RLVC_OK);
        assert_int_equal(rlvc_observe(agent, choice, (choice.action == 1) == (thing == 0), NULL,
                                      RLVC_TERMINATED),
                         RLVC_OK);
    }
    assert_int_equal(rlvc_learn(agent, RLVC_BUDGET_UNBOUNDED, &progress), RLVC_OK);
    for (uint32_t t = 0; t < 100u; t++) {
        uint32_t action = 2;
        see_thing(0, t % 4u, 2);
        assert_int_equal(rlvc_predict(agent, percept(0), NULL, &action), RLVC_OK);
        assert_int_equal(action, t % 4u == 0);
    }
}

/* ------------------------------------------------------------------ weighing */

#define ALL 4u /* things, and actions: each thing has its own that is right */

static uint64_t weighing_memory[60000];

static rlvc_agent *taught(uint32_t form) {
    rlvc_config config;
    rlvc_agent *agent;
    rlvc_progress progress;
    open_things(form);
    assert_int_equal(rlvc_config_default(&config, &f.domain, ALL), RLVC_OK);
    config.capacity = 400;
    config.classes = 16;
    assert_int_equal(
        rlvc_agent_init(&config, &f.domain, weighing_memory, sizeof weighing_memory, &agent),
        RLVC_OK);
    for (uint32_t t = 0; t < config.capacity; t++) {
        const uint32_t thing = rlvc_rng_below(&f.rng, ALL);
        const rlvc_choice choice = {(uint8_t)rlvc_rng_below(&f.rng, ALL), 0};
        see_thing(0, thing, 0);
        assert_int_equal(rlvc_begin(agent, percept(0)), RLVC_OK);
        assert_int_equal(rlvc_observe(agent, choice, choice.action == thing, NULL, RLVC_TERMINATED),
                         RLVC_OK);
    }
    assert_int_equal(rlvc_learn(agent, RLVC_BUDGET_UNBOUNDED, &progress), RLVC_OK);
    return agent;
}

static uint32_t classes_of(const rlvc_agent *agent) {
    rlvc_statistics statistics;
    assert_int_equal(rlvc_stats(agent, &statistics), RLVC_OK);
    return statistics.classes;
}

/* What the bags on a class's path weigh. */
static double weight_of_path(const rlvc_agent *agent, uint32_t at, uint32_t class_id) {
    rlvc_split split;
    if (class_id == 0)
        return 1.0;
    assert_int_equal(rlvc_split_at(agent, class_id - 1u, &split, NULL), RLVC_OK);
    const double parent = weight_of_path(agent, at, split.class_id);
    assert_int_equal(rlvc_split_at(agent, class_id - 1u, NULL, bag(0)), RLVC_OK);
    return fmin(1.0, parent) *
           fmin(4.0, score_by_definition(at, 0) / (double)rlvc_bags_needed(bag(0)));
}

static double weight_by_definition(const rlvc_agent *agent, uint32_t at, uint32_t class_id) {
    rlvc_split split;
    double left = 1.0;
    for (uint32_t j = 0; rlvc_split_at(agent, j, &split, NULL) == RLVC_OK; j++)
        if (split.class_id == class_id)
            left = 0.4;
    return left * weight_of_path(agent, at, class_id);
}

static void check_weights(const rlvc_agent *agent, uint32_t at) {
    float weight[16];
    uint32_t class_id = 99, action = 99, best = 0, wanted = 99;
    assert_int_equal(rlvc_bags_weigh(&bags, agent, percept(at), bag(1), weight, &class_id, &action),
                     RLVC_OK);
    for (uint32_t c = 0; c < classes_of(agent); c++) {
        assert_true(fabs(weight_by_definition(agent, at, c) - (double)weight[c]) < 1e-4);
        best = weight[c] > weight[best] ? c : best;
    }
    assert_int_equal(class_id, best);
    assert_int_equal(rlvc_value(agent, best, NULL, &wanted), RLVC_OK);
    assert_int_equal(action, wanted);
}

/* Numbers of a percept's vectors that are as far from their thing's as they can be and still count:
 * of a thing so seen no bag has enough, but its own has the most. */
static void blur(uint32_t i) {
    for (uint32_t k = 0; k < count_of(percept(i)) * bags.vectors.dimensions; k++)
        if (get_number(percept(i) + 4u, k) > 9.0)
            set_number(percept(i) + 4u, k, 7);
}

static void test_weigh_refuses(void **state) {
    (void)state;
    float weight[16];
    rlvc_agent *agent = taught(RLVC_DESCRIPTORS_FLOAT);
    void *room = bag(1);
    const void *seen = percept(0);
    assert_int_equal(rlvc_bags_weigh(&bags, agent, seen, room, weight, NULL, NULL), RLVC_OK);
    assert_int_equal(rlvc_bags_weigh(NULL, agent, seen, room, weight, NULL, NULL), RLVC_E_NULL);
    assert_int_equal(rlvc_bags_weigh(&bags, NULL, seen, room, weight, NULL, NULL), RLVC_E_NULL);
    assert_int_equal(rlvc_bags_weigh(&bags, agent, NULL, room, weight, NULL, NULL), RLVC_E_NULL);
    assert_int_equal(rlvc_bags_weigh(&bags, agent, seen, NULL, weight, NULL, NULL), RLVC_E_NULL);
    assert_int_equal(rlvc_bags_weigh(&bags, agent, seen, room, NULL, NULL, NULL), RLVC_E_NULL);
    set_count(0, 9);
    assert_int_equal(rlvc_bags_weigh(&bags, agent, seen, room, weight, NULL, NULL), RLVC_E_PERCEPT);
}

static void test_weigh_knows_no_plans(void **state) {
    (void)state;
    float weight[16];
    rlvc_thresholds thresholds;
    rlvc_domain domain;
    rlvc_config config;
    rlvc_agent *planner;
    open_things(RLVC_DESCRIPTORS_FLOAT);
    assert_int_equal(rlvc_thresholds_default(&thresholds, 1), RLVC_OK);
    assert_int_equal(rlvc_thresholds_domain(&thresholds, &domain), RLVC_OK);
    assert_int_equal(rlvc_config_default(&config, &domain, 2), RLVC_OK);
    config.method = &rlvc_method_planner;
    size_t bytes = 0;
    assert_int_equal(rlvc_agent_size(&config, &domain, &bytes), RLVC_OK);
    void *memory = malloc(bytes);
    assert_int_equal(rlvc_agent_init(&config, &domain, memory, bytes, &planner), RLVC_OK);
    assert_int_equal(rlvc_bags_weigh(&bags, planner, percept(0), bag(1), weight, NULL, NULL),
                     RLVC_E_MISMATCH);
    free(memory);
}

static void test_weigh(void **state) {
    (void)state;
    for (uint32_t form = 0; form <= RLVC_DESCRIPTORS_INT8; form++) {
        rlvc_agent *agent = taught(form);
        uint32_t predicted = 0;
        assert_true(classes_of(agent) >= ALL && classes_of(agent) <= 16u);
        for (uint32_t t = 0; t < 40u; t++) {
            float weight[16];
            uint32_t action = 99;
            see_thing(0, t % ALL, t % 3u); /* as it was learnt, or in part */
            check_weights(agent, 0);
            blur(0);
            see_thing(1, t % ALL, 4); /* nothing of it */
            check_weights(agent, 1);
            see_thing(0, t % ALL, 3);
            blur(0);
            check_weights(agent, 0);
            assert_int_equal(
                rlvc_bags_weigh(&bags, agent, percept(0), bag(1), weight, NULL, &action), RLVC_OK);
            assert_int_equal(action, t % ALL);
            assert_int_equal(rlvc_predict(agent, percept(0), NULL, &action), RLVC_OK);
            predicted += action == t % ALL;
        }
        assert_true(predicted < 40u);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_detect),
        cmocka_unit_test(test_nearest),
        cmocka_unit_test(test_gathered),
        cmocka_unit_test(test_nothing_to_gather),
        cmocka_unit_test(test_damaged_percepts),
        cmocka_unit_test(test_name),
        cmocka_unit_test(test_checks),
        cmocka_unit_test(test_ranges),
        cmocka_unit_test(test_learning),
        cmocka_unit_test(test_nothing_to_tell),
        cmocka_unit_test(test_nothing_parts),
        cmocka_unit_test(test_own_vectors_do_not_count),
        cmocka_unit_test(test_actions),
        cmocka_unit_test(test_noise),
        cmocka_unit_test(test_short_runs),
        cmocka_unit_test(test_scatter),
        cmocka_unit_test(test_the_bar_is_exact),
        cmocka_unit_test(test_things_behind),
        cmocka_unit_test(test_weigh),
        cmocka_unit_test(test_weigh_refuses),
        cmocka_unit_test(test_weigh_knows_no_plans),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
