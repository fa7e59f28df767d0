/* SPDX-License-Identifier: MIT */
#include "cases.h"

#include "gridworld.h"
#include <stdlib.h>
#include <string.h>

#define BITS_MAX 300u
#define BYTES_MAX GRIDWORLD_PERCEPT_BYTES(BITS_MAX)
#define PLACES 6u
#define VECTORS_CAPACITY 600u
#define NUMBERS_CAPACITY 2000u
#define SLOT_BYTES 0x200000u /* more than any snapshot of these */

static union {
    uint64_t aligned;
    unsigned char bytes[RLVC_AGENT_BYTES(4, 30000, 400, BYTES_MAX, RLVC_BITS_FEATURE_BYTES, 64)];
    unsigned char vectors[RLVC_AGENT_BYTES(
        4, VECTORS_CAPACITY, 400, sizeof(vectors),
        RLVC_BAGS_FEATURE_BYTES(BAG_SIZE, DIMENSIONS, RLVC_DESCRIPTORS_FLOAT), 64)];
} memory;

static void must(rlvc_status status, const char *what) {
    if (status != RLVC_OK) {
        printf("%s: %s\n", what, rlvc_status_text(status));
        exit(2);
    }
}

static void learn(rlvc_agent *agent) {
    rlvc_progress progress;
    do
        must(rlvc_learn(agent, RLVC_BUDGET_UNBOUNDED, &progress), "learn");
    while (!progress.done);
}

/* A store of two slots in a file, of which the second was never written. */
static int file_read(void *file, uint32_t offset, void *buffer, uint32_t bytes) {
    memset(buffer, 0, bytes);
    if (fseek(file, (long)offset, SEEK_SET) == 0)
        (void)fread(buffer, 1, bytes, file);
    return 0;
}

static int file_write(void *file, uint32_t offset, const void *buffer, uint32_t bytes) {
    return fseek(file, (long)offset, SEEK_SET) != 0 || fwrite(buffer, 1, bytes, file) != bytes;
}

static rlvc_store store_in(FILE *file) {
    const rlvc_store store = {file, SLOT_BYTES, file_read, file_write, NULL, NULL};
    return store;
}

void save_case(const learnt *made, FILE *file) {
    const rlvc_store store = store_in(file);
    must(rlvc_save(made->agent, &store), "save");
}

/* An agent that knows nothing yet, or one that is loaded. */
static rlvc_agent *make_agent(const rlvc_domain *domain, uint32_t capacity, float epsilon,
                              FILE *saved) {
    rlvc_config config;
    rlvc_agent *agent;
    must(rlvc_config_default(&config, domain, 4), "config");
    config.method = &rlvc_method_classes;
    config.capacity = capacity;
    config.classes = 400;
    config.epsilon = epsilon;
    if (saved) {
        const rlvc_store store = store_in(saved);
        must(rlvc_load(&config, domain, &memory, sizeof memory, &store, &agent), "load");
    } else {
        must(rlvc_agent_init(&config, domain, &memory, sizeof memory, &agent), "init");
    }
    return agent;
}

/* One decision is an episode: 1 for the wanted action, else 0. */
static void decide(rlvc_agent *agent, const void *percept, uint32_t wanted) {
    rlvc_choice choice;
    must(rlvc_begin(agent, percept), "begin");
    must(rlvc_act(agent, &choice), "act");
    const float reward = choice.action == wanted ? 1.0f : 0.0f;
    must(rlvc_observe(agent, choice, reward, NULL, RLVC_TERMINATED), "observe");
}

static void learn_maze(rlvc_agent *agent) {
    gridworld world;
    unsigned char percept[BYTES_MAX];
    if (gridworld_init(&world, &gridworld_sutton, 11, 0.0f, 1) != 0)
        exit(2);
    gridworld_percept(&world, percept);
    must(rlvc_begin(agent, percept), "begin");
    for (uint32_t i = 1; i <= 4000; i++) {
        rlvc_choice choice;
        float reward = 0.0f;
        must(rlvc_act(agent, &choice), "act");
        int over = gridworld_step(&world, choice.action, &reward);
        if (over)
            gridworld_reset(&world);
        gridworld_percept(&world, percept);
        must(rlvc_observe(agent, choice, reward, percept, over ? RLVC_TERMINATED : RLVC_GOES_ON),
             "observe");
        if (over)
            must(rlvc_begin(agent, percept), "begin");
        if (i % 200 == 0)
            learn(agent);
    }
}

