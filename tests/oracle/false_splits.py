#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""How often a tree grows although there is nothing to learn.

Percepts are independent random bits, rewards are random and independent of percept and action, and the agent
learns again and again from a growing database: whatever it splits by is chance. config.alpha is the
probability, at most, that a run grows any test. In the end there is a world of 100 classes to learn: how many trees
test a bit that has nothing to do with it? With --shift there is something to learn: how soon is it found?

RLVC_TESTING_LIB=build/dev/core/librlvc_testing.so tests/oracle/false_splits.py
"""
import argparse

import numpy

import binding

# Rewards, and how often a bit is 1: rare rewards and rare bits make tables of small counts.
TASKS = {
    "coin": (lambda rng: float(rng.integers(2)), 0.5),
    "gauss": (lambda rng: float(numpy.float32(rng.normal())), 0.5),
    "rare reward": (lambda rng: 100.0 if rng.random() < 0.02 else -1.0, 0.5),
    "rare bits": (lambda rng: float(rng.integers(2)), 0.03),
    "seldom bits": (lambda rng: float(rng.integers(2)), 0.1),
    "rare both": (lambda rng: 100.0 if rng.random() < 0.02 else -1.0, 0.03),
}

# Bits that stay as they are with a probability, and normal rewards of which each keeps a part of the last one:
# independent of each other, but not samples of one trajectory.
STAYING = {"staying": (0.95, 0.0), "drift": (0.9, 0.9),
           "mixed drift": (0.95, 0.9), "slow drift": (0.99, 0.99)}

SCORES = {"gain": binding.GAIN, "ranks": binding.RANKS}


def grows(task, seed, interactions, every, bits=18, actions=4, shift=0.0, **fields):
    """After how many interactions a run takes up a test; 0 if never. Where bit 0 is 1 rewards are higher by
    `shift`."""
    reward, share = TASKS[task]
    rng = numpy.random.default_rng(seed)
    agent = binding.Agent(bits, actions, capacity=interactions, seed=seed, **fields)
    percepts = (rng.random((interactions + 1, bits)) < share).astype(numpy.uint8)
    agent.begin(percepts[0])
    for t in range(1, interactions + 1):
        earned = reward(rng) + shift * percepts[t - 1][0]
        agent.observe(*agent.act(), earned, percepts[t], binding.GOES_ON)
        if t % every == 0:
            agent.learn()
            if agent.stats().classes > 1:
                return t
    return 0


def grows_staying(task, seed, interactions, every, bits=18, actions=4, **fields):
    """Likewise, for bits and rewards that stay for a while."""
    stays, keeps = STAYING[task]
    rng = numpy.random.default_rng(seed)
    agent = binding.Agent(bits, actions, capacity=interactions, seed=seed, **fields)
    percept, reward = rng.random(bits) < 0.5, rng.normal()
    agent.begin(percept)
    for t in range(1, interactions + 1):
        reward = keeps * reward + numpy.sqrt(1 - keeps**2) * rng.normal()
        percept = numpy.where(rng.random(bits) < stays, percept, ~percept)
        agent.observe(*agent.act(), float(numpy.float32(reward)), percept, binding.GOES_ON)
        if t % every == 0:
            agent.learn()
            if agent.stats().classes > 1:
                return t
    return 0


def tests_noise(seed, interactions=6000, every=300, noise=18, side=10, **fields):
    """The classes of a tree that learns a world of side * side cells, whose rewards are normal with a mean of the
    cell's, and how many of its tests are of noise."""
    rng = numpy.random.default_rng(seed)
    mean = 3 * rng.normal(size=(side, side))
    agent = binding.Agent(8 + noise, 4, capacity=interactions, classes=4 * side * side, seed=seed, **fields)
    place = numpy.zeros(2, int)

    def see():
        return numpy.concatenate([(place[:, None] >> numpy.arange(4) & 1).ravel(), rng.integers(0, 2, noise)])

    agent.begin(see())
    for t in range(1, interactions + 1):
        action, exploited = agent.act()
        earned = float(numpy.float32(mean[tuple(place)] + rng.normal()))
        place = (place + [(1, 0), (0, 1), (-1, 0), (0, -1)][action]) % side
        agent.observe(action, exploited, earned, see(), binding.GOES_ON)
        if t % every == 0:
            agent.learn()
    return agent.stats().classes, sum(bit >= 8 for _, bit in agent.splits())


def count(task, runs, *arguments, **fields):
    return sum(grows(task, seed, *arguments, **fields) > 0 for seed in range(runs))


def main():
    parser = argparse.ArgumentParser(description="Counts the runs that grow a test by chance.")
    parser.add_argument("--runs", type=int, default=200)
    parser.add_argument("--interactions", type=int, default=2500)
    parser.add_argument("--every", type=int, default=100, help="interactions from one learning step to the next")
    parser.add_argument("--alpha", type=float, default=0.05, help="the rate that is stated (0.05)")
    parser.add_argument("--shift", type=float, default=0.0, help="of rewards, by bit 0 (0)")
    parser.add_argument("--score", choices=SCORES, default="gain", help="of a feature (gain)")
    options = parser.parse_args()
    for task in TASKS:
        found = [grows(task, seed, options.interactions, options.every, shift=options.shift,
                       alpha=options.alpha, score=SCORES[options.score])
                 for seed in range(options.runs)]
        grown = sum(after > 0 for after in found)
        median = numpy.median([after or numpy.inf for after in found])
        print(f"{task:12} {grown:4} of {options.runs} runs grew a test",
              f"after {median:.0f} interactions (median)" if options.shift else "", flush=True)
    for task in () if options.shift else STAYING:
        grown = sum(grows_staying(task, seed, options.interactions, options.every, alpha=options.alpha,
                                  score=SCORES[options.score]) > 0 for seed in range(options.runs))
        print(f"{task:12} {grown:4} of {options.runs} runs grew a test", flush=True)
    if not options.shift:
        trees = [tests_noise(seed, alpha=options.alpha) for seed in range(options.runs)]
        print(f"100 classes  {sum(false > 0 for _, false in trees):4} of {options.runs} trees test noise;",
              f"they have {min(size for size, _ in trees)} to {max(size for size, _ in trees)} classes", flush=True)


if __name__ == "__main__":
    main()
