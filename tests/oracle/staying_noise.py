#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Is noise that stays taken for structure?

FrozenLake of 4 x 4 cells that is not slippery: the cell in 4 bits, and beside it bits that have nothing to do
with it, but are no independent draws. With the defaults a tree has 11 classes, and tests none of these bits.

RLVC_TESTING_LIB=build/dev/core/librlvc_testing.so tests/oracle/staying_noise.py
"""
import argparse

import numpy

import binding

HOLES, GOAL, SIDE = {5, 7, 11, 12}, 15, 4


def move(cell, action):
    row, column = divmod(cell, SIDE)
    row += (0, 1, 0, -1)[action]
    column += (-1, 0, 1, 0)[action]
    return min(max(row, 0), SIDE - 1) * SIDE + min(max(column, 0), SIDE - 1)


def stays(probability):
    """Each bit stays with a probability."""
    def begin(bits, rng):
        state = rng.integers(0, 2, bits)
        while True:
            yield state
            state = numpy.where(rng.random(bits) < probability, state, 1 - state)
    return begin


def counts(bits, rng):
    """A counter, which goes round and round."""
    time = int(rng.integers(1000))
    while True:
        yield time >> numpy.arange(bits) & 1
        time += 1


def turns(bits, rng):
    """Each bit goes on and off with a period of its own."""
    half, time = rng.integers(2, 30, bits), rng.integers(0, 60, bits)
    while True:
        yield time // half % 2
        time = time + 1


def shifts(bits, rng):
    """Each bit is what its neighbour was."""
    state = rng.integers(0, 2, bits)
    while True:
        yield state
        state = numpy.concatenate([rng.integers(0, 2, 1), state[:-1]])


def agrees(bits, rng):
    """Four bits in five show the same hidden one, which stays with probability 0.95."""
    hidden = int(rng.integers(2))
    while True:
        yield numpy.where(rng.random(bits) < 0.8, hidden, rng.integers(0, 2, bits))
        hidden ^= int(rng.random() < 0.05)


NOISE = {"drawn": stays(0.5), "0.9": stays(0.9), "0.99": stays(0.99), "counts": counts, "turns": turns,
         "shifts": shifts, "agrees": agrees}


def run(noise, seed, interactions=1000, bits=6, every=100, **fields):
    """The agent's return from the start, its classes, and how many of its tests are of noise."""
    rng = numpy.random.default_rng(seed)
    agent = binding.Agent(SIDE + bits, 4, capacity=2 * interactions, classes=400, seed=seed, **fields)
    beside = NOISE[noise](bits, rng)

    def see(cell):
        return numpy.concatenate([cell >> numpy.arange(SIDE) & 1, next(beside)])

    cell = 0
    agent.begin(see(cell))
    for t in range(1, interactions + 1):
        action, exploited = agent.act()
        cell = move(cell, action)
        if cell in HOLES or cell == GOAL:
            agent.observe(action, exploited, float(cell == GOAL), None, binding.TERMINATED)
            cell = 0
            agent.begin(see(cell))
        else:
            agent.observe(action, exploited, 0.0, see(cell), binding.GOES_ON)
        if t % every == 0:
            agent.learn()
    cell = 0
    for _ in range(100):
        cell = move(cell, agent.predict(see(cell))[1])
        if cell in HOLES or cell == GOAL:
            break
    return float(cell == GOAL), agent.stats().classes, sum(bit >= SIDE for _, bit in agent.splits())


def main():
    parser = argparse.ArgumentParser(description="Learns FrozenLake beside noise that is no independent draw.")
    parser.add_argument("--runs", type=int, default=20)
    parser.add_argument("--interactions", type=int, default=1000)
    options = parser.parse_args()
    for noise in NOISE:
        found = [run(noise, seed, options.interactions) for seed in range(options.runs)]
        print(f"{noise:7} {sum(x[0] for x in found):3.0f} of {options.runs} runs reach the goal,",
              f"{max(x[1] for x in found)} classes at most,",
              f"{sum(x[2] > 0 for x in found)} with a test of noise", flush=True)


if __name__ == "__main__":
    main()
