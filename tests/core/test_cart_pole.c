/* SPDX-License-Identifier: MIT */
/* The cart and pole: its motion against the equations of a cart with a pole, solved in double; when
 * an episode ends, and where it starts. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "cart_pole.h"

#include <math.h>
#include <stdio.h>

/* Of the forces on both and of the torques about the hinge,
 *
 *     (M + m) x'' + m l cos t'' = F + m l t'^2 sin        cos x'' + 4/3 l t'' = g sin,
 *
 * solved by Cramer's rule. */
static void move(double state[4], double force) {
    const double mass = 1.0, pole = 0.1, half = 0.5, gravity = 9.8, period = 0.02;
    double a = mass + pole, b = pole * half * cos(state[2]), c = cos(state[2]);
    double d = 4.0 / 3.0 * half, right = gravity * sin(state[2]);
    double left = force + pole * half * state[3] * state[3] * sin(state[2]);
    double det = a * d - b * c;
    double speed[2] = {state[1], state[3]};
    state[1] += period * (left * d - b * right) / det;
    state[3] += period * (a * right - left * c) / det;
    state[0] += period * speed[0];
    state[2] += period * speed[1];
}

static void test_moves_as_the_equations_say(void **state) {
    struct cart_pole cart;
    (void)state;
    cart_pole_init(&cart, 3);
    for (uint32_t i = 0; i < 10000u; i++) {
        double expected[4];
        for (uint32_t k = 0; k < 4u; k++)
            expected[k] = (double)cart.state[k];
        uint32_t action = i / 3u % 2u;
        move(expected, action == CART_POLE_RIGHT ? 10.0 : -10.0);
        int over = cart_pole_step(&cart, action);
        for (uint32_t k = 0; k < 4u; k++)
            if (fabs((double)cart.state[k] - expected[k]) > 1e-6)
                fail_msg("step %u: component %u is %.9g, not %.9g", (unsigned)i, (unsigned)k,
                         (double)cart.state[k], expected[k]);
        if (over)
            cart_pole_reset(&cart);
    }
}

static void test_ends_where_the_pole_fell_or_the_track_ends(void **state) {
    static const struct {
        float position, angle;
        int over;
    } cases[] = {{2.39f, 0.0f, 0},   {2.41f, 0.0f, 1},   {-2.39f, 0.0f, 0},   {-2.41f, 0.0f, 1},
                 {0.0f, 0.2094f, 0}, {0.0f, 0.2095f, 1}, {0.0f, -0.2094f, 0}, {0.0f, -0.2095f, 1}};
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct cart_pole cart = {{cases[i].position, 0.0f, cases[i].angle, 0.0f}, 0};
        if (cart_pole_step(&cart, CART_POLE_LEFT) != cases[i].over)
            fail_msg("case %u", (unsigned)i);
    }
}

static void test_starts_are_near_the_middle_and_even(void **state) {
    struct cart_pole cart;
    double sum[4] = {0.0}, squares[4] = {0.0};
    (void)state;
    cart_pole_init(&cart, 1);
    for (uint32_t i = 0; i < 10000u; i++) {
        cart_pole_reset(&cart);
        for (uint32_t k = 0; k < 4u; k++) {
            double x = (double)cart.state[k];
            assert_true(x >= -0.05 && x <= 0.05);
            sum[k] += x;
            squares[k] += x * x;
        }
    }
    for (uint32_t k = 0; k < 4u; k++) { /* five standard errors of an even distribution's moments */
        assert_true(fabs(sum[k] / 1e4) < 5.0 * 0.05 / sqrt(3e4));
        assert_true(fabs(squares[k] / 1e4 - 0.0025 / 3.0) < 5.0 * 0.0025 * sqrt(4.0 / 45.0 / 1e4));
    }
}

static void test_seeds_decide_the_starts(void **state) {
    struct cart_pole one, same, other;
    (void)state;
    cart_pole_init(&one, 7);
    cart_pole_init(&same, 7);
    cart_pole_init(&other, 8);
    assert_memory_equal(one.state, same.state, sizeof one.state);
    assert_memory_not_equal(one.state, other.state, sizeof one.state);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_moves_as_the_equations_say),
        cmocka_unit_test(test_ends_where_the_pole_fell_or_the_track_ends),
        cmocka_unit_test(test_starts_are_near_the_middle_and_even),
        cmocka_unit_test(test_seeds_decide_the_starts),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
