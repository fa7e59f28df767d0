# SPDX-License-Identifier: MIT
"""A model of a world whose states are known: how often each state followed each state and action."""

import numpy as np


class Model:
    """Counts and summed rewards of each state-action pair; the end of an episode is worth 0."""

    def __init__(self, states, actions, discount):
        self.following = np.zeros((states * actions, states))
        self.reward = np.zeros((states, actions))
        self.tried = np.zeros((states, actions))
        self.discount = discount

    def add(self, state, action, reward, reached, over):
        """Count an interaction."""
        self.reward[state, action] += reward
        self.tried[state, action] += 1
        if not over:
            self.following[state * self.tried.shape[1] + action, reached] += 1

    def solve(self, values, unknown, least):
        """Q by value iteration, which changes ``values`` in place.

        ``unknown`` is the value of each pair that was tried fewer than ``least`` times. A state without
        a known pair and with ``unknown`` of minus infinity keeps its value.
        """
        tried = np.maximum(self.tried, 1)
        known = self.tried >= least
        while True:
            onward = (self.following @ values).reshape(tried.shape)
            q = np.where(known, (self.reward + self.discount * onward) / tried, unknown)
            best = q.max(axis=1)
            best = np.where(np.isfinite(best), best, values)
            change = np.abs(best - values).max()
            values[:] = best
            if change < 1e-7 * max(1.0, np.abs(values).max()):
                return q

    @property
    def nbytes(self):
        """Of the counts that are not zero, and of the table of rewards."""
        return np.count_nonzero(self.following) * 8 + self.reward.nbytes + self.tried.nbytes


def greedy(world, q):
    """The greedy actions, as ``check`` takes them."""
    return lambda rows: q[[world.state_of(row) for row in rows]].argmax(axis=1)
