#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""How often bags of vectors test noise, and how soon they find what there is to find.

    tools/bench/seeing/noise.py [TASK ...] [--runs N] [--seed N] [--alpha P]

A percept has the vectors of one of four things, of which one of four may be missing, among four vectors of
what is behind it. The agent acts at random, and learns six times, from ever more interactions. coin: rewards
are 0 or 1, drawn; gauss: they are normal, drawn. Each test is one too many then, and alpha is the share of runs, at
most, that should have one. thing: one action is right with the first thing, and the other with the rest.
thing+gauss: likewise, and a normal number of standard deviation 0.5 is added to each reward. A line tells in how
many runs a tree grew, and, if half of them found something, after how many interactions (the median)."""

import numpy as np

import command_line
import rlvc

THINGS, PARTS, DIMENSIONS = 4, 4, 32
INTERACTIONS, STEPS = 300, 6
TASKS = {  # name: (reward by whether the action is right, is there something to learn)
    "coin": (lambda right, random: float(random.integers(2)), False),
    "gauss": (lambda right, random: random.normal(), False),
    "thing": (lambda right, random: float(right), True),
    "thing+gauss": (lambda right, random: right + 0.5 * random.normal(), True),
}


def scene(domain, thing, random):
    """The vectors of a percept."""
    kept = random.permutation(PARTS)[random.integers(2):]
    vectors = np.zeros((len(kept) + PARTS, DIMENSIONS), domain.vector_dtype)
    vectors[np.arange(len(kept)), PARTS * thing + kept] = 10
    behind = np.arange(len(kept), len(vectors))
    vectors[behind, 16 + random.integers(8, size=PARTS)] = -10
    vectors[behind, 24 + random.integers(8, size=PARTS)] = 10
    return vectors


def grows(task, seed, alpha):
    """After how many interactions a run takes up a test; 0 if never."""
    reward, _ = TASKS[task]
    random = np.random.default_rng(seed)
    domain = rlvc.Bags(points=2 * PARTS, dimensions=DIMENSIONS, radius=4.0, form="int8", size=PARTS)
    agent = rlvc.Agent(domain, rlvc.Config(2, capacity=INTERACTIONS, classes=64, discount=0.0,
                                           alpha=alpha, seed=seed))
    for i in range(1, INTERACTIONS + 1):
        thing, action = int(random.integers(THINGS)), int(random.integers(2))
        agent.begin(scene(domain, thing, random))
        earned = float(np.float32(reward(action == (thing == 0), random)))
        agent.observe(action, earned, None, terminated=True)
        if i % (INTERACTIONS // STEPS) == 0:
            agent.learn()
            if agent.classes > 1:
                return i
    return 0


def main():
    parser = command_line.parser_of(__doc__, runs=200, seed=1000)
    command_line.add_names(parser, "task", TASKS)
    parser.add_argument("--alpha", type=float, default=0.01, help="of the agent (0.01, the default)")
    options = parser.parse_args()
    for task in options.tasks:
        after = [grows(task, options.seed + i, options.alpha) for i in range(options.runs)]
        _, learnable = TASKS[task]
        median = np.median([t or np.inf for t in after])
        soon = f", after {median:.0f} interactions" if learnable and np.isfinite(median) else ""
        print(f"{task:12} {np.count_nonzero(after):4} of {options.runs} runs grew a test{soon}", flush=True)


if __name__ == "__main__":
    main()
