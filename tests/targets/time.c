/* SPDX-License-Identifier: MIT */
/* How many instructions the public functions take, by what their time depends on. Prints the table
 * of core/TIME.md; everything is exact and reproducible under an emulator that counts instructions.
 *
 * What the measuring itself takes is found first, and left out. */
#include "port.h"
#include "report.h"
#include <stdio.h>

struct meter {
    uint32_t least;
    uint32_t most;
};

static struct robot robot;
static uint32_t overhead;

static void meter_add(struct meter *meter, uint32_t instructions) {
    instructions = instructions > overhead ? instructions - overhead : 0;
    meter->least = instructions < meter->least ? instructions : meter->least;
    meter->most = instructions > meter->most ? instructions : meter->most;
}

static void print_row(const char *function, const char *by, uint32_t argument,
                      const struct meter *meter) {
    printf("| `%s` | %s %u | %u | %u |\n", function, by, (unsigned)argument, (unsigned)meter->least,
           (unsigned)meter->most);
}

#define TIMED(meter, call)                                                                         \
    do {                                                                                           \
        uint32_t start = port_instructions();                                                      \
        call;                                                                                      \
        uint32_t end = port_instructions();                                                        \
        meter_add(&(meter), end - start);                                                          \
    } while (0)

static const struct meter unknown = {UINT32_MAX, 0};

/* Depth of the leaf of a class: the tests above it. */
static uint32_t depth_of(uint32_t class_id) {
    uint32_t depth = 0;
    rlvc_statistics statistics;
    if (rlvc_stats(robot.agent, &statistics) != RLVC_OK) {
        return 0;
    }
    /* Splits that passed on the class or made it lie on its path: walk up from the newest. */
    uint32_t wanted = class_id;
    for (uint32_t j = statistics.classes - 1u; j-- > 0;) {
        rlvc_split split;
        if (rlvc_split_at(robot.agent, j, &split, NULL) != RLVC_OK) {
            return 0;
        }
        if (j + 1u == wanted || split.class_id == wanted) {
            depth++;
            wanted = split.class_id;
        }
    }
    return depth;
}

/* rlvc_predict, by the depth of the percept's leaf; all cells, four percepts each. */
static void time_predict(void) {
    struct meter meters[32];
    gridworld_random random;
    gridworld_random_seed(&random, 1);
    for (uint32_t d = 0; d < 32u; d++) {
        meters[d] = unknown;
    }
    for (uint32_t i = 0; i < 4u * CELLS; i++) {
        unsigned char percept[PERCEPT_BYTES];
        uint32_t class_id = 0, action = 0;
        gridworld_encode(&gridworld_sutton, DISTRACTORS, i / 4u, &random, percept);
        (void)rlvc_predict(robot.agent, percept, &class_id, NULL);
        TIMED(meters[depth_of(class_id)],
              (void)rlvc_predict(robot.agent, percept, &class_id, &action));
    }
    for (uint32_t d = 0; d < 32u; d++) {
        if (meters[d].most > 0) {
            print_row("rlvc_predict", "depth", d, &meters[d]);
        }
    }
}

/* rlvc_act, whatever it chooses, by the depth of the tree; rlvc_observe and rlvc_begin. */
static void time_interactions(void) {
    struct meter act = unknown, observe = unknown, begin = unknown;
    rlvc_statistics statistics;
    rlvc_choice choice = {0, 0};
    unsigned char percept[PERCEPT_BYTES];
    (void)rlvc_stats(robot.agent, &statistics);
    gridworld world;
    if (gridworld_init(&world, &gridworld_sutton, DISTRACTORS, 0.0f, 7) != 0) {
        return;
    }
    for (uint32_t i = 0; i < 2000u; i++) {
        gridworld_percept(&world, percept);
        TIMED(begin, (void)rlvc_begin(robot.agent, percept));
        TIMED(act, (void)rlvc_act(robot.agent, &choice));
        TIMED(observe, (void)rlvc_observe(robot.agent, choice, -1.0f, percept, RLVC_GOES_ON));
        gridworld_reset(&world);
    }
    print_row("rlvc_begin", "bytes of a percept", PERCEPT_BYTES, &begin);
    print_row("rlvc_act", "depth of the tree", statistics.depth, &act);
    print_row("rlvc_observe", "bytes of a percept", PERCEPT_BYTES, &observe);
}