/* What to do at a percept, by a random decision tree of the given depth over the percept's bits:
 * which bit a node tests, and which action a leaf takes, comes from the path. */
static uint32_t wanted(const unsigned char *percept, uint32_t bits, uint32_t depth) {
    uint32_t path = 1;
    for (uint32_t level = 0; level < depth; level++) {
        uint32_t bit = path * 2654435761u % 4294967291u % bits;
        path = 2u * path + (percept[bit / 8u] >> bit % 8u & 1u);
    }
    return (path * 2246822519u >> 13) % 4u;
}

static void learn_decisions(rlvc_agent *agent, uint32_t bits, uint32_t depth, uint32_t count) {
    gridworld_random random;
    unsigned char percept[BYTES_MAX];
    gridworld_random_seed(&random, 1);
    for (uint32_t i = 0; i < count; i++) {
        /* A maze of one cell has no bits of its own: all are random. */
        static const unsigned char cell[1] = {GRIDWORLD_FREE};
        const gridworld_maze nowhere = {1, 1, 1, cell};
        uint32_t own = gridworld_bits(&nowhere, 0);
        gridworld_encode(&nowhere, bits - own, 0, &random, percept);
        decide(agent, percept, wanted(percept, bits, depth));
    }
    learn(agent);
}

/* ------------------------------------------------------------------ descriptors */

uint32_t draw(uint64_t *state) {
    *state = *state * 6364136223846793005u + 1442695040888963407u;
    return (uint32_t)(*state >> 32);
}

void set_number(unsigned char *record, uint32_t form, uint32_t k, float number) {
    const int8_t byte = (int8_t)(number < -127.0f ? -127.0f : number > 127.0f ? 127.0f : number);
    if (form == RLVC_DESCRIPTORS_INT8)
        memcpy(record + 4u + k, &byte, 1);
    else
        memcpy(record + 4u + 4u * k, &number, sizeof number);
}

float get_number(const unsigned char *record, uint32_t form, uint32_t k) {
    int8_t byte;
    float number;
    memcpy(&byte, record + 4u + k, 1);
    if (form == RLVC_DESCRIPTORS_INT8)
        return (float)byte;
    memcpy(&number, record + 4u + 4u * k, sizeof number);
    return number;
}

/* Which of the places a vector is near: that is known by its first number, for the rule. */
static float place_number(uint32_t place, uint32_t k) {
    uint64_t state = place * DIMENSIONS + k;
    (void)draw(&state);
    return k == 0 ? 40.0f * (float)place - 100.0f : (float)(draw(&state) % 200u) - 100.0f;
}

void draw_vectors(uint64_t *state, uint32_t form, vectors *percept) {
    percept->count = draw(state) % (POINTS + 1u);
    for (uint32_t point = 0; point < POINTS; point++) {
        const uint32_t place = draw(state) % PLACES;
        for (uint32_t k = 0; k < DIMENSIONS; k++)
            set_number(percept->bytes, form, point * DIMENSIONS + k,
                       place_number(place, k) + (float)(draw(state) % 1000u) / 300.0f);
    }
}

/* Which places some vector is near. */
static uint32_t places_near(const vectors *percept, uint32_t form) {
    uint32_t near = 0;
    for (uint32_t point = 0; point < percept->count; point++) {
        const float first = get_number(percept->bytes, form, point * DIMENSIONS);
        near |= 1u << (uint32_t)((first + 110.0f) / 40.0f);
    }
    return near;
}

/* What to do, by the places that some vector is near. */
static uint32_t wanted_of_vectors(const vectors *percept, uint32_t form) {
    const uint32_t near = places_near(percept, form);
    return near & 1u ? (near & 2u ? 2u : 1u) : near & 4u ? 3u : 0u;
}

static void teach_vectors(rlvc_agent *agent, uint32_t form,
                          uint32_t decision(const vectors *percept, uint32_t form)) {
    uint64_t state = 1;
    for (uint32_t i = 0; i < VECTORS_CAPACITY; i++) {
        vectors percept;
        memset(&percept, 0, sizeof percept);
        draw_vectors(&state, form, &percept);
        decide(agent, &percept, decision(&percept, form));
    }
    learn(agent);
}

