#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""How good a policy is that solves a model of samples exactly: what no learner can expect to exceed by much.

    tools/bench/sampled_model.py [--slip P] [--interactions N] [--models N]

Sutton's maze as `run_gridworld binary --slip P` plays it, discount 0.9. Each action in each cell is drawn equally
often, N interactions in all, and the model of relative frequencies is solved. Prints, as a mean over the models, the
cells whose action is within 1 % of the optimal value, and of how many cells two actions are so near. Needs numpy.
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


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("--slip", type=float, default=0.2, metavar="P")
    parser.add_argument("--interactions", type=int, default=15000, metavar="N")
    parser.add_argument("--models", type=int, default=200, metavar="N")
    arguments = parser.parse_args()
    nexts, exit_cell = read(MAZE)
    ways = len(WAYS)
    chances = np.full((ways, ways), arguments.slip / (ways - 1))
    np.fill_diagonal(chances, 1 - arguments.slip)
    inner = np.arange(len(nexts)) != exit_cell
    truth = solve(np.broadcast_to(chances, (len(nexts), ways, ways)), nexts, exit_cell)[inner]
    best = truth.max(1, keepdims=True)
    near = best - truth <= 0.01 * abs(best)
    visits = arguments.interactions // near.size
    draw = np.random.default_rng(1)
    good = []
    for _ in range(arguments.models):
        shares = np.stack([draw.multinomial(visits, chance, len(nexts)) for chance in chances], 1) / visits
        chosen = solve(shares, nexts, exit_cell)[inner].argmax(1)
        good.append(near[np.arange(len(near)), chosen].mean())
    print(f"slip {arguments.slip:g}, {visits} visits of each of {near.size} pairs: {100 * np.mean(good):.1f} % of",
          f"{len(near)} cells within 1 %; in {(near.sum(1) > 1).sum()} cells two actions or more are")  # fmt: skip


if __name__ == "__main__":
    main()
