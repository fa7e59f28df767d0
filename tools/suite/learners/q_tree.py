# SPDX-License-Identifier: MIT
"""Pyeatt and Howe's Q-tree ("Decision tree function approximation in reinforcement learning", 2001),
with their t-test. A leaf holds Q of each action, learnt as in a table, and its last changes of Q:

    d := rate * (r + discount * max over b of Q(leaf of s', b) - Q(leaf of s, a))

Once it holds ``history`` of these, and their mean is within two standard deviations of 0 (so that Q no
longer goes one way), the leaf is split by the bit whose sides differ most, if their t is above
``critical``. Both sides begin with its Q.
"""

import numpy as np


class Tree:
    """Nodes in the order in which they were made; a node is a leaf while its bit is -1."""

    def __init__(self, actions, bits, history):
        self.bit, self.sides = [-1], [None]
        self.q = [np.zeros(actions)]
        self.changes = [[]]  # of a leaf: pairs of observation and d
        self.bits, self.history = bits, history

    def leaf(self, row):
        """The leaf of an observation."""
        node = 0
        while self.bit[node] >= 0:
            node = self.sides[node][int(row[self.bit[node]])]
        return node

    def note(self, leaf, row, change, critical):
        """Keeps a change of Q, and splits the leaf when it is time."""
        kept = self.changes[leaf]
        kept.append((row, change))
        if len(kept) < self.history:
            return
        rows = np.array([row for row, _ in kept], bool)
        changes = np.array([change for _, change in kept])
        kept.pop(0)
        if abs(changes.mean()) < 2 * changes.std():
            t = _t(rows, changes)
            if t.max() > critical:
                self._split(leaf, int(t.argmax()))

    def _split(self, leaf, bit):
        self.bit[leaf], self.sides[leaf] = bit, (len(self.bit), len(self.bit) + 1)
        for _ in range(2):
            self.bit.append(-1)
            self.sides.append(None)
            self.q.append(self.q[leaf].copy())
            self.changes.append([])
        self.changes[leaf] = []


def _t(rows, changes, fewest=3):
    """Welch's t of the changes, with a bit and without, for each bit; 0 if a side has too few."""
    count = np.stack([(~rows).sum(axis=0), rows.sum(axis=0)])
    some = np.maximum(count, 1)
    mean = np.stack([changes @ ~rows, changes @ rows]) / some
    square = np.stack([changes**2 @ ~rows, changes**2 @ rows]) / some
    error = ((square - mean**2).clip(0) / np.maximum(some - 1, 1)).sum(axis=0)
    t = np.abs(mean[1] - mean[0]) / np.sqrt(error + 1e-12)
    return np.where(count.min(axis=0) < fewest, 0.0, t)


def learn(task, seed, check, rate=0.1, epsilon=0.3, history=200, critical=3.0, checks=100):
    """One run; see the head of this package."""
    env, world = task.make(seed), task.world
    random = np.random.default_rng([seed, 7])
    tree = Tree(world.actions, world.bits.shape[1], history)
    every = task.interactions // checks

    def act(rows):
        return np.array([tree.q[tree.leaf(row)].argmax() for row in rows])

    row = env.reset(seed=seed)[0]
    for done in range(1, task.interactions + 1):
        leaf = tree.leaf(row)
        q = tree.q[leaf]
        if random.random() < epsilon:
            action = int(random.integers(world.actions))
        else:
            action = int(random.choice(np.flatnonzero(q == q.max())))
        reached, reward, over, cut, _ = env.step(action)
        onward = 0.0 if over else tree.q[tree.leaf(reached)].max()
        change = rate * (reward + task.discount * onward - q[action])
        q[action] += change
        tree.note(leaf, row, change, critical)
        row = env.reset()[0] if over or cut else reached
        if done % every == 0:
            check(done, act)
    noise = set(world.distractors.tolist())
    return {
        "leaves": tree.bit.count(-1),
        "distractors": sum(bit in noise for bit in tree.bit),
        "bytes": sum(q.nbytes for q in tree.q) + history * world.bits.shape[1] * tree.bit.count(-1),
    }
