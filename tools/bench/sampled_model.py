#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""How good a policy is that solves a model of samples exactly: what no learner can expect to exceed by much.

    tools/bench/sampled_model.py [--slip P] [--interactions N] [--models N] [--allocate ROUNDS]

Sutton's maze as `run_gridworld binary --slip P` plays it, discount 0.9. Each action in each cell is drawn equally
often, N interactions in all, and the model of relative frequencies is solved. Prints, as a mean over the models, the
cells whose action is within 1 % of the optimal value, and of how many cells two actions are so near. Needs numpy.

With --allocate draws go where decisions are doubtful, as one would spend them who knew the outcome: in each round a
pair's share grows with how often its cell's decision is wrong, and how often it is the one decided for. Of the
best round as many fresh models are made.
"""

import argparse
from pathlib import Path

import numpy as np

MAZE = Path(__file__).parents[2] / "examples/gridworld/mazes/sutton.txt"
WAYS = ((-1, 0), (0, 1), (1, 0), (0, -1))
DISCOUNT = 0.9


def read(path):
    """The next cell of each cell and direction, and the number of the exit."""
    rows = path.read_text(encoding="ascii").split()
    cells = [(y, x) for y, row in enumerate(rows) for x, sign in enumerate(row) if sign != "#"]
    number = {cell: i for i, cell in enumerate(cells)}
    nexts = [[number.get((y + dy, x + dx), number[y, x]) for dy, dx in WAYS] for y, x in cells]
    exits = [i for i, (y, x) in enumerate(cells) if rows[y][x] == "*"]
    return np.array(nexts), exits[0]


def solve(shares, nexts, exit_cell):
    """Q by value iteration; shares[cell, action, direction] is how often an action moves in a direction."""
    rewards = np.where(nexts == exit_cell, 100.0, -1.0)
    values = np.zeros(len(nexts))
    for _ in range(300):
        q = (shares * (rewards + DISCOUNT * values[nexts])[:, None]).sum(2)
        values = q.max(1)
        values[exit_cell] = 0.0
    return q


class Sampler:
    """Makes models of samples, and compares their policies with the truth."""

    def __init__(self, slip, interactions):
        self.nexts, exit_cell = read(MAZE)
        ways = len(WAYS)
        self.chances = np.full((ways, ways), slip / (ways - 1))
        np.fill_diagonal(self.chances, 1 - slip)
        self.inner = np.arange(len(self.nexts)) != exit_cell
        self.exit_cell, self.interactions = exit_cell, interactions
        self.draw = np.random.default_rng(1)
        truth = self.q(np.broadcast_to(self.chances, (len(self.nexts), ways, ways)))
        best = truth.max(1, keepdims=True)
        self.near = best - truth <= 0.01 * abs(best)

    def q(self, shares):
        return solve(shares, self.nexts, self.exit_cell)[self.inner]

    def visits(self, weights):
        """Draws of each action in each cell; the exit's are never asked for."""
        visits = np.ones((len(self.nexts), len(WAYS)), int)
        visits[self.inner] = np.maximum(1, weights / weights.sum() * self.interactions)
        return visits

    def judge(self, visits, models):
        """How often the decision in each cell is within 1 %, and how often each action is decided for."""
        good, chosen = np.zeros(len(self.near)), np.zeros(self.near.shape)
        cells = np.arange(len(self.near))
        for _ in range(models):
            drawn = [
                self.draw.multinomial(visits[:, a], chance) for a, chance in enumerate(self.chances)
            ]
            action = self.q(np.stack(drawn, 1) / visits[:, :, None]).argmax(1)
            good += self.near[cells, action]
            chosen[cells, action] += 1
        return good / models, chosen / models

    def allocate(self, rounds, models):
        """The best weights of the pairs that were met in so many rounds."""
        weights = np.ones(self.near.shape)
        best, found = 0.0, weights
        for _ in range(rounds):
            good, chosen = self.judge(self.visits(weights), models)
            if good.mean() > best:
                best, found = good.mean(), weights
            doubt = np.sqrt((chosen + 0.03) * (1.01 - good[:, None]))
            weights = weights * (doubt / doubt.mean()) ** 0.15
            weights = np.maximum(weights, 0.1 * weights.mean())  # none is left out
        return found


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("--slip", type=float, default=0.2, metavar="P")
    parser.add_argument("--interactions", type=int, default=15000, metavar="N")
    parser.add_argument("--models", type=int, default=200, metavar="N")
    parser.add_argument("--allocate", type=int, default=0, metavar="ROUNDS")
    arguments = parser.parse_args()
    sampler = Sampler(arguments.slip, arguments.interactions)
    near = sampler.near
    each = arguments.interactions // near.size
    visits = np.full((len(sampler.nexts), len(WAYS)), each)
    spent = f"{each} visits of each of {near.size} pairs"
    if arguments.allocate:
        visits = sampler.visits(sampler.allocate(arguments.allocate, arguments.models))
        drawn = visits[sampler.inner]
        spent = f"{drawn.min()} to {drawn.max()} visits of {near.size} pairs, {drawn.sum()} in all"
    good, _ = sampler.judge(visits, arguments.models)
    print(f"slip {arguments.slip:g}, {spent}: {100 * good.mean():.1f} % of",
          f"{len(near)} cells within 1 %; in {(near.sum(1) > 1).sum()} cells two actions or more are")  # fmt: skip


if __name__ == "__main__":
    main()
