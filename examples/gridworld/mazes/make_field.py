#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Makes field64.txt: 64 x 64 cells, 22 % of them walls at random, the exit at the centre.

    ./make_field.py > field64.txt

Free cells without a way to the exit become walls. A fixed seed: the output is always the same.
"""
import random

SIDE = 64
WALLS = 0.22
SEED = 64


def reached_from(start, free):
    """The free cells that have a way to `start`."""
    seen, front = {start}, [start]
    while front:
        x, y = front.pop()
        for cell in ((x, y - 1), (x + 1, y), (x, y + 1), (x - 1, y)):
            if cell in free and cell not in seen:
                seen.add(cell)
                front.append(cell)
    return seen


def main():
    draw = random.Random(SEED)
    free = {(x, y) for y in range(SIDE) for x in range(SIDE) if draw.random() >= WALLS}
    exit_cell = (SIDE // 2, SIDE // 2)
    free = reached_from(exit_cell, free)
    for y in range(SIDE):
        print("".join("*" if (x, y) == exit_cell else "." if (x, y) in free else "#"
                      for x in range(SIDE)))


main()
