# SPDX-License-Identifier: MIT
"""Makes a small policy from the values of an agent."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from ..checks import whole
from ..errors import ArrayError, RangeError
from .small_policy import Reals, SmallPolicy

_CUTPOINTS = 32  # cutpoints of a component, at quantiles of all percepts
_LEAST = 1e-6  # smallest gain of a split, as a share of the total weight


class _Growth:
    """A growing policy: the rows of each leaf, and the best split of each leaf."""

    def __init__(self, rows: Reals, values: Reals) -> None:
        # The weight of a percept: the square root of its advantage of the best action. The advantage
        # itself would spend all leaves on the moments before a failure, none on avoiding them.
        order = np.sort(values, axis=1)
        stake = order[:, -1] - order[:, -2] if values.shape[1] > 1 else order[:, -1] * 0
        stake = np.sqrt(stake)
        self.weight = np.zeros(values.shape)
        self.weight[np.arange(len(rows)), values.argmax(axis=1)] = stake
        ranks = np.arange(1, _CUTPOINTS + 1) / (_CUTPOINTS + 1)
        self.cutpoints = [
            np.unique(np.quantile(column, ranks).astype(np.float32)) for column in rows.T
        ]
        self.bins = [
            np.searchsorted(cut, column) for cut, column in zip(self.cutpoints, rows.T, strict=True)
        ]
        self.least = _LEAST * float(stake.sum())
        self.policy = SmallPolicy()
        self.leaves: dict[int, npt.NDArray[Any]] = {}
        self.best: dict[int, tuple[float, int, int]] = {}
        self.put(0, np.arange(len(rows)))

    def put(self, node: int, rows: npt.NDArray[Any]) -> None:
        self.leaves[node] = rows
        self.best[node] = self.search(rows)
        self.policy._action[node] = int(self.weight[rows].sum(axis=0).argmax())

    def search(self, rows: npt.NDArray[Any]) -> tuple[float, int, int]:
        """Return the gain of the best split of some rows, its component and its cutpoint's index."""
        found = (self.least, -1, 0)
        weight = self.weight[rows]
        for i, cut in enumerate(self.cutpoints):
            below = np.stack(
                [np.bincount(self.bins[i][rows], w, len(cut) + 1) for w in weight.T], axis=1
            ).cumsum(axis=0)
            whole = below[-1]
            gains = _impurity(whole) - _impurity(below[:-1]) - _impurity(whole - below[:-1])
            if len(cut) and gains.max() > found[0]:
                found = (float(gains.max()), i, int(gains.argmax()))
        return found

    def grow(self) -> bool:
        """Split the leaf with the largest gain; return whether there was one."""
        node = max(self.best, key=lambda leaf: self.best[leaf][0])
        _, test, number = self.best.pop(node)
        if test < 0:
            return False
        rows = self.leaves.pop(node)
        above = self.bins[test][rows] > number
        absent, present = self.policy._split(node, test, float(self.cutpoints[test][number]))
        self.put(absent, rows[~above])
        self.put(present, rows[above])
        return True


def _impurity(weight: Reals) -> Any:
    """Gini impurity times the total weight: 0 if all weight is on one action."""
    whole = weight.sum(axis=-1)
    return whole - (weight**2).sum(axis=-1) / np.maximum(whole, 1e-30)


def shrink(percepts: Reals, values: Reals, leaves: int) -> SmallPolicy:
    """Make a small policy from percepts and the values of the actions there, by a greedy search.

    Each percept votes for its best action. The weight of the vote is the square root of the
    advantage of the best action over the second best. Each step makes the split that reduces the
    weighted Gini impurity of the votes most.

    Parameters
    ----------
    percepts : ndarray of float32, [n, components]
    values : ndarray, [n, actions]
        Q of each action at each percept.
    leaves : int
        Maximum number of leaves.

    Returns
    -------
    SmallPolicy

    Raises
    ------
    RangeError
        ``leaves`` is less than 1.
    ArrayError
        ``percepts`` or ``values`` has another shape.
    """
    leaves = whole("leaves", leaves, 1, 2**31, RangeError)
    try:
        rows, wanted = np.asarray(percepts, np.float32), np.asarray(values, np.float64)
    except (TypeError, ValueError) as error:
        raise ArrayError(f"percepts and values must be arrays of numbers: {error}") from None
    if rows.ndim != 2 or wanted.ndim != 2 or len(rows) != len(wanted) or 0 in wanted.shape:
        raise ArrayError(
            f"percepts {list(rows.shape)} and values {list(wanted.shape)}, expected "
            "[n, components] and [n, actions], neither of them empty"
        )
    growth = _Growth(rows, wanted)
    while len(growth.leaves) < leaves and growth.grow():
        pass
    return growth.policy._merge()
