# SPDX-License-Identifier: MIT
"""A walk in a corridor, which the tests of logs write in the dialects that are in use."""

import numpy as np


def walk(episodes=60, seed=2):
    """Cells 0 to 6 with the exit 4: rows (episode, step, cell, action, reward, next cell, terminated, truncated)."""
    random, rows = np.random.default_rng(seed), []
    for episode in range(episodes):
        cell = int(random.choice([0, 1, 2, 3, 5, 6]))
        for step in range(9):
            action = int(random.integers(2))
            after = min(max(cell + (1 if action else -1), 0), 6)
            over = after == 4
            rows.append(
                (episode, step, cell, action, float(over), after, over, step == 8 and not over)
            )
            cell = after
            if over:
                break
    return rows


ROWS = walk()
NAMES = ("episode", "step", "cell", "action", "reward", "next", "terminated", "truncated")
BASE = dict(zip(NAMES, map(np.array, zip(*ROWS, strict=True)), strict=True))


def table(head, fields, end="\n", start="", sep=","):
    rows = [sep.join(map(str, fields(*row))) for row in ROWS]
    return start + end.join([head, *rows]) + end
