/* SPDX-License-Identifier: MIT */
/* The cart of the page: the controller of ../balance learns to balance the pole, and what it has
 * learnt balances a cart that one can push.
 *
 *     cart_new                   a controller that knows nothing
 *     cart_tick                  periods of its control loop
 *     cart_show, cart_push       the cart that is shown, which it does not learn from
 *     cart_view                  numbers to be drawn
 *     cart_tree, cart_policy_c   write text */
#include "controller.h"
#include "page.h"
#include "port.h"

#include "rlvc/rlvc.h"

#define PUSH_MAX 100.0f

/* Read by the page as 32-bit numbers, in this order. */
struct view {
    float state[CART_POLE_COMPONENTS]; /* of the cart that is shown */
    float score;                       /* steps that the policy is held to last */
    uint32_t action;
    uint32_t steps; /* since the cart that is shown fell */
    uint32_t falls;
    uint32_t interactions, episodes, length; /* of the last episode */
    uint32_t learning, leaves, verdict, bytes;
};

static struct {
    struct controller controller;
    struct cart_pole shown;
    struct view view;
} lab;

uint32_t port_instructions(void) {
    return 0; /* a page cannot count them */
}

EXPORT(cart_new) int cart_new(uint32_t seed) {
    const struct view empty = {0};
    lab.view = empty;
    lab.view.bytes = controller_block_bytes();
    cart_pole_init(&lab.shown, seed + 2u);
    return controller_init(&lab.controller, seed);
}

static void look(void) {
    rlvc_planner_statistics statistics;
    (void)rlvc_planner_stats(lab.controller.agent, &statistics);
    lab.view.leaves = statistics.leaves;
    lab.view.score = statistics.score;
    lab.view.verdict = statistics.verdict;
}

/* At most so many periods; stops where an episode ends or a step of learning is done. */
EXPORT(cart_tick) int cart_tick(uint32_t count) {
    struct controller *controller = &lab.controller;
    while (count-- > 0) {
        const uint32_t steps = controller->steps, episodes = controller->episodes;
        if (controller_tick(controller) != 0) {
            return TICK_FAILED;
        }
        if (controller->episodes > episodes) {
            lab.view.length = steps + 1u;
            return TICK_EPISODE_OVER;
        }
        if (controller->finished) {
            look();
            return TICK_LEARNT;
        }
    }
    return TICK_ON;
}

/* One period of the cart that is shown. */
EXPORT(cart_show) void cart_show(void) {
    uint32_t action = CART_POLE_LEFT;
    (void)rlvc_predict(lab.controller.agent, lab.shown.state, NULL, &action);
    lab.view.action = action;
    lab.view.steps++;
    if (cart_pole_step(&lab.shown, action)) {
        cart_pole_reset(&lab.shown);
        lab.view.steps = 0;
        lab.view.falls++;
    }
}

/* Pushes the pole that is shown. @param speed in rad/s; nothing happens beyond +-PUSH_MAX, or if it
 * is NaN */
EXPORT(cart_push) void cart_push(float speed) {
    if (speed >= -PUSH_MAX && speed <= PUSH_MAX) {
        lab.shown.state[3] += speed;
    }
}

EXPORT(cart_view) const struct view *cart_view(void) {
    uint32_t i;
    for (i = 0; i < CART_POLE_COMPONENTS; i++) {
        lab.view.state[i] = lab.shown.state[i];
    }
    lab.view.interactions = lab.controller.interactions;
    lab.view.episodes = lab.controller.episodes;
    lab.view.learning = lab.controller.learning;
    return &lab.view;
}

/* Writes the learnt tree as JSON. Returns whether there is one; likewise below. */
EXPORT(cart_tree) uint32_t cart_tree(void) {
    text_begin();
    return rlvc_print(lab.controller.agent, RLVC_PRINT_JSON, text_write, NULL) == RLVC_OK;
}

/* Writes it as C. */
EXPORT(cart_policy_c) uint32_t cart_policy_c(void) {
    text_begin();
    return rlvc_export_c(lab.controller.agent, "balance", text_write, NULL, NULL) == RLVC_OK;
}
