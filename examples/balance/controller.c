/* SPDX-License-Identifier: MIT */
/* The controller: see controller.h. */
#include "controller.h"

#include "port.h"
#include "rlvc/rlvc.h"

static uint64_t block[RLVC_PLANNER_BYTES(CART_POLE_COMPONENTS, CART_POLE_ACTIONS, CAPACITY, SAMPLE,
                                         MODEL_LEAVES) /
                          sizeof(uint64_t) +
                      1u];

uint32_t controller_block_bytes(void) {
    return (uint32_t)sizeof block;
}

int controller_init(struct controller *controller, uint32_t seed) {
    static const struct controller made;
    static rlvc_thresholds thresholds;
    rlvc_domain domain;
    rlvc_config config;
    *controller = made;
    if (rlvc_thresholds_default(&thresholds, CART_POLE_COMPONENTS) != RLVC_OK ||
        rlvc_thresholds_domain(&thresholds, &domain) != RLVC_OK ||
        rlvc_config_default(&config, &domain, CART_POLE_ACTIONS) != RLVC_OK)
        return -1;
    config.capacity = CAPACITY;
    config.sample = SAMPLE;
    config.model_leaves = MODEL_LEAVES;
    config.horizon = EPISODE_STEPS;
    config.candidates = CANDIDATES;
    config.patience = PATIENCE;
    config.seed = seed;
    if (rlvc_agent_init(&config, &domain, block, sizeof block, &controller->agent) != RLVC_OK)
        return -1;
    cart_pole_init(&controller->cart, seed);
    cart_pole_init(&controller->meanwhile, seed + 1u);
    return 0;
}

/* An interaction of an episode, and the first percept of the next one after the last. */
static int explore(struct controller *controller) {
    rlvc_agent *agent = controller->agent;
    struct cart_pole *cart = &controller->cart;
    rlvc_choice choice;
    uint8_t end = RLVC_GOES_ON;
    if (controller->steps == 0 && rlvc_begin(agent, cart->state) != RLVC_OK)
        return -1;
    if (rlvc_act(agent, &choice) != RLVC_OK)
        return -1;
    controller->steps++;
    if (cart_pole_step(cart, choice.action))
        end = RLVC_TERMINATED;
    else if (controller->steps == EPISODE_STEPS)
        end = RLVC_TRUNCATED;
    if (rlvc_observe(agent, choice, 1.0f, cart->state, end) != RLVC_OK)
        return -1;
    controller->interactions++;
    if (end == RLVC_GOES_ON)
        return 0;
    controller->learning = 1;
    controller->episodes++;
    controller->steps = 0;
    cart_pole_reset(cart);
    return 0;
}

static int balance(struct controller *controller) {
    struct cart_pole *cart = &controller->meanwhile;
    uint32_t action;
    if (rlvc_predict(controller->agent, cart->state, NULL, &action) != RLVC_OK)
        return -1;
    if (cart_pole_step(cart, action)) {
        cart_pole_reset(cart);
        controller->falls++;
    }
    return 0;
}

static int lend_slice(struct controller *controller) {
    rlvc_progress progress;
    uint32_t start = port_instructions();
    rlvc_status status = rlvc_learn(controller->agent, SLICE, &progress);
    controller->slice_instructions = port_instructions() - start;
    if (status != RLVC_OK || progress.work > SLICE)
        return -1;
    controller->slices++;
    controller->learning = !progress.done;
    controller->finished = progress.done;
    return 0;
}

int controller_tick(struct controller *controller) {
    controller->finished = 0;
    controller->slice_instructions = 0;
    if (!controller->learning)
        return explore(controller);
    if (balance(controller) != 0)
        return -1;
    return lend_slice(controller);
}
