/* SPDX-License-Identifier: MIT */
/* The report: see report.h. */
#include "report.h"

#include "rlvc/rlvc.h"
#include <stdio.h>
#include <string.h>

uint32_t report_trials(const struct controller *controller) {
    struct cart_pole cart; /* not the controller's: looking must not change what happens */
    uint32_t steps = 0;
    cart_pole_init(&cart, 0);
    for (uint32_t i = 0; i < TRIALS; i++) {
        int fell = 0;
        cart_pole_reset(&cart);
        for (uint32_t k = 0; k < EPISODE_STEPS && !fell; k++) {
            uint32_t action;
            if (rlvc_predict(controller->agent, cart.state, NULL, &action) != RLVC_OK)
                return 0;
            fell = cart_pole_step(&cart, action);
            steps++;
        }
    }
    return steps;
}

/* ------------------------------------------------------------------ text */

void report_task(void) {
    printf("Cart and pole  %u actions, a percept of %u numbers, a tick each %u ms\n",
           CART_POLE_ACTIONS, CART_POLE_COMPONENTS, CART_POLE_PERIOD_MS);
    printf("Learning       at least %u interactions, %u units of work a tick\n", INTERACTIONS,
           SLICE);
    printf("Memory         %u percepts, %u leaves of a model\n\n", CAPACITY, MODEL_LEAVES);
    printf("episode  interactions   ticks  leaves  steps of %u\n", EPISODE_STEPS);
}

static uint32_t ticks(const struct controller *controller) {
    return controller->interactions + controller->slices;
}

static rlvc_planner_statistics ask(const struct controller *controller) {
    rlvc_planner_statistics statistics;
    memset(&statistics, 0, sizeof statistics);
    (void)rlvc_planner_stats(controller->agent, &statistics); /* no pointer is null */
    return statistics;
}

/* Hundredths, as there are TRIALS = 100 of them. */
static void print_mean(uint32_t steps) {
    printf("%u.%02u", (unsigned)(steps / TRIALS), (unsigned)(steps % TRIALS));
}

void report_step(const struct controller *controller, uint32_t steps) {
    printf("%7u  %12u  %6u  %6u  ", (unsigned)controller->episodes,
           (unsigned)controller->interactions, (unsigned)ticks(controller),
           (unsigned)ask(controller).leaves);
    print_mean(steps);
    printf("\n");
}

static int write_text(void *file, const char *text, size_t bytes) {
    return fwrite(text, 1, bytes, (FILE *)file) != bytes;
}

void report_summary(const struct controller *controller, uint32_t steps,
                    const struct milestones *reached) {
    printf("\nPolicy (component 0: position, 1: speed, 2: angle, 3: its speed; action 0: push to "
           "the left)\n");
    (void)rlvc_print(controller->agent, RLVC_PRINT_TEXT, write_text, stdout);
    printf("\n  balances      ");
    print_mean(steps);
    printf(" of %u steps", EPISODE_STEPS);
    if (reached->since > 0)
        printf(", %u or more from %u interactions on", LEARNT, (unsigned)reached->since);
    printf("\n  interactions  %u, in %u episodes\n", (unsigned)controller->interactions,
           (unsigned)controller->episodes);
    printf("  meanwhile     %u ticks while learning, %u falls\n", (unsigned)controller->slices,
           (unsigned)controller->falls);
}

/* ------------------------------------------------------------------ JSON */

static uint32_t bits_of(float number) {
    uint32_t bits;
    memcpy(&bits, &number, sizeof bits);
    return bits;
}

/* The nodes of the policy, with the bits of each cutpoint. A leaf has no component. */
static void json_policy(const struct controller *controller) {
    rlvc_planner_test node;
    printf("\"policy\":[");
    for (uint32_t i = 0; rlvc_planner_node(controller->agent, i, &node) == RLVC_OK; i++) {
        printf("%s", i > 0 ? "," : "");
        if (node.component == RLVC_PLANNER_LEAF)
            printf("{\"action\":%u}", (unsigned)node.action);
        else
            printf("{\"component\":%u,\"cutpoint_bits\":%u,\"child\":%u}", (unsigned)node.component,
                   (unsigned)bits_of(node.cutpoint), (unsigned)node.child);
    }
    printf("]");
}

int report_json(const struct controller *controller, uint32_t steps,
                const struct milestones *reached) {
    rlvc_planner_statistics statistics = ask(controller);
    printf("{\"version\":1,\"kind\":\"balance\",\"program\":\"balance %s\",", rlvc_version());
    printf("\"loop\":{\"slice\":%u,\"ticks\":%u,\"falls\":%u},", SLICE, (unsigned)ticks(controller),
           (unsigned)controller->falls);
    printf("\"options\":{\"interactions\":%u,\"seed\":%u,\"capacity\":%u,\"sample\":%u,"
           "\"model_leaves\":%u,\"candidates\":%u,\"patience\":%u},",
           INTERACTIONS, SEED, CAPACITY, SAMPLE, MODEL_LEAVES, CANDIDATES, PATIENCE);
    printf("\"episodes\":%u,\"interactions\":%u,\"trials\":%u,\"steps\":%u,",
           (unsigned)controller->episodes, (unsigned)controller->interactions, TRIALS,
           (unsigned)steps);
    printf("\"interactions_to_learnt\":%u,\"interactions_to_first_learnt\":%u,",
           (unsigned)reached->since, (unsigned)reached->first);
    printf("\"fits\":%u,\"searches\":%u,\"candidates\":%u,\"score_bits\":%u,\"beta_bits\":%u,",
           (unsigned)statistics.fits, (unsigned)statistics.searches,
           (unsigned)statistics.candidates, (unsigned)bits_of(statistics.score),
           (unsigned)bits_of(statistics.beta));
    printf("\"leaves\":%u,", (unsigned)statistics.leaves);
    json_policy(controller);
    printf("}\n");
    return ferror(stdout) ? -1 : 0;
}