static learnt make_vectors(uint32_t form, FILE *saved) {
    static rlvc_descriptors descriptors;
    learnt made = {.descriptors = &descriptors};
    rlvc_domain domain;
    must(rlvc_descriptors_default(&descriptors, POINTS, DIMENSIONS, form, 150.0f), "default");
    descriptors.candidates = 24;
    descriptors.draws = 2;
    must(rlvc_descriptors_domain(&descriptors, &domain), "domain");
    made.agent = make_agent(&domain, VECTORS_CAPACITY, 1.0f, saved);
    if (!saved)
        teach_vectors(made.agent, form, wanted_of_vectors);
    return made;
}

/* ------------------------------------------------------------------ pairs */

static size_t place_at(const rlvc_spatial *spatial, uint32_t point) {
    return RLVC_DESCRIPTORS_PERCEPT_BYTES(POINTS, DIMENSIONS, spatial->vectors.form) + 4u * point;
}

void get_place(const rlvc_spatial *spatial, const vectors *percept, uint32_t point,
               int16_t place[2]) {
    const unsigned char *byte = percept->bytes + place_at(spatial, point);
    for (uint32_t k = 0; k < 2u; k++)
        place[k] = (int16_t)((int)byte[2u * k] | (int)(int8_t)byte[2u * k + 1u] * 256);
}

void set_place(const rlvc_spatial *spatial, vectors *percept, uint32_t point,
               const int16_t place[2]) {
    unsigned char *byte = percept->bytes + place_at(spatial, point);
    for (uint32_t k = 0; k < 4u; k++)
        byte[k] = (unsigned char)((unsigned)place[k / 2u] >> 8u * (k % 2u));
}

void draw_places(uint64_t *state, const rlvc_spatial *spatial, vectors *percept) {
    for (uint32_t point = 0; point < POINTS; point++) {
        const int16_t place[2] = {(int16_t)(draw(state) % 2u * 60u + draw(state) % 3u),
                                  (int16_t)(draw(state) % 3u)};
        const int8_t direction[2] = {(int8_t)(127 - (int)(draw(state) % 2u)),
                                     (int8_t)((int)(draw(state) % 21u) - 10)};
        set_place(spatial, percept, point, place);
        if (spatial->directed)
            memcpy(percept->bytes + place_at(spatial, POINTS) + 2u * point, direction, 2u);
    }
}

/* What to do, by which of two things is left of the other if both are there. */
static uint32_t wanted_of_pairs(const rlvc_spatial *spatial, const vectors *percept) {
    uint32_t near = 0;
    int16_t at[PLACES + 1u] = {0};
    for (uint32_t point = 0; point < percept->count; point++) {
        const float first = get_number(percept->bytes, spatial->vectors.form, point * DIMENSIONS);
        const uint32_t place = (uint32_t)((first + 110.0f) / 40.0f);
        int16_t where[2];
        get_place(spatial, percept, point, where);
        at[place] = where[0];
        near |= 1u << place;
    }
    return (near & 3u) == 3u ? (at[0] + 30 < at[1] ? 2u : 1u) : near & 4u ? 3u : 0u;
}

static learnt make_pairs(uint32_t form, uint32_t directed, FILE *saved) {
    static rlvc_spatial spatial;
    learnt made = {.descriptors = &spatial.vectors, .spatial = &spatial};
    rlvc_domain domain;
    uint64_t state = 1;
    must(rlvc_spatial_default(&spatial, POINTS, DIMENSIONS, form, directed, 150.0f), "default");
    spatial.vectors.candidates = 24;
    spatial.vectors.draws = 2;
    must(rlvc_spatial_domain(&spatial, &domain), "domain");
    made.agent = make_agent(&domain, VECTORS_CAPACITY, 1.0f, saved);
    if (saved)
        return made;
    for (uint32_t i = 0; i < VECTORS_CAPACITY; i++) {
        vectors percept;
        memset(&percept, 0, sizeof percept);
        draw_vectors(&state, form, &percept);
        draw_places(&state, &spatial, &percept);
        decide(made.agent, &percept, wanted_of_pairs(&spatial, &percept));
    }
    learn(made.agent);
    return made;
}

