# SPDX-License-Identifier: MIT
"""Logs for tests of counting: walks by chance in Sutton's maze, many at a time."""

import numpy as np

from rlvc.counts.table import Columns

ROWS = (".......#*", "..#....#.", "..#....#.", "..#......", ".....#...", ".........")
MOVES = ((0, -1), (1, 0), (0, 1), (-1, 0))
BITS = 18  # 4 of the column, 11 that say nothing, 3 of the row


def _tables():
    height, width = len(ROWS), len(ROWS[0])
    after = np.zeros((height * width, 4), np.int64)
    for y in range(height):
        for x in range(width):
            for a, (dx, dy) in enumerate(MOVES):
                u, v = x + dx, y + dy
                open_ = 0 <= u < width and 0 <= v < height and ROWS[v][u] != "#"
                after[y * width + x, a] = v * width + u if open_ else y * width + x
    cells = np.array(list("".join(ROWS)))
    return np.flatnonzero(cells == "."), after, cells == "*", width


def maze(count, seed=7, slip=0.0, rewards="plain", walkers=200):
    """`count` interactions: episodes of one walker after another, each cut short at its end."""
    free, after, exits, width = _tables()
    rng = np.random.default_rng(seed)
    steps = -(-count // walkers)
    shape = (walkers, steps)
    before, later = np.zeros(shape, np.uint32), np.zeros(shape, np.uint32)
    actions, ends = np.zeros(shape, np.uint8), np.zeros(shape, np.uint8)
    paid = np.zeros(shape, np.float32)

    def seen(cell):
        noise = rng.integers(0, 1 << 11, walkers)
        return (cell % width | noise << 4 | cell // width << 15).astype(np.uint32)

    cell = rng.choice(free, walkers)
    percept = seen(cell)
    for t in range(steps):
        action = rng.integers(0, 4, walkers)
        astray = rng.random(walkers) < slip
        move = np.where(astray, rng.integers(0, 4, walkers), action)
        to = after[cell, move]
        over = exits[to]
        before[:, t], actions[:, t], later[:, t], ends[:, t] = percept, action, seen(to), over
        paid[:, t] = np.where(over, 100, -1)
        cell = np.where(over, rng.choice(free, walkers), to)
        percept = np.where(over, seen(cell), later[:, t])
    ends[:, -1] = np.where(ends[:, -1] == 1, 1, 2)
    if rewards == "tenths":
        paid = np.where(paid > 0, paid, np.float32(-0.1) * rng.integers(1, 4, shape)).astype(
            np.float32
        )
    if rewards == "normal":
        paid += np.float32(0.5) * rng.standard_normal(shape).astype(np.float32)
    return columns(before, actions, paid, later, ends, count)


def columns(before, actions, paid, later, ends, count):
    def packed(values):
        return np.ascontiguousarray(values.ravel()[:count].view(np.uint8).reshape(-1, 4)[:, :3])

    rewards = np.ascontiguousarray(paid.ravel()[:count])
    return Columns(packed(before), packed(later), actions.ravel()[:count], rewards,
                   ends.ravel()[:count], rewards)  # fmt: skip


def walk(env, encoder, count, seed):
    """A log of an environment of Gymnasium, by chance: what rlvc.learn_from takes."""
    rng = np.random.default_rng(seed)
    made = {name: [] for name in ("observations", "next_observations", "actions", "rewards", "terminated",
                                  "truncated")}  # fmt: skip
    observation, _ = env.reset(seed=seed)
    for _ in range(count):
        action = int(rng.integers(env.action_space.n))
        after, reward, terminated, truncated, _ = env.step(action)
        for name, value in zip(made, (bits(encoder, observation), bits(encoder, after), action, reward,
                                      terminated, truncated), strict=True):  # fmt: skip
            made[name].append(value)
        observation = env.reset()[0] if terminated or truncated else after
    made["truncated"][-1] = not made["terminated"][-1]
    return {name: np.array(values) for name, values in made.items()}


def bits(encoder, observation):
    record = np.frombuffer(encoder.encode(observation), np.uint8)
    return np.unpackbits(record, count=encoder.domain.bits, bitorder="little").astype(bool)


def log_of(some, bits=BITS):
    """Columns as a log of arrays."""

    def unpacked(values):
        return np.unpackbits(values, axis=1, count=bits, bitorder="little").astype(bool)

    return {"observations": unpacked(some.percepts), "next_observations": unpacked(some.next_percepts),
            "actions": some.actions, "rewards": some.rewards, "terminated": some.ends == 1,
            "truncated": some.ends == 2}  # fmt: skip


def part_of(some, index):
    return Columns(*(np.ascontiguousarray(getattr(some, name)[index])
                     for name in ("percepts", "next_percepts", "actions", "rewards", "ends", "keys")))  # fmt: skip
