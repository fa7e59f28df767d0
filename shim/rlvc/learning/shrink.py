# SPDX-License-Identifier: MIT
"""A small policy from the values of an agent."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from ..checks import whole
from ..errors import ArrayError, RangeError
from .small_policy import Reals, SmallPolicy

_CUTPOINTS = 32  # of a component, at quantiles of all percepts
_LEAST = 1e-6  # gain of a test that is worth a leaf, as a share of what is at stake


class _Growth:
    """A small policy that grows: which rows each leaf has, and its best split."""

    def __init__(self, rows: Reals, values: Reals) -> None:
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
        """The gain of the best split of some rows, its component, and its cutpoint's number."""
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
        """Split the leaf where that gains most; whether there was one."""
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
    """Gini's, times what is weighed: 0 where there is but one action."""
    whole = weight.sum(axis=-1)
    return whole - (weight**2).sum(axis=-1) / np.maximum(whole, 1e-30)


def shrink(percepts: Reals, values: Reals, leaves: int) -> SmallPolicy:
    """Make a small policy that loses as little as can be of what is at stake, by a greedy search.

    Each percept wants the action of the greatest value, by the square root of how much that is
    above the second: by as much itself, what goes before a fall would take all leaves, and none be
    left for what keeps one far from falling. The leaf is split, and the cutpoint taken, by which
    the impurity of these wishes falls most.

    Parameters
    ----------
    percepts : ndarray of float32, [n, components]
        That were met.
    values : ndarray, [n, actions]
        Q of each action at each of them.
    leaves : int
        At most.

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