/* ------------------------------------------------------------------ bags */

/* What to do, by whether two parts are seen of a thing of three, and what stands beside it. */
static uint32_t wanted_of_parts(const vectors *percept, uint32_t form) {
    static const uint32_t parts_of[8] = {0, 0, 0, 1, 0, 1, 1, 1};
    const uint32_t near = places_near(percept, form);
    return parts_of[near & 7u] ? (near & 8u ? 2u : 1u) : near & 16u ? 3u : 0u;
}

static learnt make_parts(uint32_t form, FILE *saved) {
    static rlvc_bags bags;
    learnt made = {.descriptors = &bags.vectors, .bags = &bags};
    rlvc_domain domain;
    must(rlvc_bags_default(&bags, POINTS, DIMENSIONS, form, 40.0f), "default");
    bags.size = BAG_SIZE;
    bags.vectors.candidates = 3; /* emulated machines learn it, too */
    must(rlvc_bags_domain(&bags, &domain), "domain");
    made.agent = make_agent(&domain, VECTORS_CAPACITY, 1.0f, saved);
    if (!saved)
        teach_vectors(made.agent, form, wanted_of_parts);
    return made;
}

/* ------------------------------------------------------------------ thresholds */

void draw_numbers(uint64_t *state, float *x) {
    for (uint32_t i = 0; i < COMPONENTS; i++)
        x[i] = (float)(draw(state) >> 8) * 1.1920929e-7f - 1.0f;
}

static uint32_t wanted_of_numbers(const float *x) {
    return x[0] > 0.25f * x[2] ? (x[1] > 0.1f ? 2u : 1u) : x[1] > -0.6f ? 3u : 0u;
}

static learnt make_numbers(uint8_t oblique, FILE *saved) {
    static rlvc_thresholds thresholds;
    learnt made = {.bits = 0};
    rlvc_domain domain;
    uint64_t state = 1;
    must(rlvc_thresholds_default(&thresholds, COMPONENTS), "default");
    thresholds.oblique = oblique;
    must(rlvc_thresholds_domain(&thresholds, &domain), "domain");
    made.agent = make_agent(&domain, NUMBERS_CAPACITY, 1.0f, saved);
    if (saved)
        return made;
    for (uint32_t i = 0; i < NUMBERS_CAPACITY; i++) {
        float x[COMPONENTS];
        draw_numbers(&state, x);
        decide(made.agent, x, wanted_of_numbers(x));
    }
    learn(made.agent);
    return made;
}

/* ------------------------------------------------------------------ cases */

int takes_long(uint32_t i) {
    return i == 3 || i == 4 || i == 8 || i == 10 || i == 12; /* wide, many, turned, slants, parts */
}

learnt make_case(uint32_t i, FILE *saved) {
    if (i >= 11)
        return make_parts(i == 11 ? RLVC_DESCRIPTORS_INT8 : RLVC_DESCRIPTORS_FLOAT, saved);
    if (i >= 9)
        return make_numbers(i == 10, saved);
    if (i >= 7)
        return i == 7 ? make_pairs(RLVC_DESCRIPTORS_INT8, 0, saved)
                      : make_pairs(RLVC_DESCRIPTORS_FLOAT, 1, saved);
    if (i >= 5)
        return make_vectors(i == 5 ? RLVC_DESCRIPTORS_FLOAT : RLVC_DESCRIPTORS_INT8, saved);
    static const uint32_t bits[] = {18, 7, 40, BITS_MAX, 40};
    static const uint32_t capacity[] = {4000, 100, 12000, 6000, 30000};
    static const uint32_t depth[] = {0, 0, 4, 4, 6};
    learnt made = {.bits = bits[i]};
    rlvc_domain domain;
    must(rlvc_bits_domain(bits[i], &domain), "domain");
    made.agent = make_agent(&domain, capacity[i], i == 0 ? 0.9f : 1.0f, saved);
    if (saved)
        return made;
    if (i == 0)
        learn_maze(made.agent);
    else
        learn_decisions(made.agent, bits[i], depth[i], capacity[i]);
    return made;
}
