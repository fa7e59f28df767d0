#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Makes rng.csv beside itself: the generator of exploration, once more, from its definition."""
import csv
import pathlib

HERE = pathlib.Path(__file__).parent
MASK = 2**64 - 1
SEEDS = (0, 1, 2, 42, 2**31, 2**32 - 1)
BOUNDS = (1, 2, 3, 10, 255, 2**31, 2**32 - 1)


class Pcg32:
    """PCG-XSH-RR 64/32 of a state and an odd increment."""

    def __init__(self, state, increment=1442695040888963407):
        self.state, self.increment = state, increment

    def next(self):
        state = self.state
        self.state = (state * 6364136223846793005 + self.increment) & MASK
        word = ((state ^ state >> 18) >> 27) & 0xFFFFFFFF
        turn = state >> 59
        return (word >> turn | word << 32 - turn) & 0xFFFFFFFF


def splitmix64(x):
    z = (x + 0x9E3779B97F4A7C15) & MASK
    z = (z ^ z >> 30) * 0xBF58476D1CE4E5B9 & MASK
    z = (z ^ z >> 27) * 0x94D049BB133111EB & MASK
    return z ^ z >> 31


def rows():
    for seed in SEEDS:
        generator = Pcg32(splitmix64(seed))
        for i in range(40):
            word = generator.next()
            bound = BOUNDS[i % len(BOUNDS)]
            yield seed, word, word >> 8, bound, word * bound >> 32


HEADER = ("seed", "next", "uniform * 2^24", "bound", "below")

if __name__ == "__main__":
    with open(HERE / "rng.csv", "w", newline="") as file:
        out = csv.writer(file, lineterminator="\n")
        out.writerow(HEADER)
        out.writerows(rows())
