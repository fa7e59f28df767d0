#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""What config.gate keeps out of the tree, and what it costs.

Choices: percepts are independent random bits and every interaction ends an episode, so that a class is worth
its rewards. FrozenLake 4x4: cells are seen as 4 bits among 6 random ones, moves slip, one cell pays.

RLVC_TESTING_LIB=build/shipped/core/librlvc_testing.so tests/oracle/value_gate.py
"""
import argparse
import statistics

import numpy

import binding

# Rewards of a percept and an action, and the tests that the best policy needs.
CHOICES = {
    "no use": (lambda p, a: 2 * p[0], 0),        # a bit tells what all actions are worth
    "one use": (lambda p, a: a == p[0], 1),      # a bit tells which action is best
    "both": (lambda p, a: 2 * p[1] + (a == p[0]), 1),
    "and": (lambda p, a: (0.6, p[0] * p[1], 0, 0)[a], 2),  # two bits, neither of use alone
}
LAKE = "SFFFFHFHFFFHHFFG"
MOVES = [(-1, 0), (0, 1), (1, 0), (0, -1)]  # in x and y: an action and its neighbours are the likely moves


def choose(task, seed, interactions=2500, every=100, **fields):
    """Learns by single choices. Returns the number of classes, and the share of percepts acted upon best."""
    worth = CHOICES[task][0]
    rng = numpy.random.default_rng(seed)
    agent = binding.Agent(18, 4, capacity=interactions, seed=seed, discount=0.0, successors=0, **fields)
    for t in range(1, interactions + 1):
        percept = rng.integers(0, 2, 18)
        agent.begin(percept)
        action, exploited = agent.act()
        agent.observe(action, exploited, float(worth(percept, action)) + rng.normal(), None, binding.TERMINATED)
        if t % every == 0:
            agent.learn()
    good = 0
    for percept in rng.integers(0, 2, (400, 18)):
        worths = [worth(percept, a) for a in range(4)]
        good += worths[agent.predict(percept)[1]] == max(worths)
    return agent.stats().classes, good / 400


def slip(cell, action, way):
    x, y = cell % 4 + MOVES[(action + way) % 4][0], cell // 4 + MOVES[(action + way) % 4][1]
    return 4 * y + x if 0 <= x < 4 and 0 <= y < 4 else cell


def cross(seed, interactions=7500, every=100, **fields):
    """Learns FrozenLake. Returns the number of classes, and the probability of getting across in 100 moves."""
    rng = numpy.random.default_rng(seed)
    agent = binding.Agent(10, 4, capacity=interactions, classes=512, seed=seed, discount=0.99, tolerance=0.001,
                          **fields)

    def percept(cell):
        return [cell >> i & 1 for i in range(4)] + list(rng.integers(0, 2, 6))

    cell, moves = 0, 0
    agent.begin(percept(cell))
    for t in range(1, interactions + 1):
        action, exploited = agent.act()
        cell, moves = slip(cell, action, int(rng.integers(-1, 2))), moves + 1
        over = LAKE[cell] in "HG"
        end = binding.TERMINATED if over else binding.TRUNCATED if moves == 100 else binding.GOES_ON
        agent.observe(action, exploited, float(LAKE[cell] == "G"), None if over else percept(cell), end)
        if end != binding.GOES_ON:
            cell, moves = 0, 0
            agent.begin(percept(cell))
        if t % every == 0:
            agent.learn()
    across = numpy.array([float(sign == "G") for sign in LAKE])
    actions = [agent.predict(percept(cell))[1] for cell in range(16)]
    for _ in range(100):
        across = numpy.array([across[c] if LAKE[c] in "HG" else
                              numpy.mean([across[slip(c, actions[c], way)] for way in (-1, 0, 1)])
                              for c in range(16)])
    return agent.stats().classes, across[0]


def main():
    parser = argparse.ArgumentParser(description="What the value gate does, and costs: medians over runs.")
    parser.add_argument("--runs", type=int, default=20)
    runs = range(parser.parse_args().runs)
    print("task                     gate  classes  policy")
    for task, (_, tests) in CHOICES.items():
        for gate in (0, 1):
            classes, good = zip(*(choose(task, seed, gate=gate) for seed in runs))
            print(f"{task:8} needs {tests + 1:<10} {gate:4}  {statistics.median(classes):7g}  "
                  f"best for {statistics.median(good):.0%} of percepts", flush=True)
    for successors in (1, 0):
        for gate in (0, 1):
            classes, across = zip(*(cross(seed, gate=gate, successors=successors) for seed in runs))
            print(f"FrozenLake successors {successors}  {gate:4}  {statistics.median(classes):7g}  "
                  f"{statistics.median(across):.2f} get across, {min(across):.2f} the least", flush=True)


if __name__ == "__main__":
    main()