static void time_questions(void) {
    struct meter stats = unknown, q = unknown, value = unknown, split_at = unknown;
    rlvc_statistics statistics;
    rlvc_split split;
    float number;
    TIMED(stats, (void)rlvc_stats(robot.agent, &statistics));
    for (uint32_t c = 0; c + 1u < statistics.classes; c++) {
        uint32_t count, action;
        unsigned char feature[RLVC_BITS_FEATURE_BYTES];
        TIMED(q, (void)rlvc_q(robot.agent, c, c % GRIDWORLD_ACTIONS, &number, &count));
        TIMED(value, (void)rlvc_value(robot.agent, c, &number, &action));
        TIMED(split_at, (void)rlvc_split_at(robot.agent, c, &split, feature));
    }
    print_row("rlvc_stats", "classes", statistics.classes, &stats);
    print_row("rlvc_q", "actions", GRIDWORLD_ACTIONS, &q);
    print_row("rlvc_value", "actions", GRIDWORLD_ACTIONS, &value);
    print_row("rlvc_split_at", "bytes of a feature", RLVC_BITS_FEATURE_BYTES, &split_at);
}

static void time_chi2(void) {
    static const uint32_t degrees[] = {1, 2, 4, 255};
    for (uint32_t i = 0; i < sizeof degrees / sizeof *degrees; i++) {
        struct meter survival = unknown;
        for (uint32_t x = 1; x <= 64u; x++) {
            float statistic = (float)(x * degrees[i]) / 8.0f, p, log_p;
            TIMED(survival, (void)rlvc_chi2_survival(statistic, degrees[i], &p, &log_p));
        }
        print_row("rlvc_chi2_survival", "degrees", degrees[i], &survival);
    }
}

/* An interaction that the agent has not seen, without which it would have nothing to learn. */
static rlvc_status observe_one(void) {
    const rlvc_choice choice = {0, 0};
    const unsigned char percept[PERCEPT_BYTES] = {1};
    rlvc_status status = rlvc_begin(robot.agent, percept);
    if (status == RLVC_OK) {
        status = rlvc_observe(robot.agent, choice, -1.0f, percept, RLVC_GOES_ON);
    }
    return status;
}

/* One learning step by each of several budgets. */
static int time_learning(void) {
    static const uint32_t budgets[] = {64, 128, 256, 1024};
    for (uint32_t i = 0; i < sizeof budgets / sizeof *budgets; i++) {
        struct meter learn = unknown;
        rlvc_progress progress;
        if (observe_one() != RLVC_OK) {
            return -1;
        }
        do {
            rlvc_status status = RLVC_OK;
            TIMED(learn, status = rlvc_learn(robot.agent, budgets[i], &progress));
            if (status != RLVC_OK) {
                return -1;
            }
        } while (!progress.done);
        print_row("rlvc_learn", "budget", budgets[i], &learn);
    }
    return 0;
}

static void measure_overhead(void) {
    uint32_t start = port_instructions();
    uint32_t end = port_instructions();
    overhead = end - start;
}

int main(void) {
    port_begin();
    measure_overhead();
    int status = robot_init(&robot);
    while (status == 0 && robot.steps < 40u) {
        status = robot_tick(&robot);
    }
    printf("| function | by | least | most |\n|---|---|--:|--:|\n");
    status = status == 0 ? time_learning() : status;
    time_predict();
    time_questions();
    time_chi2();
    time_interactions();
    return status == 0 ? 0 : 1;
}
